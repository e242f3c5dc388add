//! Loaded candidate code: the one place where it is called.

use std::collections::HashMap;
use std::fs::File;
use std::path::{Path, PathBuf};

use libloading::Library;
use scene::{KernelFn, List, PrepareFn, RayHits, RayPacket, Record, Triangle};

use crate::isolation;
use crate::memory_layout::COPIES;
use crate::protocol::Entry;

/// A kernel that can be called while its library is kept.
#[derive(Clone, Copy)]
pub(crate) struct Loaded {
    /// One function, in each copy of the library.
    copies: [KernelFn; COPIES],
    record: Record,
    /// How many packets it takes at once.
    together: usize,
    /// What makes its records, if they are its own.
    prepare: Option<PrepareFn>,
}

impl Loaded {
    /// Runs the kernel on packets and a list in its layout.
    ///
    /// # Panics
    ///
    /// If they are not as many as it takes at once.
    pub fn call_all(self, packets: &mut [RayPacket], hits: &mut RayHits, list: List<'_>) {
        self.call_copy(0, packets, hits, list);
    }

    /// The same by one of the [`COPIES`] of its code.
    pub fn call_copy(
        self,
        copy: usize,
        packets: &mut [RayPacket],
        hits: &mut RayHits,
        list: List<'_>,
    ) {
        assert_eq!(packets.len(), self.together, "as many as it takes at once");
        // SAFETY: the function was exported by a library of ours with this signature; it reads the
        // list's records and reads and writes `hits` and as many packets, all of which are valid for it.
        unsafe {
            (self.copies[copy])(
                packets.as_mut_ptr(),
                hits,
                list.numbers.as_ptr(),
                list.records,
            )
        }
    }

    /// Runs the kernel on one packet, and on copies of it if it takes several at once.
    pub fn call(self, packet: &mut RayPacket, hits: &mut RayHits, list: List<'_>) {
        if self.together == 1 {
            self.call_all(std::slice::from_mut(packet), hits, list);
            return;
        }
        let mut packets = vec![packet.clone(); self.together];
        self.call_all(&mut packets, hits, list);
        packet.clone_from(&packets[0]);
    }

    /// How many packets it takes at once.
    pub fn together(self) -> usize {
        self.together
    }

    /// What it has of a triangle.
    pub fn prepare(self, triangle: &Triangle) -> Vec<f32> {
        if let Record::Stored(stored) = self.record {
            return stored.of(triangle).concat();
        }
        let mut record = vec![f32::NAN; self.record.numbers()];
        self.prepare_all(std::slice::from_ref(triangle), &mut record);
        record
    }

    /// Whether it makes records of its own.
    pub fn prepares(self) -> bool {
        self.prepare.is_some()
    }

    /// Makes its own records of triangles, one after another; does nothing if it has none.
    ///
    /// # Panics
    ///
    /// If there is no room for as many numbers.
    pub fn prepare_all(self, triangles: &[Triangle], records: &mut [f32]) {
        let Some(prepare) = self.prepare else {
            return;
        };
        let room = triangles.len() * self.record.numbers();
        assert!(records.len() >= room, "room for every record");
        // SAFETY: the function was exported by a library of ours with this signature, and writes as
        // many numbers of every triangle as its record has.
        unsafe { prepare(triangles.as_ptr(), triangles.len(), records.as_mut_ptr()) }
    }
}

/// Libraries in use, each in one or several copies. Dropping them takes away the kernels' code.
#[derive(Default)]
pub(crate) struct Libraries(HashMap<PathBuf, Vec<Copied>>);

/// Files that stay free for all else where copies of libraries take them.
const FREE_FILES: usize = 32;

/// A library, and the file that it is a copy of its own in, which has its name while it is open.
struct Copied {
    library: Library,
    _file: Option<File>,
}

impl Libraries {
    /// Loads a kernel, and its library if that is not loaded yet: in [`COPIES`] if it is to be timed, the system can
    /// load a library twice, and as many files may be open.
    pub fn load(&mut self, entry: &Entry, timed: bool) -> Result<Loaded, libloading::Error> {
        let libraries = match self.0.get(&entry.library) {
            Some(libraries) => libraries,
            None => {
                let mut libraries = vec![Copied {
                    library: open(&entry.library)?,
                    _file: None,
                }];
                // Every copy keeps a file open.
                let open_files = (self.0.len() + 1) * (COPIES - 1) + FREE_FILES;
                if timed && open_files <= isolation::open_files() {
                    libraries.extend((1..COPIES).map_while(|_| copied(&entry.library)));
                }
                self.0.entry(entry.library.clone()).or_insert(libraries)
            }
        };
        let library = &libraries[0].library;
        let symbol = emit::entry_symbol(entry.index);
        // SAFETY: our libraries export this symbol with this signature.
        let mut copies = [unsafe { *library.get::<KernelFn>(symbol.as_bytes())? }; COPIES];
        for (copy, copied) in copies.iter_mut().zip(libraries).skip(1) {
            // SAFETY: likewise.
            *copy = unsafe { *copied.library.get::<KernelFn>(symbol.as_bytes())? };
        }
        let record = entry.layout.record;
        let prepare = match record {
            Record::Stored(_) => None,
            Record::Own { .. } => {
                let symbol = emit::prepare_symbol(entry.index);
                // SAFETY: likewise.
                Some(unsafe { *library.get::<PrepareFn>(symbol.as_bytes())? })
            }
        };
        Ok(Loaded {
            copies,
            record,
            together: entry.together,
            prepare,
        })
    }
}

impl Libraries {
    /// How often a loaded kernel's words have been used so far, if its library counts them.
    pub fn counts(&self, entry: &Entry) -> Option<Vec<u64>> {
        type CountsFn = unsafe extern "C" fn() -> *const [u64; emit::COUNTED_WORDS.len()];
        let library = &self.0.get(&entry.library)?.first()?.library;
        let counts = emit::Isa::ALL.into_iter().find_map(|isa| {
            let symbol = emit::counts_symbol(isa);
            // SAFETY: our libraries export this symbol with this signature.
            unsafe { library.get::<CountsFn>(symbol.as_bytes()) }.ok()
        })?;
        // SAFETY: the function gives a pointer to a static of the library, which is kept; kernels write to
        // it on this thread alone, and none is running.
        Some(unsafe { *counts() }.to_vec())
    }
}

fn open(path: &Path) -> Result<Library, libloading::Error> {
    // SAFETY: the libraries are ours and have no initialisers.
    unsafe { Library::new(path) }
}

/// Another copy of a library, at another place in memory; none if there cannot be one. A loader knows a library again by
/// its file and by its name, so the copy has a file of its own, in memory.
#[cfg(target_os = "linux")]
fn copied(path: &Path) -> Option<Copied> {
    use std::io::Write;
    use std::os::fd::AsRawFd;

    use rustix::fs::{MemfdFlags, memfd_create};

    let mut file = File::from(memfd_create("copy", MemfdFlags::CLOEXEC).ok()?);
    file.write_all(&std::fs::read(path).ok()?).ok()?;
    let name = PathBuf::from(format!("/proc/self/fd/{}", file.as_raw_fd()));
    Some(Copied {
        library: open(&name).ok()?,
        _file: Some(file),
    })
}

/// Elsewhere there is one.
#[cfg(not(target_os = "linux"))]
fn copied(_: &Path) -> Option<Copied> {
    None
}

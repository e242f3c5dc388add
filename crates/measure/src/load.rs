//! Loaded candidate code: the one place where it is called.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use libloading::Library;
use scene::{KernelFn, List, RayHits, RayPacket};

use crate::protocol::Entry;

/// A kernel that can be called while its library is kept.
#[derive(Clone, Copy)]
pub(crate) struct Loaded(KernelFn);

impl Loaded {
    /// Runs the kernel on a list in its layout.
    pub fn call(self, packet: &mut RayPacket, hits: &mut RayHits, list: List<'_>) {
        // SAFETY: the function was exported by a library of ours with this signature; it reads the
        // list's records and reads and writes `packet` and `hits`, all of which are valid for it.
        unsafe { (self.0)(packet, hits, list.numbers.as_ptr(), list.records) }
    }
}

/// Libraries in use. Dropping them takes away the kernels' code.
#[derive(Default)]
pub(crate) struct Libraries(HashMap<PathBuf, Library>);

impl Libraries {
    /// Loads a kernel, and its library if that is not loaded yet.
    pub fn load(&mut self, entry: &Entry) -> Result<Loaded, libloading::Error> {
        let library = match self.0.get(&entry.library) {
            Some(library) => library,
            None => {
                let library = open(&entry.library)?;
                self.0.entry(entry.library.clone()).or_insert(library)
            }
        };
        let symbol = emit::entry_symbol(entry.index);
        // SAFETY: our libraries export this symbol with this signature.
        let function = unsafe { library.get::<KernelFn>(symbol.as_bytes())? };
        Ok(Loaded(*function))
    }
}

fn open(path: &Path) -> Result<Library, libloading::Error> {
    // SAFETY: the libraries are ours and have no initialisers.
    unsafe { Library::new(path) }
}

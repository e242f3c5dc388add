//! Where kernels run: packets of the workload and lists of triangles, at whatever place in memory.

use std::collections::BTreeMap;
use std::ops::Range;

use scene::{
    Layout, Lists, NO_HITS, RayHits, RayPacket, Triangle, Workload, at_depth, drive_together,
};

use crate::load::Loaded;
use crate::memory_layout::MemoryLayout;
use crate::placed::Placed;

/// A kernel to be timed.
#[derive(Clone, Copy)]
pub(crate) struct Numbered {
    /// Its place in the batch.
    pub number: usize,
    /// Its code.
    pub loaded: Loaded,
    /// How it has its triangles in memory.
    pub layout: Layout,
}

/// The workload, with packets to write to.
pub(crate) struct Track<'a> {
    workload: &'a Workload,
    /// The lists of triangles in every layout that some kernel has.
    lists: BTreeMap<Layout, Lists>,
    packets: Placed<RayPacket>,
    hits: Placed<RayHits>,
}

impl<'a> Track<'a> {
    /// The track of these lists, for so many packets at once.
    pub fn new<'b>(
        workload: &'a Workload,
        lists_of: impl Iterator<Item = &'b [Triangle]> + Clone,
        kernels: &[Numbered],
        packets: usize,
    ) -> Track<'a> {
        let mut lists = BTreeMap::new();
        for Numbered { loaded, layout, .. } in kernels {
            lists.entry(*layout).or_insert_with(|| {
                layout.lists_of(lists_of.clone(), |triangle| loaded.prepare(triangle))
            });
        }
        Track {
            workload,
            lists,
            packets: Placed::new(packets),
            hits: Placed::new(1),
        }
    }

    /// Moves the records of all lists to this line of a page.
    pub fn move_records(&mut self, line: usize) {
        for lists in self.lists.values_mut() {
            lists.move_to(line);
        }
    }

    /// Runs a kernel on some packets, everything lying at its place: `time` is given what is to be timed. Gives what
    /// that says, and the packets as the kernel leaves them.
    pub fn run<T>(
        &mut self,
        kernel: Numbered,
        at: MemoryLayout,
        packets: &Range<usize>,
        time: impl FnOnce(&mut dyn FnMut()) -> T,
    ) -> (T, &[RayPacket]) {
        let initial = &self.workload.packets[packets.clone()];
        let scratch = self.packets.at(at.rays, initial);
        let [hits] = self.hits.at(at.hits, std::slice::from_ref(&NO_HITS)) else {
            unreachable!("there is one")
        };
        let lists = &self.lists[&kernel.layout];
        let said = at_depth(at.depth, || {
            time(&mut || {
                drive_together(
                    kernel.loaded.together(),
                    initial,
                    lists.iter(),
                    scratch,
                    |packets, list| kernel.loaded.call_copy(at.code, packets, hits, list),
                );
            })
        });
        (said, scratch)
    }
}

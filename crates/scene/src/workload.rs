//! Workloads: rays and triangles to time or test on.

use std::ops::Range;

use crate::{Hits, Packet, Regime, Triangle};

/// Rays in a packet of the paper's workload (appendix, `packet_size`).
pub const PACKET_SIZE: usize = 64;

/// A packet of the paper's size.
pub type RayPacket = Packet<PACKET_SIZE>;

/// What is reported of the hits of such a packet.
pub type RayHits = Hits<PACKET_SIZE>;

/// Nothing reported yet.
pub const NO_HITS: RayHits = Hits {
    u: [0.0; PACKET_SIZE],
    v: [0.0; PACKET_SIZE],
    triangle: [0; PACKET_SIZE],
    normal: [[0.0; PACKET_SIZE]; 3],
    point: [[0.0; PACKET_SIZE]; 3],
};

/// What `t` is before a ray has hit anything (appendix, `rtf`).
pub const INITIAL_T: f32 = 1_000_000.0;

/// What `hit_t` is before a ray has hit anything.
pub const NO_HIT: f32 = f32::INFINITY;

/// Triangles, and packets of rays of which each is tested against all of them.
#[derive(Clone)]
pub struct Workload {
    /// The triangles.
    pub triangles: Vec<Triangle>,
    /// The packets, as they are before a kernel has seen them.
    pub packets: Vec<RayPacket>,
}

impl Workload {
    /// The packets of `range` against all triangles. A workload is shortened by packets, never
    /// by triangles: in the shrinking regime the length of the list decides what a test costs.
    ///
    /// # Panics
    ///
    /// `range` does not lie within the packets.
    pub fn part(&self, range: Range<usize>) -> Part<'_> {
        Part {
            packets: &self.packets[range],
            triangles: &self.triangles,
        }
    }

    /// All packets.
    pub fn whole(&self) -> Part<'_> {
        self.part(0..self.packets.len())
    }
}

/// Triangles in a list of the [`Regime::Leaf`] regime: a BVH leaf.
pub const LEAF_TRIANGLES: usize = 8;

/// Some packets of a workload against all of its triangles.
#[derive(Clone, Copy)]
pub struct Part<'a> {
    /// The packets, as they are before a kernel has seen them.
    pub packets: &'a [RayPacket],
    /// The triangles.
    pub triangles: &'a [Triangle],
}

impl Part<'_> {
    /// The lists of triangles that every packet sees in a regime, one after another: one of all of
    /// them, or in [`Regime::Leaf`] lists of [`LEAF_TRIANGLES`].
    pub fn lists(&self, regime: Regime) -> std::slice::Chunks<'_, Triangle> {
        self.triangles.chunks(match regime {
            Regime::Shrinking | Regime::Fixed => self.triangles.len().max(1),
            Regime::Leaf => LEAF_TRIANGLES,
        })
    }

    /// Ray-triangle tests in one run over it, in any regime.
    pub fn tests(&self) -> u64 {
        (self.packets.len() * PACKET_SIZE) as u64 * self.triangles.len() as u64
    }
}

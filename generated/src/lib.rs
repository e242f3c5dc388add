//! Ray-triangle intersection kernels, bred by genetic search, each with its measured error.
//!
//! A packet of rays is tested against a slice of triangles for the closest hit of every ray:
//!
//! ```
//! use raybreed::{Packet, Triangle};
//!
//! let triangle = Triangle {
//!     p0: [-1.0, -1.0, 5.0],
//!     p1: [1.0, -1.0, 5.0],
//!     p2: [0.0, 1.0, 5.0],
//! };
//! let mut packet = Packet::<64>::new();
//! packet.set_ray(0, [0.0; 3], [0.0, 0.0, 1.0], f32::INFINITY);
//! # #[cfg(target_arch = "x86_64")] {
//! raybreed::closest_hits(&mut packet, &[triangle]);
//! assert_eq!(packet.t[0], 5.0);
//! # }
//! ```
//!
//! Which triangle it was, a caller learns by testing short slices, such as the leaves of a
//! hierarchy, and looking where `t` fell.
//!
//! What the kernels promise: a hit has `0 < t < packet.t[i]`; triangles are seen from both sides;
//! NaN, infinity and triangles without area are misses, in their own lane only; there is no
//! absolute epsilon. They are not watertight: a ray at an edge that two triangles share may miss
//! both. [`CATALOGUE`] has every kernel's speed and error, as measured when it was bred.
//!
//! The files of [`kernels`] are generated from the recipes beside them.

mod catalogue;
mod entry;
pub mod kernels;
mod packet;

pub use catalogue::CATALOGUE;
pub use entry::{Entry, Origin, Scales, Share, Stability, TError, Tags, Watertight};
pub use packet::{Packet, Triangle};

/// Lowers each `packet.t[i]` to the closest hit of ray `i` with any of `triangles`, if there is
/// one below it.
///
/// `N`, the number of rays, must be a multiple of 4; anything else does not compile.
#[cfg(target_arch = "x86_64")]
pub fn closest_hits<const N: usize>(packet: &mut Packet<N>, triangles: &[Triangle]) {
    // SAFETY: every x86-64 processor has SSE2, which is all that the kernel needs.
    unsafe { kernels::sse2::packet_shrinking(packet, triangles) }
}

/// The same as [`closest_hits`] for rays that share one origin, that of ray 0; faster.
///
/// The origins of the other rays are never read.
#[cfg(target_arch = "x86_64")]
pub fn closest_hits_from_one_origin<const N: usize>(
    packet: &mut Packet<N>,
    triangles: &[Triangle],
) {
    // SAFETY: every x86-64 processor has SSE2, which is all that the kernel needs.
    unsafe { kernels::sse2::common_origin_shrinking(packet, triangles) }
}

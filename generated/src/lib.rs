//! Ray-triangle intersection kernels, bred by genetic search, each with its measured error.
//!
//! Rays come in packets, or one by one; a scene says what it requires of a test; the test is made once, with the
//! instructions that the processor has, from SSE2 to AVX-512:
//!
//! ```
//! use raybreed::{Block, Hits, Intersector, Packet, Ray, Scene, Triangle, Watertight};
//!
//! /// Meshes without holes; which triangle a ray hits, and where.
//! struct Meshes;
//!
//! impl Scene for Meshes {
//!     const WATERTIGHT: Watertight = Watertight::Edges;
//!     const TRIANGLE: bool = true;
//!     const UV: bool = true;
//! }
//!
//! let floor = |z| Triangle::new([-4.0, -4.0, z], [4.0, -4.0, z], [0.0, 4.0, z]);
//! let triangles = [floor(7.0), floor(2.0), floor(3.0)];
//! let test = Intersector::<Meshes>::new();
//!
//! // Many rays, triangles one after another: the closest hit of every ray.
//! let mut packet = Packet::<64>::new();
//! for i in 0..64 {
//!     packet.set(i, Ray::new([0.0; 3], [i as f32 / 32.0 - 1.0, 0.0, 1.0]));
//! }
//! let mut hits = Hits::new();
//! test.closest_hits(&mut packet, &mut hits, &triangles);
//! assert_eq!((packet.t[32], hits.triangle[32]), (2.0, 1));
//!
//! // One ray, triangles in blocks of eight: the closest hit, or whether there is any.
//! let blocks: Vec<Block<8>> = Triangle::blocks(&triangles).collect();
//! let mut ray = Ray::new([0.0; 3], [0.0, 0.0, 1.0]);
//! let hit = test.ray_closest_hit(&mut ray, &blocks).unwrap();
//! assert_eq!((hit.t, hit.triangle), (2.0, 1));
//! assert!(!test.ray_any(&ray, &blocks), "nothing is closer");
//! ```
//!
//! # Which kernel do I need?
//!
//! None by name. Say what the scene requires, and the fastest that keeps it is called:
//!
//! | I have … | write |
//! |---|---|
//! | rays that start and go together: primary rays, shadow rays of a packet | a [`Packet`]; [`closest`](Intersector::closest), [`any`](Intersector::any) |
//! | … all from one point, as from the eye | [`ORIGIN`](Scene::ORIGIN)` = Origin::Common` |
//! | rays that go anywhere: ambient occlusion, paths | a [`Ray`] and [`Block`]s; [`ray_closest`](Intersector::ray_closest), [`ray_any`](Intersector::ray_any) |
//! | leaves of a hierarchy | nothing: short lists are the default |
//! | hundreds of triangles in a row | [`LISTS`](Scene::LISTS)` = Lists::Long` |
//! | meshes that must have no holes | [`WATERTIGHT`](Scene::WATERTIGHT)` = Watertight::Edges`, or `Full` if not at a vertex either |
//! | answers that must not depend on the machine | [`NUMERIC`](Scene::NUMERIC)` = Numeric::Portable` |
//! | to shade what is hit | [`TRIANGLE`](Scene::TRIANGLE), [`UV`](Scene::UV), [`NORMAL`](Scene::NORMAL), [`POINT`](Scene::POINT) |
//! | surfaces that rays start from | [`T_MIN`](Scene::T_MIN)` = true` |
//! | closed meshes seen from outside | [`CULLING`](Scene::CULLING)` = Culling::Back` |
//! | normals at hand | [`TriangleWithNormal`]: another 12 bytes a triangle |
//! | a kernel in mind | [`kernels`], by name |
//!
//! What each costs in speed and error, [`catalogue()`] knows, and the pages of [`kernels`] show. By its name, a kernel is
//! a function that needs its instruction set; elsewhere to call it is `unsafe`:
//!
//! ```
//! # #[cfg(target_arch = "x86_64")] {
//! use raybreed::{Hits, Isa, Packet, Ray, Triangle, kernels::avx2};
//!
//! let floor = Triangle::new([-4.0, -4.0, 2.0], [4.0, -4.0, 2.0], [0.0, 4.0, 2.0]);
//! let mut packet = Packet::<8>::of(&[Ray::new([0.0; 3], [0.0, 0.0, 1.0]); 8]);
//! if Isa::Avx2.is_available() {
//!     // No hits are reported but by `t`, of those the closest; nothing beyond the default scene is asked for.
//!     // SAFETY: the processor has AVX2.
//!     unsafe { avx2::packet_leaf::<8, 0, false, (), Triangle>(&mut packet, &mut Hits::new(), &[floor]) };
//!     assert_eq!(packet.t, [2.0; 8]);
//! }
//! # }
//! ```
//!
//! # What holds for all
//!
//! - A hit has `t_min < t < t_max`, both strictly, and no less than zero; what is at the ends is no hit, and what is
//!   within a rounding of them may be none.
//! - No input makes a test panic. NaN and infinity are misses, in their own lane only.
//! - A triangle without area is a miss: its vertices are on a line, or not three. That is told exactly, of a slice's
//!   triangles and of those that [`Triangle::block`] takes; a triangle of any area, however small, is kept. A mesh that
//!   closes a gap beside a vertex in the middle of an edge by such triangles is not tight there: the edge must end in it.
//! - A ray whose `t` is zero, negative or NaN is inactive: nothing of it, nor of its hit, is written.
//! - No kernel has an absolute epsilon: a triangle of a thousandth is hit as one of a thousand. How far that goes, the
//!   [`Scales`] of each kernel say: most from 2^-37 to 2^37, those that square volumes from 2^-16 to 2^16.
//! - Empty slices are fine, packets of any size, blocks of any width.
//! - Whether there is any hit, and whether there is a closest one, is one test: they agree.
//! - Triangles are seen from both sides, unless a side is culled.
//! - Directions are never normalised for you.
//!
//! # Features
//!
//! - `std` (default): the processor is asked what it has. Without it the crate is `no_std`, and has what the
//!   compiler was told, `-C target-feature`; on x86-64 that is SSE2 at least.
//! - `bytemuck`: triangles are plain data, so a slice of numbers is a slice of them.
//! - `glam`: triangles from `Vec3` and `Vec3A`; rays take them anyway.
//!
//! What is below [`kernels`], but for this documentation's links, is generated from the recipes of the package.

#![no_std]

#[cfg(feature = "std")]
extern crate std;

mod catalogue;
mod dispatch;
mod entry;
mod intersector;
mod isa;
pub mod kernels;
mod ray;
mod scene;
mod triangle;

pub use entry::{Entry, Grouping, Scales, Share, Stability, TError, Tags};
pub use intersector::Intersector;
pub use isa::Isa;
pub use ray::{Hit, Hits, Packet, Ray};
pub use scene::{Culling, Lists, Numeric, Origin, Scene, Watertight};
pub use triangle::{Block, Edges, EdgesWithNormal, Record, Triangle, TriangleWithNormal};

/// Every kernel of the package, with what was measured of it.
///
/// ```
/// for entry in raybreed::catalogue() {
///     println!("{} {}: {:.2} times Möller-Trumbore", entry.name, entry.isa, entry.ratio);
/// }
/// ```
pub fn catalogue() -> &'static [Entry] {
    catalogue::CATALOGUE
}

//! How often, and how far, ray-triangle kernels are wrong.
//!
//! Random rays against random triangles prove nothing about edges, so the [`Case`]s here aim at
//! them, and an [`Exact`] oracle says what is right. Whatever tests rays against triangles is a
//! [`Subject`]; [`watertightness`] counts the rays that slip through closed surfaces,
//! and [`profiles`] says how often a [`PairCase`]'s verdicts are wrong, and how far `t` is off;
//! [`scale_range`] says over which scales they stay the same, and [`hostile()`] what becomes of inputs
//! that are not finite. A [`Sweep`] follows errors and verdicts as everything grows, or moves away, and a
//! [`Trial`] tells a search as much as it needs of many subjects.

mod cases;
mod distribution;
mod exact;
mod fans;
mod hostile;
mod lattice;
mod leaks;
mod meshes;
mod metrics;
mod pairs;
mod patch;
mod placement;
mod random;
mod rate;
mod rays;
mod scales;
mod subject;
mod sweeps;
mod trial;
mod vector;

pub use cases::{BLOCK_RAYS, Block, Case, Shot};
pub use distribution::{Distribution, Summary};
pub use exact::{Class, Corner, Exact, Side};
pub use fans::Fan;
pub use hostile::{Hostile, hostile};
pub use leaks::{CaseLeaks, Leaks, Passage, watertightness};
pub use meshes::{Mesh, Star};
pub use metrics::{CaseProfile, Counts, Profile, profiles};
pub use pairs::{PairBlock, PairCase, TRIANGLE_RAYS};
pub use patch::Patch;
pub use rate::Rate;
pub use rays::Aim;
pub use scales::{Scaling, scale_range};
pub use subject::{BATCH_RAYS, BATCH_TRIANGLES, Hit, Packets, Scalar, Subject};
pub use sweeps::{Sweep, SweepPoint, Swept, sweeps};
pub use trial::{Trial, Tried};

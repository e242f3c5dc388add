//! Scene models, the paper's workload, the regimes it is run in, and the oracle that judges
//! answers.
//!
//! A [`SceneModel`] says what a scene requires of a kernel. A [`Generator`] makes the [`Workload`]
//! of Kensler-Shirley's appendix; [`drive`] runs a kernel over a [`Part`] of it in a [`Regime`];
//! [`Expected`] says which answers an `f32` kernel may give, and how far off they are.
//!
//! ```
//! use scene::{Expected, Generator, Part, Regime};
//!
//! let workload = Generator { triangles: 100, packets: 2, ..Generator::default() }.generate();
//! let part: Part = workload.part(0..1);
//! let expected = Expected::of(Regime::Shrinking, &part.packets[0], part.triangles);
//! assert!(expected.clear_hit(0).is_some());
//! ```

#[path = "../../../templates/abi.rs"]
pub mod abi;
#[path = "../../../templates/bounds.rs"]
pub mod bounds;

mod depth;
mod drand48;
mod expected;
mod generate;
mod layout;
mod model;
mod oracle;
mod run;
mod task;
mod workload;

pub use abi::{Edges, EdgesWithNormal, Hits, Packet, Triangle, TriangleWithNormal};
pub use bounds::{BoundsCheck, OutOfBounds};
pub use depth::{DEPTH_STEP, DEPTHS, at_depth};
pub use drand48::Drand48;
pub use expected::Expected;
pub use generate::Generator;
pub use layout::{Layout, List, Lists, Record};
pub use model::{
    Bounds, Contradiction, Culling, Directions, Grouping, Length, NoBounds, NoLength, Numeric,
    Origin, Output, Query, Range, Regime, SceneModel, Stored, UnknownScene, UnknownWord,
    VolumeBounds, Watertight,
};
pub use oracle::{Ray, Verdict, barycentric, hit_fraction, judge};
pub use run::{KernelFn, PrepareFn, answers, drive, drive_together, one_ray, rays, rays_mut};
pub use task::Task;
pub use workload::{
    INITIAL_T, LEAF_TRIANGLES, NO_HIT, NO_HITS, PACKET_SIZE, Part, RayHits, RayPacket, Workload,
};

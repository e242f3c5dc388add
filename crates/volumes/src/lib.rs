//! Signed volumes of a ray and a triangle: every way to write one, and the cheapest ways to write four.
//!
//! Kensler and Shirley, *Optimizing Ray-Triangle Intersection via Automated Search* (2006), see the
//! direct 3D tests as ratios of signed volumes. A volume is a triple product of vectors between the
//! ray's origin `a` and the triangle's vertices `p0`, `p1`, `p2`, and of the ray's direction `d`;
//! there are 36 ways to write one that has three points and `d`, 384 for one that has four points
//! (section 3). Here they are derived, given their cost by how often their parts change, and
//! searched for the sets of four that cost least (section 4).
//!
//! Bottom up: [`Point`], [`Edge`] and [`Vector`]; [`Cross`] and [`TripleProduct`]; [`Volume`], whose
//! ways are found by evaluating candidates at a [`Sample`]; [`Rate`] and [`Rates`]; [`Case`],
//! [`Model`], [`Formulation`] and its [`Cost`]; [`cheapest`], the search. [`Polynomial`] proves equations.
//!
//! Everything is pure: no files, no floating-point arithmetic but for showing a cost, no randomness
//! but from a given seed.

mod cost;
mod count;
mod exact;
mod formulation;
mod model;
mod polynomial;
mod product;
mod rate;
mod vector;
mod volume;

pub use cost::{Case, Cost};
pub use count::{Count, cheapest};
pub use exact::Sample;
pub use formulation::{Formulation, Step, Stored, VECTOR_BYTES};
pub use model::{BadPorts, Kind, MAX_PORTS, Model, Operations, Port, read_ports};
pub use polynomial::Polynomial;
pub use product::{Cross, TripleProduct};
pub use rate::{Rate, Rates};
pub use vector::{Edge, Point, Vector};
pub use volume::{Volume, crosses};

//! The graph of a segment from `a` to `b`: the extended one, and what the other end offers (section 3
//! of Kensler-Shirley).
//!
//! The segment crosses the triangle's plane if `Va` and `Vb`, the volumes of the two ends with the
//! triangle, have opposite signs, and `t = Va / (Va - Vb)`. So there are beside what the extended
//! graph has:
//!
//! - `Vb` by all triple products that have the triangle's normal as their cross;
//! - `V = Va - Vb`, as one more way to have `V`;
//! - a test of the ends, before any of the tests of `t`, and perhaps an exit.
//!
//! The tests of `t` stay. They hold the upper bound, which a hit may have lowered, and say with one
//! rule for every kernel what the ends themselves are: no hits.

use crate::builder::{Arithmetic, Builder};
use crate::graph::Graph;

/// Builds the graph.
pub fn segment() -> Graph {
    Builder::new(Arithmetic::Fused)
        .of_segments()
        .volumes_to_hit()
}

//! The graph of Kensler and Shirley with fused operations as choices.
//!
//! It has every node of [`kensler_shirley`](crate::kensler_shirley()) and beside it what a fused
//! multiply-add offers: each cross, each triple product in both orders, and the Newton step. What
//! is fused is rounded once, so a program is shorter by a third, and its answers differ from those
//! of the plain one. Nothing is fused where the number of operations would stay the same: a test
//! compares a product with what is there, and an addition of volumes has no product at hand.
//!
//! Made for scenes that allow fused operations on instruction sets that have them; elsewhere each
//! is two operations and nothing is gained.

use crate::builder::{Arithmetic, Builder};
use crate::graph::Graph;

/// Builds the graph.
pub fn extended() -> Graph {
    Builder::new(Arithmetic::Fused).volumes_to_hit()
}

//! The graph of 1294 nodes, built from the algebra of Kensler and Shirley (2006).
//!
//! The paper gives the number and the kinds of choices (section 5), not the list. Ours holds
//! every triple product of the five volumes, each with two orders of summation, and around them
//! the ways to go on from volumes to a hit: `dag/README.md` has the table of families.

use crate::builder::{Arithmetic, Builder};
use crate::genome::Genome;
use crate::graph::{Graph, NodeId};

/// The number of nodes, as the paper gives it.
pub const COUNT: usize = 1294;

/// Builds the graph.
pub fn kensler_shirley() -> Graph {
    Builder::new(Arithmetic::Plain).volumes_to_hit()
}

/// The genome that picks the general packet kernel of the paper's appendix (GA+), in the order
/// in which it is printed there.
///
/// # Panics
///
/// If `graph` is not [`kensler_shirley`]'s.
pub fn appendix(graph: &Graph) -> Genome {
    preferring(
        graph,
        &[
            "p1",
            "p0",
            "edge.p1-p0",
            "p2",
            "edge.p0-p2",
            "cross.p1-p0.p0-p2",
            "zero",
            "a",
            "t_max",
            "d",
            "v.direct",
            "v.p1-p0.p0-p2.d.xy_z",
            "reciprocal.newton",
            "edge.p0-a",
            "va.p1-p0.p0-p2.p0-a.xy_z",
            "t.multiply",
            "mask",
            "range.late",
            "far",
            "far.quotient",
            "near.quotient",
            "near.exit",
            "cross.p0-a.d",
            "v1.direct",
            "v1.p0-a.d.p0-p2.xy_z",
            "beta.multiply",
            "side1.quotient",
            "side1.exit",
            "v2.direct",
            "v2.p0-a.d.p1-p0.xy_z",
            "pair.v1_v2",
            "square.v",
            "side0.sum",
            "side0",
            "gamma.multiply",
            "side2.quotient",
            "side2.exit",
            "inside.sides",
        ],
    )
}

/// The genome that picks equations 2, the volumes of Möller and Trumbore, with divisions and
/// tests in their order.
///
/// # Panics
///
/// If `graph` is not [`kensler_shirley`]'s.
pub fn moller_trumbore_volumes(graph: &Graph) -> Genome {
    preferring(
        graph,
        &[
            "p0",
            "p1",
            "p2",
            "edge.p1-p0",
            "edge.p2-p0",
            "zero",
            "one",
            "d",
            "cross.d.p2-p0",
            "v.direct",
            "v.d.p2-p0.p1-p0.xy_z",
            "reciprocal.exact",
            "a",
            "edge.a-p0",
            "v1.direct",
            "v1.d.p2-p0.a-p0.xy_z",
            "beta.multiply",
            "mask",
            "side1.quotient",
            "side1.exit",
            "cross.a-p0.p1-p0",
            "v2.direct",
            "v2.a-p0.p1-p0.d.xy_z",
            "gamma.multiply",
            "side2.quotient",
            "side2",
            "alpha.rest",
            "side0.quotient",
            "side0.exit",
            "va.a-p0.p1-p0.p2-p0.xy_z",
            "t.multiply",
            "t_max",
            "range.late",
            "near",
            "near.quotient",
            "far.quotient",
            "far.exit",
            "inside.sides",
        ],
    )
}

fn preferring(graph: &Graph, names: &[&str]) -> Genome {
    let node = |name: &&str| {
        let found = graph.find(name);
        found.unwrap_or_else(|| panic!("the graph has no node {name:?}"))
    };
    let nodes: Vec<NodeId> = names.iter().map(node).collect();
    Genome::identity(graph.nodes().len()).preferring(&nodes)
}

//! Which nodes are other ways to write the same value.
//!
//! The algebra writes a value in many ways. A program that holds two of them computes it twice,
//! so the walk that marks live nodes treats them as one.

use std::collections::HashMap;

use volumes::{Edge, Sample, Vector};

use crate::graph::NodeId;
use crate::op::{Op, Summation};
use crate::quantity::Quantity;

/// The nodes of a graph by the values that they compute.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Same {
    vector: Vec<Option<NodeId>>,
    /// The place in `twins` of every triple product.
    group: Vec<Option<usize>>,
    twins: Vec<Vec<NodeId>>,
}

impl Same {
    /// Of nodes with these operations and quantities; `required` gives their operands.
    pub fn new<'a>(
        ops: &[Op],
        quantities: &[Quantity],
        required: impl Fn(usize) -> &'a [NodeId],
    ) -> Same {
        let mut groups = HashMap::new();
        let mut twins: Vec<Vec<NodeId>> = Vec::new();
        let group = (0..ops.len()).map(|index| {
            let Op::Volume(volume, summation) = ops[index] else {
                return None;
            };
            let operand = |operand: &NodeId| quantities[operand.index()];
            let key = (
                volume,
                factors(required(index).iter().map(operand), summation)?,
            );
            let group = *groups.entry(key).or_insert_with(|| {
                twins.push(Vec::new());
                twins.len() - 1
            });
            twins[group].push(NodeId::from_index(index));
            Some(group)
        });
        Same {
            group: group.collect(),
            vector: same_vectors(ops, quantities),
            twins,
        }
    }

    /// For a cross, the first node whose cross is the same vector, by whatever edges, fused or not;
    /// itself if it is the first. None for other nodes.
    ///
    /// The 24 crosses of two edges of one triangle are its normal or the negative, twelve of each.
    pub fn vector(&self, id: NodeId) -> Option<NodeId> {
        self.vector[id.index()]
    }

    /// For a triple product, all that are equal to it, itself included: of the same edges, some of
    /// them walked the other way. None for other nodes.
    ///
    /// Rounding is symmetric, so a vector and its opposite have opposite components, and two signs
    /// that change leave the product as it is, to the last bit. Not so if the cross is fused: its
    /// factors may have changed places, and then other products are rounded by themselves.
    pub fn twins(&self, id: NodeId) -> &[NodeId] {
        match self.group[id.index()] {
            Some(group) => &self.twins[group],
            None => &[],
        }
    }
}

/// The first node of the same vector for every cross, found by exact evaluation.
fn same_vectors(ops: &[Op], quantities: &[Quantity]) -> Vec<Option<NodeId>> {
    let samples = [1, 2].map(Sample::random);
    let mut first = HashMap::new();
    let nodes = ops.iter().zip(quantities).enumerate();
    nodes
        .map(|(index, node)| match node {
            (Op::Cross | Op::FusedCross, Quantity::Cross(cross)) => {
                let vector = samples.map(|sample| sample.cross(*cross));
                Some(*first.entry(vector).or_insert(NodeId::from_index(index)))
            }
            // A choice is whatever it resolves to.
            _ => None,
        })
        .collect()
}

/// What decides the bits of a triple product of a plain cross, but for its sign: the factors of the cross in
/// either order, the other factor, the order of the sum.
type Factors = ([Vector; 2], Vector, Summation);

fn factors(mut operands: impl Iterator<Item = Quantity>, summation: Summation) -> Option<Factors> {
    match (operands.next()?, operands.next()?) {
        (Quantity::Cross(cross), Quantity::Vector(dot)) => {
            let mut factors = [cross.left, cross.right].map(undirected);
            factors.sort_unstable();
            Some((factors, undirected(dot), summation))
        }
        _ => None,
    }
}

fn undirected(vector: Vector) -> Vector {
    match vector {
        Vector::Edge(edge) => Vector::Edge(Edge::min(edge, edge.reversed())),
        Vector::Direction => Vector::Direction,
    }
}

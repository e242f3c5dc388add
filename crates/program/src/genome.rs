//! Genomes: permutations of the node numbers.

use rand::Rng;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use crate::graph::NodeId;

/// A permutation of `0..n`: the number at a node's place is the node's priority, the larger the
/// higher (section 5 of Kensler-Shirley).
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "Vec<u32>", into = "Vec<u32>")]
pub struct Genome(Vec<u32>);

/// A list that is no permutation of its indices.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[error("not a permutation of 0..{length}: {value} is repeated or too large")]
pub struct NotAPermutation {
    length: usize,
    value: u32,
}

impl Genome {
    /// A permutation of `0..nodes`, all equally likely.
    pub fn random(nodes: usize, rng: &mut impl Rng) -> Genome {
        let mut priorities = Genome::identity(nodes).0;
        priorities.shuffle(rng);
        Genome(priorities)
    }

    /// The genome whose priorities grow with the node numbers.
    pub fn identity(nodes: usize) -> Genome {
        Genome((0..nodes).map(|node| node as u32).collect())
    }

    /// This genome with `first` raised above all other nodes, the earlier the higher.
    ///
    /// # Panics
    ///
    /// If `first` names a node twice, or one that the genome does not have.
    #[must_use]
    pub fn preferring(&self, first: &[NodeId]) -> Genome {
        let mut by_priority: Vec<usize> = (0..self.0.len()).collect();
        by_priority.sort_by_key(|&node| std::cmp::Reverse(self.0[node]));
        by_priority.retain(|node| !first.iter().any(|id| id.index() == *node));
        assert_eq!(
            by_priority.len() + first.len(),
            self.0.len(),
            "not distinct nodes"
        );
        let order = first.iter().map(|id| id.index()).chain(by_priority);
        let mut priorities = vec![0; self.0.len()];
        for (priority, node) in (0..self.0.len() as u32).rev().zip(order) {
            priorities[node] = priority;
        }
        Genome(priorities)
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are no nodes at all.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The priority of each node.
    pub fn priorities(&self) -> &[u32] {
        &self.0
    }

    /// Exchanges the priorities of two nodes.
    ///
    /// # Panics
    ///
    /// If either is not below [`Genome::len`].
    pub fn swap(&mut self, a: usize, b: usize) {
        self.0.swap(a, b);
    }
}

impl TryFrom<Vec<u32>> for Genome {
    type Error = NotAPermutation;

    fn try_from(priorities: Vec<u32>) -> Result<Genome, NotAPermutation> {
        let length = priorities.len();
        let mut seen = vec![false; length];
        for &value in &priorities {
            match seen.get_mut(value as usize) {
                Some(seen) if !*seen => *seen = true,
                _ => return Err(NotAPermutation { length, value }),
            }
        }
        Ok(Genome(priorities))
    }
}

impl From<Genome> for Vec<u32> {
    fn from(genome: Genome) -> Vec<u32> {
        genome.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_permutations_are_genomes() {
        assert!(Genome::try_from(vec![2, 0, 1]).is_ok());
        assert!(Genome::try_from(vec![0, 0, 1]).is_err());
        assert!(Genome::try_from(vec![0, 3, 1]).is_err());
    }

    #[test]
    fn preferred_nodes_come_first_and_the_rest_keeps_its_order() {
        let [a, b] = [3, 1].map(NodeId::from_index);
        let genome = Genome::identity(5).preferring(&[a, b]);
        assert_eq!(genome.priorities(), [0, 3, 1, 4, 2]);
    }
}

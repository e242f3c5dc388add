//! Individuals and where they come from.

use program::{Genome, Program};
use serde::{Deserialize, Serialize};

use crate::evaluate::Evaluation;

/// A genome with what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Individual {
    /// Its number, counted from 0 in the order of evaluation.
    pub id: u64,
    /// How it was made.
    pub origin: Origin,
    /// Its genome.
    pub genome: Genome,
    /// The program that the genome picks.
    pub program: Program,
    /// What became of it.
    pub evaluation: Evaluation,
}

/// How an individual was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "operator", rename_all = "kebab-case")]
pub enum Origin {
    /// Drawn at random.
    Random,
    /// The first parent with a segment in the second one's order, then mutated.
    Crossover {
        /// The parents' numbers.
        parents: [u64; 2],
    },
}

impl Individual {
    /// Its fitness, 0 if it failed: the weight with which it is drawn as a parent.
    pub fn weight(&self) -> f64 {
        self.evaluation.fitness.unwrap_or(0.0)
    }
}

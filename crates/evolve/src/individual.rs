//! Candidates, where they come from, and individuals: candidates that have been judged.

use program::{Genome, Program};
use serde::{Deserialize, Serialize};

use crate::evaluate::Evaluation;

/// A genome with the program that it picks.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Its number, counted from 0.
    pub id: u64,
    /// The generation that it was made for; 0 is the random one.
    pub generation: usize,
    /// How it was made.
    pub origin: Origin,
    /// Its genome.
    pub genome: Genome,
    /// The program that the genome picks.
    pub program: Program,
    /// A hash of what is emitted for the program. Candidates with the same one are the same
    /// kernel.
    pub source: String,
}

/// How a candidate was made.
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

/// A candidate with what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Individual {
    /// The candidate.
    pub candidate: Candidate,
    /// What became of it.
    pub evaluation: Evaluation,
}

impl Individual {
    /// Its fitness, 0 if it failed: the weight with which it is drawn as a parent.
    pub fn weight(&self) -> f64 {
        self.evaluation.fitness.unwrap_or(0.0)
    }
}

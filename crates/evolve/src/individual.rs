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
    /// The first parent with a [part](crate::graft) of the second one's program.
    Graft {
        /// The parents' numbers.
        parents: [u64; 2],
    },
    /// The parent with other [options](crate::flip) of some choices.
    Flip {
        /// The parent's number.
        parent: u64,
    },
    /// The parent with a statement at [another place](crate::slide).
    Slide {
        /// The parent's number.
        parent: u64,
    },
}

impl Origin {
    /// Its name in journals and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Origin::Random => "random",
            Origin::Crossover { .. } => "crossover",
            Origin::Graft { .. } => "graft",
            Origin::Flip { .. } => "flip",
            Origin::Slide { .. } => "slide",
        }
    }

    /// The numbers of the parents, the one that gave more first.
    pub fn parents(&self) -> &[u64] {
        match self {
            Origin::Random => &[],
            Origin::Crossover { parents } | Origin::Graft { parents } => parents,
            Origin::Flip { parent } | Origin::Slide { parent } => std::slice::from_ref(parent),
        }
    }
}

/// What a strategy would have judged: a [`Candidate`] that has no number yet.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// How it was made.
    pub origin: Origin,
    /// Its genome.
    pub genome: Genome,
    /// The program that the genome picks.
    pub program: Program,
    /// A hash of what is emitted for the program.
    pub source: String,
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

    /// Which kernel it is, as far as that is known: what was compiled, or else its source.
    pub fn kernel(&self) -> &str {
        let code = self.evaluation.code.as_deref();
        code.unwrap_or(&self.candidate.source)
    }
}

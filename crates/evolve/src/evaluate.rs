//! What the search asks of whoever can judge a program.

use program::Program;
use serde::{Deserialize, Serialize};

use crate::individual::Individual;

/// Judges programs: in earnest by compiling and timing them, in tests by a formula.
pub trait Evaluate {
    /// Why judging had to stop.
    type Error;

    /// Judges programs, one evaluation each, in their order.
    ///
    /// # Errors
    ///
    /// If judging as a whole cannot go on. A program that fails is an [`Evaluation`] without
    /// fitness.
    fn evaluate(&mut self, programs: &[Program]) -> Result<Vec<Evaluation>, Self::Error>;

    /// Judges again those on whom much depends: a first timing that looks fast owes some of it to
    /// luck. Gives each what is known of it now, by default what was known before.
    ///
    /// # Errors
    ///
    /// As for [`Evaluate::evaluate`].
    fn confirm(&mut self, individuals: &[&Individual]) -> Result<Vec<Evaluation>, Self::Error> {
        Ok(individuals
            .iter()
            .map(|individual| individual.evaluation.clone())
            .collect())
    }
}

/// What became of a program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// A hash of what was emitted for it. Programs with the same one are the same kernel.
    pub source: String,
    /// Its fitness, the larger the better and above zero; none if it failed.
    pub fitness: Option<f64>,
    /// Relative uncertainty of the fitness.
    pub uncertainty: f64,
    /// The measurements behind it, and if it failed the reason.
    pub details: serde_json::Value,
}

impl Evaluation {
    /// Only a positive, finite number is a fitness; anything else is a failure.
    pub(crate) fn drop_what_is_no_fitness(&mut self) {
        let sound = |fitness: &f64| fitness.is_finite() && *fitness > 0.0;
        self.fitness = self.fitness.filter(sound);
        if !self.uncertainty.is_finite() {
            self.uncertainty = 0.0;
        }
    }
}

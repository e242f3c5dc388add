//! What the search asks of whoever can judge a program.

use program::Program;
use serde::{Deserialize, Serialize};
use volumes::{Case, Model};

use crate::individual::{Candidate, Individual};

/// What can be told of a program before it is judged.
pub trait Foresee {
    /// A hash of what is emitted for a program. Programs with the same one are the same kernel.
    fn source(&mut self, program: &Program) -> String;

    /// How much work a program looks like before it is timed: any number above zero, the smaller the better. Here
    /// all of its operations.
    fn work(&self, program: &Program) -> f64 {
        program.cost(Case::SINGLE, &Model::paper()).operations()
    }
}

/// Judges programs in three steps, so that one batch can be made ready while another is judged. Batches are judged
/// one at a time, in the order in which they were made ready.
pub trait Evaluate: Foresee {
    /// Why judging had to stop.
    type Error;

    /// A batch that is ready to be judged: compiled.
    type Ready;

    /// A batch that is being judged: timed.
    type Begun;

    /// Makes a batch ready. Another one may be being judged.
    ///
    /// # Errors
    ///
    /// If judging as a whole cannot go on. A candidate that fails is an [`Evaluation`] without
    /// fitness.
    fn prepare(&mut self, batch: &Batch<'_>) -> Result<Self::Ready, Self::Error>;

    /// Begins to judge a batch that is ready. No other one is being judged.
    ///
    /// # Errors
    ///
    /// As of [`Evaluate::prepare`].
    fn begin(&mut self, ready: Self::Ready) -> Result<Self::Begun, Self::Error>;

    /// What became of a batch; waits until it is judged.
    ///
    /// # Errors
    ///
    /// As of [`Evaluate::prepare`].
    fn finish(&mut self, begun: Self::Begun) -> Result<Judged, Self::Error>;
}

/// Judges programs at once, in tests by a formula; then there is nothing to wait for.
pub trait EvaluateAtOnce: Foresee {
    /// Why judging had to stop.
    type Error;

    /// Judges a batch.
    ///
    /// # Errors
    ///
    /// As of [`Evaluate::prepare`].
    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, Self::Error>;
}

impl<E: EvaluateAtOnce> Evaluate for E {
    type Error = E::Error;
    type Ready = Judged;
    type Begun = Judged;

    fn prepare(&mut self, batch: &Batch<'_>) -> Result<Judged, E::Error> {
        self.evaluate(batch)
    }

    fn begin(&mut self, ready: Judged) -> Result<Judged, E::Error> {
        Ok(ready)
    }

    fn finish(&mut self, begun: Judged) -> Result<Judged, E::Error> {
        Ok(begun)
    }
}

/// Who is to be judged together.
#[derive(Clone, Copy, Debug)]
pub struct Batch<'a> {
    /// The generation that this is for.
    pub generation: usize,
    /// Those of whom nothing is known.
    pub new: &'a [Candidate],
    /// Those on whom much depends: a first timing that looks fast owes some of it to luck.
    pub again: &'a [Individual],
    /// Those of the same island who will survive if nobody new does, best first; nobody in the random generation.
    pub survivors: &'a [Individual],
}

/// What became of a batch, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judged {
    /// One evaluation for each of the new.
    pub new: Vec<Evaluation>,
    /// For each of the others what is known of it now, by all that it has been through.
    pub again: Vec<Evaluation>,
}

/// What became of a program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// Its fitness, the larger the better and above zero; none if it failed.
    pub fitness: Option<f64>,
    /// Relative uncertainty of the fitness.
    pub uncertainty: f64,
    /// What speed is paid for with, the smaller the better: as many numbers for everyone of a search. Of
    /// interest where the [objective](crate::Objective) is a front.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub costs: Vec<f64>,
    /// What was compiled, the same for programs that came to be the same kernel though their sources differ; none
    /// if that is not known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub code: Option<String>,
    /// The measurements behind it, and if it failed the reason.
    pub details: serde_json::Value,
}

impl Evaluation {
    /// Only a positive, finite number is a fitness; anything else is a failure, and so is a cost that is no
    /// finite number.
    pub(crate) fn without_what_is_no_fitness(mut self) -> Evaluation {
        let sound = |fitness: &f64| fitness.is_finite() && *fitness > 0.0;
        let affordable = self.costs.iter().all(|cost| cost.is_finite());
        self.fitness = self.fitness.filter(sound).filter(|_| affordable);
        if !affordable {
            self.costs.clear();
        }
        if !self.uncertainty.is_finite() {
            self.uncertainty = 0.0;
        }
        self
    }
}

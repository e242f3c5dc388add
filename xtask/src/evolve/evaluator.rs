//! Programs judged in earnest: printed, compiled, checked and timed.

use std::cell::Cell;
use std::rc::Rc;
use std::time::{Duration, Instant};

use emit::{Kernel, operations};
use evolve::{Batch, Evaluate, Judged, Objective};
use measure::{MAX_P99_ERROR, MeasureError, Spent, source_hash};
use program::Program;

use super::course::Course;
use crate::arena::Arena;
use crate::benches::Benches;

/// Judges programs on a bench.
pub struct Evaluator<'a> {
    arena: &'a Arena,
    bench: &'a mut Benches,
    objective: Objective,
    /// How many cores time at once.
    cores: usize,
    spent: Rc<Cell<Totals>>,
}

/// Where the time went, for whoever reports it.
#[derive(Clone, Copy, Default)]
pub struct Totals {
    /// Picking programs is the search's; printing them is counted here.
    pub emit: Duration,
    /// Compiling and measuring.
    pub bench: Spent,
}

impl<'a> Evaluator<'a> {
    /// An evaluator that leaves its totals in `spent` after every batch.
    pub fn new(
        arena: &'a Arena,
        bench: &'a mut Benches,
        objective: Objective,
        cores: usize,
        spent: Rc<Cell<Totals>>,
    ) -> Evaluator<'a> {
        Evaluator {
            arena,
            bench,
            objective,
            cores,
            spent,
        }
    }

    fn kernels(&mut self, program: &Program) -> Vec<Kernel> {
        let start = Instant::now();
        let kernels = self.arena.kernels(program);
        let mut totals = self.spent.get();
        totals.emit += start.elapsed();
        self.spent.set(totals);
        kernels
    }
}

impl Evaluate for Evaluator<'_> {
    type Error = MeasureError;

    fn source(&mut self, program: &Program) -> String {
        source(&self.kernels(program))
    }

    fn work(&self, program: &Program) -> f64 {
        operations(program, &self.arena.scene)
    }

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, MeasureError> {
        let new = batch.new.iter().map(|candidate| &candidate.program);
        let again = batch.again.iter().map(|one| &one.candidate.program);
        let programs: Vec<&Program> = new.chain(again).collect();
        let kernels: Vec<Vec<Kernel>> = programs.iter().map(|one| self.kernels(one)).collect();
        let kernels: Vec<&[Kernel]> = kernels.iter().map(Vec::as_slice).collect();
        let course = Course::of(batch, MAX_P99_ERROR, self.objective);
        let plan = course.plan(batch.new.len(), batch.again.len(), self.cores);
        let verdicts = self.bench.measure(&kernels, &plan)?;
        let bench = self.bench.spent();
        self.spent.set(Totals {
            bench,
            ..self.spent.get()
        });
        // The first one is the reference's.
        let mut verdicts = verdicts.into_iter().skip(1);
        let new = verdicts.by_ref().take(batch.new.len());
        let new = new.map(|verdict| course.evaluation(verdict)).collect();
        let again = batch.again.iter().zip(verdicts);
        Ok(Judged {
            new,
            again: again
                .map(|(individual, verdict)| course.pooled(individual, verdict))
                .collect(),
        })
    }
}

/// Judges nobody: for a replay, which has all its evaluations or ends.
pub struct Nobody<'a>(pub &'a Arena);

/// The search made a candidate of whom nothing was recorded.
#[derive(Debug, thiserror::Error)]
#[error("the replay ends in generation {generation}: candidate {id} was never timed")]
pub struct NeverTimed {
    id: u64,
    generation: usize,
}

impl Evaluate for Nobody<'_> {
    type Error = NeverTimed;

    fn source(&mut self, program: &Program) -> String {
        source(&self.0.kernels(program))
    }

    fn work(&self, program: &Program) -> f64 {
        operations(program, &self.0.scene)
    }

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, NeverTimed> {
        match batch.new.first() {
            Some(candidate) => Err(NeverTimed {
                id: candidate.id,
                generation: candidate.generation,
            }),
            // Nothing more is known of those who were not timed again.
            None => Ok(Judged {
                new: Vec::new(),
                again: batch
                    .again
                    .iter()
                    .map(|one| one.evaluation.clone())
                    .collect(),
            }),
        }
    }
}

/// What makes a program the same as another: the hash of its kernels' sources.
pub fn source(kernels: &[Kernel]) -> String {
    match kernels {
        [kernel] => source_hash(kernel),
        _ => {
            let hashes: String = kernels.iter().map(source_hash).collect();
            blake3::hash(hashes.as_bytes()).to_hex()[..16].to_owned()
        }
    }
}

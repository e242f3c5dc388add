//! Programs judged in earnest: printed, compiled, checked and timed.

use std::cell::Cell;
use std::ops::Range;
use std::rc::Rc;
use std::time::{Duration, Instant};

use emit::Kernel;
use evolve::{Evaluate, Evaluation};
use measure::{Bench, MeasureError, Plan, Spent, Verdict, summarise};
use program::Program;

use crate::arena::Arena;
use crate::shootout::TRAINING;

/// Rounds of timing for every candidate.
const ROUNDS: usize = 15;

/// Packets of a round, 2.6 million tests. Other packets every round and every generation, lest a
/// champion be fitted to a few.
const PACKETS_A_ROUND: usize = 2;

/// Judges programs on a bench.
pub struct Evaluator<'a> {
    arena: &'a Arena,
    bench: &'a mut Bench,
    spent: Rc<Cell<Totals>>,
    generation: usize,
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
    /// An evaluator that leaves its totals in `spent` after every generation.
    pub fn new(arena: &'a Arena, bench: &'a mut Bench, spent: Rc<Cell<Totals>>) -> Evaluator<'a> {
        Evaluator {
            arena,
            bench,
            spent,
            generation: 0,
        }
    }

    /// The packets of a generation's rounds, which move on through the training packets.
    pub fn rounds(generation: usize) -> Vec<Range<usize>> {
        let parts = TRAINING.len() / PACKETS_A_ROUND;
        (0..ROUNDS)
            .map(|round| {
                let part = (generation * ROUNDS + round) % parts;
                let first = TRAINING.start + part * PACKETS_A_ROUND;
                first..first + PACKETS_A_ROUND
            })
            .collect()
    }
}

impl Evaluate for Evaluator<'_> {
    type Error = MeasureError;

    fn evaluate(&mut self, programs: &[Program]) -> Result<Vec<Evaluation>, MeasureError> {
        let start = Instant::now();
        let kernels: Vec<Kernel> = programs
            .iter()
            .map(|program| self.arena.kernel(program))
            .collect();
        let mut totals = self.spent.get();
        totals.emit += start.elapsed();
        let plan = Plan {
            rounds: Evaluator::rounds(self.generation),
            separate: false,
        };
        self.generation += 1;
        let outcomes = self.bench.measure(&kernels, &plan)?;
        totals.bench = self.bench.spent();
        self.spent.set(totals);
        Ok(outcomes
            .into_iter()
            .map(|outcome| {
                let summary = match &outcome.verdict {
                    Verdict::Timed { ratios, .. } => Some(summarise(ratios)),
                    _ => None,
                };
                Evaluation {
                    source: outcome.source,
                    fitness: summary.map(|summary| summary.median),
                    uncertainty: summary.map_or(0.0, |summary| summary.uncertainty),
                    details: serde_json::to_value(&outcome.verdict)
                        .expect("a verdict is plain data"),
                }
            })
            .collect())
    }
}

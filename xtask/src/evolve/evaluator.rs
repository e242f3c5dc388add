//! Programs judged in earnest: printed, compiled, checked and timed.

use std::cell::Cell;
use std::ops::Range;
use std::rc::Rc;
use std::time::{Duration, Instant};

use emit::Kernel;
use evolve::{Evaluate, Evaluation, Individual};
use measure::{Bench, MeasureError, Outcome, Plan, Spent};
use program::Program;

use crate::arena::Arena;

/// Packets that every candidate is timed on, one a round, 1.3 million tests each. All candidates
/// have the same ones, since packets differ more than candidates do; so many, lest a champion be
/// fitted to a few.
const ROUNDS: Range<usize> = 0..36;

/// A candidate this much slower than the slowest of those judged again is not timed to the end.
const HOPELESS: f64 = 0.85;

/// Timings of one source that suffice.
const ENOUGH: usize = 10 * ROUNDS.end;

/// Judges programs on a bench.
pub struct Evaluator<'a> {
    arena: &'a Arena,
    bench: &'a mut Bench,
    spent: Rc<Cell<Totals>>,
    /// The ratio below which a candidate is hopeless.
    cutoff: Option<f64>,
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
            cutoff: None,
        }
    }

    /// How candidates are timed: all of them on the same packets.
    pub fn plan(cutoff: Option<f64>) -> Plan {
        Plan {
            rounds: ROUNDS.map(|packet| packet..packet + 1).collect(),
            separate: false,
            cutoff,
        }
    }

    fn kernels<'p>(&mut self, programs: impl Iterator<Item = &'p Program>) -> Vec<Kernel> {
        let start = Instant::now();
        let kernels = programs.map(|program| self.arena.kernel(program)).collect();
        let mut totals = self.spent.get();
        totals.emit += start.elapsed();
        self.spent.set(totals);
        kernels
    }

    fn evaluations(&self, outcomes: Vec<Outcome>) -> Vec<Evaluation> {
        let bench = self.bench.spent();
        self.spent.set(Totals {
            bench,
            ..self.spent.get()
        });
        outcomes.into_iter().map(evaluation).collect()
    }
}

fn evaluation(outcome: Outcome) -> Evaluation {
    let summary = outcome.verdict.summary();
    Evaluation {
        source: outcome.source,
        fitness: summary.map(|summary| summary.ratio),
        uncertainty: summary.map_or(0.0, |summary| summary.uncertainty),
        details: serde_json::to_value(&outcome.verdict).expect("a verdict is plain data"),
    }
}

impl Evaluate for Evaluator<'_> {
    type Error = MeasureError;

    fn evaluate(&mut self, programs: &[Program]) -> Result<Vec<Evaluation>, MeasureError> {
        let kernels = self.kernels(programs.iter());
        let plan = Evaluator::plan(self.cutoff);
        let outcomes = self.bench.measure(&kernels, &plan)?;
        Ok(self.evaluations(outcomes))
    }

    fn confirm(&mut self, individuals: &[&Individual]) -> Result<Vec<Evaluation>, MeasureError> {
        // They come best first.
        let slowest = individuals.last().and_then(|last| last.evaluation.fitness);
        self.cutoff = slowest.map(|slowest| slowest * HOPELESS);
        let known_well = |individual: &Individual| {
            let ratios = individual.evaluation.details["ratios"].as_array();
            ratios.is_some_and(|ratios| ratios.len() >= ENOUGH)
        };
        let asked = individuals
            .iter()
            .filter(|individual| !known_well(individual));
        let programs: Vec<&Program> = asked.map(|individual| &individual.program).collect();
        let kernels = self.kernels(programs.into_iter());
        let kernels: Vec<&Kernel> = kernels.iter().collect();
        let outcomes = self.bench.measure_again(&kernels, &Evaluator::plan(None))?;
        let again = self.evaluations(outcomes);
        let known = |individual: &&Individual| {
            let source = &individual.evaluation.source;
            let again = again.iter().find(|evaluation| evaluation.source == *source);
            again.unwrap_or(&individual.evaluation).clone()
        };
        Ok(individuals.iter().map(known).collect())
    }
}

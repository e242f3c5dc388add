//! Programs judged in earnest: printed, compiled, checked and timed.

use std::cell::Cell;
use std::rc::Rc;
use std::time::{Duration, Instant};

use emit::Kernel;
use evolve::{Batch, Evaluate, Evaluation, Individual, Judged};
use measure::{Bench, Lead, MeasureError, Plan, Race, Spent, Verdict, source_hash};
use program::Program;

use crate::arena::Arena;
use crate::shootout::training_packets;

/// Rounds of an evaluation, each on a packet of its own, 1.3 million tests. All candidates have the
/// same packets, since packets differ more than candidates do.
const ROUNDS: usize = 10;

/// Rounds after which a candidate is compared, again and again, with the slowest of those who
/// survive.
const RACE: usize = 4;

/// The packets that candidates are timed on, spread over those of the training half.
fn packets() -> impl Iterator<Item = usize> {
    let all = training_packets().count();
    training_packets().step_by(all / ROUNDS).take(ROUNDS)
}

/// Judges programs on a bench.
pub struct Evaluator<'a> {
    arena: &'a Arena,
    bench: &'a mut Bench,
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
    pub fn new(arena: &'a Arena, bench: &'a mut Bench, spent: Rc<Cell<Totals>>) -> Evaluator<'a> {
        Evaluator {
            arena,
            bench,
            spent,
        }
    }

    /// How candidates are timed: all of them on the same packets. The first ones race.
    fn plan(race: Race, racers: usize) -> Plan {
        Plan {
            race: Some(race),
            racers,
            noise_floor: false,
            ..Evaluator::noise_plan()
        }
    }

    /// How the reference is timed against itself, to see how noisy the figures of candidates are.
    pub fn noise_plan() -> Plan {
        Plan {
            rounds: packets().map(|packet| packet..packet + 1).collect(),
            separate: false,
            race: None,
            racers: 0,
            noise_floor: true,
        }
    }

    fn kernel(&mut self, program: &Program) -> Kernel {
        let start = Instant::now();
        let kernel = self.arena.kernel(program);
        let mut totals = self.spent.get();
        totals.emit += start.elapsed();
        self.spent.set(totals);
        kernel
    }

    /// Newcomers race against the slowest survivor: who is clearly slower is out, and who is
    /// clearly faster will be timed again among the elite.
    fn race(batch: &Batch<'_>) -> Race {
        let survivor = batch.survivor.and_then(|one| verdict(&one.evaluation));
        let ratios = match survivor {
            Some(Verdict::Timed { ratios, .. }) if ratios.len() >= ROUNDS => by_round(&ratios),
            _ => Vec::new(),
        };
        Race {
            ratios,
            every: RACE,
        }
    }
}

/// The mean ratio of every round that a kernel has been through, most of them several times.
fn by_round(ratios: &[f64]) -> Vec<f64> {
    let round = |round: usize| {
        let times = ratios.iter().skip(round).step_by(ROUNDS);
        times.clone().sum::<f64>() / times.len() as f64
    };
    (0..ROUNDS).map(round).collect()
}

impl Evaluate for Evaluator<'_> {
    type Error = MeasureError;

    fn source(&mut self, program: &Program) -> String {
        source_hash(&self.kernel(program))
    }

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, MeasureError> {
        let new = batch.new.iter().map(|candidate| &candidate.program);
        let again = batch.again.iter().map(|one| &one.candidate.program);
        let programs: Vec<&Program> = new.chain(again).collect();
        let kernels: Vec<Kernel> = programs.iter().map(|one| self.kernel(one)).collect();
        let kernels: Vec<&Kernel> = kernels.iter().collect();
        let race = Evaluator::race(batch);
        let plan = Evaluator::plan(race.clone(), batch.new.len());
        let verdicts = self.bench.measure(&kernels, &plan)?;
        let bench = self.bench.spent();
        self.spent.set(Totals {
            bench,
            ..self.spent.get()
        });
        // The first one is the reference's.
        let mut verdicts = verdicts.into_iter().skip(1);
        let new = verdicts.by_ref().take(batch.new.len());
        Ok(Judged {
            new: new
                .map(|verdict| match batch.survivor {
                    Some(survivor) => after_race(verdict, &race, survivor),
                    None => evaluation(verdict),
                })
                .collect(),
            again: batch.again.iter().zip(verdicts).map(pooled).collect(),
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
        source_hash(&self.0.kernel(program))
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

fn evaluation(verdict: Verdict) -> Evaluation {
    let summary = verdict.summary();
    Evaluation {
        fitness: summary.map(|summary| summary.ratio),
        uncertainty: summary.map_or(0.0, |summary| summary.uncertainty),
        details: serde_json::to_value(&verdict).expect("a verdict is plain data"),
    }
}

/// The evaluation of a kernel that may have left the race against `survivor`. Its rounds are the
/// first ones, and packets differ, so its fitness is the other's times its lead. Of a lead it has
/// what it can hardly owe to luck; if that is the elite's, it will be timed again.
fn after_race(verdict: Verdict, race: &Race, survivor: &Individual) -> Evaluation {
    let lead = match &verdict {
        Verdict::Timed { ratios, .. } if (1..ROUNDS).contains(&ratios.len()) => race.lead(ratios),
        _ => None,
    };
    let evaluation = evaluation(verdict);
    match lead {
        Some(Lead { mean, error }) => Evaluation {
            fitness: Some(survivor.weight() * (mean - error).exp()),
            uncertainty: 1.96 * error,
            ..evaluation
        },
        None => evaluation,
    }
}

/// What is known of an individual with one verdict more. Of one that once left a race little is.
fn pooled((individual, later): (&Individual, Verdict)) -> Evaluation {
    evaluation(match verdict(&individual.evaluation) {
        Some(Verdict::Timed { ratios, .. }) if ratios.len() % ROUNDS != 0 => later,
        Some(known) => known.pooled_with(later),
        None => later,
    })
}

fn verdict(evaluation: &Evaluation) -> Option<Verdict> {
    serde_json::from_value(evaluation.details.clone()).ok()
}

//! Who judges and observes in the tests of the search: no compiler, no file.

#![allow(dead_code, reason = "every test file uses some of it")]

use std::collections::HashSet;
use std::convert::Infallible;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::ControlFlow;

use evolve::{
    Batch, Candidate, EvaluateAtOnce, Evaluation, Foresee, Generation, Individual, Judged, Observe,
};
use program::{Op, Program};

/// A generation as it was observed.
#[derive(Clone, Debug, PartialEq)]
pub struct Observed {
    pub number: usize,
    pub new: Vec<Individual>,
    pub population: Vec<Individual>,
}

/// Keeps what it observes, and ends the search after so many generations if it is told to.
#[derive(Default)]
pub struct Watch {
    pub seen: Vec<Observed>,
    pub end_after: Option<usize>,
}

impl Observe for Watch {
    fn generation(&mut self, generation: &Generation<'_>) -> ControlFlow<()> {
        self.seen.push(Observed {
            number: generation.number,
            new: generation.new.to_vec(),
            population: generation.population.to_vec(),
        });
        if self.end_after == Some(self.seen.len()) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// Judges by a formula.
#[derive(Clone, Copy)]
pub struct Judge(pub fn(&Program) -> Option<f64>);

pub const FORMULA: Judge = Judge(|program| Some(speed(program)));

impl Judge {
    fn judge(self, candidate: &Candidate) -> Evaluation {
        evaluation(self.0(&candidate.program))
    }
}

pub fn evaluation(fitness: Option<f64>) -> Evaluation {
    Evaluation {
        fitness,
        uncertainty: 0.0,
        costs: Vec::new(),
        code: None,
        details: serde_json::Value::Null,
    }
}

impl Foresee for Judge {
    fn source(&mut self, program: &Program) -> String {
        source(program)
    }
}

impl EvaluateAtOnce for Judge {
    type Error = Infallible;

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, Infallible> {
        let again = batch.again.iter().map(|one| &one.candidate);
        Ok(Judged {
            new: batch.new.iter().map(|one| self.judge(one)).collect(),
            again: again.map(|one| self.judge(one)).collect(),
        })
    }
}

/// Overrates a third of all programs until it is asked again.
#[derive(Default)]
pub struct Lucky {
    known: HashSet<String>,
}

impl Foresee for Lucky {
    fn source(&mut self, program: &Program) -> String {
        source(program)
    }
}

impl EvaluateAtOnce for Lucky {
    type Error = Infallible;

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, Infallible> {
        let Ok(mut judged) = { FORMULA }.evaluate(batch);
        let again = batch.again.iter().map(|one| one.candidate.source.clone());
        self.known.extend(again);
        for (candidate, evaluation) in batch.new.iter().zip(&mut judged.new) {
            let lucky = hash(&candidate.program).is_multiple_of(3);
            if lucky && !self.known.contains(&candidate.source) {
                evaluation.fitness = evaluation.fitness.map(|fitness| 10.0 * fitness);
            }
        }
        Ok(judged)
    }
}

/// Judges so many batches and then cannot go on.
pub struct Breaks {
    pub after: usize,
}

impl Foresee for Breaks {
    fn source(&mut self, program: &Program) -> String {
        source(program)
    }
}

impl EvaluateAtOnce for Breaks {
    type Error = &'static str;

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, &'static str> {
        self.after = self.after.checked_sub(1).ok_or("the worker is gone")?;
        let Ok(judged) = { FORMULA }.evaluate(batch);
        Ok(judged)
    }
}

/// Never the same twice, as timings are; and keeps count of whom it was asked about.
#[derive(Default)]
pub struct Noisy {
    pub asked: Vec<String>,
    pub seen: HashSet<String>,
    pub drift: f64,
}

impl Foresee for Noisy {
    fn source(&mut self, program: &Program) -> String {
        source(program)
    }
}

impl EvaluateAtOnce for Noisy {
    type Error = Infallible;

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, Infallible> {
        let Ok(mut judged) = { FORMULA }.evaluate(batch);
        for evaluation in judged.new.iter_mut().chain(&mut judged.again) {
            self.drift = (self.drift + 0.618_033_988_75).fract();
            let noise = 1.0 + 0.05 * self.drift;
            evaluation.fitness = evaluation.fitness.map(|fitness| fitness * noise);
        }
        for candidate in batch.new {
            assert!(self.seen.insert(candidate.source.clone()), "asked twice");
            self.asked.push(candidate.source.clone());
        }
        let again = batch.again.iter().map(|one| one.candidate.source.clone());
        self.asked.extend(again);
        Ok(judged)
    }
}

/// The fewer operations the better, and the earlier a program may leave.
pub fn speed(program: &Program) -> f64 {
    let statements = program.statements();
    let operations = statements.iter().map(|statement| match statement.op {
        Op::Edge => 3.0,
        Op::Cross => 9.0,
        Op::Volume(..) => 5.0,
        _ => 1.0,
    });
    let exit = statements
        .iter()
        .position(|statement| statement.op == Op::Exit);
    let exit = exit.unwrap_or(statements.len());
    1.0 / (operations.sum::<f64>() + exit as f64)
}

pub fn source(program: &Program) -> String {
    format!("{:016x}", hash(program))
}

pub fn hash(program: &Program) -> u64 {
    let mut hasher = DefaultHasher::new();
    program.statements().hash(&mut hasher);
    hasher.finish()
}

/// Judges by [`speed`] and one cost, which is the less the more crosses a program has: cheap ones are slow.
pub struct Priced;

impl Priced {
    pub fn cost(program: &Program) -> f64 {
        let statements = program.statements().iter();
        let crosses = statements.filter(|statement| statement.op == Op::Cross);
        1.0 / (1.0 + crosses.count() as f64)
    }
}

impl Foresee for Priced {
    fn source(&mut self, program: &Program) -> String {
        source(program)
    }
}

impl EvaluateAtOnce for Priced {
    type Error = Infallible;

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, Infallible> {
        let Ok(mut judged) = { FORMULA }.evaluate(batch);
        let new = batch.new.iter().zip(&mut judged.new);
        let again = batch.again.iter().map(|one| &one.candidate);
        for (candidate, evaluation) in new.chain(again.zip(&mut judged.again)) {
            evaluation.costs = vec![Priced::cost(&candidate.program)];
        }
        Ok(judged)
    }
}

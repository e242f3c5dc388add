//! Who judges and observes in the tests of the search: no compiler, no file.

use std::collections::HashSet;
use std::convert::Infallible;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;

use evolve::{Evaluate, Evaluation, Generation, Individual, Observe};
use program::{Op, Program};

/// A generation as it was observed.
#[derive(Debug, PartialEq)]
pub struct Observed {
    pub number: usize,
    pub new: Vec<Individual>,
    pub population: Vec<Individual>,
}

pub struct Record(pub Vec<Observed>);

impl Observe for Record {
    fn generation(&mut self, generation: &Generation<'_>) -> io::Result<()> {
        self.0.push(Observed {
            number: generation.number,
            new: generation.new.to_vec(),
            population: generation.population.to_vec(),
        });
        Ok(())
    }
}

pub struct DiskFull {
    pub room_for: usize,
}

impl Observe for DiskFull {
    fn generation(&mut self, generation: &Generation<'_>) -> io::Result<()> {
        if generation.number < self.room_for {
            Ok(())
        } else {
            Err(io::ErrorKind::StorageFull.into())
        }
    }
}

/// Judges by a formula.
pub struct Judge(pub fn(&Program) -> Option<f64>);

pub const FORMULA: Judge = Judge(|program| Some(speed(program)));

impl Evaluate for Judge {
    type Error = Infallible;

    fn evaluate(&mut self, programs: &[Program]) -> Result<Vec<Evaluation>, Infallible> {
        let judge = |program| Evaluation {
            source: source(program).to_string(),
            fitness: self.0(program),
            uncertainty: 0.0,
            details: serde_json::Value::Null,
        };
        Ok(programs.iter().map(judge).collect())
    }
}

/// Overrates a third of all programs until it is asked again.
#[derive(Default)]
pub struct Lucky {
    known: HashSet<String>,
}

impl Evaluate for Lucky {
    type Error = Infallible;

    fn evaluate(&mut self, programs: &[Program]) -> Result<Vec<Evaluation>, Infallible> {
        let Ok(mut evaluations) = { FORMULA }.evaluate(programs);
        for (program, evaluation) in programs.iter().zip(&mut evaluations) {
            if source(program).is_multiple_of(3) && !self.known.contains(&evaluation.source) {
                evaluation.fitness = evaluation.fitness.map(|fitness| 10.0 * fitness);
            }
        }
        Ok(evaluations)
    }

    fn confirm(&mut self, individuals: &[&Individual]) -> Result<Vec<Evaluation>, Infallible> {
        let programs: Vec<Program> = individuals.iter().map(|one| one.program.clone()).collect();
        let Ok(evaluations) = { FORMULA }.evaluate(&programs);
        self.known.extend(
            evaluations
                .iter()
                .map(|evaluation| evaluation.source.clone()),
        );
        Ok(evaluations)
    }
}

/// Gives recorded evaluations in their order, whatever it is asked.
pub struct Replay(pub std::vec::IntoIter<Evaluation>);

impl Evaluate for Replay {
    type Error = Infallible;

    fn evaluate(&mut self, programs: &[Program]) -> Result<Vec<Evaluation>, Infallible> {
        Ok(self.0.by_ref().take(programs.len()).collect())
    }
}

/// Judges so many generations and then cannot go on.
pub struct Breaks {
    pub after: usize,
}

impl Evaluate for Breaks {
    type Error = &'static str;

    fn evaluate(&mut self, programs: &[Program]) -> Result<Vec<Evaluation>, &'static str> {
        self.after = self.after.checked_sub(1).ok_or("the worker is gone")?;
        let Ok(evaluations) = { FORMULA }.evaluate(programs);
        Ok(evaluations)
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

pub fn source(program: &Program) -> u64 {
    let mut hasher = DefaultHasher::new();
    program.statements().hash(&mut hasher);
    hasher.finish()
}

//! Programs judged in earnest: printed, compiled, checked and timed.

use std::cell::Cell;
use std::collections::{HashMap, HashSet};
use std::rc::Rc;
use std::time::{Duration, Instant};

use emit::{Kernel, operations};
use evolve::{
    Batch, Evaluate, EvaluateAtOnce, Evaluation, Foresee, Individual, Judged, Line, Objective,
    Recorded,
};
use measure::{MAX_P99_ERROR, MeasureError, Spent, source_hash};
use program::Program;

use super::course::Course;
use crate::arena::Arena;
use crate::benches::{Benches, BuiltForAll, Running};

/// Judges programs on a bench.
pub struct Evaluator<'a> {
    arena: &'a Arena,
    bench: &'a mut Benches,
    objective: Objective,
    /// How many cores time at once.
    cores: usize,
    spent: Rc<Cell<Totals>>,
    /// By machine code, what is known of it.
    known: HashMap<String, Evaluation>,
}

/// Where the time went, for whoever reports it.
#[derive(Clone, Copy, Default)]
pub struct Totals {
    /// Picking programs is the search's; printing them is counted here.
    pub emit: Duration,
    /// Compiling and measuring.
    pub bench: Spent,
    /// How many candidates were not timed, since they were the same machine code as one that had been.
    pub twins: u64,
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
            known: HashMap::new(),
        }
    }

    /// Learns what was recorded of machine code by the part of the run that is over.
    pub fn remember(&mut self, recorded: &Recorded) {
        for line in &recorded.lines {
            if let Line::New { evaluation, .. } | Line::Again { evaluation, .. } = line
                && let Some(code) = &evaluation.code
            {
                self.known.insert(code.clone(), evaluation.clone());
            }
        }
    }

    /// Whether each of these is machine code that nobody has been, before or in this batch.
    fn first_of_their_code(&self, codes: &[Option<String>]) -> Vec<bool> {
        let mut met = HashSet::new();
        let first = codes.iter().map(|code| match code {
            Some(code) => !self.known.contains_key(code) && met.insert(code),
            None => true,
        });
        first.collect()
    }

    /// Keeps what is known of machine code, and says in the evaluation which it is.
    fn learn(&mut self, code: Option<&str>, mut evaluation: Evaluation) -> Evaluation {
        if let Some(code) = code {
            evaluation.code = Some(code.to_owned());
            self.known.insert(code.to_owned(), evaluation.clone());
        }
        evaluation
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

/// A batch that is compiled.
pub struct Compiled {
    built: BuiltForAll,
    context: Context,
}

/// A batch that is being timed.
pub struct Timing {
    running: Running,
    /// Of each of the new whether it is timed: nobody was the same machine code.
    timed: Vec<bool>,
    context: Context,
}

/// What an evaluation is made of beside the verdict.
struct Context {
    course: Course,
    /// The machine code of the new, and of those judged again.
    codes: Vec<Option<String>>,
    /// How many are new.
    new: usize,
    again: Vec<Individual>,
}

impl Foresee for Evaluator<'_> {
    fn source(&mut self, program: &Program) -> String {
        source(&self.kernels(program))
    }

    fn work(&self, program: &Program) -> f64 {
        operations(program, &self.arena.scene)
    }
}

impl Evaluate for Evaluator<'_> {
    type Error = MeasureError;
    type Ready = Compiled;
    type Begun = Timing;

    fn prepare(&mut self, batch: &Batch<'_>) -> Result<Compiled, MeasureError> {
        let new = batch.new.iter().map(|candidate| &candidate.program);
        let again = batch.again.iter().map(|one| &one.candidate.program);
        let programs: Vec<&Program> = new.chain(again).collect();
        let kernels: Vec<Vec<Kernel>> = programs.iter().map(|one| self.kernels(one)).collect();
        let kernels: Vec<&[Kernel]> = kernels.iter().map(Vec::as_slice).collect();
        let built = self.bench.build(&kernels, false)?;
        let context = Context {
            course: Course::of(batch, MAX_P99_ERROR, self.objective),
            codes: built.codes(),
            new: batch.new.len(),
            again: batch.again.to_vec(),
        };
        Ok(Compiled { built, context })
    }

    fn begin(&mut self, Compiled { mut built, context }: Compiled) -> Result<Timing, MeasureError> {
        let timed = self.first_of_their_code(&context.codes[..context.new]);
        built.retain(&timed);
        let newcomers = timed.iter().filter(|timed| **timed).count();
        let plan = context
            .course
            .plan(newcomers, context.again.len(), self.cores);
        let mut totals = self.spent.get();
        totals.twins += (context.new - newcomers) as u64;
        self.spent.set(totals);
        Ok(Timing {
            running: self.bench.begin(built, &plan)?,
            timed,
            context,
        })
    }

    fn finish(
        &mut self,
        Timing {
            running,
            timed,
            context,
        }: Timing,
    ) -> Result<Judged, MeasureError> {
        let verdicts = self.bench.finish(running)?;
        let mut totals = self.spent.get();
        totals.bench = self.bench.spent();
        self.spent.set(totals);
        // The first one is the reference's.
        let mut verdicts = verdicts.into_iter().skip(1);
        let (of_new, of_again) = context.codes.split_at(context.new);
        let mut new = Vec::with_capacity(context.new);
        for (code, timed) in of_new.iter().zip(timed) {
            new.push(match code.as_ref().filter(|_| !timed) {
                Some(code) => self.known[code].clone(),
                None => {
                    let verdict = verdicts.next().expect("one a kernel that was timed");
                    self.learn(code.as_deref(), context.course.evaluation(verdict))
                }
            });
        }
        let again = context.again.iter().zip(of_again).zip(verdicts);
        let again = again.map(|((individual, code), verdict)| {
            self.learn(code.as_deref(), context.course.pooled(individual, verdict))
        });
        let again = again.collect();
        Ok(Judged { new, again })
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

impl Foresee for Nobody<'_> {
    fn source(&mut self, program: &Program) -> String {
        source(&self.0.kernels(program))
    }

    fn work(&self, program: &Program) -> f64 {
        operations(program, &self.0.scene)
    }
}

impl EvaluateAtOnce for Nobody<'_> {
    type Error = NeverTimed;

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

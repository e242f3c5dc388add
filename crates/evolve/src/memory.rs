//! What a run knows already, so that nothing is judged twice: by this run, or by the part of it
//! that a journal has recorded.

use std::collections::{HashMap, HashSet, VecDeque};
use std::io;

use program::Program;

use crate::evaluate::{Batch, Evaluate, Evaluation, Foresee, Judged};
use crate::individual::Candidate;
use crate::journal::{Identity, Journal, Line, Recorded};

/// Judges by what is known, asks another for the rest, and writes all of it down.
pub struct Memory<E> {
    evaluate: E,
    journal: Option<Journal>,
    /// By source, what is known of it now.
    known: HashMap<String, Evaluation>,
    /// Every source that has been asked for, known already or not yet.
    met: HashSet<String>,
    tape: Tape,
}

/// A batch of which what is not on the tape is being made ready, or is being judged, by somebody else.
pub struct Asked<T> {
    generation: usize,
    new: Vec<(Identity, Answer)>,
    /// Number and source of those judged again, and what was recorded; none if somebody else is asked.
    again: Vec<(u64, String, Option<Evaluation>)>,
    /// None if all of it is known.
    by_other: Option<T>,
}

/// Where an evaluation comes from.
enum Answer {
    /// The source was met before.
    Known,
    /// The tape.
    Recorded(Evaluation),
    /// Somebody else.
    Asked,
}

/// What was recorded and has not been asked for yet.
#[derive(Default)]
struct Tape {
    /// The first evaluation of every source.
    new: HashMap<String, Evaluation>,
    /// Its later ones, in order.
    again: HashMap<String, VecDeque<Evaluation>>,
    /// The source of every candidate, by its number; empty if other candidates may come.
    sources: Vec<String>,
}

/// Judging stopped, or recording did.
#[derive(Debug, thiserror::Error)]
pub enum MemoryError<E> {
    /// Judging could not go on.
    #[error(transparent)]
    Evaluate(E),
    /// The journal cannot be written.
    #[error("the run cannot be recorded: {0}")]
    Journal(#[from] io::Error),
    /// The recorded run tried something else.
    #[error(
        "candidate {id} is not the one that was recorded: the graph or what is emitted for it \
         has changed since, so the run cannot go on"
    )]
    Changed {
        /// The candidate's number.
        id: u64,
    },
}

impl<E: Evaluate> Memory<E> {
    /// A memory of a new run, in a journal that has just begun.
    pub fn new(evaluate: E, journal: Journal) -> Memory<E> {
        Memory::with_tape(evaluate, Some(journal), Tape::default())
    }

    /// A memory that gives what was recorded as long as there is something, and goes on from
    /// there. The search must be the one that was recorded.
    pub fn resume(evaluate: E, journal: Journal, recorded: Recorded) -> Memory<E> {
        Memory::with_tape(evaluate, Some(journal), Tape::new(recorded, true))
    }

    /// A memory of what was recorded, for any search. Nothing is written; `evaluate` is asked
    /// for what was never recorded.
    pub fn replay(evaluate: E, recorded: Recorded) -> Memory<E> {
        Memory::with_tape(evaluate, None, Tape::new(recorded, false))
    }

    fn with_tape(evaluate: E, journal: Option<Journal>, tape: Tape) -> Memory<E> {
        Memory {
            evaluate,
            journal,
            known: HashMap::new(),
            met: HashSet::new(),
            tape,
        }
    }

    /// How many different sources have been judged.
    pub fn sources(&self) -> usize {
        self.known.len()
    }

    /// Ends the memory. Gives the journal, which stays locked for as long as somebody has it.
    pub fn into_journal(self) -> Option<Journal> {
        self.journal
    }

    /// Where the evaluation of a new candidate comes from.
    fn answer_for_new(&mut self, candidate: &Candidate) -> Answer {
        if !self.met.insert(candidate.source.clone()) {
            return Answer::Known;
        }
        let recorded = self.tape.new.remove(&candidate.source);
        recorded.map_or(Answer::Asked, Answer::Recorded)
    }

    /// What was recorded next of one that is judged again.
    fn recorded_again(&mut self, source: &str) -> Option<Evaluation> {
        self.tape.again.get_mut(source)?.pop_front()
    }

    /// Learns what became of a batch, `fresh` being what somebody else was asked for. Gives the lines that are not in
    /// the journal yet.
    fn learn<T>(&mut self, batch: &Asked<T>, fresh: Judged) -> Vec<Line> {
        let (mut new, mut again) = (fresh.new.into_iter(), fresh.again.into_iter());
        let mut lines = Vec::new();
        for (candidate, answer) in &batch.new {
            let evaluation = match answer {
                Answer::Known => None,
                Answer::Recorded(evaluation) => Some(evaluation.clone()),
                Answer::Asked => Some(new.next().expect("an evaluation a candidate")),
            };
            let evaluation = evaluation.map(Evaluation::without_what_is_no_fitness);
            if let Some(evaluation) = &evaluation {
                let source = candidate.source.clone();
                self.known.insert(source, evaluation.clone());
            }
            if self.tape.source(candidate.id).is_some() {
                continue;
            }
            let candidate = candidate.clone();
            lines.push(match evaluation {
                Some(evaluation) => Line::New {
                    candidate,
                    evaluation,
                },
                None => Line::Duplicate { candidate },
            });
        }
        for (id, source, recorded) in &batch.again {
            let evaluation = recorded.clone().or_else(|| again.next());
            let evaluation = evaluation.expect("an evaluation an individual");
            let evaluation = evaluation.without_what_is_no_fitness();
            self.known.insert(source.clone(), evaluation.clone());
            if recorded.is_none() {
                lines.push(Line::Again {
                    id: *id,
                    generation: batch.generation,
                    source: source.clone(),
                    evaluation,
                });
            }
        }
        assert!(
            new.next().is_none() && again.next().is_none(),
            "no more than was asked"
        );
        lines
    }
}

impl<T> Asked<T> {
    /// The same with somebody else's next step taken.
    fn step<U, E>(self, step: impl FnOnce(T) -> Result<U, E>) -> Result<Asked<U>, E> {
        let Asked {
            generation,
            new,
            again,
            by_other,
        } = self;
        Ok(Asked {
            generation,
            new,
            again,
            by_other: by_other.map(step).transpose()?,
        })
    }
}

impl Tape {
    /// `same` says whether the search will be the recorded one.
    fn new(recorded: Recorded, same: bool) -> Tape {
        let mut tape = Tape::default();
        for line in recorded.lines {
            match line {
                Line::Run { .. } => {}
                Line::New {
                    candidate,
                    evaluation,
                } => {
                    tape.sources.push(candidate.source.clone());
                    tape.new.insert(candidate.source, evaluation);
                }
                Line::Duplicate { candidate } => tape.sources.push(candidate.source),
                Line::Again {
                    source, evaluation, ..
                } => tape.again.entry(source).or_default().push_back(evaluation),
            }
        }
        if !same {
            tape.sources.clear();
        }
        tape
    }

    fn source(&self, id: u64) -> Option<&String> {
        self.sources.get(usize::try_from(id).ok()?)
    }
}

impl<E: Evaluate> Foresee for Memory<E> {
    fn source(&mut self, program: &Program) -> String {
        self.evaluate.source(program)
    }

    fn work(&self, program: &Program) -> f64 {
        self.evaluate.work(program)
    }
}

impl<E: Evaluate> Evaluate for Memory<E> {
    type Error = MemoryError<E::Error>;
    type Ready = Asked<E::Ready>;
    type Begun = Asked<E::Begun>;

    fn prepare(&mut self, batch: &Batch<'_>) -> Result<Self::Ready, Self::Error> {
        let differs = |candidate: &&Candidate| {
            let recorded = self.tape.source(candidate.id);
            recorded.is_some_and(|source| *source != candidate.source)
        };
        if let Some(&Candidate { id, .. }) = batch.new.iter().find(differs) {
            return Err(MemoryError::Changed { id });
        }
        let (mut new, mut again) = (Vec::new(), Vec::new());
        let (mut unknown, mut unknown_again) = (Vec::new(), Vec::new());
        for candidate in batch.new {
            let answer = self.answer_for_new(candidate);
            if matches!(answer, Answer::Asked) {
                unknown.push(candidate.clone());
            }
            new.push((Identity::of(candidate), answer));
        }
        for individual in batch.again {
            let Candidate { id, source, .. } = &individual.candidate;
            let recorded = self.recorded_again(source);
            if recorded.is_none() {
                unknown_again.push(individual.clone());
            }
            again.push((*id, source.clone(), recorded));
        }
        let asked = Batch {
            new: &unknown,
            again: &unknown_again,
            ..*batch
        };
        let is_known = unknown.is_empty() && unknown_again.is_empty();
        let by_other = match is_known {
            true => None,
            false => Some(
                self.evaluate
                    .prepare(&asked)
                    .map_err(MemoryError::Evaluate)?,
            ),
        };
        Ok(Asked {
            generation: batch.generation,
            new,
            again,
            by_other,
        })
    }

    fn begin(&mut self, ready: Self::Ready) -> Result<Self::Begun, Self::Error> {
        let begun = ready.step(|ready| self.evaluate.begin(ready));
        begun.map_err(MemoryError::Evaluate)
    }

    fn finish(&mut self, begun: Self::Begun) -> Result<Judged, Self::Error> {
        let mut batch = begun
            .step(|begun| self.evaluate.finish(begun))
            .map_err(MemoryError::Evaluate)?;
        let fresh = batch.by_other.take().unwrap_or_default();
        let lines = self.learn(&batch, fresh);
        if let Some(journal) = &mut self.journal
            && !lines.is_empty()
        {
            journal.append(&lines)?;
        }
        let known = |source: &String| self.known[source].clone();
        let new = batch.new.iter().map(|(one, _)| known(&one.source));
        let again = batch.again.iter().map(|(_, source, _)| known(source));
        Ok(Judged {
            new: new.collect(),
            again: again.collect(),
        })
    }
}

//! What a run knows already, so that nothing is judged twice: by this run, or by the part of it
//! that a journal has recorded.

use std::collections::{HashMap, VecDeque};
use std::io;

use program::Program;

use crate::evaluate::{Batch, Evaluate, Evaluation, Judged};
use crate::individual::{Candidate, Individual};
use crate::journal::{Identity, Journal, Line, Recorded};

/// Judges by what is known, asks another for the rest, and writes all of it down.
pub struct Memory<E> {
    evaluate: E,
    journal: Option<Journal>,
    /// By source, what is known of it now.
    known: HashMap<String, Evaluation>,
    tape: Tape,
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
            tape,
        }
    }

    /// How many different sources have been judged.
    pub fn sources(&self) -> usize {
        self.known.len()
    }

    /// Takes the evaluations of the batch's new sources from the tape or else from `fresh`. Gives
    /// the lines that are not in the journal yet.
    fn learn_new(&mut self, batch: &Batch<'_>, fresh: Vec<Evaluation>) -> Vec<Line> {
        let mut fresh = fresh.into_iter();
        let mut lines = Vec::new();
        for candidate in batch.new {
            let source = &candidate.source;
            let first = !self.known.contains_key(source);
            if first {
                let recorded = self.tape.new.remove(source);
                let evaluation = recorded.or_else(|| fresh.next());
                let evaluation = evaluation.expect("one for every unknown source");
                let evaluation = evaluation.without_what_is_no_fitness();
                self.known.insert(source.clone(), evaluation);
            }
            if self.tape.source(candidate.id).is_some() {
                continue;
            }
            let identity = Identity::of(candidate);
            lines.push(if first {
                let evaluation = self.known[source].clone();
                Line::New {
                    candidate: identity,
                    evaluation,
                }
            } else {
                Line::Duplicate {
                    candidate: identity,
                }
            });
        }
        lines
    }

    /// The same for those judged again.
    fn learn_again(&mut self, batch: &Batch<'_>, fresh: Vec<Evaluation>) -> Vec<Line> {
        let mut fresh = fresh.into_iter();
        let mut lines = Vec::new();
        for Individual { candidate, .. } in batch.again {
            let source = &candidate.source;
            let queue = self.tape.again.get_mut(source);
            let evaluation = queue.and_then(VecDeque::pop_front).unwrap_or_else(|| {
                let evaluation = fresh.next().expect("one for whoever is not on the tape");
                let evaluation = evaluation.without_what_is_no_fitness();
                lines.push(Line::Again {
                    id: candidate.id,
                    generation: batch.generation,
                    source: source.clone(),
                    evaluation: evaluation.clone(),
                });
                evaluation
            });
            self.known.insert(source.clone(), evaluation);
        }
        lines
    }

    /// Ends the memory. Gives the journal, which stays locked for as long as somebody has it.
    pub fn into_journal(self) -> Option<Journal> {
        self.journal
    }

    /// Those of a batch that nobody has judged.
    fn unknown(&self, batch: &Batch<'_>) -> (Vec<Candidate>, Vec<Individual>) {
        let mut new: Vec<Candidate> = Vec::new();
        for candidate in batch.new {
            let source = &candidate.source;
            let seen = self.known.contains_key(source)
                || self.tape.new.contains_key(source)
                || new.iter().any(|other| other.source == *source);
            if !seen {
                new.push(candidate.clone());
            }
        }
        let recorded = |individual: &&Individual| {
            let again = self.tape.again.get(&individual.candidate.source);
            again.is_none_or(VecDeque::is_empty)
        };
        let again = batch.again.iter().filter(recorded).cloned().collect();
        (new, again)
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

impl<E: Evaluate> Evaluate for Memory<E> {
    type Error = MemoryError<E::Error>;

    fn source(&mut self, program: &Program) -> String {
        self.evaluate.source(program)
    }

    fn work(&self, program: &Program) -> f64 {
        self.evaluate.work(program)
    }

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, Self::Error> {
        let differs = |candidate: &&Candidate| {
            let recorded = self.tape.source(candidate.id);
            recorded.is_some_and(|source| *source != candidate.source)
        };
        if let Some(&Candidate { id, .. }) = batch.new.iter().find(differs) {
            return Err(MemoryError::Changed { id });
        }
        let (new, again) = self.unknown(batch);
        let judged = if new.is_empty() && again.is_empty() {
            Judged::default()
        } else {
            let asked = Batch {
                new: &new,
                again: &again,
                ..*batch
            };
            let judged = self.evaluate.evaluate(&asked);
            judged.map_err(MemoryError::Evaluate)?
        };
        assert_eq!(judged.new.len(), new.len(), "an evaluation a candidate");
        assert_eq!(judged.again.len(), again.len(), "one an individual");
        let mut lines = self.learn_new(batch, judged.new);
        lines.extend(self.learn_again(batch, judged.again));
        if let Some(journal) = &mut self.journal
            && !lines.is_empty()
        {
            journal.append(&lines)?;
        }
        let known = |candidate: &Candidate| self.known[&candidate.source].clone();
        let again = batch.again.iter().map(|one| known(&one.candidate));
        Ok(Judged {
            new: batch.new.iter().map(known).collect(),
            again: again.collect(),
        })
    }
}

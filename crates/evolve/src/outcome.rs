//! What is told of a search: of every generation, and of its end.

use std::ops::ControlFlow;

use program::ProgramError;

use crate::individual::Individual;
use crate::selection::{distinct, front, fronts};

/// Told of every generation.
pub trait Observe {
    /// A generation has been evaluated. Says whether to go on.
    fn generation(&mut self, generation: &Generation<'_>) -> ControlFlow<()>;
}

/// One generation, evaluated.
pub struct Generation<'a> {
    /// Its number; the first one of every island is random.
    pub number: usize,
    /// Those evaluated in it.
    pub new: &'a [Individual],
    /// Everyone alive, on all islands, best first; but not by the paper, those who are the same kernel as one before
    /// them come last.
    pub population: &'a [Individual],
    /// How many drafts so far were no candidates, since their source had been tried.
    pub redrawn: u64,
}

impl Generation<'_> {
    /// The kernels alive that no other one beats in speed and in every cost at once, the fittest first.
    pub fn front(&self) -> Vec<&Individual> {
        front(self.population)
    }
}

/// Why a search stopped.
#[derive(Debug)]
pub enum Stop<E> {
    /// All generations are through.
    Done,
    /// Nobody has any fitness, so nobody can be a parent.
    NobodyFit,
    /// The strategy finds nothing that has not been tried.
    Exhausted,
    /// The graph lets a genome pick a program that is none.
    Graph(ProgramError),
    /// Judging could not go on.
    Evaluation(E),
    /// As many have been evaluated as were to be.
    Enough,
    /// The observer did not want to go on.
    Ended,
}

/// How a search ended.
#[derive(Debug)]
pub struct Outcome<E> {
    /// Everyone alive, best first. Empty if the first generation was never finished.
    pub population: Vec<Individual>,
    /// How many individuals were evaluated.
    pub evaluations: u64,
    /// How many drafts were no candidates, since their source had been tried.
    pub redrawn: u64,
    /// Why it stopped.
    pub stop: Stop<E>,
}

impl<E> Outcome<E> {
    /// The fittest kernels, the fittest first, each once.
    pub fn best(&self, count: usize) -> Vec<&Individual> {
        let mut best = distinct(&self.population);
        best.truncate(count);
        best
    }

    /// The kernels that no other one beats in speed and in every cost at once, the fittest first, no two of the
    /// same source.
    pub fn front(&self) -> Vec<&Individual> {
        front(&self.population)
    }

    /// The front, and those behind it until there are so many: whole fronts, the fittest first in each.
    pub fn fronts(&self, count: usize) -> Vec<&Individual> {
        fronts(&self.population, count)
    }
}

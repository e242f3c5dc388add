//! A search within the search: it begins at random, breeds from its own, and is over when nothing it makes is better.
//! A neighbourhood is soon used up, and what is found far from it is never bred from beside what has been tuned
//! for long; so the next one has no parents in common with it.

use program::Genome;

use super::memetic::child_of;
use super::niches::Niches;
use crate::individual::{Individual, Origin};
use crate::world::World;

/// It is over when its island has had so many candidates since anyone became its best.
const STALE: u64 = 250;

/// Everybody who was evaluated from some number on.
#[derive(Default)]
pub struct Epoch {
    /// The number of its first candidate.
    first: u64,
    niches: Niches,
    /// The youngest of those who were its best at some time.
    youngest_best: u64,
    /// How many the island had had when that one was known.
    rose: u64,
}

impl Epoch {
    /// One that begins with whoever is evaluated next.
    pub fn from_now(world: &World<'_>) -> Epoch {
        Epoch {
            first: world.made,
            rose: world.evaluations,
            ..Epoch::default()
        }
    }

    /// Whether nobody belongs to it who could be a parent.
    pub fn is_empty(&self) -> bool {
        self.niches.is_empty()
    }

    /// Takes everyone alive into account who belongs to it.
    pub fn see(&mut self, world: &World<'_>) {
        self.niches.see(self.members(world.population));
        if self.is_empty() {
            return;
        }
        // Who was better before is so again when it is timed again.
        let best = self.niches.best(0).candidate.id;
        if best > self.youngest_best {
            self.youngest_best = best;
            self.rose = world.evaluations;
        }
    }

    /// Whether nobody became its best for too long.
    pub fn is_over(&self, world: &World<'_>) -> bool {
        world.evaluations >= self.rose + STALE
    }

    /// A child of two that belong to it, or a neighbour of one.
    pub fn child(&self, world: &mut World<'_>) -> Option<(Origin, Genome)> {
        let alive = &world.population[..world.fit()];
        let elite: Vec<&Individual> = self.members(alive).collect();
        child_of(world, &elite, &self.niches)
    }

    fn members<'a>(&self, all: &'a [Individual]) -> impl Iterator<Item = &'a Individual> + use<'a> {
        let first = self.first;
        all.iter().filter(move |one| one.candidate.id >= first)
    }
}

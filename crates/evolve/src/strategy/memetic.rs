//! A genetic algorithm whose every child is a kernel that nobody has timed, with local search at its end.

use program::{Genome, ProgramError};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::Propose;
use super::hill::neighbour;
use super::niches::Niches;
use crate::individual::{Draft, Individual, Origin};
use crate::operators::{crossover, graft, mutate, random_cut, tournament};
use crate::world::World;

/// From here on, of the whole search, neighbours of the few best are tried and nothing else.
const LOCAL: f64 = 0.7;

/// How many structures have neighbours of their best tried then.
const FEW: usize = 3;

/// How many structures have a chance to breed.
const STRUCTURES: usize = 12;

/// A population that breeds by tournament.
#[derive(Default)]
pub struct Memetic {
    niches: Niches,
    /// Of all islands.
    all: Niches,
}

impl Propose for Memetic {
    fn propose(&mut self, world: &mut World<'_>) -> Result<Vec<Draft>, ProgramError> {
        if world.population.is_empty() {
            return world.random_drafts(world.batch());
        }
        self.niches.see(world.population);
        self.all.see(world.everyone());
        world.fresh(world.batch(), |world| {
            if world.progress() >= LOCAL {
                return neighbour_of_a_best(world, &self.all);
            }
            let elite: Vec<&Individual> = world.population[..world.fit()].iter().collect();
            child_of(world, &elite, &self.niches)
        })
    }
}

/// A neighbour of the best of one of the few best structures.
pub fn neighbour_of_a_best(world: &mut World<'_>, niches: &Niches) -> Option<(Origin, Genome)> {
    let place = tournament(niches.len().min(FEW), world.rng)?;
    neighbour(world, niches.best(place))
}

/// A child of two of the elite or of the best of their structures, or a neighbour of one.
pub fn child_of(
    world: &mut World<'_>,
    elite: &[&Individual],
    niches: &Niches,
) -> Option<(Origin, Genome)> {
    let mut draw = || parent(elite, niches, world.rng);
    let [parent, other] = [draw()?, draw()?];
    let [one, two] = [parent, other].map(|individual| &individual.candidate);
    let parents = [one.id, two.id];
    match world.rng.random_range(0..4) {
        0 => {
            let cut = random_cut(world.graph.nodes().len(), world.rng);
            let [mut genome, _] = crossover(&one.genome, &two.genome, cut);
            mutate(&mut genome, world.rng);
            Some((Origin::Crossover { parents }, genome))
        }
        1 => {
            let genome = graft(world.graph, &one.genome, &two.genome, world.rng)?;
            Some((Origin::Graft { parents }, genome))
        }
        _ => neighbour(world, parent),
    }
}

/// One of the elite, if there is one, or, as often, the best of a structure; the better the likelier.
fn parent<'a>(
    elite: &[&'a Individual],
    niches: &'a Niches,
    rng: &mut ChaCha8Rng,
) -> Option<&'a Individual> {
    if rng.random()
        && let Some(place) = tournament(elite.len(), rng)
    {
        return Some(elite[place]);
    }
    let place = tournament(niches.len().min(STRUCTURES), rng)?;
    Some(niches.best(place))
}

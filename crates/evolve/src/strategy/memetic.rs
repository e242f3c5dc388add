//! A genetic algorithm whose every child is a kernel that nobody has timed, with local search at its end.

use program::{Genome, ProgramError};
use rand::RngExt;

use super::Propose;
use super::hill::neighbour;
use crate::individual::{Draft, Origin};
use crate::operators::{crossover, graft, mutate, random_cut, tournament};
use crate::world::World;

/// From here on, of the whole search, neighbours of the few best are tried and nothing else.
const LOCAL: f64 = 0.7;

/// How many have neighbours tried then.
const FEW: usize = 3;

/// A population that breeds by tournament.
pub struct Memetic;

impl Propose for Memetic {
    fn propose(&mut self, world: &mut World<'_>) -> Result<Vec<Draft>, ProgramError> {
        if world.population.is_empty() {
            return world.random_drafts(world.batch());
        }
        world.fresh(world.batch(), child)
    }
}

/// A child of the elite; late in the search a neighbour of one of the few best.
pub fn child(world: &mut World<'_>) -> Option<(Origin, Genome)> {
    let fit = world.fit();
    if world.progress() >= LOCAL {
        let place = tournament(fit.min(FEW), world.rng)?;
        return neighbour(world, &world.population[place]);
    }
    let [a, b] = [tournament(fit, world.rng)?, tournament(fit, world.rng)?];
    let (parent, other) = (&world.population[a], &world.population[b]);
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

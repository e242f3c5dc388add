//! The genetic algorithm of the paper's section 5, made exact.
//!
//! The first generation is random. In every later one the elite survives unchanged and the rest
//! is replaced by pairs of offspring: both parents are drawn from the whole population with
//! probability proportional to fitness, a segment between two cut points is exchanged by order,
//! and in each of the offspring a random pair of values is swapped, twice. Another [`Objective`] has
//! others survive and breed.
//!
//! [`Objective`]: crate::Objective

use program::{Genome, ProgramError};

use super::Propose;
use crate::individual::{Draft, Origin};
use crate::operators::{crossover, mutate, random_cut};
use crate::settings::Settings;
use crate::world::World;

/// The paper's strategy, which tries duplicates like everybody else.
pub struct Paper;

impl Propose for Paper {
    fn propose(&mut self, world: &mut World<'_>) -> Result<Vec<Draft>, ProgramError> {
        let genomes = if world.population.is_empty() {
            let places = 0..world.generation();
            let random = places.map(|place| (Origin::Random, world.random(place)));
            random.collect()
        } else {
            offspring(world).unwrap_or_default()
        };
        let genomes = genomes.into_iter();
        genomes
            .map(|(origin, genome)| world.draft(origin, genome))
            .collect()
    }
}

/// The next offspring, or none if nobody has any fitness.
fn offspring(world: &mut World<'_>) -> Option<Vec<(Origin, Genome)>> {
    let &Settings {
        elite, objective, ..
    } = world.settings;
    let count = world.generation();
    let mut offspring = Vec::with_capacity(count);
    while offspring.len() < count {
        let mut parent = || objective.parent(world.population, elite, world.rng);
        let [a, b] = [parent()?, parent()?].map(|place| &world.population[place].candidate);
        let cut = random_cut(world.graph.nodes().len(), world.rng);
        let pair = crossover(&a.genome, &b.genome, cut);
        let parents = [[a.id, b.id], [b.id, a.id]];
        for (mut genome, parents) in pair.into_iter().zip(parents) {
            mutate(&mut genome, world.rng);
            offspring.push((Origin::Crossover { parents }, genome));
        }
    }
    Some(offspring)
}

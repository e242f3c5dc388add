//! The memetic strategy with a model of speed: many drafts are made, and the most promising are timed. Before anything
//! was, the most promising are those that look like the least work.

use std::collections::HashSet;

use program::ProgramError;
use rand::seq::SliceRandom;

use super::Propose;
use super::memetic::child;
use super::niches::Niches;
use super::surrogate::Surrogate;
use crate::individual::Draft;
use crate::world::World;

/// How many drafts are made for each that is timed.
const DRAFTS: usize = 10;

/// One in so many is timed whatever the model says, lest it hear only of what it likes.
const UNASKED: usize = 5;

/// What is known of speed, and of whom it was learnt.
#[derive(Default)]
pub struct Guided {
    model: Surrogate,
    niches: Niches,
    learnt: HashSet<u64>,
}

impl Propose for Guided {
    fn propose(&mut self, world: &mut World<'_>) -> Result<Vec<Draft>, ProgramError> {
        let wanted = world.batch();
        if world.population.is_empty() {
            let drafts = world.random_drafts(DRAFTS * wanted)?;
            let promise = |draft: &Draft, world: &World<'_>| -world.work(&draft.program);
            return Ok(most_promising(drafts, wanted, world, promise));
        }
        for individual in world.population {
            let program = &individual.candidate.program;
            if let Some(fitness) = individual.evaluation.fitness
                && self.learnt.insert(individual.candidate.id)
            {
                self.model.learn(program, world.work(program), fitness);
            }
        }
        self.niches.see(world);
        let weights = self.model.fit();
        let drafts = world.fresh(DRAFTS * wanted, |world| child(world, &self.niches))?;
        let promise = |draft: &Draft, world: &World<'_>| {
            let work = world.work(&draft.program);
            self.model.predict(&weights, &draft.program, work)
        };
        Ok(most_promising(drafts, wanted, world, promise))
    }
}

/// So many of the drafts: a few at random, and of the rest those of the greatest promise.
fn most_promising(
    mut drafts: Vec<Draft>,
    wanted: usize,
    world: &mut World<'_>,
    promise: impl Fn(&Draft, &World<'_>) -> f64,
) -> Vec<Draft> {
    drafts.shuffle(world.rng);
    let unasked = (wanted / UNASKED).min(drafts.len());
    let asked = drafts.split_off(unasked);
    let promises = asked.iter().map(|draft| promise(draft, world));
    let promises: Vec<f64> = promises.collect();
    let mut asked: Vec<(f64, Draft)> = promises.into_iter().zip(asked).collect();
    asked.sort_by(|a, b| b.0.total_cmp(&a.0));
    let promising = asked.into_iter().map(|(_, draft)| draft);
    drafts.extend(promising.take(wanted - unasked));
    drafts
}

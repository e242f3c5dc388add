//! The memetic strategy with a model of speed: many drafts are made, and the most promising are timed. Before anything
//! was, the most promising are those that look like the least work. What is promising is soon used up, so the search goes
//! in [epochs](Epoch), which share the model and nothing else; at last the best of all are tuned.

use std::collections::HashSet;

use program::ProgramError;
use rand::seq::SliceRandom;

use super::Propose;
use super::epoch::Epoch;
use super::memetic::neighbour_of_a_best;
use super::niches::Niches;
use super::surrogate::Surrogate;
use crate::individual::Draft;
use crate::world::World;

/// How many drafts are made for each that is timed.
const DRAFTS: usize = 20;

/// From here on, of the whole search, neighbours of the few best are tried and nothing else.
const LATE: f64 = 0.85;

/// One in so many is timed whatever the model says, lest it hear only of what it likes.
const UNASKED: usize = 5;

/// What is known of speed, and of whom it was learnt.
#[derive(Default)]
pub struct Guided {
    model: Surrogate,
    learnt: HashSet<u64>,
    epoch: Epoch,
    /// Of all epochs on all islands.
    niches: Niches,
}

impl Propose for Guided {
    fn propose(&mut self, world: &mut World<'_>) -> Result<Vec<Draft>, ProgramError> {
        let wanted = world.batch();
        if world.population.is_empty() {
            let drafts = world.random_drafts(DRAFTS * wanted)?;
            let promise = |draft: &Draft, world: &World<'_>| -world.work(&draft.program);
            return Ok(most_promising(drafts, wanted, world, promise));
        }
        self.learn(world);
        self.niches.see(world.everyone());
        self.epoch.see(world);
        let is_late = world.progress() >= LATE;
        if self.epoch.is_over(world) && !is_late {
            self.epoch = Epoch::from_now(world);
        }
        let count = DRAFTS * wanted;
        let drafts = if is_late {
            world.fresh(count, |world| neighbour_of_a_best(world, &self.niches))
        } else if self.epoch.is_empty() && !self.niches.is_empty() {
            // It begins. Where nobody was ever fit there is no use in another, and no child.
            world.random_drafts(count)
        } else {
            world.fresh(count, |world| self.epoch.child(world))
        }?;
        let weights = self.model.fit();
        let promise = |draft: &Draft, world: &World<'_>| {
            let work = world.work(&draft.program);
            self.model.predict(&weights, &draft.program, work)
        };
        Ok(most_promising(drafts, wanted, world, promise))
    }
}

impl Guided {
    /// Learns of everyone alive who is new.
    fn learn(&mut self, world: &World<'_>) {
        for individual in world.everyone() {
            let program = &individual.candidate.program;
            if let Some(fitness) = individual.evaluation.fitness
                && self.learnt.insert(individual.candidate.id)
            {
                self.model.learn(program, world.work(program), fitness);
            }
        }
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

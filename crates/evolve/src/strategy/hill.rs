//! Hill climbing: neighbours of the best, until one of them is the best.

use program::{Genome, ProgramError};
use rand::RngExt;

use super::Propose;
use crate::individual::{Draft, Individual, Origin};
use crate::operators::{flip, slide};
use crate::world::World;

/// Neighbours of the best one; of the next best where all of those have been tried.
pub struct Hill;

impl Propose for Hill {
    fn propose(&mut self, world: &mut World<'_>) -> Result<Vec<Draft>, ProgramError> {
        if world.population.is_empty() {
            return world.random_drafts(world.batch());
        }
        for place in 0..world.fit() {
            let parent = &world.population[place];
            let drafts = world.fresh(world.batch(), |world| neighbour(world, parent))?;
            if !drafts.is_empty() {
                return Ok(drafts);
            }
        }
        Ok(Vec::new())
    }
}

/// A genome near `parent`: a statement elsewhere, or other options of one choice or a few, the fewer the likelier.
pub fn neighbour(world: &mut World<'_>, parent: &Individual) -> Option<(Origin, Genome)> {
    let parent = &parent.candidate;
    if world.rng.random() {
        let genome = slide(world.graph, &parent.genome, &parent.program, world.rng)?;
        return Some((Origin::Slide { parent: parent.id }, genome));
    }
    let mut genome = flip(world.graph, &parent.genome, world.rng)?;
    while world.rng.random() {
        genome = flip(world.graph, &genome, world.rng)?;
    }
    Some((Origin::Flip { parent: parent.id }, genome))
}

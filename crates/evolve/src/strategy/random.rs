//! Random genomes: what any strategy has to beat.

use program::ProgramError;

use super::Propose;
use crate::individual::Draft;
use crate::world::World;

/// Random genomes, no two of the same source.
pub struct Random;

impl Propose for Random {
    fn propose(&mut self, world: &mut World<'_>) -> Result<Vec<Draft>, ProgramError> {
        world.random_drafts(world.batch())
    }
}

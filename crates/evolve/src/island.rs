//! An island: a population that breeds by itself.

use std::collections::HashMap;

use crate::individual::Individual;
use crate::selection::put_twins_last;
use crate::settings::Settings;
use crate::strategy::{Propose, Strategy};

/// How many of the best are judged again in every generation.
const FRONT: usize = 2;

/// So often, and nobody is judged any more.
const ENOUGH: u32 = 6;

/// A population, and who says what is bred of it.
pub(crate) struct Island {
    pub strategy: Box<dyn Propose>,
    /// Everyone alive, best first; nobody before the first generation.
    pub population: Vec<Individual>,
    /// How many candidates have been made on it.
    pub evaluations: u64,
}

impl Island {
    /// Where nobody lives yet.
    pub fn new(settings: &Settings) -> Island {
        Island {
            strategy: settings.strategy.proposes(),
            population: Vec::new(),
            evaluations: 0,
        }
    }

    /// Those who survive if nobody new does, best first.
    pub fn survivors(&self, settings: &Settings) -> &[Individual] {
        &self.population[..settings.elite.min(self.population.len())]
    }

    /// Replaces all but the survivors.
    pub fn replace(&mut self, new: impl IntoIterator<Item = Individual>, settings: &Settings) {
        self.population.truncate(settings.elite);
        self.population.extend(new);
        rank(&mut self.population, settings);
    }

    /// The fittest few, and those in the elite whose source was judged only once; best first, one
    /// of a source.
    pub fn due(&self, judgements: &HashMap<String, u32>, settings: &Settings) -> Vec<Individual> {
        let mut due: Vec<Individual> = Vec::new();
        for (rank, individual) in self.survivors(settings).iter().enumerate() {
            let source = &individual.candidate.source;
            let judgements = judgements[source];
            let asked = judgements == 1 || rank < FRONT && judgements < ENOUGH;
            let twin = due.iter().any(|other| other.candidate.source == *source);
            if asked && !twin && individual.evaluation.fitness.is_some() {
                due.push(individual.clone());
            }
        }
        due
    }
}

/// Puts the best first. In the paper's elite a kernel may be several times.
pub(crate) fn rank(population: &mut Vec<Individual>, settings: &Settings) {
    settings.objective.rank(population);
    if settings.strategy != Strategy::Paper {
        put_twins_last(population);
    }
}

//! What a strategy sees of a search, and how it makes drafts.

use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};

use program::{Genome, Graph, Program, ProgramError};
use rand_chacha::ChaCha8Rng;

use crate::evaluate::Foresee;
use crate::individual::{Draft, Individual, Origin};
use crate::settings::Settings;

/// How many drafts are made for each that is wanted, at most, before a strategy does with fewer.
const PATIENCE: usize = 40;

/// How many are proposed at a time at least, where a generation has as many: kernels are compiled and timed together.
const FEWEST: usize = 10;

/// A search as its [strategy](crate::Propose) sees it.
pub struct World<'a> {
    /// What is searched.
    pub graph: &'a Graph,
    /// Restrictions of it, of which the first generation has some programs, too.
    pub nurseries: &'a [Graph],
    /// The numbers of the search.
    pub settings: &'a Settings,
    /// Everyone alive on the island, best first; nobody before its first generation.
    pub population: &'a [Individual],
    /// Everyone alive on other islands.
    pub others: Vec<&'a Individual>,
    /// How many candidates the island has had.
    pub evaluations: u64,
    /// How many candidates there have been on all islands, the number of the next one. Of the last generation of
    /// another island nothing is known yet.
    pub made: u64,
    /// The one source of all that is random.
    pub rng: &'a mut ChaCha8Rng,
    pub(crate) judgements: &'a HashMap<String, u32>,
    pub(crate) foresee: &'a mut dyn Foresee,
    pub(crate) redrawn: &'a mut u64,
}

impl World<'_> {
    /// Everyone alive, those of the island first.
    pub fn everyone(&self) -> impl Iterator<Item = &Individual> {
        self.population.iter().chain(self.others.iter().copied())
    }

    /// How many a generation of the paper's has: the whole population at first, later all but the elite.
    pub fn generation(&self) -> usize {
        let &Settings {
            population, elite, ..
        } = self.settings;
        if self.population.is_empty() {
            population
        } else {
            population - elite
        }
    }

    /// How many are proposed at a time by who chooses: no more than a generation has, and in a short search fewer, so
    /// that every island has twenty or so occasions to learn from those before.
    pub fn batch(&self) -> usize {
        let share = if self.population.is_empty() { 10 } else { 20 };
        let share = share * self.settings.islands;
        let evaluations = usize::try_from(self.settings.evaluations()).unwrap_or(usize::MAX);
        self.generation().min((evaluations / share).max(FEWEST))
    }

    /// The first places of the population that have any fitness, no more than the elite's.
    pub fn fit(&self) -> usize {
        let elite = self.population.iter().take(self.settings.elite.max(1));
        elite
            .take_while(|one| one.evaluation.fitness.is_some())
            .count()
    }

    /// How much of the search is over, from 0 to 1.
    pub fn progress(&self) -> f64 {
        self.made as f64 / self.settings.evaluations() as f64
    }

    /// How much [work](crate::Foresee::work) a program looks like.
    pub fn work(&self, program: &Program) -> f64 {
        self.foresee.work(program)
    }

    /// A draft of a genome.
    ///
    /// # Errors
    ///
    /// [`ProgramError`] if the genome picks no program, which is the graph's fault.
    pub fn draft(&mut self, origin: Origin, genome: Genome) -> Result<Draft, ProgramError> {
        let program = self.graph.program(&genome)?;
        Ok(Draft {
            origin,
            source: self.foresee.source(&program),
            genome,
            program,
        })
    }

    /// Up to `count` drafts of sources that have not been tried and differ from each other: `make` is asked again
    /// as long as it repeats what is known, or has nothing.
    ///
    /// # Errors
    ///
    /// As of [`World::draft`].
    pub fn fresh(
        &mut self,
        count: usize,
        mut make: impl FnMut(&mut Self) -> Option<(Origin, Genome)>,
    ) -> Result<Vec<Draft>, ProgramError> {
        let mut drafts = Vec::with_capacity(count);
        let mut sources = HashSet::new();
        for _ in 0..PATIENCE * count {
            if drafts.len() == count {
                break;
            }
            let Some((origin, genome)) = make(self) else {
                continue;
            };
            let draft = self.draft(origin, genome)?;
            let tried = self.judgements.contains_key(&draft.source);
            if tried || !sources.insert(draft.source.clone()) {
                *self.redrawn += 1;
                continue;
            }
            drafts.push(draft);
        }
        Ok(drafts)
    }

    /// A random genome for a place of the first generation, which has as many of every nursery.
    pub fn random(&mut self, place: usize) -> Genome {
        let genome = Genome::random(self.graph.nodes().len(), self.rng);
        match self.nurseries.get(place % (1 + self.nurseries.len())) {
            Some(nursery) => of_nursery(nursery, &genome),
            None => genome,
        }
    }

    /// So many random drafts, of sources that have not been tried.
    ///
    /// # Errors
    ///
    /// As of [`World::draft`].
    pub fn random_drafts(&mut self, count: usize) -> Result<Vec<Draft>, ProgramError> {
        let mut places = 0..;
        self.fresh(count, |world| {
            let genome = world.random(places.next()?);
            Some((Origin::Random, genome))
        })
    }
}

/// A genome that picks from a graph what `genome` picks from a restriction of it, in the same order.
fn of_nursery(nursery: &Graph, genome: &Genome) -> Genome {
    let mut live = nursery.live(genome);
    live.sort_by_key(|id| Reverse(genome.priorities()[id.index()]));
    genome.preferring(&live)
}

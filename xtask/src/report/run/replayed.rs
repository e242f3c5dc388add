//! A run gone through again with its recorded timings: genomes are in no journal, but follow from it.

use std::collections::{BTreeSet, HashMap};
use std::ops::ControlFlow;

use evolve::{Candidate, Generation, Observe, Recorded, Settings};
use program::Graph;

use crate::arena::Arena;
use crate::evolve::search_again;
use crate::history::History;
use crate::history::traits::{Trait, traits};

/// All candidates of a run with their genomes, and who was alive when.
#[derive(Default)]
pub struct Replayed {
    candidates: HashMap<u64, Candidate>,
    traits: HashMap<u64, BTreeSet<Trait>>,
    /// The generations that were complete.
    pub generations: Vec<Alive>,
    /// How many drafts had been tried.
    pub redrawn: u64,
}

/// A generation, evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Alive {
    /// Its number; 0 is the random one.
    pub number: usize,
    /// The numbers of the elite, or of all in the random generation.
    pub elite: Vec<u64>,
}

/// Keeps what the search shows, as long as it is the recorded one.
struct Watch<'a> {
    history: &'a History,
    elite: usize,
    kept: Replayed,
    has_changed: bool,
}

impl Observe for Watch<'_> {
    fn generation(&mut self, generation: &Generation<'_>) -> ControlFlow<()> {
        for individual in generation.new {
            let candidate = &individual.candidate;
            let recorded = self.history.find(candidate.id);
            if recorded.is_none_or(|recorded| recorded.source != candidate.source) {
                self.has_changed = true;
                return ControlFlow::Break(());
            }
            let chosen = traits(&candidate.program);
            self.kept.traits.insert(candidate.id, chosen);
            self.kept.candidates.insert(candidate.id, candidate.clone());
        }
        let count = match generation.number {
            0 => generation.population.len(),
            _ => self.elite,
        };
        let alive = generation.population.iter().take(count);
        self.kept.generations.push(Alive {
            number: generation.number,
            elite: alive.map(|one| one.candidate.id).collect(),
        });
        self.kept.redrawn = generation.redrawn;
        ControlFlow::Continue(())
    }
}

impl Replayed {
    /// Goes through a run again. The error says in a sentence why that cannot be.
    pub fn new(
        graph: &Graph,
        arena: &Arena,
        settings: Settings,
        recorded: Recorded,
        history: &History,
    ) -> Result<Replayed, String> {
        let mut watch = Watch {
            history,
            elite: settings.elite,
            kept: Replayed::default(),
            has_changed: false,
        };
        search_again(graph, arena, settings, recorded, &mut watch);
        match (watch.has_changed, watch.kept.generations.is_empty()) {
            (true, _) => Err(CHANGED.into()),
            // The first candidates were others, or there was no whole generation.
            (false, true) if !history.tried.is_empty() => Err(CHANGED.into()),
            (false, true) => Err("The run ended before anybody was timed.".into()),
            (false, false) => Ok(watch.kept),
        }
    }

    /// A candidate by its number.
    pub fn candidate(&self, id: u64) -> Option<&Candidate> {
        self.candidates.get(&id)
    }

    /// What a candidate's program has chosen.
    pub fn traits(&self, id: u64) -> Option<&BTreeSet<Trait>> {
        self.traits.get(&id)
    }
}

const CHANGED: &str = "The run's programs are not known: gone through again, the search makes other candidates than the \
     recorded ones, since the graph, the search or what is emitted for a program has changed.";

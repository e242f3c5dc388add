//! Strategies: who is tried next. All have as many evaluations, the same [`World`] to draw from and the same
//! judge, so that they can be compared.
//!
//! | | parents | what is made of them |
//! |---|---|---|
//! | [`Paper`](paper) | everyone alive, by fitness | order crossover and two swaps, duplicates included |
//! | [`Random`](random) | nobody | random genomes: the floor |
//! | [`Hill`](hill) | the best | its neighbours: flips and slides |
//! | [`Memetic`](memetic) | the elite and the best of every structure, by tournament | grafts, crossovers, flips and slides that are new; neighbours of the best at the end |
//! | [`Guided`](guided) | the same, of its epoch | the same twenty times over, of which a model says who is worth a timing; begins anew when stuck |
//!
//! On several [islands](crate::Settings::islands) each population has a strategy of its own. None tries what another has
//! tried, but the paper's; guided's models learn of all, and its last part tunes the best of all, as memetic's does.

mod epoch;
mod guided;
mod hill;
mod memetic;
mod niches;
mod paper;
mod random;
mod surrogate;

use std::fmt;
use std::str::FromStr;

use program::ProgramError;
use serde::{Deserialize, Serialize};

use crate::individual::Draft;
use crate::world::World;

/// Says who is tried next.
pub trait Propose {
    /// The drafts of the next generation, some at least unless nobody can be a parent or nothing new is found.
    ///
    /// # Errors
    ///
    /// [`ProgramError`] if a genome picks no program, which is the graph's fault.
    fn propose(&mut self, world: &mut World<'_>) -> Result<Vec<Draft>, ProgramError>;
}

/// A strategy by its name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Strategy {
    /// The genetic algorithm of Kensler and Shirley (2006, section 5), made exact.
    #[default]
    Paper,
    /// Random genomes, no two of the same source.
    Random,
    /// Neighbours of the best.
    Hill,
    /// A population, tournaments, moves that change the program, local search at the end.
    Memetic,
    /// The same with a model that says which drafts are worth a timing.
    Guided,
}

impl Strategy {
    /// All, the paper's first.
    pub const ALL: [Strategy; 5] = [
        Strategy::Paper,
        Strategy::Random,
        Strategy::Hill,
        Strategy::Memetic,
        Strategy::Guided,
    ];

    /// Its name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Strategy::Paper => "paper",
            Strategy::Random => "random",
            Strategy::Hill => "hill",
            Strategy::Memetic => "memetic",
            Strategy::Guided => "guided",
        }
    }

    /// Whether it can be after a front of speed and costs, and not speed alone.
    pub const fn is_for_fronts(self) -> bool {
        matches!(self, Strategy::Paper | Strategy::Random)
    }

    /// Who proposes by it, at the beginning of a search.
    pub(crate) fn proposes(self) -> Box<dyn Propose> {
        match self {
            Strategy::Paper => Box::new(paper::Paper),
            Strategy::Random => Box::new(random::Random),
            Strategy::Hill => Box::new(hill::Hill),
            Strategy::Memetic => Box::new(memetic::Memetic::default()),
            Strategy::Guided => Box::new(guided::Guided::default()),
        }
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A name that no strategy has.
#[derive(Debug, thiserror::Error)]
#[error("'{0}' is no strategy; known are paper, random, hill, memetic and guided")]
pub struct UnknownStrategy(String);

impl FromStr for Strategy {
    type Err = UnknownStrategy;

    fn from_str(name: &str) -> Result<Strategy, UnknownStrategy> {
        let found = Strategy::ALL
            .into_iter()
            .find(|strategy| strategy.name() == name);
        found.ok_or_else(|| UnknownStrategy(name.to_owned()))
    }
}

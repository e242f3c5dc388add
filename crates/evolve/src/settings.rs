//! The numbers of a search.

use serde::{Deserialize, Serialize};

use crate::selection::Objective;
use crate::strategy::Strategy;

/// Settings of a search; the default is the paper's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Settings {
    /// Who is tried next.
    #[serde(default)]
    pub strategy: Strategy,
    /// Individuals.
    pub population: usize,
    /// How many of the best survive a generation unchanged.
    pub elite: usize,
    /// Generations after the first, random one.
    pub generations: usize,
    /// Populations, which have a generation in turn: while one's is judged, the next one's is made ready.
    #[serde(default = "one")]
    pub islands: usize,
    /// What it is after.
    #[serde(default)]
    pub objective: Objective,
    /// Seed of everything random.
    pub seed: u64,
    /// The search stops when so many have been evaluated, if that comes first.
    pub limit: Option<u64>,
}

impl Default for Settings {
    /// 50 individuals, 100 generations, the 20 best kept (section 5 of the paper).
    fn default() -> Settings {
        Settings {
            strategy: Strategy::Paper,
            population: 50,
            elite: 20,
            generations: 100,
            islands: 1,
            objective: Objective::Speed,
            seed: 1,
            limit: None,
        }
    }
}

impl Settings {
    /// The usual settings for what a search is after: the paper's numbers, with the strategy that finds the
    /// fastest at equal evaluations; or, for a front, which needs more room, the paper's strategy with 100
    /// individuals, the 50 best kept and 60 generations, 50 evaluations more than the paper's.
    pub fn usual(objective: Objective) -> Settings {
        let papers = Settings::default();
        match objective {
            Objective::Speed => Settings {
                strategy: Strategy::Guided,
                ..papers
            },
            Objective::Pareto => Settings {
                population: 100,
                elite: 50,
                generations: 60,
                objective,
                ..papers
            },
        }
    }
}

fn one() -> usize {
    1
}

/// Settings that no search can be made with.
#[derive(Clone, Copy, Debug, thiserror::Error, PartialEq, Eq)]
pub enum SettingsError {
    /// Nobody to breed from.
    #[error("a population of 0 cannot breed; ask for at least 2")]
    Empty,
    /// A strategy that looks at speed alone.
    #[error("the strategy {0} is after speed alone; for a front ask for paper or random")]
    NotForAFront(Strategy),
    /// Nowhere to live.
    #[error("with 0 islands there is no population; ask for at least 1")]
    NoIslands,
    /// Nobody may be evaluated.
    #[error("with 0 evaluations there is no search; ask for at least 1")]
    NoEvaluations,
    /// No room for offspring.
    #[error(
        "an elite of {elite} leaves no room for offspring in a population of {population}; \
         make it smaller than the population"
    )]
    EliteTooLarge {
        /// The elite asked for.
        elite: usize,
        /// The population asked for.
        population: usize,
    },
    /// Offspring come in pairs.
    #[error(
        "a population of {population} with an elite of {elite} needs {} offspring, \
         but they come in pairs; make one of the two a number larger or smaller",
        population - elite
    )]
    OddOffspring {
        /// The elite asked for.
        elite: usize,
        /// The population asked for.
        population: usize,
    },
}

impl Settings {
    /// Checks the settings.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] if the population is empty, the elite is all of it, the number of
    /// offspring is odd, nobody may be evaluated, or the strategy is not for what the search is after.
    pub fn validate(self) -> Result<Settings, SettingsError> {
        let Settings {
            population, elite, ..
        } = self;
        if population == 0 {
            Err(SettingsError::Empty)
        } else if self.islands == 0 {
            Err(SettingsError::NoIslands)
        } else if self.limit == Some(0) {
            Err(SettingsError::NoEvaluations)
        } else if elite >= population {
            Err(SettingsError::EliteTooLarge { elite, population })
        } else if !(population - elite).is_multiple_of(2) {
            Err(SettingsError::OddOffspring { elite, population })
        } else if self.objective == Objective::Pareto && !self.strategy.is_for_fronts() {
            Err(SettingsError::NotForAFront(self.strategy))
        } else {
            Ok(self)
        }
    }

    /// How many individuals the whole search evaluates.
    pub fn evaluations(&self) -> u64 {
        let all = self.population + self.generations * (self.population - self.elite);
        self.limit.unwrap_or(u64::MAX).min(all as u64)
    }

    /// How many more are evaluated, once so many have been.
    pub(crate) fn evaluations_left(&self, evaluated: u64) -> usize {
        let left = self.evaluations().saturating_sub(evaluated);
        usize::try_from(left).unwrap_or(usize::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_the_papers_3050_evaluations() {
        assert_eq!(Settings::default().validate().unwrap().evaluations(), 3050);
    }

    #[test]
    fn each_contradiction_has_its_sentence() {
        let check = |population, elite| {
            let settings = Settings {
                population,
                elite,
                ..Settings::default()
            };
            settings.validate().unwrap_err().to_string()
        };
        assert!(check(0, 0).contains("population of 0"));
        assert!(check(10, 10).contains("smaller than the population"));
        assert!(check(10, 12).contains("smaller than the population"));
        assert!(check(10, 3).contains("7 offspring"));
        let nowhere = Settings {
            islands: 0,
            ..Settings::default()
        };
        assert_eq!(nowhere.validate(), Err(SettingsError::NoIslands));
        let of_front = Settings {
            strategy: Strategy::Hill,
            ..Settings::usual(Objective::Pareto)
        };
        let error = of_front.validate().unwrap_err().to_string();
        assert!(error.contains("hill") && error.contains("paper"));
        for objective in [Objective::Speed, Objective::Pareto] {
            assert!(Settings::usual(objective).validate().is_ok());
        }
    }
}

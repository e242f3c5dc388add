//! The numbers of the genetic algorithm.

use serde::{Deserialize, Serialize};

/// Validated settings of a search; the default is the paper's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Settings {
    /// Individuals.
    pub population: usize,
    /// How many of the best survive a generation unchanged.
    pub elite: usize,
    /// Generations after the first, random one.
    pub generations: usize,
    /// Seed of everything random.
    pub seed: u64,
}

impl Default for Settings {
    /// 50 individuals, 100 generations, the 20 best kept (section 5 of the paper).
    fn default() -> Settings {
        Settings {
            population: 50,
            elite: 20,
            generations: 100,
            seed: 1,
        }
    }
}

/// Settings that no search can be made with.
#[derive(Clone, Copy, Debug, thiserror::Error, PartialEq, Eq)]
pub enum SettingsError {
    /// Nobody to breed from.
    #[error("a population of 0 cannot breed; ask for at least 2")]
    Empty,
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
    /// [`SettingsError`] if the population is empty, the elite is all of it, or the number of
    /// offspring is odd.
    pub fn validate(self) -> Result<Settings, SettingsError> {
        let Settings {
            population, elite, ..
        } = self;
        if population == 0 {
            Err(SettingsError::Empty)
        } else if elite >= population {
            Err(SettingsError::EliteTooLarge { elite, population })
        } else if !(population - elite).is_multiple_of(2) {
            Err(SettingsError::OddOffspring { elite, population })
        } else {
            Ok(self)
        }
    }

    /// How many individuals the whole search evaluates.
    pub fn evaluations(&self) -> usize {
        self.population + self.generations * (self.population - self.elite)
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
    }
}

//! What is compared: a strategy, on so many islands.

use std::fmt;
use std::str::FromStr;

use evolve::{Settings, Strategy};
use serde::{Serialize, Serializer};

/// A way to search: `guided`, or `guided:2` for the same on two islands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Method {
    pub strategy: Strategy,
    pub islands: usize,
}

impl Method {
    /// A strategy on one island.
    pub const fn of(strategy: Strategy) -> Method {
        Method {
            strategy,
            islands: 1,
        }
    }

    /// How a search with these settings goes.
    pub fn in_settings(settings: &Settings) -> Method {
        Method {
            strategy: settings.strategy,
            islands: settings.islands,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.islands {
            1 => f.pad(self.strategy.name()),
            islands => f.pad(&format!("{}:{islands}", self.strategy)),
        }
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Method, String> {
        let (strategy, islands) = text.split_once(':').unwrap_or((text, "1"));
        let strategy = strategy
            .parse::<Strategy>()
            .map_err(|error| error.to_string())?;
        match islands.parse() {
            Ok(islands) if islands > 0 => Ok(Method { strategy, islands }),
            _ => Err(format!(
                "'{text}': after the colon is the number of islands, at least 1"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_method_is_a_strategy_and_perhaps_a_number_of_islands() {
        for text in ["guided", "memetic:3"] {
            assert_eq!(text.parse::<Method>().unwrap().to_string(), text);
        }
        assert_eq!(
            "paper:1".parse::<Method>().unwrap(),
            Method::of(Strategy::Paper)
        );
        for wrong in ["guided:0", "guided:", "guided:x", "guided:-1"] {
            assert!(wrong.parse::<Method>().unwrap_err().contains("islands"));
        }
        assert!("genius".parse::<Method>().unwrap_err().contains("guided"));
    }
}

//! How a run ended, as its `run.json` says, and its ranked table.

use std::path::Path;

use evolve::Settings;
use measure::{Accuracy, Calibrated, Processes};
use serde::{Deserialize, Serialize};

use crate::failure::bad_input;

/// How a run ended. Of one that was interrupted, most is not known.
#[derive(Debug, Default, Deserialize)]
pub struct Ended {
    /// Settings with the limit that held at the end.
    pub settings: Option<Settings>,
    /// The reference against a copy of itself: relative uncertainty of one evaluation.
    pub noise_floor: Option<f64>,
    /// The reference in fresh processes before the search; none of a run of before.
    pub reference: Option<Calibrated>,
    /// What became of worker processes in which it was slow.
    pub processes: Option<Processes>,
    /// Drafts that were no candidates, since their source had been tried.
    pub redrawn: Option<u64>,
    /// Sources that were not timed, since they were the same machine code as one that had been.
    pub twins: Option<u64>,
    /// How long the search took.
    pub seconds: Option<f64>,
    /// Why it ended.
    pub stopped: Option<String>,
    /// The shoot-out at the end.
    pub shootout: Option<Vec<Standing>>,
    /// If it was after a front, who met at the end.
    pub front: Option<Vec<Standing>>,
}

/// Somebody in the table at the end.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Standing {
    /// Its name.
    pub kernel: String,
    /// Its place on the front, if there is one.
    pub number: Option<usize>,
    /// The number of the candidate, in the table of a front.
    pub candidate: Option<u64>,
    /// Speed as a multiple of Möller-Trumbore's.
    pub ratio: f64,
    /// Relative uncertainty of the ratio.
    pub uncertainty: f64,
    /// The ratio on packets that no search has seen.
    pub unseen: f64,
    /// How many times as slow it is in the worst memory layout as in most; none if that was not measured.
    #[serde(default)]
    pub worst_layout: Option<f64>,
    /// Millions of tests a second.
    pub speed: f64,
    /// How accurate its `t` is; none if it failed.
    pub accuracy: Option<Accuracy>,
    /// What became of it.
    pub verdict: String,
    /// Its rank; those that are no slower than the noise share the first one's. None if it failed.
    #[serde(default)]
    pub rank: Option<usize>,
    /// Whether it shares its rank.
    #[serde(default)]
    pub is_tied: bool,
}

impl Ended {
    /// Reads it. A run that has no such file has not ended.
    pub fn read(run: &Path) -> anyhow::Result<Ended> {
        let path = run.join("run.json");
        if !path.exists() {
            return Ok(Ended::default());
        }
        let cannot =
            |error: &dyn std::fmt::Display| bad_input(format!("{}: {error}", path.display()));
        let text = std::fs::read_to_string(&path).map_err(|error| cannot(&error))?;
        serde_json::from_str(&text).map_err(|error| cannot(&error))
    }

    /// The ranked table, of the front if the run was after one.
    pub fn standings(&self) -> Option<Vec<Standing>> {
        let mut standings = self.shootout.clone().or_else(|| self.front.clone())?;
        rank(&mut standings);
        Some(standings)
    }
}

/// Ranks by speed, failures last. Whoever is not slower than the first of a rank by more than the uncertainty of the
/// two shares it.
fn rank(standings: &mut [Standing]) {
    standings.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
    let mut first: Option<(usize, usize)> = None;
    for place in 0..standings.len() {
        if standings[place].accuracy.is_none() {
            continue;
        }
        let tied = first.filter(|&(of, _)| are_tied(&standings[of], &standings[place]));
        let (of, rank) = tied.unwrap_or((place, place + 1));
        first = Some((of, rank));
        standings[place].rank = Some(rank);
        if of != place {
            standings[place].is_tied = true;
            standings[of].is_tied = true;
        }
    }
}

fn are_tied(one: &Standing, other: &Standing) -> bool {
    let uncertainty = one.uncertainty.hypot(other.uncertainty);
    (one.ratio / other.ratio).ln().abs() <= uncertainty
}

#[cfg(test)]
mod tests {
    use super::*;

    fn standing(kernel: &str, ratio: f64, failed: bool) -> Standing {
        let accuracy = serde_json::json!({"hits": 1, "median": 0.0, "p99": 0.0, "max": 0.0});
        let accuracy = if failed {
            serde_json::Value::Null
        } else {
            accuracy
        };
        serde_json::from_value(serde_json::json!({
            "kernel": kernel, "ratio": ratio, "uncertainty": 0.02, "unseen": ratio, "speed": 1.0,
            "accuracy": accuracy, "verdict": if failed { "crashed" } else { "timed" },
        }))
        .unwrap()
    }

    #[test]
    fn who_is_within_the_noise_of_the_first_shares_its_rank() {
        let mut standings = vec![
            standing("mt", 1.0, false),
            standing("broken", 0.0, true),
            standing("champion", 2.4, false),
            standing("second", 2.37, false),
            standing("third", 2.3, false),
        ];
        rank(&mut standings);
        let told: Vec<(&str, Option<usize>, bool)> = standings
            .iter()
            .map(|one| (one.kernel.as_str(), one.rank, one.is_tied))
            .collect();
        assert_eq!(
            told,
            [
                ("champion", Some(1), true),
                ("second", Some(1), true),
                ("third", Some(3), false),
                ("mt", Some(4), false),
                ("broken", None, false),
            ]
        );
    }

    #[test]
    fn a_run_that_was_interrupted_has_no_table() {
        let directory = tempfile::tempdir().unwrap();
        let ended = Ended::read(directory.path()).unwrap();
        assert!(ended.standings().is_none() && ended.stopped.is_none());
        std::fs::write(directory.path().join("run.json"), "{").unwrap();
        let error = Ended::read(directory.path()).unwrap_err().to_string();
        assert!(error.contains("run.json"), "{error}");
    }
}

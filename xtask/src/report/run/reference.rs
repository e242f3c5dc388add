//! How fast the reference was: in fresh processes, over the run, and wherever things lay in memory.

use evolve::Evaluation;
use measure::{Calibrated, Processes, Sweep, Verdict, median};
use serde::Serialize;

use super::ended::Ended;
use crate::history::History;

/// Fresh processes that are told of, at most.
const MOST_PROCESSES: usize = 256;

/// The reference of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// Millions of tests a second in fresh processes, before the search; none of runs that did not measure it.
    pub fresh: Vec<f64>,
    /// How its time depends on where things lie in memory.
    pub sweep: Sweep,
    /// Numbers of candidates, and millions of tests a second of the reference beside each, in the middle.
    pub over_run: Vec<(u64, f64)>,
    /// What became of worker processes in which it was slow; none of a run that has not ended.
    pub processes: Option<Processes>,
}

impl Reference {
    /// That of a run; none if nothing was timed.
    pub fn of(history: &History, ended: &Ended) -> Option<Reference> {
        let beside = history.sources().filter_map(|(candidate, first, _)| {
            let speed = speed_beside(first)?;
            Some((candidate.id, speed))
        });
        let over_run: Vec<(u64, f64)> = beside.collect();
        // A file may say anything; what cannot have been measured was not.
        let Calibrated { mut speeds, sweep } = ended.reference.clone().unwrap_or_default();
        if !speeds.iter().all(|speed| (1e-6..1e9).contains(speed)) {
            speeds.clear();
        }
        speeds.truncate(MOST_PROCESSES);
        let sweep = Some(sweep).filter(Sweep::is_sound).unwrap_or_default();
        (!over_run.is_empty()).then_some(Reference {
            fresh: speeds,
            sweep,
            over_run,
            processes: ended.processes,
        })
    }

    /// Its usual speed: that in fresh processes or, if that was not measured, in the run.
    pub fn usual(&self) -> f64 {
        match self.fresh.as_slice() {
            [] => median(
                &self
                    .over_run
                    .iter()
                    .map(|(_, speed)| *speed)
                    .collect::<Vec<_>>(),
            ),
            fresh => median(fresh),
        }
    }
}

/// The reference's speed beside a candidate, in the middle of its rounds; none if that was not timed.
fn speed_beside(evaluation: &Evaluation) -> Option<f64> {
    let verdict = serde_json::from_value(evaluation.details.clone()).ok()?;
    let Verdict::Timed { ratios, speeds, .. } = verdict else {
        return None;
    };
    let beside = speeds.iter().zip(&ratios);
    let beside: Vec<f64> = beside.map(|(speed, ratio)| speed / ratio).collect();
    (!beside.is_empty()).then(|| median(&beside))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::example::line;

    #[test]
    fn the_reference_is_told_by_the_candidates_beside_it() {
        let timed = |id: u64, ratios: &str, speeds: &str| {
            line(&format!(
                r#"{{"line":"new","id":{id},"generation":0,"operator":"random","source":"s{id}","fitness":1.0,
                    "uncertainty":0.0,"details":{{"verdict":"timed","ratios":{ratios},"speeds":{speeds},
                    "accuracy":{{"hits":1,"median":0.0,"p99":0.0,"max":0.0}}}}}}"#
            ))
        };
        let lines = [
            timed(0, "[2.0, 2.0, 1.0]", "[1600.0, 1500.0, 300.0]"),
            timed(1, "[]", "[]"),
            timed(2, "[0.5]", "[350.0]"),
        ];
        let reference = Reference::of(&History::of(&lines), &Ended::default()).unwrap();
        assert_eq!(reference.over_run, [(0, 750.0), (2, 700.0)]);
        assert_eq!(reference.usual(), 725.0);
        assert_eq!(
            Reference::of(&History::of(&lines[1..2]), &Ended::default()),
            None
        );
        for speeds in [vec![700.0, f64::INFINITY], vec![0.0], vec![-1.0]] {
            let ended = Ended {
                reference: Some(Calibrated {
                    speeds,
                    sweep: Sweep {
                        depths: vec![f64::NAN],
                        ..Sweep::default()
                    },
                }),
                ..Ended::default()
            };
            let nonsense = Reference::of(&History::of(&lines), &ended).unwrap();
            assert!(nonsense.fresh.is_empty() && nonsense.sweep == Sweep::default());
        }
    }
}

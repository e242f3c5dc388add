//! What became of a candidate.

use serde::{Deserialize, Serialize};

use crate::check::Accuracy;
use crate::protocol::Phase;
use crate::statistics::{Summary, summarise};

/// What became of a candidate: timed, or why not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "verdict", rename_all = "kebab-case")]
pub enum Verdict {
    /// Built, right and timed.
    Timed {
        /// Time of the reference over time of the candidate, a number a round.
        ratios: Vec<f64>,
        /// Ray-triangle tests a second, in millions, a number a round. For people: these are not
        /// comparable between batches.
        speeds: Vec<f64>,
        /// How accurate its `t` is.
        accuracy: Accuracy,
        /// How many times as slow it is in the worst memory layout as in most; none if it was not run in all.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        worst_layout: Option<f64>,
    },
    /// This machine cannot run it, so it was not even built.
    UnsupportedIsa,
    /// rustc refused it.
    BuildFailed {
        /// What rustc said first.
        message: String,
    },
    /// rustc did not finish.
    BuildTimedOut,
    /// An answer that the oracle does not allow.
    WrongAnswer {
        /// Before, during or after the timing.
        phase: Phase,
        /// Which ray of which check or packet.
        message: String,
    },
    /// All answers are allowed, but `t` is less accurate than the policy.
    Inaccurate {
        /// How accurate its `t` is.
        accuracy: Accuracy,
    },
    /// All answers are allowed, but not the same every time.
    Nondeterministic,
    /// Killed by a signal of its own making.
    Crashed {
        /// What it was doing.
        phase: Phase,
        /// The signal's number, or none if the worker exited.
        signal: Option<i32>,
    },
    /// Did not come back in time.
    TimedOut {
        /// What it was doing.
        phase: Phase,
    },
    /// The library could not be loaded.
    NotLoaded {
        /// Why.
        message: String,
    },
}

impl Verdict {
    /// The timings in three numbers; none if the kernel was not timed.
    pub fn summary(&self) -> Option<Summary> {
        match self {
            Verdict::Timed { ratios, speeds, .. } if !ratios.is_empty() => {
                Some(summarise(ratios, speeds))
            }
            _ => None,
        }
    }

    /// This verdict with the timings of a later one; a failure is final.
    #[must_use]
    pub fn pooled_with(self, later: Verdict) -> Verdict {
        match (self, later) {
            (
                Verdict::Timed {
                    mut ratios,
                    mut speeds,
                    accuracy,
                    worst_layout,
                },
                Verdict::Timed {
                    ratios: more_ratios,
                    speeds: more_speeds,
                    worst_layout: later_worst,
                    ..
                },
            ) => {
                ratios.extend(more_ratios);
                speeds.extend(more_speeds);
                Verdict::Timed {
                    ratios,
                    speeds,
                    accuracy,
                    worst_layout: less_of(worst_layout, later_worst),
                }
            }
            (Verdict::Timed { .. }, failure) => failure,
            (failure, _) => failure,
        }
    }

    /// One verdict on a program of those on its kernels for several instruction sets, timed in the
    /// same rounds: the geometric mean of ratios and of speeds, the worst accuracy; a failure is
    /// final.
    ///
    /// # Panics
    ///
    /// If there are none.
    pub fn on_average(verdicts: Vec<Verdict>) -> Verdict {
        let count = verdicts.len() as f64;
        let power = |mut numbers: Vec<f64>, power: f64| {
            for number in &mut numbers {
                *number = number.powf(power);
            }
            numbers
        };
        let product = |a: Vec<f64>, b: Vec<f64>| a.iter().zip(&b).map(|(a, b)| a * b).collect();
        let together = |one: Verdict, other: Verdict| match (one, other) {
            (
                Verdict::Timed {
                    ratios,
                    speeds,
                    accuracy,
                    worst_layout,
                },
                Verdict::Timed {
                    ratios: other_ratios,
                    speeds: other_speeds,
                    accuracy: other_accuracy,
                    worst_layout: other_worst,
                },
            ) => Verdict::Timed {
                ratios: product(ratios, other_ratios),
                speeds: product(speeds, other_speeds),
                accuracy: accuracy.or_worse(other_accuracy),
                worst_layout: worst_layout.zip(other_worst).map(|(a, b)| a.max(b)),
            },
            (Verdict::Timed { .. }, failure) | (failure, _) => failure,
        };
        match verdicts.into_iter().reduce(together).expect("a verdict") {
            Verdict::Timed {
                ratios,
                speeds,
                accuracy,
                worst_layout,
            } => Verdict::Timed {
                ratios: power(ratios, count.recip()),
                speeds: power(speeds, count.recip()),
                accuracy,
                worst_layout,
            },
            failure => failure,
        }
    }

    /// One verdict of several, of which the first one has the first round's timing, the next one
    /// the next round's, and so on in turn; a failure is final.
    ///
    /// # Panics
    ///
    /// If there are none.
    pub(crate) fn in_turn(verdicts: Vec<Verdict>) -> Verdict {
        let mut turns: Vec<(std::vec::IntoIter<f64>, std::vec::IntoIter<f64>)> = Vec::new();
        let (mut accuracy_of_all, mut worst_of_all) = (None, None);
        for verdict in verdicts {
            match verdict {
                Verdict::Timed {
                    ratios,
                    speeds,
                    accuracy,
                    worst_layout,
                } => {
                    turns.push((ratios.into_iter(), speeds.into_iter()));
                    accuracy_of_all = Some(accuracy);
                    worst_of_all = less_of(worst_of_all, worst_layout);
                }
                failure => return failure,
            }
        }
        let (mut ratios, mut speeds) = (Vec::new(), Vec::new());
        let rounds = turns.iter().map(|(ratios, _)| ratios.len()).max();
        for _ in 0..rounds.unwrap_or(0) {
            for (of_one, speeds_of_one) in &mut turns {
                ratios.extend(of_one.next());
                speeds.extend(speeds_of_one.next());
            }
        }
        Verdict::Timed {
            ratios,
            speeds,
            accuracy: accuracy_of_all.expect("at least one"),
            worst_layout: worst_of_all,
        }
    }

    /// The verdict's name in a list of failures.
    pub fn name(&self) -> &'static str {
        match self {
            Verdict::Timed { .. } => "timed",
            Verdict::UnsupportedIsa => "unsupported ISA",
            Verdict::BuildFailed { .. } => "build failed",
            Verdict::BuildTimedOut => "build timed out",
            Verdict::WrongAnswer { .. } => "wrong answer",
            Verdict::Inaccurate { .. } => "inaccurate",
            Verdict::Nondeterministic => "nondeterministic",
            Verdict::Crashed { .. } => "crashed",
            Verdict::TimedOut { .. } => "timed out",
            Verdict::NotLoaded { .. } => "not loaded",
        }
    }
}

/// The less of what two sweeps found the worst layout to cost: what is bad is so in each, and the rest is the machine's.
fn less_of(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    match (one, other) {
        (Some(one), Some(other)) => Some(one.min(other)),
        _ => one.or(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timed(ratios: &[f64]) -> Verdict {
        Verdict::Timed {
            ratios: ratios.to_vec(),
            speeds: ratios.iter().map(|ratio| ratio * 100.0).collect(),
            accuracy: Accuracy {
                hits: 1,
                median: 0.0,
                p99: 0.0,
                max: 0.0,
                mean_square: 0.0,
                tried: None,
            },
            worst_layout: None,
        }
    }

    #[test]
    fn on_average_is_the_geometric_mean_and_no_failure_is_lost() {
        let timed = |ratios: [f64; 2], p99| Verdict::Timed {
            ratios: ratios.to_vec(),
            speeds: ratios.map(|ratio| 100.0 * ratio).to_vec(),
            accuracy: Accuracy {
                hits: 1,
                median: 0.0,
                p99,
                max: 1.0,
                mean_square: 0.0,
                tried: None,
            },
            worst_layout: Some(1.0 + p99 * 1e6),
        };
        let verdicts = vec![timed([1.0, 2.0], 1e-7), timed([4.0, 8.0], 3e-7)];
        match Verdict::on_average(verdicts.clone()) {
            Verdict::Timed {
                ratios,
                speeds,
                accuracy,
                worst_layout,
            } => {
                assert_eq!((ratios, accuracy.p99), (vec![2.0, 4.0], 3e-7));
                assert_eq!(worst_layout, Some(1.3));
                assert!((speeds[0] - 200.0).abs() < 1e-9);
            }
            other => panic!("{other:?}"),
        }
        for place in 0..3 {
            let mut verdicts = verdicts.clone();
            verdicts.insert(place, Verdict::Nondeterministic);
            assert_eq!(Verdict::on_average(verdicts), Verdict::Nondeterministic);
        }
    }

    #[test]
    fn rounds_that_were_dealt_in_turn_are_gathered_in_turn() {
        let dealt = vec![timed(&[1.0, 4.0]), timed(&[2.0, 5.0]), timed(&[3.0])];
        assert_eq!(Verdict::in_turn(dealt), timed(&[1.0, 2.0, 3.0, 4.0, 5.0]));
    }

    #[test]
    fn a_layout_is_bad_that_is_so_in_every_sweep() {
        let swept = |worst| match timed(&[1.0]) {
            Verdict::Timed {
                ratios,
                speeds,
                accuracy,
                ..
            } => Verdict::Timed {
                ratios,
                speeds,
                accuracy,
                worst_layout: worst,
            },
            _ => unreachable!(),
        };
        for (sweeps, expected) in [
            ([Some(3.0), Some(1.1)], Some(1.1)),
            ([None, Some(2.0)], Some(2.0)),
            ([None, None], None),
        ] {
            let verdicts = sweeps.map(swept);
            let [one, other] = verdicts.clone();
            for verdict in [Verdict::in_turn(verdicts.to_vec()), one.pooled_with(other)] {
                let worst = match verdict {
                    Verdict::Timed { worst_layout, .. } => worst_layout,
                    _ => unreachable!(),
                };
                assert_eq!(worst, expected);
            }
        }
    }

    #[test]
    fn a_failure_on_one_core_is_the_verdict() {
        let dealt = vec![timed(&[1.0]), Verdict::Nondeterministic, timed(&[2.0])];
        assert_eq!(Verdict::in_turn(dealt), Verdict::Nondeterministic);
    }
}

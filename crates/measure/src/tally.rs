//! What a worker says of a batch, put together to verdicts.

use std::collections::BTreeMap;
use std::io;
use std::time::Duration;

use crate::check::Accuracy;
use crate::error::MeasureError;
use crate::judge::Judged;
use crate::memory_layout::Sweep;
use crate::processes::Processes;
use crate::protocol::{Counts, Event, Failure, Phase};
use crate::verdict::Verdict;

/// What a batch came to: a verdict for every kernel but those that a crash left unmeasured.
pub(crate) type Verdicts = BTreeMap<usize, Verdict>;

/// What was found of kernels beside their timings, by their numbers.
#[derive(Default)]
pub(crate) struct Found {
    /// How often they use their words.
    pub counts: BTreeMap<usize, Counts>,
    /// What the accuracy lab says.
    pub judged: BTreeMap<usize, Judged>,
    /// How their time depends on where things lie in memory.
    pub sweeps: BTreeMap<usize, Sweep>,
    /// Millions of tests a second of the reference, each with the first packet of the round; of whatever kernels were
    /// beside it.
    pub reference: Vec<(usize, f64)>,
    /// What became of processes in which the reference was slow.
    pub processes: Processes,
}

impl Found {
    /// The same, with other numbers.
    pub fn renumbered(self, number: impl Fn(usize) -> usize) -> Found {
        fn renumber<T>(
            of: BTreeMap<usize, T>,
            number: impl Fn(usize) -> usize,
        ) -> BTreeMap<usize, T> {
            let numbered = of.into_iter();
            numbered.map(|(old, found)| (number(old), found)).collect()
        }
        Found {
            counts: renumber(self.counts, &number),
            judged: renumber(self.judged, &number),
            sweeps: renumber(self.sweeps, &number),
            ..self
        }
    }

    /// Adds what was found of others.
    pub fn extend(&mut self, others: Found) {
        self.counts.extend(others.counts);
        self.judged.extend(others.judged);
        self.sweeps.extend(others.sweeps);
        self.reference.extend(others.reference);
        self.processes += others.processes;
    }
}

/// Events of one batch, put together.
#[derive(Default)]
pub(crate) struct Tally {
    doing: Option<(usize, Phase)>,
    failed: Verdicts,
    accuracy: BTreeMap<usize, Accuracy>,
    ratios: BTreeMap<usize, Vec<f64>>,
    speeds: BTreeMap<usize, Vec<f64>>,
    /// How long the timing took, all together.
    pub timed_for: Duration,
    /// What was found beside that.
    pub found: Found,
}

impl Tally {
    /// Takes note of an event.
    pub fn add(&mut self, event: Event) {
        match event {
            Event::Begin { kernel, phase } => self.doing = Some((kernel, phase)),
            Event::Failed { kernel, failure } => {
                let verdict = match failure {
                    Failure::NotLoaded(message) => Verdict::NotLoaded { message },
                    Failure::Wrong(phase, message) => Verdict::WrongAnswer { phase, message },
                    Failure::Inaccurate(accuracy) => Verdict::Inaccurate { accuracy },
                    Failure::Nondeterministic => Verdict::Nondeterministic,
                };
                self.failed.entry(kernel).or_insert(verdict);
            }
            Event::Right { kernel, accuracy } => {
                self.accuracy.insert(kernel, accuracy);
            }
            Event::Sample {
                kernel,
                packet,
                seconds,
                reference,
                tests,
            } => {
                let ratio = reference / seconds;
                let speed = tests as f64 / seconds / 1e6;
                // A clock may be too coarse for a round; what it then says is no figure.
                if [seconds, reference, ratio, speed]
                    .into_iter()
                    .all(is_figure)
                {
                    self.ratios.entry(kernel).or_default().push(ratio);
                    self.speeds.entry(kernel).or_default().push(speed);
                    self.found.reference.push((packet, speed / ratio));
                }
            }
            Event::Swept { kernel, sweep } => {
                self.found.sweeps.insert(kernel, sweep);
            }
            Event::Counted { kernel, counts } => {
                self.found.counts.insert(kernel, counts);
            }
            Event::Judged { kernel, judged } => {
                self.found.judged.insert(kernel, *judged);
            }
            Event::TimedFor(seconds) => {
                self.timed_for += Duration::try_from_secs_f64(seconds).unwrap_or_default();
            }
            Event::Done => {}
        }
    }

    /// The verdicts of a batch of so many kernels that is done, and what was found beside.
    pub fn finish(mut self, kernels: usize) -> (Verdicts, Found) {
        for kernel in 0..kernels {
            let timed = self.accuracy.get(&kernel).map(|accuracy| Verdict::Timed {
                ratios: self.ratios.remove(&kernel).unwrap_or_default(),
                speeds: self.speeds.remove(&kernel).unwrap_or_default(),
                accuracy: *accuracy,
                worst_layout: self
                    .found
                    .sweeps
                    .get(&kernel)
                    .map(Sweep::worst)
                    .filter(|worst| is_figure(*worst)),
            });
            let untold = || Verdict::NotLoaded {
                message: "the worker said nothing of it".into(),
            };
            self.failed
                .entry(kernel)
                .or_insert_with(|| timed.unwrap_or_else(untold));
        }
        (self.failed, self.found)
    }

    /// The verdicts that stand although the worker died: failures, and that of whom it was with.
    pub fn blame(self, verdict: impl Fn(Phase) -> Verdict) -> Result<Verdicts, MeasureError> {
        let Some((kernel, phase)) = self.doing else {
            let why = "the worker died before it began";
            return Err(MeasureError::Worker(io::Error::other(why)));
        };
        let mut verdicts = self.failed;
        verdicts.insert(kernel, verdict(phase));
        Ok(verdicts)
    }
}

fn is_figure(number: f64) -> bool {
    number.is_finite() && number > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(seconds: f64, reference: f64) -> Event {
        Event::Sample {
            kernel: 0,
            packet: 0,
            seconds,
            reference,
            tests: 64,
        }
    }

    fn right() -> Event {
        Event::Right {
            kernel: 0,
            accuracy: Accuracy {
                hits: 1,
                median: 0.0,
                p99: 0.0,
                max: 0.0,
                mean_square: 0.0,
                tried: None,
            },
        }
    }

    fn verdict(events: impl IntoIterator<Item = Event>) -> Verdict {
        let mut tally = Tally::default();
        events.into_iter().for_each(|event| tally.add(event));
        tally.finish(1).0.remove(&0).unwrap()
    }

    #[test]
    fn no_time_and_no_number_never_become_a_ratio() {
        let none = [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::from_bits(1)];
        let mut events = vec![right(), sample(1.0, 2.0)];
        events.extend(none.map(|seconds| sample(seconds, 1.0)));
        events.extend(none[..5].iter().map(|&reference| sample(1.0, reference)));
        match verdict(events) {
            Verdict::Timed { ratios, speeds, .. } => {
                assert_eq!(ratios, [2.0]);
                assert_eq!(speeds, [64e-6]);
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn who_has_no_figure_has_no_summary() {
        let timed = verdict([right(), sample(0.0, 0.0)]);
        assert!(matches!(timed, Verdict::Timed { .. }));
        assert_eq!(timed.summary(), None);
    }

    #[test]
    fn the_first_failure_is_the_verdict() {
        let failed = |failure| Event::Failed { kernel: 0, failure };
        let wrong = Failure::Wrong(Phase::Time, String::new());
        let verdict = verdict([right(), failed(wrong), failed(Failure::Nondeterministic)]);
        assert!(matches!(verdict, Verdict::WrongAnswer { .. }));
    }
}

//! The rounds of an evaluation, and whom newcomers race against in them.
//!
//! A newcomer is compared, round by round, with a survivor of whom every round is known, and timed
//! until it is clear who is faster: if the newcomer is not, it is out, and if it is, it will be
//! timed again among the elite. So most run a few rounds only. Each generation begins with other
//! ones, lest all be judged by the same few packets.

use std::ops::Range;

use evolve::{Batch, Evaluation, Individual, Objective};
use measure::{Deal, Lead, Look, Plan, Race, Verdict, layout_weight, median};

use super::costs::{TRAINING, costs};
use crate::shootout::training_packets;

/// Rounds of a whole evaluation, each on a packet of its own, 1.3 million tests. All candidates
/// have the same packets, since packets differ more than candidates do.
pub const ROUNDS: usize = 16;

/// Rounds between two looks at a race.
const LOOK: usize = 4;

/// What a kernel is worth at most, in parts of its speed, if its error is above a champion's: so much less that
/// no family which is just above it can hold the elite against one that is below.
const INACCURATE: f64 = 0.75;

/// Kernels that a core has to time at least to be worth a reference of its own.
const FEWEST: usize = 4;

/// How the kernels of one batch are timed.
pub struct Course {
    /// The rounds in the order in which they are run.
    order: Vec<usize>,
    race: Option<Race>,
    /// What the speed of whom newcomers race against is worth. Who leaves the race was run in no memory layouts but
    /// those of its rounds, and is taken to have no better worst one.
    rival: Option<f64>,
    /// The greatest error that a champion may have.
    limit: f64,
    /// By which rays kernels are tried, if errors and leaks are objectives of their own.
    trial: Option<Look>,
}

impl Course {
    /// The course of a generation. Where speed is not all that counts nobody is out because others are faster,
    /// so nobody races.
    pub fn of(batch: &Batch<'_>, limit: f64, objective: Objective) -> Course {
        let first = batch.generation * LOOK;
        let order: Vec<usize> = (first..first + ROUNDS)
            .map(|round| round % ROUNDS)
            .collect();
        let rival = batch.survivors.iter().rev().find_map(|survivor| {
            let known = verdict(&survivor.evaluation)?;
            let speed = known.summary()?.ratio;
            let Verdict::Timed {
                ratios,
                worst_layout,
                ..
            } = known
            else {
                return None;
            };
            let speed = speed * layout_weight(worst_layout);
            is_whole(&ratios).then(|| (by_round(&ratios), speed))
        });
        let ratios = match &rival {
            Some((by_round, _)) => Some(order.iter().map(|&round| by_round[round]).collect()),
            // Everybody is new: a first look is enough to tell who is worth more.
            None if batch.survivors.is_empty() => Some(Vec::new()),
            None => None,
        };
        let races = objective == Objective::Speed;
        Course {
            order,
            race: ratios.filter(|_| races).map(|ratios| Race {
                ratios,
                every: LOOK,
            }),
            rival: rival.filter(|_| races).map(|(_, speed)| speed),
            limit,
            trial: (!races).then_some(TRAINING),
        }
    }

    /// How to time so many newcomers and, after them, others, on so many cores at most.
    pub fn plan(&self, newcomers: usize, others: usize, cores: usize) -> Plan {
        let packets: Vec<usize> = packets().collect();
        let packets = self.order.iter().map(|&round| packets[round]);
        Plan {
            rounds: packets.map(|packet| packet..packet + 1).collect(),
            separate: false,
            race: self.race.clone(),
            racers: newcomers,
            cores: cores.min((newcomers + others) / FEWEST),
            deal: Deal::Kernels,
            noise_floor: false,
            sweep: true,
            trial: self.trial,
        }
    }

    /// The rounds of a whole evaluation.
    pub fn rounds() -> Vec<Range<usize>> {
        packets().map(|packet| packet..packet + 1).collect()
    }

    /// How the reference is timed against itself, on as many cores as candidates, to see how noisy
    /// their figures are.
    pub fn noise_plan(cores: usize) -> Plan {
        Plan {
            rounds: Course::rounds(),
            separate: false,
            race: None,
            racers: 0,
            cores,
            deal: Deal::Rounds,
            noise_floor: true,
            sweep: false,
            trial: None,
        }
    }

    /// What a newcomer's verdict is worth. If it left the race early its rounds are a few, and
    /// packets differ, so its speed is the rival's times its lead: of that, what it can hardly
    /// owe to luck.
    pub fn evaluation(&self, verdict: Verdict) -> Evaluation {
        let verdict = self.in_order(verdict);
        let lead = match (&verdict, &self.race) {
            (Verdict::Timed { ratios, .. }, Some(race)) if !is_whole(ratios) => race.lead(ratios),
            _ => None,
        };
        let weight = self.weight(&verdict);
        let evaluation = self.judged(verdict);
        match (lead, self.rival) {
            (Some(Lead { mean, error }), Some(rival)) => Evaluation {
                fitness: Some(rival * (mean - error).exp() * weight),
                uncertainty: 1.96 * error,
                ..evaluation
            },
            _ => evaluation,
        }
    }

    /// What is known of an individual with one verdict more. Of one that once left a race little
    /// is.
    pub fn pooled(&self, individual: &Individual, later: Verdict) -> Evaluation {
        let later = self.in_order(later);
        self.judged(match verdict(&individual.evaluation) {
            Some(Verdict::Timed { ratios, .. }) if !is_whole(&ratios) => later,
            Some(known) => known.pooled_with(later),
            None => later,
        })
    }

    /// What a verdict is worth: the speed as a multiple of the reference's, and of that the less the
    /// farther the error is above a champion's.
    fn judged(&self, verdict: Verdict) -> Evaluation {
        let summary = verdict.summary();
        let weight = self.weight(&verdict);
        Evaluation {
            fitness: summary.map(|summary| summary.ratio * weight),
            uncertainty: summary.map_or(0.0, |summary| summary.uncertainty),
            costs: match &verdict {
                Verdict::Timed { accuracy, .. } => accuracy.tried.map(costs).unwrap_or_default(),
                _ => Vec::new(),
            },
            code: None,
            details: serde_json::to_value(&verdict).expect("a verdict is plain data"),
        }
    }

    /// What part of its speed a kernel is worth. Whoever cannot be a champion may be a parent; but were
    /// speed all that counts the elite would soon have no others, where the fastest family is one of those. A kernel
    /// that is slow in some memory layout is worth what it has there.
    fn weight(&self, verdict: &Verdict) -> f64 {
        let Verdict::Timed {
            accuracy,
            worst_layout,
            ..
        } = verdict
        else {
            return 1.0;
        };
        let of_error = match accuracy.p99 > self.limit && self.trial.is_none() {
            true => INACCURATE * (self.limit / accuracy.p99).sqrt(),
            false => 1.0,
        };
        of_error * layout_weight(*worst_layout)
    }

    /// A verdict with the timings of a whole evaluation in the order of the rounds' numbers.
    fn in_order(&self, mut verdict: Verdict) -> Verdict {
        if let Verdict::Timed { ratios, speeds, .. } = &mut verdict
            && ratios.len() == ROUNDS
        {
            for timings in [ratios, speeds] {
                let run = timings.clone();
                for (&round, timing) in self.order.iter().zip(run) {
                    timings[round] = timing;
                }
            }
        }
        verdict
    }
}

/// The packets that candidates are timed on, spread over those of the training half: of each stretch
/// the middle one. On them kernels have 1 to 3% less than on all; on the first of each stretch, 9 to
/// 11% more.
fn packets() -> impl Iterator<Item = usize> {
    let stretch = training_packets().count() / ROUNDS;
    let middles = training_packets().skip(stretch / 2 + 1).step_by(stretch);
    middles.take(ROUNDS)
}

/// Whether these are the ratios of one or more whole evaluations.
fn is_whole(ratios: &[f64]) -> bool {
    !ratios.is_empty() && ratios.len().is_multiple_of(ROUNDS)
}

/// The middle ratio of every round of one or more whole evaluations.
fn by_round(ratios: &[f64]) -> Vec<f64> {
    let round = |round: usize| {
        let times = ratios.iter().skip(round).step_by(ROUNDS).copied();
        median(&times.collect::<Vec<f64>>())
    };
    (0..ROUNDS).map(round).collect()
}

fn verdict(evaluation: &Evaluation) -> Option<Verdict> {
    serde_json::from_value(evaluation.details.clone()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timed(ratios: Vec<f64>) -> Verdict {
        accurate(ratios, 0.0)
    }

    fn accurate(ratios: Vec<f64>, p99: f64) -> Verdict {
        let verdict = serde_json::json!({
            "verdict": "timed",
            "speeds": ratios,
            "ratios": ratios,
            "accuracy": {"hits": 1, "median": 0.0, "p99": p99, "max": 1.0},
        });
        serde_json::from_value(verdict).unwrap()
    }

    fn course(generation: usize) -> Course {
        let batch = Batch {
            generation,
            new: &[],
            again: &[],
            survivors: &[],
        };
        Course::of(&batch, 1e-6, Objective::Speed)
    }

    #[test]
    fn error_above_a_champions_is_paid_for_and_below_it_is_not() {
        let fitness = |p99| {
            let verdict = accurate(vec![2.0; ROUNDS], p99);
            course(0).evaluation(verdict).fitness.unwrap()
        };
        for (p99, expected) in [(0.0, 2.0), (1e-6, 2.0), (1.01e-6, 1.4925), (4e-6, 0.75)] {
            assert!((fitness(p99) - expected).abs() < 1e-3, "{p99}");
        }
    }

    #[test]
    fn a_bad_memory_layout_is_paid_for_and_the_usual_ones_are_not() {
        let fitness = |worst: Option<f64>| {
            let mut verdict = serde_json::to_value(timed(vec![2.0; ROUNDS])).unwrap();
            verdict["worst_layout"] = worst.into();
            let verdict = serde_json::from_value(verdict).unwrap();
            course(0).evaluation(verdict).fitness.unwrap()
        };
        for (worst, expected) in [
            (None, 2.0),
            (Some(1.0), 2.0),
            (Some(1.25), 2.0),
            (Some(2.5), 1.0),
        ] {
            assert!((fitness(worst) - expected).abs() < 1e-9, "{worst:?}");
        }
    }

    #[test]
    fn timings_of_any_generation_are_kept_in_the_order_of_the_rounds() {
        for generation in 0..7 {
            let course = course(generation);
            let run: Vec<f64> = course.order.iter().map(|&round| round as f64).collect();
            let Verdict::Timed { ratios, .. } = course.in_order(timed(run)) else {
                unreachable!()
            };
            assert!(ratios.into_iter().eq((0..ROUNDS).map(|round| round as f64)));
        }
    }

    #[test]
    fn each_generation_runs_every_round_and_begins_with_others_than_the_last() {
        for generation in 0..7 {
            let [now, next] = [generation, generation + 1].map(|number| course(number).order);
            assert!(
                now[..LOOK]
                    .iter()
                    .all(|round| !next[..LOOK].contains(round))
            );
            let mut rounds = now.clone();
            rounds.sort_unstable();
            assert!(rounds.into_iter().eq(0..ROUNDS));
        }
    }

    #[test]
    fn every_round_has_a_packet_of_its_own() {
        let mut packets: Vec<usize> = packets().collect();
        packets.dedup();
        assert_eq!(packets.len(), ROUNDS);
    }

    #[test]
    fn who_left_the_race_has_the_rivals_fitness_times_its_lead() {
        let race = Race {
            ratios: (1..=ROUNDS).map(|ratio| ratio as f64).collect(),
            every: LOOK,
        };
        let half_as_fast = race.ratios[..LOOK].iter().map(|ratio| ratio / 2.0);
        let verdict = timed(half_as_fast.collect());
        let course = Course {
            race: Some(race),
            rival: Some(1.8),
            ..course(0)
        };
        let fitness = course.evaluation(verdict).fitness.unwrap();
        assert!((fitness - 0.9).abs() < 1e-9, "{fitness}");
    }
}

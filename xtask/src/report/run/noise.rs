//! How far timings of the same kernel on the same packet are apart, and what a second look at the elite was worth.

use evolve::Evaluation;
use measure::{Verdict, median};
use serde::Serialize;

use crate::evolve::ROUNDS;
use crate::history::History;

/// Bars to either side of zero.
const BARS: i32 = 10;

/// What repeated timings say.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// How many pairs of timings there are.
    pub pairs: usize,
    /// Of how many kernels.
    pub kernels: usize,
    /// Half of the pairs are nearer than this, relative.
    pub median: f64,
    /// 95% of them are.
    pub p95: f64,
    /// A histogram of them.
    pub bars: Vec<Bar>,
    /// The fitness after all timings as a multiple of the first one, in the middle of those timed again.
    pub second_look: f64,
}

/// A bar of a histogram: the relative differences from one value to another. The outer ones have whatever is beyond.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bar {
    /// The lower end.
    pub from: f64,
    /// The upper end.
    pub to: f64,
    /// How many there are.
    pub count: usize,
}

impl Noise {
    /// That of a run; none if nothing was timed twice.
    pub fn of(history: &History) -> Option<Noise> {
        let (mut differences, mut looks, mut kernels) = (Vec::new(), Vec::new(), 0);
        for (_, first, last) in history.sources() {
            let own = differences_of(&ratios(last));
            kernels += usize::from(!own.is_empty());
            // Who left its race was worth what it could hardly owe to luck, so only whole timings are compared.
            if !own.is_empty() && ratios(first).len() == ROUNDS {
                looks.extend(
                    last.fitness
                        .zip(first.fitness)
                        .map(|(last, first)| last / first),
                );
            }
            differences.extend(own);
        }
        if differences.is_empty() {
            return None;
        }
        let mut sizes: Vec<f64> = differences.iter().map(|one| one.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let p95 = sizes[(sizes.len() - 1) * 95 / 100];
        Some(Noise {
            pairs: differences.len(),
            kernels,
            median: median(&sizes),
            p95,
            bars: histogram(&differences, width(p95)),
            second_look: match looks.as_slice() {
                [] => 1.0,
                looks => median(looks),
            },
        })
    }
}

/// The ratios of an evaluation, a number a round; none if it failed.
fn ratios(evaluation: &Evaluation) -> Vec<f64> {
    match serde_json::from_value(evaluation.details.clone()) {
        Ok(Verdict::Timed { ratios, .. }) => ratios,
        _ => Vec::new(),
    }
}

/// How far, relative, every timing of a round is from the one before. Whole evaluations follow one another, each
/// with all rounds in order.
fn differences_of(ratios: &[f64]) -> Vec<f64> {
    let pairs = ratios.iter().zip(ratios.iter().skip(ROUNDS));
    let differences = pairs.map(|(before, after)| after / before - 1.0);
    differences.filter(|one| one.is_finite()).collect()
}

/// A round width for bars, with most of what there is in them.
fn width(p95: f64) -> f64 {
    let widths = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05];
    let mut wide = widths.into_iter();
    wide.find(|width| f64::from(BARS) * width >= p95)
        .unwrap_or(0.1)
}

/// Counts values in bars of a width around zero.
pub fn histogram(values: &[f64], width: f64) -> Vec<Bar> {
    let mut bars: Vec<Bar> = (-BARS..BARS)
        .map(|bar| Bar {
            from: f64::from(bar) * width,
            to: f64::from(bar + 1) * width,
            count: 0,
        })
        .collect();
    for value in values {
        let bar = (value / width)
            .floor()
            .clamp(-f64::from(BARS), f64::from(BARS - 1));
        bars[(bar as i32 + BARS) as usize].count += 1;
    }
    bars
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::example::line;

    #[test]
    fn a_histogram_has_all_values_and_the_outer_bars_what_is_beyond() {
        let bars = histogram(&[0.0, 0.005, 0.015, -0.001, 5.0, -5.0, 0.0999], 0.01);
        assert_eq!(bars.len(), 20);
        assert_eq!(bars.iter().map(|bar| bar.count).sum::<usize>(), 7);
        assert_eq!((bars[10].count, bars[11].count, bars[9].count), (2, 1, 1));
        assert_eq!((bars[0].count, bars[19].count), (1, 2));
    }

    #[test]
    fn only_timings_of_the_same_round_are_compared() {
        let one: Vec<f64> = (0..ROUNDS).map(|round| 1.0 + round as f64).collect();
        let two: Vec<f64> = one.iter().map(|ratio| 1.1 * ratio).collect();
        assert!(differences_of(&one).is_empty());
        let differences = differences_of(&[one.clone(), two].concat());
        assert_eq!(differences.len(), ROUNDS);
        assert!(differences.iter().all(|one| (one - 0.1).abs() < 1e-9));
    }

    #[test]
    fn what_was_timed_again_says_how_noisy_it_is_and_what_luck_was_worth() {
        let timed = |kind: &str, ratios: Vec<f64>, fitness: f64| {
            line(&format!(
                r#"{{"line":"{kind}","id":0,"generation":0,"operator":"random","source":"a","fitness":{fitness},
                    "uncertainty":0.0,"details":{{"verdict":"timed","ratios":{ratios:?},"speeds":{ratios:?},
                    "accuracy":{{"hits":1,"median":0.0,"p99":0.0,"max":0.0}}}}}}"#
            ))
        };
        let once = timed("new", vec![2.0; ROUNDS], 2.0);
        assert_eq!(Noise::of(&History::of(std::slice::from_ref(&once))), None);
        let later = [vec![2.0; ROUNDS], vec![1.9; ROUNDS]].concat();
        let noise = Noise::of(&History::of(&[once, timed("again", later, 1.95)])).unwrap();
        assert_eq!((noise.pairs, noise.kernels), (ROUNDS, 1));
        assert!((noise.median - 0.05).abs() < 1e-9 && (noise.second_look - 0.975).abs() < 1e-9);
    }
}

//! What the champions of the strategies came to, and which differences are more than chance.

use std::collections::BTreeMap;

use serde::Serialize;
use statrs::statistics::Statistics;
use statrs::stats_tests::Alternative;
use statrs::stats_tests::mannwhitneyu::{MannWhitneyUMethod, mannwhitneyu};

use super::method::Method;
use super::trial::Trial;
use crate::shootout::Standing;

/// Seeds that the test's approximation needs at least.
const FEWEST: usize = 5;

/// What came of an experiment.
#[derive(Serialize)]
pub struct Comparison {
    /// Every strategy's, the best mean first.
    pub strategies: Vec<Record>,
    /// Every pair's, the better strategy first.
    pub pairs: Vec<Pair>,
    /// The relative uncertainty of a champion's ratio in the batch, the middle one.
    pub uncertainty: f64,
}

/// What the trials of a strategy came to.
#[derive(Serialize)]
pub struct Record {
    /// The strategy, and its islands.
    pub strategy: Method,
    /// Its champions' ratios on the full workload, by seed.
    pub ratios: BTreeMap<u64, f64>,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation, none of a single one.
    pub deviation: Option<f64>,
    /// Means over the trials.
    pub evaluations: f64,
    /// Candidates with the source of an earlier one, of all candidates.
    pub duplicates: f64,
    /// Drafts that were drawn again, of all drafts.
    pub redrawn: f64,
    /// Sources with the machine code of an earlier one, of all sources.
    pub twins: f64,
    /// Seconds a trial, none if no trial ran in one go.
    pub seconds: Option<f64>,
}

/// Whether one strategy's champions are faster than another's.
#[derive(Serialize)]
pub struct Pair {
    /// The one with the better mean.
    pub better: Method,
    /// The other one.
    pub worse: Method,
    /// How much better the mean is, 0.05 for 5%.
    pub gain: f64,
    /// The probability of a difference like that between equals, by Mann and Whitney's test of two sides and its
    /// normal approximation; none if there are too few to tell.
    pub p: Option<f64>,
}

/// Puts trials and the batch of their champions together.
pub fn compare(trials: &[Trial], standings: &[Standing]) -> Comparison {
    let mut strategies: Vec<Record> = Vec::new();
    for (method, of_it) in by_method(trials) {
        strategies.push(record(method, &of_it, standings));
    }
    strategies.sort_by(|a, b| b.mean.total_cmp(&a.mean));
    let mut pairs = Vec::new();
    for (place, better) in strategies.iter().enumerate() {
        for worse in &strategies[place + 1..] {
            pairs.push(pair(better, worse));
        }
    }
    let mut uncertainties: Vec<f64> = standings.iter().map(|one| one.uncertainty).collect();
    uncertainties.sort_by(f64::total_cmp);
    Comparison {
        strategies,
        pairs,
        uncertainty: uncertainties[uncertainties.len() / 2],
    }
}

/// The trials of every method, in the order in which methods come.
pub fn by_method(trials: &[Trial]) -> Vec<(Method, Vec<&Trial>)> {
    let mut methods: Vec<(Method, Vec<&Trial>)> = Vec::new();
    for trial in trials {
        let method = Method::in_settings(&trial.settings);
        match methods.iter_mut().find(|(known, _)| *known == method) {
            Some((_, of_it)) => of_it.push(trial),
            None => methods.push((method, vec![trial])),
        }
    }
    methods
}

fn record(strategy: Method, trials: &[&Trial], standings: &[Standing]) -> Record {
    let ratio = |trial: &&Trial| {
        let standing = standings.iter().find(|one| one.kernel == trial.champion);
        standing.map_or(0.0, |one| one.ratio)
    };
    let ratios: BTreeMap<u64, f64> = trials
        .iter()
        .map(|trial| (trial.settings.seed, ratio(trial)))
        .collect();
    let sum = |of: fn(&Trial) -> u64| trials.iter().map(|trial| of(trial)).sum::<u64>() as f64;
    let evaluations = sum(|trial| trial.evaluations);
    let redrawn = sum(|trial| trial.redrawn);
    let seconds: Vec<f64> = trials.iter().filter_map(|trial| trial.seconds).collect();
    Record {
        strategy,
        mean: ratios.values().mean(),
        deviation: (ratios.len() > 1).then(|| ratios.values().std_dev()),
        ratios,
        evaluations: evaluations / trials.len() as f64,
        duplicates: 1.0 - sum(|trial| trial.distinct) / evaluations,
        redrawn: redrawn / (redrawn + evaluations),
        twins: sum(|trial| trial.twins) / sum(|trial| trial.distinct),
        seconds: (!seconds.is_empty()).then(|| seconds.iter().mean()),
    }
}

fn pair(better: &Record, worse: &Record) -> Pair {
    let [a, b] = [better, worse].map(|one| one.ratios.values().copied().collect::<Vec<f64>>());
    let method = MannWhitneyUMethod::AsymptoticInclContinuityCorrection;
    let test = mannwhitneyu(&a, &b, method, Alternative::TwoSided).ok();
    let test = test.filter(|_| a.len().min(b.len()) >= FEWEST);
    Pair {
        better: better.strategy,
        worse: worse.strategy,
        gain: better.mean / worse.mean - 1.0,
        p: test.map(|(_, p)| p).filter(|p| p.is_finite()),
    }
}

impl Comparison {
    /// Prints the tables.
    pub fn print(&self) {
        println!(
            "strategy    mean ratio to MT     worst   best  evaluations  redrawn  same source  same code  seconds"
        );
        for one in &self.strategies {
            let ratios = one.ratios.values().copied();
            let deviation = one
                .deviation
                .map_or("      ".into(), |sd| format!("±{sd:5.3}"));
            let seconds = one
                .seconds
                .map_or("-".into(), |seconds| format!("{seconds:.0}"));
            println!(
                "{:10}  {:9.3}x {deviation}  {:6.2}x {:5.2}x  {:11.0}  {:6.0}%  {:10.0}%  {:8.0}%  {seconds:>7}",
                one.strategy,
                one.mean,
                ratios.clone().fold(f64::INFINITY, f64::min),
                ratios.fold(0.0, f64::max),
                one.evaluations,
                100.0 * one.redrawn,
                100.0 * one.duplicates,
                100.0 * one.twins,
            );
        }
        println!();
        println!("better      than          by  Mann-Whitney p");
        for one in &self.pairs {
            let p = one.p.map_or("too few".into(), |p| format!("{p:.4}"));
            println!(
                "{:10}  {:10}  {:4.1}%  {p}",
                one.better,
                one.worse,
                100.0 * one.gain
            );
        }
        println!();
        println!(
            "A champion's ratio is known to ±{:.1}% in the batch.",
            100.0 * self.uncertainty
        );
    }
}

#[cfg(test)]
mod tests {
    use evolve::Strategy;

    use super::*;

    fn of(strategy: Strategy, ratios: &[f64]) -> Record {
        Record {
            strategy: Method::of(strategy),
            ratios: (1..).zip(ratios.iter().copied()).collect(),
            mean: ratios.iter().mean(),
            deviation: None,
            evaluations: 1.0,
            duplicates: 0.0,
            redrawn: 0.0,
            twins: 0.0,
            seconds: None,
        }
    }

    #[test]
    fn what_never_overlaps_is_no_chance_and_what_is_shuffled_may_be() {
        let low: Vec<f64> = (0..10).map(|i| 1.0 + 0.01 * f64::from(i)).collect();
        let high: Vec<f64> = low.iter().map(|ratio| ratio + 0.5).collect();
        let apart = pair(&of(Strategy::Guided, &high), &of(Strategy::Paper, &low));
        // The least rank sum is 3.74 deviations from the middle, with half a rank for continuity.
        assert!((apart.p.unwrap() - 1.8e-4).abs() < 1e-5, "{:?}", apart.p);
        assert!((apart.gain - 0.5 / 1.045).abs() < 1e-9);
        let (odd, even): (Vec<f64>, Vec<f64>) = low.chunks(2).map(|two| (two[0], two[1])).unzip();
        let mixed = pair(&of(Strategy::Hill, &even), &of(Strategy::Paper, &odd));
        assert!(mixed.p.unwrap() > 0.5, "{:?}", mixed.p);
        assert_eq!(
            pair(
                &of(Strategy::Hill, &high[..3]),
                &of(Strategy::Paper, &low[..3])
            )
            .p,
            None
        );
    }
}

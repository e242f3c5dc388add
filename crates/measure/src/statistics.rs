//! Middles and spreads of timings.

use std::collections::BTreeMap;

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Timings of a kernel in three numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Total time of the reference over total time of the kernel, beside it, without the rounds in which
    /// the machine was busy with something else.
    pub ratio: f64,
    /// Half the width, relative to the ratio, of the interval that holds the true one with about
    /// 95% probability, were the rounds' packets drawn at random. Between kernels that were timed
    /// on the same packets it is smaller.
    pub uncertainty: f64,
    /// How many rounds there are.
    pub rounds: usize,
}

/// The share of the rounds, one in so many, that is left out at either end: rounds in which the
/// machine was busy with something else.
const EXTREMES: usize = 20;

/// How far from the middle a round may be, in robust standard deviations, and by what factor at least.
/// Packets differ by less; a reference or a kernel that had to wait for its core differs by more.
const OUTLIER: (f64, f64) = (4.0, 1.5);

/// The median absolute deviation of a normal distribution is this part of its standard deviation.
const MEDIAN_DEVIATION: f64 = 0.6745;

/// Whether each of some logarithms of ratios is near enough to their middle to be believed.
///
/// On a shared machine one round in a hundred has a core taken away for as long as the round takes; a
/// reference that waits makes the kernel beside it look ten times as fast.
fn believed(logs: &[f64]) -> Vec<bool> {
    if logs.is_empty() {
        return Vec::new();
    }
    let middle = median(logs);
    let deviations: Vec<f64> = logs.iter().map(|log| (log - middle).abs()).collect();
    let (deviations_allowed, factor) = OUTLIER;
    let spread = median(&deviations) / MEDIAN_DEVIATION;
    let limit = (deviations_allowed * spread).max(factor.ln());
    // Not a number is never believed.
    deviations
        .iter()
        .map(|&deviation| deviation <= limit)
        .collect()
}

/// The median; of an even number, the mean of the middle two.
///
/// # Panics
///
/// If there are no numbers.
pub fn median(numbers: &[f64]) -> f64 {
    let sorted = sorted(numbers);
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 {
        sorted[middle]
    } else {
        (sorted[middle - 1] + sorted[middle]) / 2.0
    }
}

/// The ratio of total times, from the ratio and the speed in every round of as many tests.
///
/// Packets differ, and a mean of ratios would favour those on which a kernel happens to shine;
/// total time is what a user waits for.
///
/// # Panics
///
/// If there are no rounds, or not as many speeds as ratios.
pub fn summarise(ratios: &[f64], speeds: &[f64]) -> Summary {
    assert!(!ratios.is_empty(), "nothing was measured");
    assert_eq!(ratios.len(), speeds.len(), "a ratio and a speed a round");
    // The time of a round, but for a factor.
    let times = speeds.iter().map(|speed| 1.0 / speed);
    let logs: Vec<f64> = ratios.iter().map(|ratio| ratio.ln()).collect();
    let rounds = ratios.iter().copied().zip(times).zip(believed(&logs));
    let mut rounds: Vec<(f64, f64)> = rounds
        .filter_map(|(round, is)| is.then_some(round))
        .collect();
    rounds.sort_by(|a, b| a.0.total_cmp(&b.0));
    let extremes = rounds.len() / EXTREMES;
    let rounds = &rounds[extremes..rounds.len() - extremes];
    let total: f64 = rounds.iter().map(|(_, time)| time).sum();
    let ratio = rounds.iter().map(|(ratio, time)| ratio * time).sum::<f64>() / total;
    let squares = rounds
        .iter()
        .map(|(each, time)| (time * (each - ratio)).powi(2));
    let error = squares.sum::<f64>().sqrt() / total;
    Summary {
        ratio,
        uncertainty: 1.96 * error / ratio,
        rounds: ratios.len(),
    }
}

/// The relative uncertainty of a ratio whose rounds were timed in groups, as by several processes: what is alike within a
/// group and differs between groups is in it, too. `groups` has the group of every round. It is NaN where there are
/// fewer than two groups.
///
/// # Panics
///
/// If there is not a speed and a group a ratio.
pub fn uncertainty_over(groups: &[usize], ratios: &[f64], speeds: &[f64]) -> f64 {
    assert!(groups.len() == ratios.len() && ratios.len() == speeds.len());
    let mut by_group: BTreeMap<usize, (Vec<f64>, Vec<f64>)> = BTreeMap::new();
    for (group, (ratio, speed)) in groups.iter().zip(ratios.iter().zip(speeds)) {
        let of_group = by_group.entry(*group).or_default();
        of_group.0.push(*ratio);
        of_group.1.push(*speed);
    }
    let of_each = by_group.values();
    let logs: Vec<f64> = of_each
        .map(|(ratios, speeds)| summarise(ratios, speeds).ratio.ln())
        .collect();
    let count = logs.len() as f64;
    let mean = logs.iter().sum::<f64>() / count;
    let squares: f64 = logs.iter().map(|log| (log - mean).powi(2)).sum();
    let error = (squares / (count - 1.0) / count).sqrt();
    error * student(logs.len().saturating_sub(1))
}

/// The 97.5% quantile of Student's distribution of so many degrees of freedom.
fn student(degrees: usize) -> f64 {
    match degrees {
        0 => f64::NAN,
        degrees => StudentsT::new(0.0, 1.0, degrees as f64)
            .expect("a number above zero")
            .inverse_cdf(0.975),
    }
}

/// How many times as slow as in most a kernel may be in its worst memory layout, and be worth all of its speed.
pub const MAX_WORST_LAYOUT: f64 = 1.25;

/// What part of its speed a kernel is worth that is so many times as slow in its worst memory layout: of one that is
/// slow in one place, a user may meet no other.
pub fn layout_weight(worst: Option<f64>) -> f64 {
    worst.map_or(1.0, |worst| (MAX_WORST_LAYOUT / worst).min(1.0))
}

/// How far a kernel is ahead of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lead {
    /// The logarithm of how many times it is as fast, on average over the rounds.
    pub mean: f64,
    /// The standard error of that; NaN if there were fewer than two rounds.
    pub error: f64,
}

impl Lead {
    /// How far a kernel with `ratios`, one a round, is ahead of one with `theirs` in the same
    /// rounds.
    ///
    /// Packets differ more than kernels do, but two kernels much less from packet to packet: so
    /// they are compared round by round.
    pub fn of(ratios: &[f64], theirs: &[f64]) -> Lead {
        let logs: Vec<f64> = (ratios.iter().zip(theirs))
            .map(|(ours, theirs)| (ours / theirs).ln())
            .collect();
        let logs = logs.iter().zip(believed(&logs));
        let logs: Vec<f64> = logs.filter_map(|(&log, is)| is.then_some(log)).collect();
        let count = logs.len() as f64;
        let mean = logs.iter().sum::<f64>() / count;
        let squares: f64 = logs.iter().map(|log| (log - mean).powi(2)).sum();
        let error = (squares / (count - 1.0) / count).sqrt();
        Lead { mean, error }
    }

    /// Whether it is clear who is faster. Of two that are equal, this is said three times in ten.
    pub(crate) fn is_clear(self) -> bool {
        // False for NaN.
        self.mean.abs() > STUDENT * self.error
    }
}

/// The 85% quantile of Student's distribution for the fewest rounds that are compared, four.
const STUDENT: f64 = 1.25;

/// The number below which a share of `numbers` lies, or the greatest if they are few. Leaves them
/// in another order.
///
/// # Panics
///
/// If there are no numbers, or `share` is not in 0..=1.
pub(crate) fn quantile(numbers: &mut [f64], share: f64) -> f64 {
    assert!((0.0..=1.0).contains(&share), "a share of the numbers");
    let rank = (share * numbers.len() as f64).ceil() as usize;
    let index = rank.clamp(1, numbers.len()) - 1;
    *numbers.select_nth_unstable_by(index, f64::total_cmp).1
}

fn sorted(numbers: &[f64]) -> Vec<f64> {
    assert!(!numbers.is_empty(), "nothing was measured");
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_between_groups_is_in_the_uncertainty_and_what_is_alike_is_not() {
        let groups = [0, 0, 1, 1, 2, 2, 3, 3];
        let speeds = [1.0; 8];
        let alike = [1.9, 2.1, 2.1, 1.9, 1.9, 2.1, 2.1, 1.9];
        assert!(uncertainty_over(&groups, &alike, &speeds) < 1e-12);
        // Each group is steady, and they are one and a few percent apart.
        let apart = [2.0, 2.0, 2.02, 2.02, 1.98, 1.98, 2.04, 2.04];
        let uncertainty = uncertainty_over(&groups, &apart, &speeds);
        // The standard error of four, times 3.182.
        assert!((uncertainty - 0.0205).abs() < 5e-4, "{uncertainty}");
        assert!(uncertainty_over(&[7; 8], &apart, &speeds).is_nan());
    }

    #[test]
    fn kernels_are_compared_round_by_round_however_the_packets_differ() {
        let theirs = [1.5, 2.0, 2.5, 3.0];
        let against = |factors: [f64; 4]| {
            let ratios = theirs.iter().zip(factors);
            Lead::of(
                &ratios.map(|(ratio, by)| ratio * by).collect::<Vec<_>>(),
                &theirs,
            )
        };
        let behind = against([0.9, 0.91, 0.89, 0.9]);
        assert!(behind.is_clear() && behind.mean < 0.0);
        let ahead = against([1.1, 1.12, 1.1, 1.11]);
        assert!(ahead.is_clear() && (ahead.mean.exp() - 1.1075).abs() < 1e-3);
        // Behind on the whole, but the rounds say anything.
        assert!(!against([0.7, 1.1, 0.9, 1.0]).is_clear());
        assert!(!against([1.0; 4]).is_clear());
    }

    #[test]
    fn a_lead_does_not_mind_a_round_in_which_somebody_had_to_wait() {
        let theirs = [1.5, 2.0, 2.5, 3.0, 2.0, 2.0];
        let ours = [1.66, 2.2, 40.0, 3.3, 2.19, 2.2];
        let lead = Lead::of(&ours, &theirs);
        assert!(lead.is_clear() && (lead.mean.exp() - 1.1).abs() < 0.01);
    }

    #[test]
    fn one_round_decides_nothing() {
        assert!(!Lead::of(&[0.1], &[1.0]).is_clear());
        assert!(!Lead::of(&[], &[]).is_clear());
    }

    #[test]
    fn the_median_does_not_mind_an_outlier() {
        assert_eq!(median(&[3.0, 1.0, 1e9]), 3.0);
        assert_eq!(median(&[1.0, 2.0]), 1.5);
    }

    #[test]
    fn the_ratio_is_that_of_total_times() {
        // One packet takes 1 s where the reference takes 4 s, another 3 s where it takes 2 s.
        let summary = summarise(&[4.0, 2.0 / 3.0], &[1.0, 1.0 / 3.0]);
        assert!((summary.ratio - 6.0 / 4.0).abs() < 1e-12);
    }

    #[test]
    fn the_ratio_does_not_mind_rounds_in_which_the_machine_was_busy() {
        let mut ratios = vec![2.0; 38];
        ratios.extend([0.01, 1e9]);
        let ratio = summarise(&ratios, &[1.0; 40]).ratio;
        assert!((ratio - 2.0).abs() < 1e-12);
    }

    /// Packets differ by as much as these in the regime where `t` shrinks.
    #[test]
    fn the_ratio_minds_every_packet_and_no_round_of_waiting() {
        let ratios = [
            1.6, 2.3, 1.5, 1.9, 3.2, 2.3, 2.9, 3.3, 2.1, 2.8, 2.3, 2.3, 1.7, 3.3,
        ];
        let speeds = [1.0; 14];
        let all = summarise(&ratios, &speeds);
        let mean = ratios.iter().sum::<f64>() / 14.0;
        assert!((all.ratio - mean).abs() < 1e-12, "{all:?}");
        let disturbed = [&ratios[..], &[12.8, 15.0]].concat();
        let disturbed = summarise(&disturbed, &[1.0; 16]);
        assert!((disturbed.ratio - mean).abs() < 1e-12, "{disturbed:?}");
    }

    #[test]
    fn uncertainty_shrinks_with_more_rounds_of_the_same_spread() {
        let uncertainty = |rounds: usize| {
            let ratios: Vec<f64> = (0..rounds).map(|i| 1.0 + (i % 10) as f64 / 10.0).collect();
            summarise(&ratios, &vec![1.0; rounds]).uncertainty
        };
        let [few, many] = [10, 1000].map(uncertainty);
        assert!(few > 5.0 * many && many > 0.0, "{few} {many}");
    }

    #[test]
    fn quantiles_are_members_of_the_sample() {
        let mut sorted: Vec<f64> = (1..=100).map(f64::from).collect();
        assert_eq!(quantile(&mut sorted, 0.99), 99.0);
        assert_eq!(quantile(&mut sorted, 0.5), 50.0);
        assert_eq!(quantile(&mut sorted, 1.0), 100.0);
        assert_eq!(quantile(&mut [7.0], 0.01), 7.0);
    }
}

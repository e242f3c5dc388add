//! Medians and spreads.

/// A sample in three numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// The median.
    pub median: f64,
    /// Half the width, relative to the median, of the interval that holds the true median with
    /// about 95% probability: from the order statistics, whatever the distribution.
    pub uncertainty: f64,
    /// How many numbers there are.
    pub count: usize,
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

/// Median and uncertainty.
///
/// # Panics
///
/// If there are no numbers.
pub fn summarise(numbers: &[f64]) -> Summary {
    let count = numbers.len();
    let sorted = sorted(numbers);
    let median = median(&sorted);
    // The rank of the median is binomial: n/2 ± 1.96·√n/2.
    let reach = 0.98 * (count as f64).sqrt();
    let low = (count as f64 / 2.0 - reach).floor().max(0.0) as usize;
    let high = count - 1 - low.min(count - 1);
    let uncertainty = (sorted[high.max(low)] - sorted[low.min(high)]) / 2.0 / median;
    Summary {
        median,
        uncertainty,
        count,
    }
}

/// The number below which a share of `numbers` lies, or the greatest if they are few.
///
/// # Panics
///
/// If there are no numbers, or `share` is not in 0..=1.
pub(crate) fn quantile(sorted: &[f64], share: f64) -> f64 {
    assert!((0.0..=1.0).contains(&share), "a share of the numbers");
    let rank = (share * sorted.len() as f64).ceil() as usize;
    sorted[rank.clamp(1, sorted.len()) - 1]
}

pub(crate) fn sorted(numbers: &[f64]) -> Vec<f64> {
    assert!(!numbers.is_empty(), "nothing was measured");
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_does_not_mind_an_outlier() {
        assert_eq!(median(&[3.0, 1.0, 1e9]), 3.0);
        assert_eq!(median(&[1.0, 2.0]), 1.5);
    }

    #[test]
    fn uncertainty_shrinks_with_more_samples_of_the_same_spread() {
        let sample = |n: usize| {
            (0..n)
                .map(|i| 1.0 + (i % 10) as f64 / 10.0)
                .collect::<Vec<_>>()
        };
        let [few, many] = [10, 1000].map(|n| summarise(&sample(n)).uncertainty);
        assert!(few > 2.0 * many && many > 0.0, "{few} {many}");
        assert_eq!(summarise(&[5.0]).uncertainty, 0.0);
    }

    #[test]
    fn quantiles_are_members_of_the_sample() {
        let sorted: Vec<f64> = (1..=100).map(f64::from).collect();
        assert_eq!(quantile(&sorted, 0.99), 99.0);
        assert_eq!(quantile(&sorted, 0.5), 50.0);
        assert_eq!(quantile(&sorted, 1.0), 100.0);
        assert_eq!(quantile(&sorted[..1], 0.01), 1.0);
    }
}

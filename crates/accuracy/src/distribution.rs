//! Quantiles of errors, in little memory, and the same in whatever order they came.

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer, Serialize};

/// Bits of the significand that a bin keeps: its upper end is less than 0.8% above its lower one.
const SIGNIFICAND_BITS: u32 = 7;

/// A set of errors that are not negative.
///
/// It counts them in bins that are 0.8% wide, so its quantiles are that much too big at most; its
/// maximum is exact. NaN counts as infinite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Distribution {
    /// How many there are, by their upper bits.
    bins: BTreeMap<u32, u64>,
    count: u64,
    max: f64,
}

/// What is published of a [`Distribution`]. A maximum of samples is no bound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Number of samples.
    pub samples: u64,
    /// Half are at most this.
    #[serde(deserialize_with = "or_infinity")]
    pub median: f64,
    /// 99% are at most this.
    #[serde(deserialize_with = "or_infinity")]
    pub p99: f64,
    /// 99.99% are at most this.
    #[serde(deserialize_with = "or_infinity")]
    pub p9999: f64,
    /// The greatest that came up.
    #[serde(deserialize_with = "or_infinity")]
    pub max: f64,
}

/// JSON has no infinity, and is written without: `null`.
fn or_infinity<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
}

impl Distribution {
    /// Adds one error.
    pub fn add(&mut self, error: f64) {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        debug_assert!(error >= 0.0, "an error of {error}");
        *self.bins.entry(bin(error)).or_default() += 1;
        self.count += 1;
        self.max = self.max.max(error);
    }

    /// Adds all of another's.
    pub fn merge(&mut self, other: &Self) {
        for (&bin, count) in &other.bins {
            *self.bins.entry(bin).or_default() += count;
        }
        self.count += other.count;
        self.max = self.max.max(other.max);
    }

    /// Number of errors.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The least bound of `share` of the errors, from 0 to 1, up to 0.8% above it. 0 if there are
    /// none.
    pub fn quantile(&self, share: f64) -> f64 {
        let rank = (share * self.count as f64).ceil().max(1.0);
        let mut below = 0;
        for (&bin, count) in &self.bins {
            below += count;
            if below as f64 >= rank {
                return upper_end(bin).min(self.max);
            }
        }
        self.max
    }

    /// The quantiles that are published; `None` if there are no errors.
    pub fn summary(&self) -> Option<Summary> {
        (self.count > 0).then(|| Summary {
            samples: self.count,
            median: self.quantile(0.5),
            p99: self.quantile(0.99),
            p9999: self.quantile(0.9999),
            max: self.max,
        })
    }
}

const SHIFT: u32 = f64::MANTISSA_DIGITS - 1 - SIGNIFICAND_BITS;

/// Rounded up, so that the upper end is what belongs to a bin, and zero has one of its own.
fn bin(error: f64) -> u32 {
    let bits = error.to_bits();
    let up = (1 << SHIFT) - 1;
    ((bits + up) >> SHIFT) as u32
}

fn upper_end(bin: u32) -> f64 {
    f64::from_bits(u64::from(bin) << SHIFT)
}

#[cfg(test)]
mod tests {
    use super::Distribution;

    #[test]
    fn quantiles_are_those_of_the_sorted_errors_to_a_bin() {
        let mut distribution = Distribution::default();
        for i in (1..=10_000).rev() {
            distribution.add(f64::from(i) * 1e-7);
        }
        for (share, exact) in [(0.5, 5000e-7), (0.99, 9900e-7), (0.9999, 9999e-7)] {
            let quantile = distribution.quantile(share);
            assert!((exact..=exact * 1.008).contains(&quantile), "{quantile}");
        }
        let summary = distribution.summary().unwrap();
        assert_eq!((summary.samples, summary.max), (10_000, 1e-3));
    }

    #[test]
    fn zeros_are_zero_and_nan_is_infinite() {
        let mut distribution = Distribution::default();
        assert_eq!(distribution.summary(), None);
        for error in [0.0, 0.0, 0.0, f64::NAN] {
            distribution.add(error);
        }
        assert_eq!(distribution.quantile(0.5), 0.0);
        assert_eq!(distribution.quantile(1.0), f64::INFINITY);
    }

    #[test]
    fn merging_is_adding() {
        let (mut all, mut parts) = (
            Distribution::default(),
            [(); 3].map(|()| Distribution::default()),
        );
        for i in 0..100 {
            all.add(f64::from(i));
            parts[i as usize % 3].add(f64::from(i));
        }
        let [mut merged, b, c] = parts;
        merged.merge(&c);
        merged.merge(&b);
        assert_eq!(merged, all);
    }
}

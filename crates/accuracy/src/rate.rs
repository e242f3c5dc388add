//! How often something happened among how many samples.

use std::iter::Sum;
use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

/// Events among samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rate {
    /// How often it happened.
    pub events: u64,
    /// How often it could have.
    pub samples: u64,
}

impl Rate {
    /// Counts one more sample.
    pub fn count(&mut self, happened: bool) {
        self.events += u64::from(happened);
        self.samples += 1;
    }

    /// Events a sample; NaN if there are no samples.
    pub fn share(self) -> f64 {
        self.events as f64 / self.samples as f64
    }

    /// What the true share is below, with a confidence of 95%, if nothing happened: `3 / N`. `None`
    /// if something did, or there are no samples.
    ///
    /// ```
    /// # use accuracy::Rate;
    /// assert_eq!(Rate { events: 0, samples: 300 }.bound_of_zero(), Some(0.01));
    /// ```
    pub fn bound_of_zero(self) -> Option<f64> {
        (self.events == 0 && self.samples > 0).then(|| 3.0 / self.samples as f64)
    }
}

impl AddAssign for Rate {
    fn add_assign(&mut self, other: Self) {
        self.events += other.events;
        self.samples += other.samples;
    }
}

impl Sum for Rate {
    fn sum<I: Iterator<Item = Self>>(rates: I) -> Self {
        rates.fold(Self::default(), |mut sum, rate| {
            sum += rate;
            sum
        })
    }
}

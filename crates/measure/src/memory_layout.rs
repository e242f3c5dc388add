//! Where what a kernel works on lies in memory, which may be worth more than how the kernel is written.
//!
//! A vector that straddles two pages, or a load from a place that ends like that of a store before it, costs as much as
//! a dozen tests. So every timing has a layout of its own, drawn from the seed of its batch (Curtsinger and Berger
//! 2013, "STABILIZER"); and kernels that last are run with the stack, packets and hits at every place of a page, one moved
//! at a time, for the worst.

use rand::{Rng, RngExt};
use scene::DEPTHS;
use serde::{Deserialize, Serialize};

use crate::placed::LINES;

/// Places in memory at which a kernel's library is loaded to be timed, where the system can load one twice.
pub(crate) const COPIES: usize = 3;

/// Where things lie in one timing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct MemoryLayout {
    /// The depth of the stack, of [`DEPTHS`].
    pub depth: usize,
    /// The line of a page at which the packets begin.
    pub rays: usize,
    /// The line at which begins what is reported of hits.
    pub hits: usize,
    /// Which copy of the code runs.
    pub code: usize,
}

impl MemoryLayout {
    /// Any one.
    pub fn random(rng: &mut impl Rng) -> MemoryLayout {
        MemoryLayout {
            depth: rng.random_range(0..DEPTHS),
            rays: rng.random_range(0..LINES),
            hits: rng.random_range(0..LINES),
            code: rng.random_range(0..COPIES),
        }
    }
}

/// Times of a kernel in the layouts of a sweep, as multiples of what most depths take.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// At evenly spaced depths of the stack down to a page, vectors on it straddling lines and pages at some.
    pub depths: Vec<f64>,
    /// With the packet at each line of a page.
    pub rays: Vec<f64>,
    /// With what is reported of hits at each line of a page.
    pub hits: Vec<f64>,
}

impl Sweep {
    /// Whether all times are numbers above zero, no more than a page has places, and there are any.
    pub fn is_sound(&self) -> bool {
        let times = || self.depths.iter().chain(&self.rays).chain(&self.hits);
        let few = self.depths.len() <= DEPTHS && self.rays.len().max(self.hits.len()) <= LINES;
        // More than a thousand times as long is no layout, but a machine that stood still.
        few && !self.depths.is_empty() && times().all(|time| (1e-3..1e3).contains(time))
    }

    /// The worst layout: how many times as slow a kernel is there as in most; NaN if there is none.
    pub fn worst(&self) -> f64 {
        let all = self.depths.iter().chain(&self.rays).chain(&self.hits);
        all.copied().fold(f64::NAN, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_layout_is_the_slowest_whatever_is_moved() {
        let sweep = Sweep {
            depths: vec![1.0, 0.9],
            rays: vec![1.1, 3.5],
            hits: vec![1.0],
        };
        assert_eq!(sweep.worst(), 3.5);
        assert!(sweep.is_sound());
        assert!(Sweep::default().worst().is_nan());
    }

    #[test]
    fn what_no_kernel_takes_is_no_sound_sweep() {
        let of = |depths: Vec<f64>| Sweep {
            depths,
            ..Sweep::default()
        };
        assert!(of(vec![1.0; DEPTHS]).is_sound());
        for depths in [
            vec![],
            vec![1.0; DEPTHS + 1],
            vec![1.0, 0.0],
            vec![-1.0],
            vec![f64::NAN],
            vec![1e300],
        ] {
            assert!(!of(depths).is_sound());
        }
    }
}

//! What fresh processes say of the reference.

use serde::{Deserialize, Serialize};

use crate::driver::Measured;
use crate::memory_layout::Sweep;
use crate::statistics::median;

/// Fresh processes that say how fast the reference is.
pub(crate) const FRESH: usize = 3;

/// The reference in fresh processes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Calibrated {
    /// Millions of tests a second, a number a process.
    pub speeds: Vec<f64>,
    /// How its time depends on where things lie in memory.
    pub sweep: Sweep,
}

impl Calibrated {
    /// Half the width, relative, of the interval that holds the speed in so many processes with about 95% probability:
    /// by how much a figure may be off because it is of these processes and no others. 0 of fewer than two.
    pub fn spread(&self, processes: usize) -> f64 {
        let count = self.speeds.len() as f64;
        if count < 2.0 {
            return 0.0;
        }
        let mean = self.speeds.iter().sum::<f64>() / count;
        let squares = self.speeds.iter().map(|speed| (speed / mean - 1.0).powi(2));
        let deviation = (squares.sum::<f64>() / (count - 1.0)).sqrt();
        1.96 * deviation / (processes.max(1) as f64).sqrt()
    }

    pub(crate) fn of(measured: Vec<Measured>) -> Calibrated {
        let speed = |one: &Measured| {
            let speeds = one.found.reference.iter().map(|(_, speed)| *speed);
            let speeds: Vec<f64> = speeds.collect();
            (!speeds.is_empty()).then(|| median(&speeds))
        };
        let speeds = measured.iter().filter_map(speed).collect();
        let mut measured = measured.into_iter();
        let mut sweeps = measured
            .by_ref()
            .filter_map(|mut one| one.found.sweeps.remove(&0));
        Calibrated {
            speeds,
            sweep: sweeps.next().unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processes_that_are_alike_have_no_spread_and_more_of_them_have_less() {
        let spread = |speeds: &[f64], processes| {
            let calibrated = Calibrated {
                speeds: speeds.to_vec(),
                sweep: Sweep::default(),
            };
            calibrated.spread(processes)
        };
        assert_eq!(spread(&[700.0, 700.0, 700.0], 2), 0.0);
        assert_eq!(spread(&[700.0], 2), 0.0);
        let one = spread(&[99.0, 100.0, 101.0], 1);
        assert!((one - 0.0196).abs() < 1e-12, "{one}");
        assert!((spread(&[99.0, 100.0, 101.0], 4) - one / 2.0).abs() < 1e-12);
    }
}

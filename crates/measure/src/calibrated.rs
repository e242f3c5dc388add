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

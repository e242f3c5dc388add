//! What fresh processes say of the reference.

use serde::{Deserialize, Serialize};

use crate::driver::Measured;
use crate::memory_layout::Sweep;
use crate::statistics::median;

/// Fresh processes that say how fast the reference is, at least.
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
    /// One of those on several instruction sets: the geometric means of speeds, and the sweep with the worst layout.
    ///
    /// # Panics
    ///
    /// If there are none.
    pub fn on_average(of_isas: Vec<Calibrated>) -> Calibrated {
        let count = of_isas.len() as f64;
        let processes = of_isas.iter().map(|one| one.speeds.len()).min();
        let speed = |process: usize| {
            let speeds = of_isas.iter().map(|one| one.speeds[process].ln());
            (speeds.sum::<f64>() / count).exp()
        };
        let speeds = (0..processes.unwrap_or(0)).map(speed).collect();
        let sweeps = of_isas.into_iter().map(|one| one.sweep);
        let worst = sweeps.max_by(|one, other| one.worst().total_cmp(&other.worst()));
        Calibrated {
            speeds,
            sweep: worst.expect("at least one"),
        }
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
    fn on_average_has_geometric_means_and_the_worst_layout() {
        let one = |speeds: [f64; 2], worst: f64| Calibrated {
            speeds: speeds.to_vec(),
            sweep: Sweep {
                depths: vec![1.0, worst],
                ..Sweep::default()
            },
        };
        let both = Calibrated::on_average(vec![one([100.0, 400.0], 1.5), one([900.0, 400.0], 1.1)]);
        assert!((both.speeds[0] - 300.0).abs() < 1e-9 && (both.speeds[1] - 400.0).abs() < 1e-9);
        assert_eq!(both.sweep.worst(), 1.5);
    }
}

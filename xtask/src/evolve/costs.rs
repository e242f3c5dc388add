//! What speed is paid for with: the error of `t` and what leaks, as numbers that a front is made of.

use accuracy::Tried;
use measure::Look;

use crate::accuracy::HELD_OUT;

/// By which rays a search tries its candidates.
pub const TRAINING: Look = Look {
    samples: 4_000,
    seed: 1,
};

/// By which rays those are tried who have come out of it: more, and others.
pub const CONFIRMING: Look = Look {
    samples: 50_000,
    seed: HELD_OUT,
};

/// Steps of an octave within which two costs count as equal. One that is lower by less is no reason to keep
/// a slower kernel; and a quantile of some ten thousand errors says no more.
const STEPS: f64 = 4.0;

/// The costs of a kernel: p99.99 of the relative error of `t`, and the share of rays that leak.
pub fn costs(tried: Tried) -> Vec<f64> {
    [tried.t_p9999, tried.leak.share()].map(in_steps).into()
}

fn in_steps(cost: f64) -> f64 {
    match cost > 0.0 {
        true => ((cost.log2() * STEPS).round() / STEPS).exp2(),
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accuracy::Rate;

    fn of(t_p9999: f64, events: u64) -> Vec<f64> {
        let samples = 1000;
        costs(Tried {
            t_p9999,
            leak: Rate { events, samples },
        })
    }

    #[test]
    fn costs_that_hardly_differ_are_equal_and_none_is_less_than_any() {
        assert_eq!(of(3.00e-7, 84), of(3.05e-7, 86));
        assert_ne!(of(3e-7, 80), of(4e-7, 80));
        assert_ne!(of(3e-7, 80), of(3e-7, 100));
        assert!(of(3e-7, 0)[1] < of(3e-7, 1)[1]);
        assert_eq!(of(0.0, 0), [0.0, 0.0]);
        assert_eq!(of(f64::INFINITY, 0)[0], f64::INFINITY);
    }
}

//! Figures of a kernel in a case, as programs read them.

use serde::Serialize;

use super::running::Running;
use crate::cases::Identity;
use crate::shootout::Standing;

/// A kernel in a case.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Of which kernel, in which case.
    #[serde(flatten)]
    pub of: Identity,
    /// Speed as a multiple of Möller-Trumbore's in the same case; none if it was not timed.
    pub ratio: Option<f64>,
    /// Relative uncertainty of the ratio.
    pub uncertainty: Option<f64>,
    /// How many times as slow it is in the worst memory layout as in most.
    pub worst_layout: Option<f64>,
    /// Millions of ray-triangle tests a second.
    pub speed: Option<f64>,
    /// Cycles that a test of one ray and one triangle takes.
    pub cycles: Option<f64>,
    /// The least that its arithmetic takes on this processor, if nothing ever waits.
    pub least_cycles: Option<f64>,
    /// llvm-mca's estimate of the cycles of a test that leaves at the first exit, if it is installed.
    pub first_exit_cycles: Option<f64>,
    /// Bytes that are kept of a triangle.
    pub bytes: usize,
    /// Millions of triangles a second that these are made of, if the kernel has records of its own.
    pub precomputation: Option<f64>,
    /// Relative error of `t`: the median,
    pub t_error_median: Option<f64>,
    /// what 99 of 100 are below,
    pub t_error_p99: Option<f64>,
    /// the greatest,
    pub t_error_max: Option<f64>,
    /// and the mean square.
    pub t_error_mean_square: Option<f64>,
    /// What became of it: `timed`, or why it is not ranked.
    pub verdict: &'static str,
}

/// The figures of a case, the fastest kernel first.
pub fn of(running: &Running<'_>) -> Vec<Figures> {
    let figures = running.standings().into_iter().map(|standing| {
        let Standing {
            kernel,
            ratio,
            uncertainty,
            worst_layout,
            speed,
            bytes,
            precomputation,
            accuracy,
            verdict,
            ..
        } = standing;
        let cycles = accuracy.and_then(|_| running.cycles(&kernel, speed));
        let if_timed = |figure| accuracy.map(|_| figure);
        Figures {
            of: running.case.identity(&kernel),
            ratio: if_timed(ratio),
            uncertainty: if_timed(uncertainty),
            worst_layout,
            speed: if_timed(speed),
            cycles: cycles.as_ref().map(|one| one.taken),
            least_cycles: cycles.map(|one| one.least),
            first_exit_cycles: running.estimate(&kernel),
            bytes,
            precomputation,
            t_error_median: accuracy.map(|one| one.median),
            t_error_p99: accuracy.map(|one| one.p99),
            t_error_max: accuracy.map(|one| one.max),
            t_error_mean_square: accuracy.map(|one| one.mean_square),
            verdict,
        }
    });
    figures.collect()
}

#[cfg(test)]
impl Figures {
    /// Those of a kernel that failed, and why.
    pub fn untimed(of: Identity, verdict: &'static str) -> Figures {
        Figures {
            of,
            ratio: None,
            uncertainty: None,
            worst_layout: None,
            speed: None,
            cycles: None,
            least_cycles: None,
            first_exit_cycles: None,
            bytes: 36,
            precomputation: None,
            t_error_median: None,
            t_error_p99: None,
            t_error_max: None,
            t_error_mean_square: None,
            verdict,
        }
    }
}

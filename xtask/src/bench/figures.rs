//! Figures of a kernel in a case, as programs read them.

use serde::Serialize;

use crate::cases::Case;
use crate::shootout::Standing;

/// A kernel in a case.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Its name.
    pub kernel: String,
    /// The instruction set.
    pub isa: String,
    /// What is tested together.
    pub grouping: String,
    /// Where the packets' rays start.
    pub origin: String,
    /// What is asked of a ray.
    pub query: String,
    /// What the kernel's arithmetic may be.
    pub numeric: String,
    /// Where the kernel is watertight.
    pub watertight: String,
    /// What becomes of `t`.
    pub regime: String,
    /// Speed as a multiple of Möller-Trumbore's in the same case; none if it was not timed.
    pub ratio: Option<f64>,
    /// Relative uncertainty of the ratio.
    pub uncertainty: Option<f64>,
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
pub fn of(case: &Case) -> Vec<Figures> {
    let standings = case.standings();
    let isa = case.arena.isas.to_string();
    let figures = standings.into_iter().map(|standing| {
        let scene = case.scene_of(&standing.kernel);
        let asked = &case.arena.scene;
        let Standing {
            kernel,
            ratio,
            uncertainty,
            speed,
            bytes,
            precomputation,
            accuracy,
            verdict,
            ..
        } = standing;
        let cycles = accuracy.and_then(|_| case.cycles(&kernel, speed));
        let first_exit_cycles = case.estimate(&kernel);
        let if_timed = |figure| accuracy.map(|_| figure);
        Figures {
            kernel,
            isa: isa.clone(),
            grouping: asked.grouping.to_string(),
            origin: asked.origin.to_string(),
            query: asked.query.to_string(),
            numeric: scene.numeric.to_string(),
            watertight: scene.watertight.to_string(),
            regime: asked.regime.to_string(),
            ratio: if_timed(ratio),
            uncertainty: if_timed(uncertainty),
            speed: if_timed(speed),
            cycles: cycles.as_ref().map(|one| one.taken),
            least_cycles: cycles.map(|one| one.least),
            first_exit_cycles,
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

/// Figures as CSV, with a line of names.
pub fn to_csv(figures: &[Figures]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for one in figures {
        writer.serialize(one)?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_has_a_line_a_kernel_below_the_names_and_leaves_empty_what_was_not_measured() {
        let figures = Figures {
            kernel: "wald".into(),
            isa: "sse2".into(),
            grouping: "packet".into(),
            origin: "general".into(),
            query: "closest".into(),
            numeric: "fast".into(),
            watertight: "none".into(),
            regime: "leaf".into(),
            ratio: Some(1.5),
            uncertainty: Some(0.01),
            speed: Some(900.0),
            cycles: None,
            least_cycles: None,
            first_exit_cycles: None,
            bytes: 40,
            precomputation: None,
            t_error_median: Some(1e-7),
            t_error_p99: Some(4e-7),
            t_error_max: Some(1e-6),
            t_error_mean_square: Some(1e-14),
            verdict: "timed",
        };
        let csv = to_csv(&[figures]).unwrap();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines.len(), 2);
        assert!(
            lines[0]
                .starts_with("kernel,isa,grouping,origin,query,numeric,watertight,regime,ratio")
        );
        assert!(
            lines[1].starts_with(
                "wald,sse2,packet,general,closest,fast,none,leaf,1.5,0.01,900.0,,,,40,,"
            )
        );
    }
}

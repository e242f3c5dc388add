//! The best so far against evaluations: a line a strategy, the middle one of the seeds, in a band from quarter to
//! quarter.

use plotters::prelude::*;

use super::method::Method;
use super::standings::by_method;
use super::trial::Trial;
use crate::plots::{COLOURS, undrawn};

/// Its size in pixels.
const SIZE: (u32, u32) = (860, 520);

/// Points of a line.
const POINTS: u32 = 120;

/// A strategy's line.
struct Line {
    method: Method,
    /// Evaluations, and the lower quarter, the middle and the upper quarter of the best so far.
    points: Vec<(f64, [f64; 3])>,
}

/// The plot of an experiment.
///
/// # Errors
///
/// If it cannot be drawn.
pub fn svg(scene: &str, trials: &[Trial]) -> anyhow::Result<String> {
    let most = trials
        .iter()
        .map(|trial| trial.evaluations)
        .max()
        .unwrap_or(1) as f64;
    let by_method = by_method(trials);
    let lines = by_method
        .iter()
        .map(|(method, of_it)| line(*method, of_it, most));
    let lines: Vec<Line> = lines.collect();
    let all = || lines.iter().flat_map(|line| &line.points);
    // What the first handful found is far below all that follows, and would squeeze it.
    let settled = all().filter(|(at, _)| *at >= most.min(20.0));
    let lowest = settled
        .map(|(_, band)| band[0])
        .fold(f64::INFINITY, f64::min);
    let highest = all().map(|(_, band)| band[2]).fold(0.0, f64::max);
    let margin = (highest - lowest).max(0.01) * 0.05;
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
    root.fill(&WHITE).map_err(undrawn)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(format!("Best so far: {scene}"), ("sans-serif", 16))
        .margin(12)
        .margin_right(24)
        .x_label_area_size(44)
        .y_label_area_size(56)
        .build_cartesian_2d(
            (10.0..most * 1.02).log_scale(),
            lowest - margin..highest + margin,
        )
        .map_err(undrawn)?;
    chart
        .configure_mesh()
        .x_desc("evaluations")
        .y_desc("speed, of Möller-Trumbore's")
        .x_label_formatter(&|at| format!("{at:.0}"))
        .y_label_formatter(&|ratio| format!("{ratio:.2}x"))
        .light_line_style(WHITE)
        .draw()
        .map_err(undrawn)?;
    for (line, colour) in lines.iter().zip(COLOURS.iter().cycle()) {
        let inside = || {
            line.points
                .iter()
                .filter(|(at, band)| *at >= 10.0 && band[1] >= lowest)
        };
        let upper = inside().map(|&(at, [_, _, high])| (at, high));
        let lower = inside()
            .rev()
            .map(|&(at, [low, _, _])| (at, low.max(lowest - margin)));
        let band: Vec<(f64, f64)> = upper.chain(lower).collect();
        chart
            .draw_series([Polygon::new(band, colour.mix(0.12))])
            .map_err(undrawn)?;
        let style = colour.stroke_width(2);
        let middle = inside().map(|&(at, [_, middle, _])| (at, middle));
        chart
            .draw_series(LineSeries::new(middle, style))
            .map_err(undrawn)?
            .label(line.method.to_string())
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .draw()
        .map_err(undrawn)?;
    root.present().map_err(undrawn)?;
    drop(chart);
    drop(root);
    Ok(text)
}

fn line(method: Method, trials: &[&Trial], most: f64) -> Line {
    let points = (0..=POINTS).map(|point| {
        let at = most.powf(f64::from(point) / f64::from(POINTS));
        let best = trials.iter().map(|trial| best_at(trial, at));
        let mut best: Vec<f64> = best.collect();
        best.sort_by(f64::total_cmp);
        let quarter = |number: usize| best[(best.len() - 1) * number / 4];
        (at, [1, 2, 3].map(quarter))
    });
    Line {
        method,
        points: points.collect(),
    }
}

/// The best of a trial after so many evaluations, 0 before the first.
fn best_at(trial: &Trial, evaluations: f64) -> f64 {
    let before = trial
        .course
        .iter()
        .take_while(|(at, _)| *at as f64 <= evaluations);
    before.last().map_or(0.0, |&(_, best)| best)
}

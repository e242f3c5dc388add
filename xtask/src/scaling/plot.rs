//! A plot of an axis.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

use super::Figure;
use super::axes::Axis;
use crate::plots::{COLOURS, undrawn};

/// Its size in pixels.
const SIZE: (u32, u32) = (760, 460);

/// A kernel's line.
struct Line<'a> {
    kernel: &'a str,
    points: Vec<(f64, f64)>,
}

/// The plot of an axis: nanoseconds a test, a line a kernel.
///
/// # Errors
///
/// If it cannot be drawn.
pub fn svg(axis: &Axis, figures: &[Figure]) -> anyhow::Result<String> {
    let of_axis = figures.iter().filter(|one| one.axis == axis.name);
    let mut lines: Vec<Line<'_>> = Vec::new();
    let mut title = String::new();
    for one in of_axis {
        title = format!("Nanoseconds a test: {}, t {}", one.isa, one.regime);
        let Some(nanoseconds) = one.nanoseconds else {
            continue;
        };
        let point = (one.at, nanoseconds);
        match lines.iter_mut().find(|line| line.kernel == one.kernel) {
            Some(line) => line.points.push(point),
            None => lines.push(Line {
                kernel: &one.kernel,
                points: vec![point],
            }),
        }
    }
    let all = || lines.iter().flat_map(|line| &line.points);
    let most = all()
        .map(|point| point.1)
        .fold(0.0, f64::max)
        .max(f64::MIN_POSITIVE);
    let ends = axis.points.iter().map(|point| point.at);
    let (first, last) = ends.fold((f64::INFINITY, 0.0_f64), |(first, last), at| {
        (first.min(at), last.max(at))
    });
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
    root.fill(&WHITE).map_err(undrawn)?;
    let nanoseconds = 0.0..most * 1.08;
    match axis.base {
        Some(base) => {
            let across = (first * 0.9..last * 1.1).log_scale().base(base);
            draw(&root, axis, &title, &lines, across, nanoseconds)?;
        }
        None => {
            let margin = (last - first).max(0.1) * 0.03;
            let across = first - margin..last + margin;
            draw(&root, axis, &title, &lines, across, nanoseconds)?;
        }
    }
    root.present().map_err(undrawn)?;
    drop(root);
    Ok(text)
}

fn draw<'a, X>(
    root: &DrawingArea<SVGBackend<'a>, Shift>,
    axis: &Axis,
    title: &str,
    lines: &[Line<'_>],
    across: X,
    upward: std::ops::Range<f64>,
) -> anyhow::Result<()>
where
    X: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(root)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .margin_right(24)
        .x_label_area_size(44)
        .y_label_area_size(52)
        .build_cartesian_2d(across, upward)
        .map_err(undrawn)?;
    chart
        .configure_mesh()
        .x_desc(axis.label)
        .x_label_formatter(&|at| axis.tick(*at))
        .y_label_formatter(&|nanoseconds| format!("{nanoseconds:.2}"))
        .light_line_style(WHITE)
        .draw()
        .map_err(undrawn)?;
    for (line, colour) in lines.iter().zip(COLOURS.iter().cycle()) {
        let style = colour.stroke_width(2);
        let points = || line.points.iter().copied();
        chart
            .draw_series(LineSeries::new(points(), style))
            .map_err(undrawn)?
            .label(line.kernel)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
        let dots = points().map(|point| Circle::new(point, 3, colour.filled()));
        chart.draw_series(dots).map_err(undrawn)?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .draw()
        .map_err(undrawn)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaling::axes::Point;

    #[test]
    fn every_kernel_that_was_timed_has_a_line_and_its_name() {
        let axis = Axis {
            name: "rays",
            label: "rays of a packet",
            base: Some(2.0),
            points: [8.0, 16.0].map(Point::nowhere).into(),
        };
        let figure = |kernel: &str, at, nanoseconds| Figure {
            axis: "rays",
            at,
            kernel: kernel.into(),
            isa: "sse2".into(),
            regime: "leaf".into(),
            nanoseconds,
            ratio: Some(1.0),
            verdict: "timed",
        };
        let figures = [
            figure("wald", 8.0, Some(1.5)),
            figure("wald", 16.0, Some(1.0)),
            figure("woop", 8.0, Some(3.0)),
            figure("woop", 16.0, Some(2.0)),
            figure("culls", 8.0, None),
        ];
        let svg = svg(&axis, &figures).unwrap();
        assert!(svg.contains("wald") && svg.contains("woop") && !svg.contains("culls"));
        assert_eq!(svg.matches("<circle").count(), 4);
        assert!(svg.contains("rays of a packet") && svg.contains("sse2, t leaf"));
    }
}

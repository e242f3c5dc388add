//! Plots of kernels along a sweep: what becomes of them as everything grows, or moves away.

use accuracy::{Sweep, SweepPoint};
use maud::{Markup, html};

use super::axis::Axis;
use super::labels::{Point, Rectangle};
use super::scatter::{frame, px};

/// A kernel along a sweep.
pub struct Line<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its classes: how it is drawn, and by which it is pointed out in all plots.
    pub class: String,
    /// What was found.
    pub points: &'a [SweepPoint],
}

/// What is plotted along a sweep.
#[derive(Clone, Copy, Debug)]
pub enum Ordinate {
    /// The 99% quantile of the relative error of `t`.
    Error,
    /// The share of wrong verdicts.
    Wrong,
}

const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 300.0;
const FRAME: Rectangle = Rectangle {
    x: 62.0,
    y: 10.0,
    width: 548.0,
    height: 240.0,
};

/// Errors beyond these are drawn at the ends.
const ERRORS: (f64, f64) = (1e-8, 10.0);

impl Ordinate {
    fn title(self, sweep: Sweep) -> &'static str {
        match (self, sweep) {
            (Ordinate::Error, Sweep::Scale) => "Error of t against scale",
            (Ordinate::Error, Sweep::Distance) => "Error of t against distance",
            (Ordinate::Wrong, Sweep::Scale) => "Wrong verdicts against scale",
            (Ordinate::Wrong, Sweep::Distance) => "Wrong verdicts against distance",
        }
    }

    fn value(self, point: &SweepPoint) -> Option<f64> {
        match self {
            Ordinate::Error => point.relative_error.map(|errors| errors.p99),
            Ordinate::Wrong => Some(point.wrong.share()),
        }
    }

    fn axis(self) -> Axis {
        let places = (FRAME.y + FRAME.height, FRAME.y);
        match self {
            Ordinate::Error => Axis::powers(10, ERRORS, 2, places),
            Ordinate::Wrong => Axis::shares(places),
        }
    }
}

/// The plot of one sweep as a figure.
pub fn figure(ordinate: Ordinate, sweep: Sweep, lines: &[Line<'_>]) -> Markup {
    let title = ordinate.title(sweep);
    let (across, upward) = (sweep_axis(sweep), ordinate.axis());
    let caption = match ordinate {
        Ordinate::Error => "99% of the hits are better. A line ends where nothing is hit any more.",
        Ordinate::Wrong => {
            "Hits that are missed and misses that are hit, half of the rays being next to sides."
        }
    };
    let label = match sweep {
        Sweep::Scale => "everything times",
        Sweep::Distance => "distance from the world's origin, in lengths of a triangle",
    };
    html! {
        figure.plot {
            figcaption { b { (title) } " " (caption) }
            div.scroll {
                svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label=(title) {
                    (frame(FRAME, &across, &upward))
                    text.axis x=(px(FRAME.x + FRAME.width / 2.0)) y=(px(HEIGHT - 8.0)) text-anchor="middle" {
                        (label)
                    }
                    @for line in lines {
                        g class={ "line " (line.class) } {
                            title { (line.name) }
                            path d=(path(line, ordinate, &across, &upward)) {}
                        }
                    }
                }
            }
        }
    }
}

/// An axis that has all points of a sweep.
fn sweep_axis(sweep: Sweep) -> Axis {
    let (base, step) = match sweep {
        Sweep::Scale => (2, 40),
        Sweep::Distance => (10, 1),
    };
    let points = sweep.points();
    let ends = (points[0], points[points.len() - 1]);
    Axis::powers(base, ends, step, (FRAME.x, FRAME.x + FRAME.width))
}

/// A line through the points, with gaps where there is no value; a point between gaps is a dot.
fn path(line: &Line<'_>, ordinate: Ordinate, across: &Axis, upward: &Axis) -> String {
    let place = |point: &SweepPoint| -> Option<Point> {
        let value = ordinate.value(point)?;
        Some((across.place(point.at), upward.place(value)))
    };
    let places: Vec<Option<Point>> = line.points.iter().map(place).collect();
    let parts = places
        .split(Option::is_none)
        .filter(|part| !part.is_empty());
    let drawn = parts.map(|part| {
        let places: Vec<String> = part
            .iter()
            .flatten()
            .map(|&(x, y)| format!("{} {}", px(x), px(y)))
            .collect();
        match places.as_slice() {
            // With round ends a line of no length is a dot.
            [alone] => format!("M{alone}h0"),
            _ => format!("M{}", places.join("L")),
        }
    });
    drawn.collect()
}

#[cfg(test)]
mod tests {
    use accuracy::{Rate, Scalar, sweeps};

    use super::*;

    fn swept(sweep: Sweep, is_blind: fn(f64) -> bool) -> Vec<SweepPoint> {
        let blind = || Scalar(|_: &scene::Ray, _: &scene::Triangle| None::<f32>);
        let mut swept = sweeps(blind, &[sweep], 64, 1).remove(0).points;
        for point in &mut swept {
            point.wrong = Rate {
                events: 1,
                samples: 2,
            };
            point.relative_error = (!is_blind(point.at)).then_some(accuracy::Summary {
                samples: 10,
                median: 1e-8,
                p99: 1e-7,
                p9999: 1e-6,
                max: 1e-6,
            });
        }
        swept
    }

    #[test]
    fn a_line_has_gaps_where_nothing_is_hit_and_dots_between_gaps() {
        let points = swept(Sweep::Distance, |at| {
            (20.0..2e4).contains(&at) && at != 1000.0
        });
        let line = Line {
            name: "woop",
            class: "k1".into(),
            points: &points,
        };
        let (across, upward) = (sweep_axis(Sweep::Distance), Ordinate::Error.axis());
        let path = path(&line, Ordinate::Error, &across, &upward);
        assert_eq!(path.matches('M').count(), 3, "{path}");
        assert_eq!(path.matches("h0").count(), 1, "{path}");
        let svg = figure(Ordinate::Error, Sweep::Distance, &[line]).into_string();
        assert!(
            svg.contains("<title>woop</title>") && svg.contains("10⁶"),
            "{svg}"
        );
    }
}

//! The best so far and the middle of every generation, as a plot.

use maud::{Markup, html};

use crate::history::course::Course;
use crate::report::axis::{Axis, Naming};
use crate::report::labels::{Point, Rectangle};
use crate::report::scatter::{frame, px};
use crate::report::text;

const WIDTH: f64 = 1100.0;
const HEIGHT: f64 = 340.0;
const FRAME: Rectangle = Rectangle {
    x: 56.0,
    y: 12.0,
    width: 1028.0,
    height: 276.0,
};

/// The plot with a sentence.
pub fn markup(course: &Course) -> Markup {
    let ends = course.best.last().copied();
    let all = course.best.iter().chain(&course.median);
    let highest = all.clone().map(|(_, fitness)| *fitness).fold(1.0, f64::max);
    let evaluations = all.map(|(at, _)| *at as f64);
    let lower = FRAME.y + FRAME.height;
    let across = Axis::logarithmic(
        evaluations,
        Naming::Decimal,
        (FRAME.x, FRAME.x + FRAME.width),
    );
    let upward = Axis::linear((0.0, 1.08 * highest), text::plain, (lower, FRAME.y));
    let place = |&(at, fitness): &(u64, f64)| (across.place(at as f64), upward.place(fitness));
    let best: Vec<Point> = course.best.iter().map(place).collect();
    let medians: Vec<Point> = course.median.iter().map(place).collect();
    let unit = upward.place(1.0);
    html! {
        p {
            @if let Some((last, fitness)) = ends {
                "After " (last) " evaluations the fittest was " b { (format!("{fitness:.2}")) } " times as fast as Möller and Trumbore's test"
                @if let Some(at) = course.reached(0.9) { "; 90% of that was there after " (at) }
                @if let Some(at) = course.reached(0.98) { ", 98% after " (at) }
                "."
            }
        }
        figure.plot {
            figcaption {
                b { "Fitness against evaluations" }
                "By what was known of each candidate in the end. "
                span.swatch.best {} " best so far  "
                span.swatch.median {} " median of those made for each generation  "
                span.swatch.unit {} " Möller and Trumbore's"
            }
            div.scroll {
                svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label="Fitness against evaluations" {
                    (frame(FRAME, &across, &upward))
                    line.unit x1=(px(FRAME.x)) x2=(px(FRAME.x + FRAME.width)) y1=(px(unit)) y2=(px(unit)) {}
                    path.course.median d=(joined(&medians)) {}
                    @for (place, (at, fitness)) in medians.iter().zip(&course.median) {
                        circle.course.median cx=(px(place.0)) cy=(px(place.1)) r="2.6" {
                            title { (at) " evaluations: median " (format!("{fitness:.2}")) }
                        }
                    }
                    path.course.best d=(stairs(&best)) {}
                    @for (place, (at, fitness)) in best.iter().zip(&course.best) {
                        circle.course.best cx=(px(place.0)) cy=(px(place.1)) r="3" {
                            title { "evaluation " (at) ": " (format!("{fitness:.2}")) }
                        }
                    }
                    text.axis x=(px(FRAME.x + FRAME.width / 2.0)) y=(px(HEIGHT - 8.0)) text-anchor="middle" { "evaluations" }
                }
            }
        }
    }
}

fn joined(points: &[Point]) -> String {
    let points: Vec<String> = points
        .iter()
        .map(|(x, y)| format!("{} {}", px(*x), px(*y)))
        .collect();
    match points.is_empty() {
        true => String::new(),
        false => format!("M{}", points.join("L")),
    }
}

/// A line that stays where it is until the next point.
fn stairs(points: &[Point]) -> String {
    let Some(((x, y), others)) = points.split_first() else {
        return String::new();
    };
    let begin = format!("M{} {}", px(*x), px(*y));
    let steps = others
        .iter()
        .map(|(x, y)| format!("H{}V{}", px(*x), px(*y)));
    begin + &steps.collect::<String>()
}

//! The reference's speed over the run and over memory layouts, as two plots.

use maud::{Markup, html};
use measure::LIMIT;

use super::super::reference::Reference;
use crate::report::axis::Axis;
use crate::report::labels::Rectangle;
use crate::report::scatter::{frame, px};

const WIDTH: f64 = 1100.0;
const HEIGHT: f64 = 260.0;
const FRAME: Rectangle = Rectangle {
    x: 56.0,
    y: 10.0,
    width: 1028.0,
    height: 200.0,
};

/// Bytes of a page, all of which the layouts are spread over.
const PAGE: f64 = 4096.0;

/// Both, with a sentence.
pub fn markup(reference: &Reference) -> Markup {
    html! {
        p { (sentence(reference)) }
        (over_run(reference))
        @if !reference.sweep.depths.is_empty() { (over_layouts(reference)) }
    }
}

fn sentence(reference: &Reference) -> Markup {
    let fresh = reference.fresh.iter().map(|speed| format!("{speed:.0}"));
    let fresh: Vec<String> = fresh.collect();
    html! {
        @if !fresh.is_empty() {
            "In " (fresh.len()) " fresh processes Möller and Trumbore's test made " b { (fresh.join(", ")) }
            " million tests a second. "
            @if !reference.sweep.depths.is_empty() {
                "In its worst memory layout it took " b { (format!("{:.2}", reference.sweep.worst())) }
                " times as long as in most. "
            }
        }
        @if let Some(processes) = reference.processes {
            "A worker in which it is slower by more than " (LIMIT) " is replaced, and its rounds are timed again: in "
            (processes.replaced) " batches it was faster then, in " (processes.slowed) " the machine had become slow."
        }
    }
}

fn over_run(reference: &Reference) -> Markup {
    let usual = reference.usual();
    let last = reference.over_run.last().map_or(1, |(id, _)| *id).max(1);
    let shares = reference.over_run.iter();
    let shares: Vec<(u64, f64)> = shares.map(|(id, speed)| (*id, speed / usual)).collect();
    let highest = shares.iter().map(|(_, share)| *share).fold(1.25, f64::max);
    let (across, upward) = (
        Axis::linear(
            (0.0, last as f64),
            |id| format!("{id:.0}"),
            (FRAME.x, FRAME.x + FRAME.width),
        ),
        upward((0.0, 1.05 * highest)),
    );
    let unit = upward.place(1.0);
    html! {
        figure.plot {
            figcaption {
                b { "The reference over the run" }
                "Its speed beside each candidate, as a multiple of that in fresh processes. Packets differ by a fifth."
            }
            div.scroll {
                svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label="Speed of the reference over the run" {
                    (frame(FRAME, &across, &upward))
                    line.unit x1=(px(FRAME.x)) x2=(px(FRAME.x + FRAME.width)) y1=(px(unit)) y2=(px(unit)) {}
                    @for (id, share) in &shares {
                        circle.course.median cx=(px(across.place(*id as f64))) cy=(px(upward.place(*share))) r="2" {
                            title { "candidate " (id) ": " (format!("{share:.2}")) }
                        }
                    }
                    text.axis x=(px(FRAME.x + FRAME.width / 2.0)) y=(px(HEIGHT - 8.0)) text-anchor="middle" { "candidate" }
                }
            }
        }
    }
}

fn over_layouts(reference: &Reference) -> Markup {
    let sweep = &reference.sweep;
    let highest = sweep.worst().max(1.25);
    let across = Axis::linear(
        (0.0, PAGE),
        |bytes| format!("{bytes:.0}"),
        (FRAME.x, FRAME.x + FRAME.width),
    );
    let upward = upward((0.0, 1.05 * highest));
    let line = |times: &[f64]| {
        let step = PAGE / times.len().max(1) as f64;
        let points: Vec<String> = times
            .iter()
            .enumerate()
            .map(|(place, time)| {
                let (x, y) = (
                    across.place(place as f64 * step),
                    upward.place(time.min(highest)),
                );
                format!("{} {}", px(x), px(y))
            })
            .collect();
        format!("M{}", points.join("L"))
    };
    html! {
        figure.plot {
            figcaption {
                b { "The reference over memory layouts" }
                "Its time, as a multiple of the median: "
                span.swatch.best {} " by the depth of the stack  "
                span.swatch.median {} " by where in a page the packet begins"
            }
            div.scroll {
                svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label="Time of the reference over memory layouts" {
                    (frame(FRAME, &across, &upward))
                    path.course.median d=(line(&sweep.rays)) {}
                    path.course.best d=(line(&sweep.depths)) {}
                    text.axis x=(px(FRAME.x + FRAME.width / 2.0)) y=(px(HEIGHT - 8.0)) text-anchor="middle" { "bytes" }
                }
            }
        }
    }
}

fn upward(values: (f64, f64)) -> Axis {
    Axis::linear(
        values,
        |share| format!("{share:.2}"),
        (FRAME.y + FRAME.height, FRAME.y),
    )
}

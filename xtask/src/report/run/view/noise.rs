//! How far repeated timings are apart, as a histogram.

use maud::{Markup, html};

use super::super::noise::Noise;
use crate::report::axis::Axis;
use crate::report::labels::Rectangle;
use crate::report::scatter::{frame, px};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 280.0;
const FRAME: Rectangle = Rectangle {
    x: 56.0,
    y: 10.0,
    width: 676.0,
    height: 220.0,
};

/// What the run itself found of it before it began.
pub fn floor(floor: f64) -> Markup {
    html! {
        p { "Before the search, a copy of Möller and Trumbore's test was timed against itself: 1.00 ± " (percent(floor)) "." }
    }
}

/// The histogram with a sentence.
pub fn markup(noise: &Noise) -> Markup {
    let lower = FRAME.y + FRAME.height;
    let most = noise
        .bars
        .iter()
        .map(|bar| bar.count)
        .max()
        .unwrap_or(0)
        .max(1) as f64;
    let (first, last) = match noise.bars.as_slice() {
        [first, .., last] => (first.from, last.to),
        _ => (-1.0, 1.0),
    };
    let wide = noise.bars.first().map_or(0.0, |bar| bar.to - bar.from);
    let digits = if wide < 0.01 { 1 } else { 0 };
    let name = |value: f64| match (1000.0 * value).round() {
        0.0 => "0".to_owned(),
        _ => format!("{:+.digits$}%", 100.0 * value).replace('-', "−"),
    };
    let across = Axis::linear((first, last), name, (FRAME.x, FRAME.x + FRAME.width));
    let upward = Axis::linear(
        (0.0, 1.05 * most),
        |count| format!("{count:.0}"),
        (lower, FRAME.y),
    );
    html! {
        p {
            (noise.kernels) " kernels were timed more than once. Of " (noise.pairs) " pairs of a timing and the next one of the same kernel on \
             the same packet, half are within " b { (percent(noise.median)) } " of each other, and 95% within "
            b { (percent(noise.p95)) } ". A whole evaluation has 16 packets, so its mean is four times as steady. "
            "In the middle, a first look's fitness was worth " b { (change(noise.second_look)) } " after all timings."
        }
        figure.plot.narrow {
            figcaption { b { "A timing against the one before" } "Same kernel, same packet. The outer bars have all that is beyond." }
            div.scroll {
                svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label="Histogram of repeated timings" {
                    (frame(FRAME, &across, &upward))
                    @for bar in &noise.bars {
                        @let (left, right) = (across.place(bar.from), across.place(bar.to));
                        @let top = upward.place(bar.count as f64);
                        rect.bin x=(px(left + 0.5)) y=(px(top)) width=(px(right - left - 1.0)) height=(px(lower - top)) {
                            title { (name(bar.from)) " to " (name(bar.to)) ": " (bar.count) }
                        }
                    }
                    text.axis x=(px(FRAME.x + FRAME.width / 2.0)) y=(px(HEIGHT - 8.0)) text-anchor="middle" {
                        "difference of the ratio to Möller and Trumbore's"
                    }
                }
            }
        }
    }
}

fn percent(share: f64) -> String {
    format!("{:.1}%", 100.0 * share)
}

fn change(ratio: f64) -> String {
    match 100.0 * (ratio - 1.0) {
        less if less <= -0.05 => format!("{:.1}% less", -less),
        more if more >= 0.05 => format!("{more:.1}% more"),
        _ => "the same".into(),
    }
}

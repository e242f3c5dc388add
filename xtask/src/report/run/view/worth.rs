//! What each choice of the champion is worth, as bars around the champion's speed.

use maud::{Markup, html};

use super::super::worth::{Flip, Worth};
use super::differences;
use crate::report::axis::Axis;
use crate::report::scatter::px;

/// Changes of a flip that are shown at once.
const SHOWN: usize = 2;

const WIDTH: f64 = 220.0;
const HEIGHT: f64 = 16.0;

/// Bars end here at most, relative to the champion, and have room to here at least.
const LONGEST: f64 = 0.6;
const SHORTEST: f64 = 0.03;

/// The bars with a sentence. `elsewhere` says in what this machine is not the run's; `of_front`, that speed was not all
/// that the run was after.
pub fn markup(worth: &Worth, elsewhere: Option<&str>, of_front: bool) -> Markup {
    let of = |is: fn(&Flip) -> bool| -> Vec<&Flip> {
        worth.flips.iter().filter(|one| is(one)).collect()
    };
    let speed = |flip: &Flip| flip.speed.map_or(1.0, |(speed, _)| speed);
    let slower = of(|flip| flip.is_clear() && flip.speed.is_some_and(|(speed, _)| speed < 1.0));
    let mut faster = of(|flip| flip.is_clear() && flip.speed.is_some_and(|(speed, _)| speed > 1.0));
    faster.reverse();
    let level = of(|flip| flip.speed.is_some() && !flip.is_clear());
    let failed = of(|flip| flip.speed.is_none());
    let clear = slower.iter().chain(&faster).map(|flip| speed(flip) - 1.0);
    let ends = clear.fold((-SHORTEST, SHORTEST), |(least, greatest), value| {
        (value.clamp(-LONGEST, least), value.clamp(greatest, LONGEST))
    });
    let ends = (1.05 * ends.0, 1.05 * ends.1);
    html! {
        p {
            "One choice at a time is made otherwise, and what depends on it follows. " (worth.flips.len()) " such programs were timed in turn \
             with the champion, on the same packets: " b { (slower.len()) } " are slower, " b { (faster.len()) } " faster, and of "
            b { (level.len()) } " no difference is seen. Of " (worth.choices) " choices, " (worth.bound)
            " change nothing by themselves: what they would have is there for another's sake."
            @if of_front { " The run was after error and leaks as well; here speed alone is looked at." }
        }
        @if let Some(elsewhere) = elsewhere { p.warning { "Timed here, not where the run was made: " (elsewhere) "." } }
        @if !faster.is_empty() {
            p.soft {
                "Of so many programs some look faster by luck: one in forty of equal ones does. Whether one is would have to be \
                 seen on the full workload."
            }
        }
        (table("Slower than the champion", &slower, ends))
        (table("Faster than the champion", &faster, ends))
        @if !level.is_empty() {
            details {
                summary { b { (level.len()) " without a difference" } ": within the uncertainty, 95%" }
                (table("", &level, ends))
            }
        }
        @if !failed.is_empty() {
            details {
                summary { b { (failed.len()) " without a figure" } ": they are no kernels that the search would let live" }
                (table("", &failed, ends))
            }
        }
    }
}

fn table(title: &str, flips: &[&Flip], ends: (f64, f64)) -> Markup {
    html! {
        @if !flips.is_empty() {
            div.scroll {
                table.worth {
                    @if !title.is_empty() { caption { b { (title) } } }
                    thead {
                        tr {
                            th.text scope="col" { "choice, and what it was flipped to" }
                            th scope="col" { "speed" }
                            th scope="col" { "±" }
                            th.text scope="col" { "against the champion, whiskers 95%" }
                            th.text scope="col" { "what changed" }
                        }
                    }
                    tbody { @for flip in flips { (row(flip, ends)) } }
                }
            }
        }
    }
}

fn row(flip: &Flip, ends: (f64, f64)) -> Markup {
    let [own, other] = &flip.options;
    html! {
        tr {
            th scope="row" { (flip.choice) div.soft { (own) " → " (other) } }
            @if let Some((speed, uncertainty)) = flip.speed {
                td { (format!("{:+.1}%", 100.0 * (speed - 1.0)).replace('-', "−")) }
                td.soft { (format!("{:.1}", 100.0 * uncertainty * speed)) }
                td.text { (bar(speed, uncertainty, ends)) }
            } @else {
                td colspan="3" { (flip.verdict) }
            }
            td.text.what {
                @if flip.changes.is_empty() { span.soft { "the order of statements" } } @else { (differences(&flip.changes, SHOWN)) }
            }
        }
    }
}

fn bar(speed: f64, uncertainty: f64, ends: (f64, f64)) -> Markup {
    let axis = Axis::linear(ends, |_| String::new(), (2.0, WIDTH - 2.0));
    let [zero, end] = [0.0, speed - 1.0].map(|at| axis.place(at));
    let whiskers = [-uncertainty, uncertainty].map(|by| axis.place(speed * by.exp() - 1.0));
    let middle = HEIGHT / 2.0;
    html! {
        svg.versus viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label=(format!("{speed:.3}")) {
            rect.slower[speed < 1.0].faster[speed >= 1.0] x=(px(zero.min(end))) y="3" width=(px((end - zero).abs())) height=(px(HEIGHT - 6.0)) {}
            line.zero x1=(px(zero)) x2=(px(zero)) y1="0" y2=(px(HEIGHT)) {}
            path.whisker d={ "M" (px(whiskers[0])) " " (px(middle)) "H" (px(whiskers[1])) } {}
        }
    }
}

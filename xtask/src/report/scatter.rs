//! A plot of kernels by time and by something else that is to be small, with those that are beaten in neither.

use evolve::pareto;
use maud::{Markup, html};

use super::axis::{Axis, Naming};
use super::labels::{self, Placed, Point, Rectangle, Wanted};
use super::text;
use crate::cases::Role;

/// What is plotted against time.
pub struct Plot<'a> {
    /// What it is, for the heading.
    pub title: &'a str,
    /// What it means, in a sentence.
    pub caption: &'a str,
    /// How its values are named.
    pub naming: Naming,
    /// The kernels.
    pub marks: Vec<Mark<'a>>,
}

/// A kernel.
pub struct Mark<'a> {
    /// Its name.
    pub name: &'a str,
    /// The name of its class, by which it is pointed out in all plots.
    pub class: String,
    /// What it takes part as.
    pub role: Role,
    /// Nanoseconds a test.
    pub nanoseconds: f64,
    /// The other value.
    pub value: Value,
}

/// A value that is to be small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// It was seen.
    Seen(f64),
    /// Nothing was seen, and it is below this with a confidence of 95%.
    Below(f64),
}

impl Value {
    /// Where it is drawn.
    fn drawn(self) -> f64 {
        match self {
            Value::Seen(value) | Value::Below(value) => value,
        }
    }

    /// What it is compared by.
    fn compared(self) -> f64 {
        match self {
            Value::Seen(value) => value,
            Value::Below(_) => 0.0,
        }
    }
}

/// The plot's size, and where its frame is.
const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 400.0;
const FRAME: Rectangle = Rectangle {
    x: 62.0,
    y: 10.0,
    width: 548.0,
    height: 340.0,
};

/// A label's height, the width of a character of its, and what is free between two in a line.
const LABEL: f64 = 13.0;
const CHARACTER: f64 = 6.35;
const BETWEEN: f64 = 6.0;

/// How much more it matters that the labels of kernels that were bred here are near them.
const OURS: f64 = 8.0;

/// Characters that a label may have.
const LONGEST: usize = 36;

/// The plot as a figure.
pub fn figure(plot: &Plot<'_>) -> Markup {
    let nanoseconds = plot.marks.iter().map(|mark| mark.nanoseconds);
    let values = plot.marks.iter().map(|mark| mark.value.drawn());
    let right = FRAME.x + FRAME.width;
    let lower = FRAME.y + FRAME.height;
    let across = Axis::logarithmic(nanoseconds, Naming::Decimal, (FRAME.x, right));
    let upward = Axis::logarithmic(values, plot.naming, (lower, FRAME.y));
    let place = |mark: &Mark<'_>| -> Point {
        (
            across.place(mark.nanoseconds),
            upward.place(mark.value.drawn()),
        )
    };
    let places: Vec<Point> = plot.marks.iter().map(place).collect();
    let names = plot.marks.iter().map(|mark| short(mark.name));
    let names: Vec<String> = names.collect();
    let wanted = plot.marks.iter().zip(&names).zip(&places);
    let wanted: Vec<Wanted> = wanted
        .map(|((mark, name), &place)| Wanted {
            mark: place,
            width: CHARACTER * name.chars().count() as f64 + BETWEEN,
            weight: if mark.role == Role::Rival { 1.0 } else { OURS },
        })
        .collect();
    let placed = labels::place(&wanted, LABEL, FRAME);
    let front = front(&plot.marks);
    html! {
        figure.plot {
            figcaption { b { (plot.title) } " " (plot.caption) }
            div.scroll {
                svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label=(plot.title) {
                    (frame(FRAME, &across, &upward))
                    text.axis x=(px(FRAME.x + FRAME.width / 2.0)) y=(px(HEIGHT - 8.0)) text-anchor="middle" {
                        "nanoseconds a test"
                    }
                    path.front d=(staircase(&front, &places)) {}
                    @for label in &placed { (leader(label)) }
                    @for (number, mark) in plot.marks.iter().enumerate() {
                        g class={ "mark " (role_class(mark.role)) " " (fill(front.contains(&number))) " " (mark.class) } {
                            title { (description(plot, mark)) }
                            (drawn(mark, places[number]))
                            (label(&names[number], &placed[number]))
                        }
                    }
                }
            }
        }
    }
}

/// The numbers of those that are beaten in neither, the fastest first.
fn front(marks: &[Mark<'_>]) -> Vec<usize> {
    let points = marks
        .iter()
        .map(|mark| vec![mark.nanoseconds, mark.value.compared()]);
    let mut front = pareto::front(&points.collect::<Vec<_>>());
    front.sort_by(|&a, &b| marks[a].nanoseconds.total_cmp(&marks[b].nanoseconds));
    front
}

/// The line that nobody is below: from the upper end by way of the front to the right end.
fn staircase(front: &[usize], places: &[Point]) -> String {
    let Some(&first) = front.first() else {
        return String::new();
    };
    let mut path = format!("M{} {}", px(places[first].0), px(FRAME.y));
    for &number in front {
        let (x, y) = places[number];
        path += &format!("H{}V{}", px(x), px(y));
    }
    path + &format!("H{}", px(FRAME.x + FRAME.width))
}

/// The frame, with lines and names for what is named on the axes.
pub fn frame(frame: Rectangle, across: &Axis, upward: &Axis) -> Markup {
    let (right, lower) = (frame.x + frame.width, frame.y + frame.height);
    html! {
        @for (value, name) in &upward.ticks {
            @let y = upward.place(*value);
            line.grid x1=(px(frame.x)) x2=(px(right)) y1=(px(y)) y2=(px(y)) {}
            text.tick x=(px(frame.x - 7.0)) y=(px(y + 3.5)) text-anchor="end" { (name) }
        }
        @for (value, name) in &across.ticks {
            @let x = across.place(*value);
            line.grid x1=(px(x)) x2=(px(x)) y1=(px(frame.y)) y2=(px(lower)) {}
            text.tick x=(px(x)) y=(px(lower + 16.0)) text-anchor="middle" { (name) }
        }
        path.frame d={ "M" (px(frame.x)) " " (px(frame.y)) "V" (px(lower)) "H" (px(right)) } {}
    }
}

fn leader(placed: &Placed) -> Markup {
    html! {
        @if let Some((start, end)) = placed.leader {
            line.leader x1=(px(start.0)) y1=(px(start.1)) x2=(px(end.0)) y2=(px(end.1)) {}
        }
    }
}

/// What is said of a mark that is pointed at.
fn description(plot: &Plot<'_>, mark: &Mark<'_>) -> String {
    let value = match (mark.value, plot.naming) {
        (Value::Seen(value), Naming::Percent) => text::percent(value),
        (Value::Seen(value), _) => text::plain(value),
        (Value::Below(bound), _) => format!("none seen, so below {}", text::percent(bound)),
    };
    format!(
        "{}: {} ns a test; {value}",
        mark.name,
        text::plain(mark.nanoseconds)
    )
}

/// A mark, with an arrow if nothing was seen.
fn drawn(mark: &Mark<'_>, (x, y): Point) -> Markup {
    html! {
        @if let Value::Below(_) = mark.value {
            path.below d={ "M" (px(x)) " " (px(y + 4.0)) "v14m-4 -5l4 5l4 -5" } {}
        }
        (shape(mark.role, (x, y)))
    }
}

fn label(name: &str, placed: &Placed) -> Markup {
    let Rectangle { x, y, .. } = placed.label;
    html! {
        text x=(px(x + BETWEEN / 2.0)) y=(px(y + LABEL - 3.0)) { (name) }
    }
}

/// The end of a name that is too long for a label: a path's last part, if there is one.
fn short(name: &str) -> String {
    let (path, last) = name.rsplit_once('/').unwrap_or(("", name));
    let length = last.chars().count();
    if name.chars().count() <= LONGEST {
        name.to_owned()
    } else if length < LONGEST && !path.is_empty() {
        format!("…/{last}")
    } else {
        format!(
            "…{}",
            last.chars()
                .skip((length + 1).saturating_sub(LONGEST))
                .collect::<String>()
        )
    }
}

/// The class of marks that are on a front, and of those that are not.
pub fn fill(on_front: bool) -> &'static str {
    if on_front { "filled" } else { "hollow" }
}

/// The form of a role's marks: a lozenge of the library, a square of a champion, a disc of a rival.
pub fn shape(role: Role, (x, y): Point) -> Markup {
    html! {
        @match role {
            Role::Library => path d={ "M" (px(x)) " " (px(y - 6.5)) "l6.5 6.5l-6.5 6.5l-6.5 -6.5z" } {},
            Role::Champion => rect x=(px(x - 4.5)) y=(px(y - 4.5)) width="9" height="9" {},
            Role::Rival => circle cx=(px(x)) cy=(px(y)) r="4.5" {},
        }
    }
}

/// The class of a role.
pub fn role_class(role: Role) -> &'static str {
    match role {
        Role::Library => "library",
        Role::Champion => "champion",
        Role::Rival => "rival",
    }
}

/// A place, to a tenth of a pixel.
pub fn px(place: f64) -> String {
    let rounded = (10.0 * place).round() / 10.0;
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(name: &str, role: Role, nanoseconds: f64, value: Value) -> Mark<'_> {
        Mark {
            name,
            class: format!("k-{name}"),
            role,
            nanoseconds,
            value,
        }
    }

    #[test]
    fn who_is_beaten_is_hollow_and_none_seen_has_an_arrow() {
        let plot = Plot {
            title: "Leaks",
            caption: "of rays",
            naming: Naming::Percent,
            marks: vec![
                mark("bred", Role::Library, 0.7, Value::Seen(0.2)),
                mark("slow", Role::Rival, 0.9, Value::Seen(0.2)),
                mark("tight", Role::Rival, 2.0, Value::Below(3e-5)),
            ],
        };
        let svg = figure(&plot).into_string();
        assert_eq!(front(&plot.marks), [0, 2]);
        for expected in [
            "mark library filled k-bred",
            "mark rival hollow k-slow",
            "mark rival filled k-tight",
            "tight: 2.00 ns a test; none seen, so below 0.0030%",
            "bred: 0.70 ns a test; 20.0%",
        ] {
            assert!(svg.contains(expected), "{expected} in {svg}");
        }
        assert_eq!(svg.matches("class=\"below\"").count(), 1);
    }

    #[test]
    fn of_a_name_that_is_too_long_the_end_is_shown() {
        assert_eq!(short("runs/seed1"), "runs/seed1");
        assert_eq!(short(&format!("{}seed1", "runs/".repeat(20))), "…/seed1");
        let long = short(&"abcdefg-".repeat(20));
        assert!(long.starts_with('…') && long.ends_with("efg-"), "{long}");
        assert_eq!(long.chars().count(), LONGEST);
    }
}

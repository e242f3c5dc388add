//! The page of a run: its sections, from what was searched to the table at the end.

mod ancestry;
mod course;
mod head;
mod listing;
mod losses;
mod noise;
mod reference;
mod standings;
mod survivors;
mod worth;

use evolve::Objective;
use maud::{Markup, html};

use super::super::page;
use super::{Known, RunPage};
use crate::history::traits::Change;

/// What the page of a run has beside the style of all pages.
const STYLE: &str = include_str!("view.css");

/// The page as HTML.
pub fn html(run: &RunPage) -> String {
    let is_front = run.conditions.settings.objective == Objective::Pareto;
    let body = html! {
        (head::markup(run))
        (section("How it went", known(&run.course.best.first().map_or(
            Known::Missing("Nobody was timed.".into()), |_| Known::Is(&run.course),
        ), |course| course::markup(course))))
        (section("Where the champion comes from", known(&run.ancestry, |steps| ancestry::markup(steps))))
        (section("Which choices survived", known(&run.survivors, survivors::markup)))
        (section("What each choice is worth", known(&run.worth, |worth| worth::markup(worth, run.elsewhere.as_deref(), is_front))))
        (section("How fast the reference was", known(&run.reference, reference::markup)))
        (section("How noisy the timings are", html! {
            @if let Some(floor) = run.noise_floor { (noise::floor(floor)) }
            (known(&run.noise, noise::markup))
        }))
        (section("Tried twice, and failed", losses::markup(&run.losses)))
        (section("The champion's code", known(&run.listing, listing::markup)))
        (section("The table at the end", known(&run.standings, |all| standings::markup(all, run.champion.is()))))
        (notes())
    };
    page::html(&head::title(run), STYLE, &body)
}

fn section(title: &str, content: Markup) -> Markup {
    html! { section { h2 { (title) } (content) } }
}

/// Something, or the sentence that says why it is missing.
fn known<T>(value: &Known<T>, markup: impl Fn(&T) -> Markup) -> Markup {
    match value {
        Known::Is(value) => markup(value),
        Known::Missing(sentence) => html! { p.missing { (sentence) } },
    }
}

/// In what a program differs from another one, a line a question; the first few, and the others on demand.
fn differences(changes: &[Change], shown: usize) -> Markup {
    let (first, others) = changes.split_at(shown.min(changes.len()));
    html! {
        @for change in first { (difference(change)) }
        @if !others.is_empty() {
            details.more {
                summary { (others.len()) " more" }
                @for change in others { (difference(change)) }
            }
        }
    }
}

fn difference(change: &Change) -> Markup {
    html! {
        div.change {
            b { (change.question) }
            @if change.from.is_empty() {
                ": also " (change.to.join(", "))
            } @else if change.to.is_empty() {
                ": no longer " (change.from.join(", "))
            } @else {
                ": " span.from { (change.from.join(", ")) } " → " (change.to.join(", "))
            }
        }
    }
}

fn notes() -> Markup {
    html! {
        footer {
            p {
                "V is six times the signed volume of the tetrahedron of the triangle and the ray's direction, V0, V1 and V2 those of the \
                 ray and each side, Va that of the triangle and the ray's origin a: t is Va / V, and the ray is inside where V0, V1 \
                 and V2 have the sign of V. After Kensler and Shirley, Optimizing Ray-Triangle Intersection via Automated \
                 Search, 2006."
            }
        }
    }
}

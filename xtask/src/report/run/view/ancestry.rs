//! The champion's line, a row a step, the oldest ancestor first.

use maud::{Markup, html};

use super::differences;
use crate::history::ancestry::Step;

/// Changes of a step that are shown at once.
const SHOWN: usize = 3;

/// A gain of less is not said to be one: timings are not as good as that.
const FLAT: f64 = 0.01;

/// The line with a sentence.
pub fn markup(steps: &[Step]) -> Markup {
    let highest = steps
        .iter()
        .filter_map(|step| step.fitness)
        .fold(0.0, f64::max);
    let bred = steps.iter().skip(1);
    let largest = bred.max_by(|a, b| a.gain.unwrap_or(0.0).total_cmp(&b.gain.unwrap_or(0.0)));
    html! {
        p {
            "The line of first parents, who gave the most, from a random program to the champion: "
            (steps.len().saturating_sub(1)) " steps. "
            @if let Some((step, gain)) = largest.and_then(|step| Some((step, step.gain?))) {
                "The largest was by " (step.operator) " in generation " (step.generation) ": " b { (percent(gain)) } ". "
            }
            "Fitness is what was known in the end."
        }
        div.scroll {
            table.line {
                thead {
                    tr {
                        th scope="col" { "generation" }
                        th.text scope="col" { "candidate" }
                        th.text scope="col" { "made by" }
                        th.text scope="col" { "fitness" }
                        th scope="col" { "gain" }
                        th.text scope="col" { "other parent" }
                        th.text scope="col" { "what changed" }
                    }
                }
                tbody {
                    @for (place, step) in steps.iter().enumerate() {
                        (row(step, highest, place == 0, place + 1 == steps.len()))
                    }
                }
            }
        }
    }
}

fn row(step: &Step, highest: f64, is_first: bool, is_last: bool) -> Markup {
    let class = match (is_first, is_last) {
        (true, true) => "lane only",
        (true, false) => "lane first",
        (false, true) => "lane last",
        (false, false) => "lane",
    };
    html! {
        tr.champions[is_last] {
            th class=(class) scope="row" { (step.generation) }
            td.text {
                "no. " (step.id)
                @if step.copies > 0 { span.soft title="descendants of the same source in between" { " +" (step.copies) " the same" } }
            }
            td.text { span class={ "operator " (step.operator) } { (step.operator) } }
            td.text {
                @if let Some(fitness) = step.fitness {
                    span.bar style=(format!("--share:{:.3}", fitness / highest)) {}
                    (format!("{fitness:.2}"))
                } @else { "failed" }
            }
            td class={ "gain " (direction(step.gain)) } { (step.gain.map_or("–".into(), percent)) }
            td.text {
                @if let Some(other) = &step.other {
                    "no. " (other.id) span.soft { (other.fitness.map_or(", failed".into(), |fitness| format!(", {fitness:.2}"))) }
                } @else { span.soft { "–" } }
            }
            td.text.what {
                @match &step.changes {
                    Some(changes) if changes.is_empty() => { span.soft { "the order of statements" } }
                    Some(changes) => { (differences(changes, SHOWN)) }
                    None if is_first => { span.soft { "drawn at random" } }
                    None => { span.soft { "not known" } }
                }
            }
        }
    }
}

/// `+12%` of 1.12.
fn percent(gain: f64) -> String {
    let percent = 100.0 * (gain - 1.0);
    format!("{percent:+.1}%").replace('-', "−")
}

fn direction(gain: Option<f64>) -> &'static str {
    match gain {
        Some(gain) if gain > 1.0 + FLAT => "up",
        Some(gain) if gain < 1.0 - FLAT => "down",
        _ => "flat",
    }
}

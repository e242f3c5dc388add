//! The shares of all answers as a heat map.

use maud::{Markup, html};

use super::super::survivors::{Question, Row, Survivors};
use crate::history::traits::Topic;

/// The map with a sentence.
pub fn markup(survivors: &Survivors) -> Markup {
    html! {
        p {
            "A candidate answers a question each way the graph leaves open. The share of the survivors that answer it so, from \
             the random generation on; " b { "◂" } " the champion's answer. What all programs of the run have in common is left out."
        }
        div.scroll {
            table.heat {
                thead {
                    tr {
                        th scope="col" { "generation" }
                        th scope="col" {}
                        @for &(first, last) in &survivors.stretches { th scope="col" { (stretch(first, last)) } }
                    }
                }
                @for topic in TOPICS {
                    @let own: Vec<&Question> = survivors.questions.iter().filter(|one| one.topic == topic).collect();
                    @if !own.is_empty() {
                        tbody {
                            tr.topic { th scope="rowgroup" colspan=(survivors.stretches.len() + 2) { (name(topic)) } }
                            @for question in own { (rows(question)) }
                        }
                    }
                }
            }
        }
    }
}

const TOPICS: [Topic; 5] = [
    Topic::Formulation,
    Topic::Division,
    Topic::Test,
    Topic::Exit,
    Topic::Order,
];

fn name(topic: Topic) -> &'static str {
    match topic {
        Topic::Formulation => "How volumes are found",
        Topic::Division => "How values are divided by V",
        Topic::Test => "How tests are made",
        Topic::Exit => "Where a triangle may be left early",
        Topic::Order => "In which order tests are made",
        Topic::Writing => "How it is written",
    }
}

fn stretch(first: usize, last: usize) -> String {
    match (first, last) {
        (0, 0) => "random".into(),
        (first, last) if first == last => first.to_string(),
        (first, last) => format!("{first}–{last}"),
    }
}

fn rows(question: &Question) -> Markup {
    html! {
        @for (place, row) in question.rows.iter().enumerate() {
            tr.begins[place == 0] {
                th scope="row" { @if place == 0 { (question.question) } }
                (option(row))
                @for &share in &row.shares { (cell(share)) }
            }
        }
    }
}

fn option(row: &Row) -> Markup {
    html! {
        td.text.option.champions[row.is_champions] {
            (row.option) @if row.is_champions { span.here { " ◂" } }
        }
    }
}

fn cell(share: f64) -> Markup {
    let percent = (100.0 * share).round();
    html! {
        td.share.high[share > 0.6].low[share < 0.1] style=(format!("--share:{share:.3}")) {
            @if percent > 0.0 { (percent) } @else if share > 0.0 { "<1" } @else { "·" }
        }
    }
}

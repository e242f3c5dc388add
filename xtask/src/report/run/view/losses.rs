//! What was tried twice, and what failed.

use maud::{Markup, html};

use super::super::losses::Losses;

/// Counts, and a row a kind of failure.
pub fn markup(losses: &Losses) -> Markup {
    let failed: usize = losses.failures.iter().map(|failure| failure.count).sum();
    html! {
        table.counts {
            tbody {
                @if let Some(redrawn) = losses.redrawn {
                    (row("Drafts drawn again", redrawn as usize, redrawn as usize + losses.candidates, "drafts",
                         "their source had been tried, so they became no candidates"))
                }
                (row("Same source", losses.same_source, losses.candidates, "candidates", "as an earlier one, so nothing was timed"))
                @if let Some(same_code) = losses.same_code {
                    (row("Same machine code", same_code as usize, losses.sources, "sources", "as an earlier one that was written otherwise"))
                }
                (row("Failed", failed, losses.sources, "sources", "no fitness"))
            }
        }
        @if losses.failures.is_empty() {
            p.soft { "No candidate failed." }
        } @else {
            div.scroll {
                table.failures {
                    thead {
                        tr {
                            th.text scope="col" { "failure" }
                            th scope="col" { "sources" }
                            th.text scope="col" { "for example" }
                        }
                    }
                    tbody {
                        @for failure in &losses.failures {
                            tr {
                                th scope="row" { (failure.verdict) }
                                td { (failure.count) }
                                td.text.what { "no. " (failure.candidate) ": " (failure.cause) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn row(name: &str, part: usize, whole: usize, of: &str, meaning: &str) -> Markup {
    let percent = 100.0 * part as f64 / whole.max(1) as f64;
    html! {
        tr {
            th scope="row" { (name) }
            td { b { (part) } " of " (whole) " " (of) }
            td { (format!("{percent:.0}%")) }
            td.text.soft { (meaning) }
        }
    }
}

//! The ranked table at the end of a run.

use maud::{Markup, html};

use super::super::Champion;
use super::super::ended::Standing;
use crate::report::text;

/// The table with a sentence. In that of a front the champion is one of the candidates.
pub fn markup(standings: &[Standing], champion: Option<&Champion>) -> Markup {
    let of_front = standings.iter().any(|one| one.candidate.is_some());
    let is_champion = |one: &Standing| {
        let id = champion.and_then(|champion| champion.id);
        one.kernel == "champion" || one.candidate.is_some() && one.candidate == id
    };
    html! {
        p {
            @if of_front {
                "Who was on the front or near it met on the full workload, and was tried by rays at edges and vertices that no \
                 candidate had been. No. is the place on the front: nobody is better in speed, error of t and leaks at once."
            } @else {
                "The best of the search met on the full workload, each compiled by itself, with the paper's kernel and the reference."
            }
            " Worst layout: how many times as slow it is where stack and rays lie worst in memory as where they lie in most. = shares its \
             rank: the difference from the first of the rank is within the uncertainty of the two."
        }
        div.scroll {
            table.standings {
                thead {
                    tr {
                        th.text scope="col" { "kernel" }
                        th scope="col" { "rank" }
                        @if of_front { th scope="col" { "no." } }
                        th scope="col" { "× Möller-Trumbore" }
                        th scope="col" { "on unseen packets" }
                        th scope="col" { "worst layout" }
                        th scope="col" { "million tests a second" }
                        th scope="col" { "t error: median" }
                        th scope="col" { "p99" }
                        @if of_front { th scope="col" { "p99.99" } th scope="col" { "leaks" } }
                    }
                }
                tbody { @for one in standings { (row(one, of_front, is_champion(one))) } }
            }
        }
    }
}

fn row(one: &Standing, of_front: bool, is_champion: bool) -> Markup {
    let name = match one.candidate {
        Some(id) if is_champion => format!("no. {id}, the champion"),
        Some(id) => format!("no. {id}"),
        None => one.kernel.clone(),
    };
    html! {
        tr.champions[is_champion] {
            th.champion[is_champion] scope="row" { (name) }
            @if let (Some(rank), Some(accuracy)) = (one.rank, one.accuracy) {
                td { (rank) @if one.is_tied { " =" } }
                @if of_front { td { (one.number.map_or("–".into(), |number| number.to_string())) } }
                td { (format!("{:.2} ± {:.2}", one.ratio, one.ratio * one.uncertainty)) }
                td { (format!("{:.2}", one.unseen)) }
                td { (one.worst_layout.map_or("–".into(), |worst| format!("{worst:.2}"))) }
                td { (format!("{:.0}", one.speed)) }
                td { (text::power(accuracy.median)) }
                td { (text::power(accuracy.p99)) }
                @if of_front {
                    @if let Some(tried) = accuracy.tried {
                        td { (text::power(tried.t_p9999)) }
                        td { (text::share(tried.leak)) }
                    } @else { td { "–" } td { "–" } }
                }
            } @else {
                td { "–" }
                td colspan=(if of_front { 9 } else { 6 }) { (one.verdict) }
            }
        }
    }
}

//! The library's page: what it is about, every case, the catalogue.

use std::collections::BTreeSet;

use maud::{Markup, html};

use super::catalogue::Entry;
use super::library::Library;
use super::scatter::{fill, role_class, shape};
use super::section::Section;
use super::{page, tables, text};
use crate::cases::Role;

/// The page as HTML.
pub fn html(library: &Library) -> String {
    let kernels = || library.cases.iter().flat_map(|case| &case.kernels);
    let rivals = kernels().filter(|one| one.role == Role::Rival);
    let rivals: BTreeSet<&str> = rivals.map(|one| one.name()).collect();
    let body = html! {
        (head(library))
        @for case in &library.cases { (Section { case, rivals: &rivals }.markup()) }
        (catalogue(&library.catalogue))
        (notes())
    };
    let most = library.cases.iter().map(|case| case.kernels.len()).max();
    page::html(TITLE, &pointing_out(most.unwrap_or(0)), &body)
}

/// What it is about.
const TITLE: &str = "raybreed: the library and its rivals";

/// Whoever is pointed at in a plot, a legend or a table stands out in all plots of the case.
fn pointing_out(kernels: usize) -> String {
    let rule = |number: usize| {
        let class = tables::class(number);
        format!(
            "section:has(.{class}:hover) .line:not(.{class}),section:has(.{class}:hover) .mark[class*=\" k\"]:not(.{class})\
             {{opacity:.15}}"
        )
    };
    (0..kernels).map(rule).collect()
}

fn head(library: &Library) -> Markup {
    let machine = &library.machine;
    let roles = || {
        library
            .cases
            .iter()
            .flat_map(|case| &case.kernels)
            .map(|one| one.role)
    };
    html! {
        header {
            h1 { (TITLE) }
            p.lead {
                "Ray-triangle intersection kernels that raybreed bred, beside those of the literature: how long a test \
                 takes, and what it gets wrong where rays pass edges, triangles are thin, far away, tiny or huge. All were \
                 timed in turn on the same packets, and judged by exact arithmetic."
            }
            dl.facts {
                div { dt { "Processor" } dd { (machine.cpu) } }
                div { dt { "System" } dd { (machine.system) ", " (machine.cores) " cores" } }
                div { dt { "Compiler" } dd { "rustc " (library.rustc) } }
                div { dt { "Timing" } dd { (library.packets) " packets, each kernel in turn" } }
                div { dt { "Accuracy" } dd { (library.samples) " rays a case, seed " (library.seed) } }
            }
            ul.key {
                @for (role, meaning) in [
                    (Role::Library, "of the library"), (Role::Rival, "rival"), (Role::Champion, "champion of a run"),
                ] {
                    @if roles().any(|it| it == role) { (key(role, false, meaning)) }
                }
                (key(Role::Rival, true, "filled: on the front, nobody is better in both"))
                li {
                    svg.key viewBox="0 0 14 20" aria-hidden="true" {
                        g.mark.rival.hollow { path.below d="M7 8v10m-3 -4l3 4l3 -4" {} (shape(Role::Rival, (7.0, 5.0))) }
                    }
                    "none seen: drawn at 3/N, which it is below"
                }
            }
        }
    }
}

fn key(role: Role, on_front: bool, meaning: &str) -> Markup {
    html! {
        li {
            svg.key viewBox="0 0 14 14" aria-hidden="true" {
                g class={ "mark " (role_class(role)) " " (fill(on_front)) } { (shape(role, (7.0, 7.0))) }
            }
            (meaning)
        }
    }
}

fn catalogue(entries: &[Entry]) -> Markup {
    html! {
        section {
            h2 { "Catalogue" }
            p { "The kernels of the package, as their recipes describe them: measured where they were bred." }
            div.catalogue {
                @for entry in entries { (catalogue_entry(entry)) }
            }
        }
    }
}

fn catalogue_entry(entry: &Entry) -> Markup {
    let scene = &entry.scene;
    let isas: Vec<&str> = entry.isas.iter().map(|isa| isa.name()).collect();
    let scene = format!(
        "{}, {} origin, {}, culling {}, t {}, {}, watertight {}",
        scene.grouping,
        scene.origin,
        scene.query,
        scene.culling,
        scene.regime,
        scene.numeric,
        scene.watertight,
    );
    html! {
        article {
            h3.library { (entry.name) }
            dl {
                dt { "Scene" } dd { (scene) }
                dt { "Instruction sets" } dd { (isas.join(", ")) }
                dt { "Bytes of a triangle" } dd { (entry.bytes) }
                dt { "Program" } dd { (entry.statements) " statements, " (text::plain(entry.operations)) " operations a test" }
                @if let Some(from) = &entry.provenance {
                    dt { "Speed" } dd { (text::plain(from.ratio)) " × Möller-Trumbore" }
                }
                @if let Some(error) = entry.error {
                    dt { "Error of t" }
                    dd {
                        "median " (text::power(error.median)) ", p99 " (text::power(error.p99))
                        @if let Some(stability) = entry.stability { ", p99.99 " (text::power(stability.t_p9999)) }
                        ", greatest seen " (text::power(error.max))
                    }
                }
                @if let Some(stability) = entry.stability {
                    dt { "Leaks" } dd { "edges " (stability.edge_leak) ", vertices " (stability.vertex_leak) }
                    dt { "Doubles" } dd { (stability.double) }
                    dt { "Scales" } dd { "2ᵏ, k from " (stability.scale[0]) " to " (stability.scale[1]) }
                }
                @if let Some(from) = &entry.provenance {
                    dt { "Provenance" }
                    dd {
                        "strategy " (from.search.strategy) ", seed " (from.search.seed) ", " (from.search.generations) " generations of "
                        (from.search.population) ", " (from.evaluations) " evaluations of " (from.distinct) " programs; "
                        (from.cpu) ", rustc " (from.rustc) ", graph " (from.graph)
                        @if let Some(improved) = &from.improved {
                            "; improved from " (text::plain(improved.cost_before)) " to " (text::plain(improved.cost)) " operations"
                        }
                    }
                }
                dt { "Recipe" } dd { code { "generated/recipes/" (entry.name) ".json" } }
            }
        }
    }
}

fn notes() -> Markup {
    html! {
        footer {
            p {
                "Kernels were timed packet by packet, in turn with Möller and Trumbore's: a time is the median of theirs, divided \
                 by the ratio, whose uncertainty is beside it. A front may hang on less. \"<\": none was seen, and the share is below that with a \
                 confidence of 95%. A quantile of samples is no bound. Far: at 10³ to 2·10⁵ from the world's origin. Scales: \
                 everything times 2ᵏ changes no verdict, nor t. Not finite: reported hits of NaN and infinities, or other rays that \
                 they changed. Kernels for a common origin are given one ray a packet by the accuracy lab, and a 32nd of the rays."
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_loads_nothing_and_prints_names_as_they_are() {
        let page = html(&Library::example());
        for loads in [
            "http", "src=", "href=", "url(", "@import", "<script", "<link", "<img",
        ] {
            assert!(!page.contains(loads), "{loads}");
        }
        assert!(
            page.contains("runs/&lt;b&gt;") && !page.contains("<b>/"),
            "{page}"
        );
    }

    #[test]
    fn who_was_timed_and_judged_is_in_every_plot_and_table_and_who_failed_is_named() {
        let page = html(&Library::example());
        // Three panels.
        assert_eq!(page.matches("<title>exact: ").count(), 3);
        // Two figures of two sweeps.
        assert_eq!(page.matches("<title>exact</title>").count(), 4);
        // The front, which takes an error, all kernels, triangles, surfaces.
        let rows = |name: &str| {
            page.split("<th scope=\"row\"")
                .filter(|row| row.contains(&format!("</svg>{name}</th>")))
                .count()
        };
        assert_eq!([rows("exact"), rows("blind"), rows("broken")], [4, 3, 1]);
        assert!(page.contains("wrong answer") && !page.contains("<title>broken"));
        // The exact one leaks nothing, which is no dot on an axis of logarithms.
        assert!(page.contains("none seen, so below"));
        assert!(page.contains("generated/recipes/packet-shrinking-sse2.json"));
    }
}

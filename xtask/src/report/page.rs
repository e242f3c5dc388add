//! The library's page, self-contained: it loads nothing.

use accuracy::{Rate, Sweep};
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::axis::Naming;
use super::catalogue::Entry;
use super::library::{Compared, Contender, Library};
use super::lines::{self, Line, Ordinate};
use super::scatter::{self, Mark, Plot, Value, role_class, shape};
use super::{tables, text};
use crate::cases::Role;

/// How it looks, light and dark.
const STYLE: &str = include_str!("page.css");

/// Ways in which lines of rivals are drawn.
const LINE_STYLES: usize = 18;

/// The page as HTML.
pub fn html(library: &Library) -> String {
    let most = library.cases.iter().map(|case| case.kernels.len()).max();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "raybreed: the library and its rivals" }
                style { (PreEscaped(STYLE)) (PreEscaped(pointing_out(most.unwrap_or(0)))) }
            }
            body {
                main {
                    (head(library))
                    @for case in &library.cases { (section(case)) }
                    (catalogue(&library.catalogue))
                    (notes())
                }
            }
        }
    };
    page.into_string()
}

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
            h1 { "raybreed: the library and its rivals" }
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
                    @if roles().any(|it| it == role) { (key(role, "hollow", meaning)) }
                }
                (key(Role::Rival, "filled", "filled: on the front, nobody is better in both"))
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

fn key(role: Role, fill: &str, meaning: &str) -> Markup {
    html! {
        li {
            svg.key viewBox="0 0 14 14" aria-hidden="true" {
                g class={ "mark " (role_class(role)) " " (fill) } { (shape(role, (7.0, 7.0))) }
            }
            (meaning)
        }
    }
}

fn section(case: &Compared) -> Markup {
    html! {
        section {
            h2 { (case.title(" · ")) }
            p.soft { (case.workload) }
            div.plots {
                (scatter::figure(&plot(
                    case, "p99.99 error of t",
                    "Relative, at ordinary triangles; half of the rays pass next to sides.",
                    Naming::Power, |one| one.t_error_p9999.filter(|error| error.is_finite()).map(Value::Seen),
                )))
                (scatter::figure(&plot(
                    case, "Edge leaks",
                    "Rays at shared edges of closed fans and meshes that no triangle reports.",
                    Naming::Percent, |one| value(one.edge_leak()?),
                )))
                (scatter::figure(&plot(
                    case, "Doubles",
                    "Rays at shared edges and vertices that are reported once too often.",
                    Naming::Percent, |one| value(one.double()?),
                )))
                (tables::front(case))
            }
            (tables::standings(case))
            (legend(case))
            div.plots {
                @for ordinate in [Ordinate::Error, Ordinate::Wrong] {
                    @for sweep in Sweep::ALL {
                        (lines::figure(ordinate, sweep, &swept(case, sweep)))
                    }
                }
            }
            (tables::extremes(case))
            (tables::surfaces(case))
        }
    }
}

fn value(rate: Rate) -> Option<Value> {
    match rate.bound_of_zero() {
        Some(bound) => Some(Value::Below(bound)),
        None => (rate.samples > 0).then(|| Value::Seen(rate.share())),
    }
}

fn plot<'a>(
    case: &'a Compared,
    title: &'a str,
    caption: &'a str,
    naming: Naming,
    value: impl Fn(&Contender) -> Option<Value>,
) -> Plot<'a> {
    let numbered = case.kernels.iter().enumerate();
    let marks = numbered.filter_map(|(number, one)| {
        Some(Mark {
            name: one.name(),
            class: tables::class(number),
            role: one.role,
            nanoseconds: one.nanoseconds?,
            value: value(one)?,
        })
    });
    Plot {
        title,
        caption,
        naming,
        marks: marks.collect(),
    }
}

/// How a kernel's lines are drawn: those of the library and of champions alike, each rival's in its own way.
fn line_class(case: &Compared, number: usize) -> String {
    let one = &case.kernels[number];
    let own = match one.role {
        Role::Rival => {
            let before = case.kernels[..number].iter();
            let rivals = before.filter(|one| one.role == Role::Rival).count();
            format!("s{}", rivals % LINE_STYLES)
        }
        role => role_class(role).to_owned(),
    };
    format!("{own} {}", tables::class(number))
}

fn swept(case: &Compared, sweep: Sweep) -> Vec<Line<'_>> {
    let numbered = case.kernels.iter().enumerate();
    let lines = numbered.filter_map(|(number, one)| {
        let mut sweeps = one.judged.as_ref()?.sweeps.iter();
        Some(Line {
            name: one.name(),
            class: line_class(case, number),
            points: &sweeps.find(|one| one.sweep == sweep)?.points,
        })
    });
    lines.collect()
}

fn legend(case: &Compared) -> Markup {
    html! {
        ul.legend {
            @for (number, one) in case.kernels.iter().enumerate() {
                @if one.judged.is_some() {
                    li class=(tables::class(number)) {
                        svg.sample viewBox="0 0 30 10" aria-hidden="true" {
                            g class={ "line " (line_class(case, number)) } { path d="M2 5h26" {} }
                        }
                        (one.name())
                    }
                }
            }
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
                        (from.search.strategy) ", seed " (from.search.seed) ", " (from.search.generations) " generations of "
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
                "A time is the median over all rounds, a round being one packet against all triangles; a ratio's uncertainty \
                 is beside it, and a front may hang on less. \"<\": none was seen, and the share is below that with a \
                 confidence of 95%. A quantile of samples is no bound. Far: at 10³ to 2·10⁵ from the world's origin. Scales: \
                 everything times 2ᵏ changes no verdict. Not finite: reported hits of NaN and infinities, or other rays that \
                 they changed. Kernels for a common origin are given one ray a packet by the accuracy lab, and a 32nd of the rays."
            }
        }
    }
}

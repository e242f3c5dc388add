//! What was searched, who won, and under which conditions.

use maud::{Markup, html};
use scene::SceneModel;

use super::super::{Champion, RunPage};
use crate::progress::short;

/// The page's title.
pub fn title(run: &RunPage) -> String {
    let conditions = &run.conditions;
    let isas = conditions.isas.to_string();
    format!(
        "A search for kernels: {}, {isas}, {}",
        conditions.scene.name, conditions.scene.regime
    )
}

/// The head of the page.
pub fn markup(run: &RunPage) -> Markup {
    let conditions = &run.conditions;
    let settings = &conditions.settings;
    let machine = &conditions.machine;
    let (evaluations, sources) = (run.losses.candidates, run.losses.sources);
    html! {
        header {
            h1 { (title(run)) }
            p.lead { (verdict(run.champion.is())) }
            p {
                "raybreed can write a test of a ray and a triangle in very many ways. A search tries some of them: each \
                 candidate is compiled, checked and timed, and its fitness is its speed as a multiple of the usual test by Möller and \
                 Trumbore, timed beside it. This page is about one search."
            }
            dl.facts {
                div { dt { "Scene" } dd { (scene(&conditions.scene)) } }
                div { dt { "Instruction set" } dd { (conditions.isas) } }
                div { dt { "Rays against" } dd { (regime(&conditions.scene)) } }
                div { dt { "Strategy" } dd { (settings.strategy) } }
                div { dt { "Objective" } dd { (settings.objective.name()) } }
                div { dt { "Seed" } dd { (settings.seed) } }
                div { dt { "Population" } dd { (settings.population) ", of which " (settings.elite) " survive"
                    @if settings.islands > 1 { ", on each of " (settings.islands) " islands" }
                } }
                div { dt { "Tried" } dd { (evaluations) " candidates, " (sources) " of them different" } }
                div { dt { "Ended" } dd {
                    (run.stopped.as_deref().unwrap_or("interrupted, or still running"))
                    @if let Some(seconds) = run.seconds { ", after " (short(std::time::Duration::from_secs_f64(seconds.max(0.0)))) }
                } }
                div { dt { "Processor" } dd { (machine.cpu) } }
                div { dt { "System" } dd {
                    (machine.system) ", " (count(machine.cores, "core")) ", timing on " (conditions.cores) " at once"
                } }
                div { dt { "Compiler" } dd { (conditions.rustc) } }
                div { dt { "Flags" } dd { code { (conditions.flags.join(" ")) } } }
                div { dt { "Workload" } dd {
                    (conditions.workload.packets) " packets of " (scene::PACKET_SIZE) " rays, " (conditions.workload.triangles) " triangles"
                } }
                div { dt { "Graph" } dd { code { (conditions.graph) } } }
                div { dt { "Run" } dd { code { (run.run) } } }
                div { dt { "Command" } dd { code { "cargo xtask " (conditions.arguments.join(" ")) } } }
            }
            @if let Some(elsewhere) = &run.elsewhere {
                p.warning {
                    b { "Not this machine. " }
                    "The run was made elsewhere, or before something changed: " (elsewhere) ". What is timed for this page is of here and \
                     now, and need not hold there."
                }
            }
        }
    }
}

fn verdict(champion: Option<&Champion>) -> Markup {
    let Some(champion) = champion else {
        return html! { "There is no champion." };
    };
    let uncertainty = champion.uncertainty.map(|share| share * champion.ratio);
    html! {
        @if champion.is_provisional { "The best so far" } @else { "The champion" }
        " makes " b { (format!("{:.2}", champion.ratio)) } " times as many tests a second as Möller and Trumbore's"
        @if let Some(uncertainty) = uncertainty { (format!(" (± {uncertainty:.2})")) }
        @if champion.by_shootout {
            ", by a last meeting on all rays, half of which no candidate had been timed on."
        } @else {
            ", by the figures of the search, which owe something to luck."
        }
    }
}

fn count(number: usize, what: &str) -> String {
    match number {
        1 => format!("1 {what}"),
        number => format!("{number} {what}s"),
    }
}

fn scene(scene: &SceneModel) -> String {
    let mut text = format!(
        "{}: {}, {} origin, {} hit, culling {}, watertight {}, {}",
        scene.name,
        scene.grouping,
        scene.origin,
        scene.query,
        scene.culling,
        scene.watertight,
        scene.numeric
    );
    if !scene.outputs.is_empty() {
        let outputs: Vec<String> = scene.outputs.iter().map(ToString::to_string).collect();
        text += &format!(", reporting {}", outputs.join(", "));
    }
    text
}

fn regime(scene: &SceneModel) -> String {
    let meaning = match scene.regime {
        scene::Regime::Shrinking => "all triangles, t shrinking to the closest hit so far",
        scene::Regime::Fixed => "all triangles, each hit by itself",
        scene::Regime::Leaf => "lists of 8 triangles",
    };
    format!("{meaning} ({})", scene.regime)
}

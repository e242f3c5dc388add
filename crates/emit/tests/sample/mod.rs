//! The recipes that tests are made with.

#![allow(dead_code, reason = "not every test file uses all")]

use emit::{ErrorProfile, Improved, Isa, Name, Provenance, Recipe, Search, Share, Stability};
use program::{appendix, kensler_shirley};
use scene::SceneModel;

/// A recipe of the appendix's program.
pub fn recipe(name: &str) -> Recipe {
    let graph = kensler_shirley();
    let plain = |text: &str| Name::new(text).unwrap();
    Recipe {
        name: plain(name),
        scene: SceneModel::preset("packet").unwrap(),
        isas: vec![Isa::Sse2],
        provenance: Some(Provenance {
            search: Search {
                strategy: plain("paper"),
                objective: None,
                population: 50,
                elite: 20,
                generations: 100,
                islands: None,
                seed: u64::MAX,
            },
            evaluations: 3050,
            distinct: 2781,
            ratio: 67005939426.048996,
            uncertainty: Some(0.004),
            worst_layout: Some(1.03),
            cpu: plain("xeon-2.0ghz"),
            rustc: plain("1.89.0"),
            graph: plain("0123456789abcdef"),
            improved: None,
        }),
        error: Some(ErrorProfile {
            hits: 100_000,
            median: 1.0 / 3.0 * 1e-7,
            p99: 1e-23,
            max: 5e-324,
        }),
        stability: None,
        program: graph.program(&appendix(&graph)).unwrap(),
    }
}

/// What the accuracy lab may find.
pub fn stability() -> Stability {
    let share = |events, samples| Share { events, samples };
    Stability {
        samples: 20_000,
        seed: 7,
        edge_leak: share(10_000, 80_000),
        vertex_leak: share(0, 40_000),
        double: share(30_000, 120_000),
        t_p9999: 3e-7,
        uv_p9999: Some(2e-7),
        scale: [-19, 20],
    }
}

/// The same, as if it had been improved by operation count.
pub fn improved_recipe(name: &str) -> Recipe {
    let mut recipe = recipe(name);
    let provenance = recipe.provenance.as_mut().unwrap();
    provenance.improved = Some(Improved {
        model: Name::new("paper").unwrap(),
        cost_before: 41.09375,
        cost: 32.234375,
        ratio_before: 1.1,
    });
    recipe
}

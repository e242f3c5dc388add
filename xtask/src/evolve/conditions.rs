//! All that a run depends on: the first line of its journal, and most of `run.json`.

use std::path::Path;

use emit::Name;
use evolve::{Recorded, Settings};
use measure::{FLAGS, Machine, Rustc, WorkloadSpec};
use scene::SceneModel;
use serde::{Deserialize, Serialize};

use crate::arena::Arena;
use crate::failure::bad_input;
use crate::isas::Isas;

/// The conditions of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// The machine.
    pub machine: Machine,
    /// `rustc --version`.
    pub rustc: String,
    /// What candidates are compiled with.
    pub flags: Vec<String>,
    /// The command line, after `cargo xtask`.
    pub arguments: Vec<String>,
    /// Settings, with the strategy and the seed.
    pub settings: Settings,
    /// What the scene requires.
    pub scene: SceneModel,
    /// The instruction sets.
    pub isas: Isas,
    /// How many cores time candidates at once.
    pub cores: usize,
    /// What kernels are timed on.
    pub workload: WorkloadSpec,
    /// Hash of the graph.
    pub graph: Name,
}

impl Conditions {
    /// The conditions here and now.
    pub fn here(
        arena: &Arena,
        rustc: &Rustc,
        settings: Settings,
        cores: usize,
        graph: Name,
    ) -> Conditions {
        Conditions {
            machine: Machine::here(),
            rustc: rustc.version().to_owned(),
            flags: FLAGS.iter().map(|&flag| flag.to_owned()).collect(),
            arguments: std::env::args().skip(1).collect(),
            settings,
            scene: arena.scene.clone(),
            isas: arena.isas.clone(),
            cores,
            workload: arena.workload(),
            graph,
        }
    }

    /// Those of a recorded run.
    pub fn of(recorded: &Recorded, journal: &Path) -> anyhow::Result<Conditions> {
        serde_json::from_value(recorded.run.clone()).map_err(|error| {
            bad_input(format!(
                "{}: the first line does not describe a run of this version ({error})",
                journal.display()
            ))
        })
    }

    /// Where the run's kernels meet.
    pub fn arena(&self) -> Arena {
        Arena {
            scene: self.scene.clone(),
            isas: self.isas.clone(),
            triangles: self.workload.triangles,
        }
    }

    /// Refuses to go on with a run whose timings would not go with new ones.
    pub fn check_against(&self, now: &Conditions) -> anyhow::Result<()> {
        let facts = |of: &Conditions| {
            serde_json::json!({
                "machine": of.machine,
                "rustc": of.rustc,
                "flags": of.flags,
                "workload": of.workload,
                "graph": of.graph,
            })
        };
        let (then, now) = (facts(self), facts(now));
        for what in ["machine", "rustc", "flags", "workload", "graph"] {
            let (then, now) = (&then[what], &now[what]);
            if then != now {
                return Err(bad_input(format!(
                    "the run's {what} was {then} and is {now} now, and timings of the two do not \
                     go together; begin a new run"
                )));
            }
        }
        Ok(())
    }
}

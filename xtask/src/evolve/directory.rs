//! The run directory: `run.json`, `evals.jsonl`, `champion.rs` and `champion.json`; `front/` if the search was after
//! one, and `graph.json` if it searched one that is not checked in.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context;
use emit::{Kernel, Recipe, print_kernel, rustfmt};
use evolve::{Journal, JournalError, Recorded};
use measure::{Calibrated, Processes};
use serde::{Deserialize, Serialize};

use super::conditions::Conditions;
use super::front::Member;
use crate::arena::Arena;
use crate::failure::bad_input;
use crate::files;
use crate::shootout::Standing;

/// The name of the copy of a graph.
const GRAPH: &str = "graph.json";

/// A run directory that is this run's own.
pub struct RunDirectory {
    path: PathBuf,
}

/// What `run.json` says: all that the run's figures depend on, and how it ended. It can be made
/// again from the journal, but for the shoot-out.
#[derive(Serialize)]
pub struct Run {
    /// What the run depends on.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// The reference against a copy of itself: relative uncertainty of one evaluation.
    pub noise_floor: Option<f64>,
    /// The reference in fresh processes before the search began.
    pub reference: Option<Calibrated>,
    /// What became of worker processes in which it was slow, in all sittings that came to an end or were interrupted.
    pub processes: Option<Processes>,
    /// Individuals evaluated; none before the end.
    pub evaluations: Option<u64>,
    /// Different sources among them.
    pub distinct: Option<u64>,
    /// Drafts that were no candidates, since their source had been tried.
    pub redrawn: Option<u64>,
    /// Sources that were not timed, since they were the same machine code as one that had been.
    pub twins: Option<u64>,
    /// How long the search took; none if it was resumed.
    pub seconds: Option<f64>,
    /// Why the search ended.
    pub stopped: Option<String>,
    /// The shoot-out at the end.
    pub shootout: Option<Vec<Standing>>,
    /// If it was after a front, that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub front: Option<Vec<Member>>,
}

impl Run {
    /// A run that begins.
    pub fn new(conditions: Conditions) -> Run {
        Run {
            conditions,
            noise_floor: None,
            reference: None,
            processes: None,
            evaluations: None,
            distinct: None,
            redrawn: None,
            twins: None,
            seconds: None,
            stopped: None,
            shootout: None,
            front: None,
        }
    }
}

impl RunDirectory {
    /// Makes the directory: `out`, which must be new or empty, or the next free one for this
    /// arena and seed below `runs`.
    pub fn create(out: Option<&Path>, arena: &Arena, seed: u64) -> anyhow::Result<RunDirectory> {
        let path = match out {
            Some(out) => out.to_owned(),
            None => {
                let Arena { scene, isas, .. } = arena;
                let (scene, regime) = (&scene.name, scene.regime);
                let stem = format!("runs/{scene}-{isas}-{regime}-seed{seed}");
                let numbered = (2..).map(|number| format!("{stem}-{number}"));
                let mut names = std::iter::once(stem.clone()).chain(numbered);
                let free = |name: &String| !files::in_repository(name).exists();
                files::in_repository(names.find(free).expect("numbers do not end"))
            }
        };
        let cannot = |error: io::Error| {
            let path = path.display();
            bad_input(format!(
                "cannot keep the run in {path}: {error}; name another with --out"
            ))
        };
        fs::create_dir_all(&path).map_err(cannot)?;
        if fs::read_dir(&path).map_err(cannot)?.next().is_some() {
            let path = path.display();
            return Err(bad_input(format!(
                "{path} is not empty, and a run's directory is its own; name another with --out"
            )));
        }
        // A directory that exists may still not take files.
        tempfile::NamedTempFile::new_in(&path).map_err(cannot)?;
        Ok(RunDirectory { path })
    }

    /// What an earlier sitting of this run has measured of the reference and its processes; nothing if it has left no
    /// such record.
    pub fn earlier(&self) -> (Option<Calibrated>, Processes) {
        #[derive(Default, Deserialize)]
        struct Earlier {
            reference: Option<Calibrated>,
            processes: Option<Processes>,
        }
        let text = fs::read_to_string(self.path.join("run.json")).unwrap_or_default();
        let earlier: Earlier = serde_json::from_str(&text).unwrap_or_default();
        (earlier.reference, earlier.processes.unwrap_or_default())
    }

    /// Where it is, from here if that is shorter.
    pub fn display(&self) -> String {
        let here = std::env::current_dir().unwrap_or_default();
        self.path
            .strip_prefix(here)
            .unwrap_or(&self.path)
            .display()
            .to_string()
    }

    /// The directory of a run that is to go on.
    pub fn open(path: &Path) -> RunDirectory {
        RunDirectory {
            path: path.to_owned(),
        }
    }

    /// Begins the journal.
    pub fn begin(&self, conditions: &Conditions) -> anyhow::Result<Journal> {
        let run = serde_json::to_value(conditions)?;
        Journal::create(&self.journal(), run).map_err(|error| self.unusable(error))
    }

    /// Opens the journal to go on with it.
    pub fn resume(&self) -> anyhow::Result<(Journal, Recorded)> {
        Journal::resume(&self.journal()).map_err(|error| self.unusable(error))
    }

    /// Reads the journal.
    pub fn recorded(&self) -> anyhow::Result<Recorded> {
        Recorded::read(&self.journal()).map_err(|error| self.unusable(error))
    }

    /// Where the journal is.
    pub fn journal(&self) -> PathBuf {
        self.path.join("evals.jsonl")
    }

    /// Keeps a copy of the graph that is searched, where that is none of those checked in.
    pub fn keep_graph(&self, graph: &Path) -> anyhow::Result<()> {
        let text = fs::read_to_string(graph).with_context(|| graph.display().to_string())?;
        files::write(&self.path.join(GRAPH), &text)
    }

    /// The copy of the graph, if there is one.
    pub fn graph(&self) -> Option<PathBuf> {
        Some(self.path.join(GRAPH)).filter(|path| path.exists())
    }

    /// Writes the recipes of a front, numbered from 1 on, in place of those of any before.
    pub fn write_front<'a>(
        &self,
        recipes: impl IntoIterator<Item = &'a Recipe>,
    ) -> anyhow::Result<()> {
        let front = self.path.join("front");
        if front.exists() {
            fs::remove_dir_all(&front).with_context(|| front.display().to_string())?;
        }
        for (number, recipe) in (1..).zip(recipes) {
            files::write(&front.join(format!("{number}.json")), &recipe.to_json())?;
        }
        Ok(())
    }

    fn unusable(&self, error: JournalError) -> anyhow::Error {
        bad_input(format!("{}/evals.jsonl: {error}", self.display()))
    }

    /// Writes `run.json`.
    pub fn write_run(&self, run: &Run) -> anyhow::Result<()> {
        files::write_json(&self.path.join("run.json"), run)
    }

    /// Writes the champion, as a recipe and as code to read.
    pub fn write_champion(&self, recipe: &Recipe) -> anyhow::Result<()> {
        files::write(&self.path.join("champion.rs"), &champion_source(recipe))?;
        files::write(&self.path.join("champion.json"), &recipe.to_json())
    }
}

/// A champion as code to read.
pub fn champion_source(recipe: &Recipe) -> String {
    let name = recipe.name.identifier();
    let kernel = print_kernel(&recipe.program, &recipe.scene, recipe.isas[0], &name, "");
    source_to_read(kernel)
}

/// A kernel as code to read.
pub fn source_to_read(kernel: Kernel) -> String {
    // Without rustfmt the lines are long, and nothing else is lost.
    rustfmt(&kernel.source).unwrap_or(kernel.source)
}

//! The run directory: `run.json`, `evals.jsonl`, `champion.rs` and `champion.json`.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context;
use emit::{Name, Recipe, print_kernel, rustfmt};
use evolve::{Journal, Settings};
use measure::{FLAGS, Machine, WorkloadSpec};
use serde::Serialize;

use crate::arena::Arena;
use crate::failure::bad_input;
use crate::files;
use crate::shootout::Standing;

/// A run directory that is this run's own.
pub struct RunDirectory {
    path: PathBuf,
}

/// What `run.json` says: all that the run's figures depend on, and how it ended.
#[derive(Serialize)]
pub struct Run<'a> {
    /// The machine.
    pub machine: Machine,
    /// `rustc --version`.
    pub rustc: &'a str,
    /// What candidates are compiled with.
    pub flags: &'static [&'static str],
    /// The command line, after `cargo xtask`.
    pub arguments: Vec<String>,
    /// `--strategy`.
    pub strategy: &'a str,
    /// Settings, with the seed.
    pub settings: Settings,
    /// What kernels are timed on.
    pub workload: WorkloadSpec,
    /// Hash of the graph.
    pub graph: Name,
    /// The reference against a copy of itself: relative uncertainty of one evaluation.
    pub noise_floor: Option<f64>,
    /// Individuals evaluated; none before the end.
    pub evaluations: Option<u64>,
    /// Different sources built.
    pub distinct: Option<u64>,
    /// Why the search ended.
    pub stopped: Option<String>,
    /// The shoot-out at the end.
    pub shootout: Option<Vec<Standing>>,
}

impl<'a> Run<'a> {
    /// A run that begins.
    pub fn begin(
        rustc: &'a str,
        strategy: &'a str,
        settings: Settings,
        arena: &Arena,
        graph: Name,
    ) -> Run<'a> {
        Run {
            machine: Machine::here(),
            rustc,
            flags: FLAGS,
            arguments: std::env::args().skip(1).collect(),
            strategy,
            settings,
            workload: arena.workload(),
            graph,
            noise_floor: None,
            evaluations: None,
            distinct: None,
            stopped: None,
            shootout: None,
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
                let Arena { scene, isa, regime } = arena;
                let stem = format!("runs/{}-{isa}-{regime}-seed{seed}", scene.name);
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

    /// Where it is, from here if that is shorter.
    pub fn display(&self) -> String {
        let here = std::env::current_dir().unwrap_or_default();
        self.path
            .strip_prefix(here)
            .unwrap_or(&self.path)
            .display()
            .to_string()
    }

    /// Begins the journal.
    pub fn journal(&self) -> anyhow::Result<Journal> {
        let path = self.path.join("evals.jsonl");
        Journal::create(&path).with_context(|| format!("cannot write {}", path.display()))
    }

    /// Writes `run.json`.
    pub fn write_run(&self, run: &Run<'_>) -> anyhow::Result<()> {
        files::write_json(&self.path.join("run.json"), run)
    }

    /// Writes the champion, as a recipe and as code to read.
    pub fn write_champion(&self, recipe: &Recipe) -> anyhow::Result<()> {
        let name = recipe.name.identifier();
        let (rates, regime) = (recipe.scene.rates(), recipe.regime);
        let kernel = print_kernel(&recipe.program, rates, regime, recipe.isas[0], &name, "");
        // Without rustfmt the lines are long, and nothing else is lost.
        let source = rustfmt(&kernel.source).unwrap_or(kernel.source);
        files::write(&self.path.join("champion.rs"), &source)?;
        files::write(&self.path.join("champion.json"), &recipe.to_json())
    }
}

//! One trial of the experiment: a search in a run directory of its own, and what is known of it afterwards.

use std::path::Path;

use evolve::Settings;
use measure::Rustc;
use program::Program;
use serde::Deserialize;

use crate::arena::Arena;
use crate::benches::Benches;
use crate::evolve::{Conditions, Run, RunDirectory, Session, cores};
use crate::failure::bad_input;
use crate::files;
use crate::history::History;

/// A search that is to be made.
#[derive(Clone, PartialEq)]
pub struct Plan {
    /// Its numbers, with strategy and seed.
    pub settings: Settings,
}

/// A search that was made.
pub struct Trial {
    /// Its numbers, with strategy and seed.
    pub settings: Settings,
    /// How many were evaluated.
    pub evaluations: u64,
    /// How many different sources there were among them.
    pub distinct: u64,
    /// How many drafts were no candidates, since their source had been tried.
    pub redrawn: u64,
    /// How many sources were not timed, since they were the machine code of one that had been.
    pub twins: u64,
    /// How long it took; not known of a search that was resumed.
    pub seconds: Option<f64>,
    /// What the champion's fitness was in the search.
    pub fitness: f64,
    /// The champion's name: a hash of its source.
    pub champion: String,
    /// The champion.
    pub program: Program,
    /// The fitness of the best after so many evaluations, wherever that rises. It is what was known of them in the
    /// end: a first timing that was lucky is none.
    pub course: Vec<(u64, f64)>,
}

/// How a run ended, as its `run.json` says.
#[derive(Deserialize)]
struct End {
    evaluations: Option<u64>,
    distinct: Option<u64>,
    redrawn: Option<u64>,
    twins: Option<u64>,
    seconds: Option<f64>,
}

impl Plan {
    /// The name of its directory.
    pub fn name(&self) -> String {
        let Settings {
            strategy,
            islands,
            seed,
            ..
        } = self.settings;
        match islands {
            1 => format!("{strategy}-{seed}"),
            _ => format!("{strategy}-on-{islands}-{seed}"),
        }
    }

    /// Makes the search, or goes on with one that was ended.
    pub fn run(
        &self,
        path: &Path,
        arena: &Arena,
        rustc: &Rustc,
        bench: &mut Benches,
    ) -> anyhow::Result<()> {
        let (graph, hash) = arena.graph_to_search(None)?;
        let cores = cores::timing(self.settings.islands);
        let conditions = Conditions::here(arena, rustc, self.settings, cores, hash);
        let begun = RunDirectory::open(path);
        let (directory, journal, recorded) = if begun.journal().exists() {
            let (journal, recorded) = begun.resume()?;
            let then = Conditions::of(&recorded, &begun.journal())?;
            self.check(&then, arena, path)?;
            then.check_against(&conditions)?;
            (begun, journal, Some(recorded))
        } else {
            let directory = RunDirectory::create(Some(path), arena, self.settings.seed)?;
            let journal = directory.begin(&conditions)?;
            (directory, journal, None)
        };
        let session = Session {
            graph,
            rustc: rustc.clone(),
            run: Run::new(conditions),
            directory,
            budget: None,
            json: false,
        };
        session.trial(bench, journal, recorded)
    }

    /// Refuses a directory with a search of something else.
    fn check(&self, then: &Conditions, arena: &Arena, path: &Path) -> anyhow::Result<()> {
        if then.settings != self.settings || then.arena() != *arena {
            return Err(bad_input(format!(
                "{} has a search with other settings or of another scene; name another directory with --out",
                path.display()
            )));
        }
        Ok(())
    }
}

impl Trial {
    /// What is known of a search that has come to its end; nothing if it has not.
    pub fn read(path: &Path, arena: &Arena, plan: &Plan) -> anyhow::Result<Option<Trial>> {
        let directory = RunDirectory::open(path);
        if !directory.journal().exists() {
            return Ok(None);
        }
        let recorded = directory.recorded()?;
        let conditions = Conditions::of(&recorded, &directory.journal())?;
        plan.check(&conditions, arena, path)?;
        let Some(text) = std::fs::read_to_string(path.join("run.json")).ok() else {
            return Ok(None);
        };
        let end: End = serde_json::from_str(&text)
            .map_err(|error| bad_input(format!("{}/run.json: {error}", path.display())))?;
        let (Some(evaluations), true) = (end.evaluations, path.join("champion.json").exists())
        else {
            return Ok(None);
        };
        if evaluations < plan.settings.evaluations() {
            return Ok(None);
        }
        let champion = files::read_champion(path)?;
        let kernels = arena.kernels(&champion.program);
        let source = crate::evolve::source(&kernels);
        let history = History::of(&recorded.lines);
        Ok(Some(Trial {
            settings: conditions.settings,
            evaluations,
            distinct: end.distinct.unwrap_or(0),
            redrawn: end.redrawn.unwrap_or(0),
            twins: end.twins.unwrap_or(0),
            seconds: end.seconds,
            fitness: history
                .first_of(&source)
                .and_then(|one| one.fitness)
                .unwrap_or(0.0),
            champion: source,
            program: champion.program,
            course: history.rises(),
        }))
    }
}

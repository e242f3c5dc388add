//! One trial of the experiment: a search in a run directory of its own, and what is known of it afterwards.

use std::collections::HashMap;
use std::path::Path;

use evolve::{Evaluation, Line, Recorded, Settings};
use measure::Rustc;
use program::Program;
use serde::Deserialize;

use crate::arena::Arena;
use crate::benches::Benches;
use crate::evolve::{Conditions, Run, RunDirectory, Session};
use crate::failure::bad_input;
use crate::files;

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
        format!("{}-{}", self.settings.strategy, self.settings.seed)
    }

    /// Makes the search, or goes on with one that was ended.
    pub fn run(
        &self,
        path: &Path,
        arena: &Arena,
        rustc: &Rustc,
        cores: usize,
        bench: &mut Benches,
    ) -> anyhow::Result<()> {
        let path_of_graph = files::graph_path(arena.graph());
        let (graph, hash) = files::read_graph(&path_of_graph)?;
        let graph = graph.restricted(&arena.rules()).map_err(|_| {
            let (scene, path) = (&arena.scene.name, path_of_graph.display());
            bad_input(format!(
                "the scene {scene} rules out every program of {path}"
            ))
        })?;
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
        let (course, known) = course(&recorded);
        Ok(Some(Trial {
            settings: conditions.settings,
            evaluations,
            distinct: end.distinct.unwrap_or(0),
            redrawn: end.redrawn.unwrap_or(0),
            twins: end.twins.unwrap_or(0),
            seconds: end.seconds,
            fitness: known.get(&source).copied().unwrap_or(0.0),
            champion: source,
            program: champion.program,
            course,
        }))
    }
}

/// How the best rose, and the fitness of every source, by what was known of it in the end.
fn course(recorded: &Recorded) -> (Vec<(u64, f64)>, HashMap<String, f64>) {
    let mut known: HashMap<String, f64> = HashMap::new();
    let mut tried: Vec<(u64, &str)> = Vec::new();
    let fitness = |evaluation: &Evaluation| evaluation.fitness.unwrap_or(0.0);
    for line in &recorded.lines {
        match line {
            Line::New {
                candidate,
                evaluation,
            } => {
                tried.push((candidate.id + 1, &candidate.source));
                known.insert(candidate.source.clone(), fitness(evaluation));
            }
            Line::Again {
                source, evaluation, ..
            } => {
                known.insert(source.clone(), fitness(evaluation));
            }
            Line::Run { .. } | Line::Duplicate { .. } => {}
        }
    }
    let mut best = 0.0;
    let mut course = Vec::new();
    for (evaluations, source) in tried {
        let fitness = known[source];
        if fitness > best {
            best = fitness;
            course.push((evaluations, fitness));
        }
    }
    (course, known)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str) -> Line {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn the_best_rises_by_what_was_known_in_the_end() {
        let new = |id: u64, source: &str, fitness: f64| {
            line(&format!(
                r#"{{"line":"new","id":{id},"generation":0,"operator":"random","source":"{source}",
                    "fitness":{fitness},"uncertainty":0.0,"details":null}}"#
            ))
        };
        let again = line(
            r#"{"line":"again","id":1,"generation":1,"source":"b","fitness":1.1,"uncertainty":0.0,
                "details":null}"#,
        );
        let lines = [
            new(0, "a", 1.0),
            new(1, "b", 9.0),
            new(2, "c", 1.05),
            new(3, "d", 1.2),
            again,
        ];
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("evals.jsonl");
        let mut journal = evolve::Journal::create(&path, serde_json::Value::Null).unwrap();
        journal.append(&lines).unwrap();
        let (course, known) = course(&Recorded::read(&path).unwrap());
        assert_eq!(course, [(1, 1.0), (2, 1.1), (4, 1.2)]);
        assert_eq!(known["b"], 1.1);
    }
}

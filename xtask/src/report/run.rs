//! The page of one search run: what it searched, how it went, where its champion comes from and what that is worth.
//!
//! ```text
//! evals.jsonl ─► history ─┬─► course, ancestry, reference,     ─┐
//!       │                 │   noise, losses                     │
//!       └─► replayed (genomes, programs) ─► survivors, worth ──┼─► RunPage ─► JSON
//! run.json ─► ended (standings), champion.json ─► kernel ──────┘       view ─► HTML
//! ```

mod ended;
mod kernel;
mod losses;
mod noise;
mod reference;
mod replayed;
mod survivors;
mod view;
mod worth;

use std::path::Path;

use evolve::{Recorded, Settings};
use measure::{Interrupt, Machine, Rustc};
use program::{Graph, Program};
use serde::Serialize;

use self::ended::{Ended, Standing};
use self::kernel::Listing;
use self::losses::Losses;
use self::noise::Noise;
use self::reference::Reference;
use self::replayed::Replayed;
use self::survivors::Survivors;
use self::worth::Worth;
use crate::evolve::{Conditions, RunDirectory, source};
use crate::failure::bad_input;
use crate::files;
use crate::history::History;
use crate::history::ancestry::{self, Step};
use crate::history::course::Course;
use crate::progress::with_spinner;
pub use view::html;

/// What the page is made of.
#[derive(Serialize)]
pub struct RunPage {
    /// The run's directory.
    pub run: String,
    /// What the run depends on.
    pub conditions: Conditions,
    /// Why it ended; none if it was interrupted.
    pub stopped: Option<String>,
    /// How long the search took.
    pub seconds: Option<f64>,
    /// What differs between the recorded machine and this one; none if nothing does.
    pub elsewhere: Option<String>,
    /// Who won.
    pub champion: Known<Champion>,
    /// How the search went.
    pub course: Course,
    /// Where the champion comes from.
    pub ancestry: Known<Vec<Step>>,
    /// Which choices survived.
    pub survivors: Known<Survivors>,
    /// What the champion's are worth.
    pub worth: Known<Worth>,
    /// How fast the reference was.
    pub reference: Known<Reference>,
    /// Relative uncertainty of an evaluation of the reference against itself.
    pub noise_floor: Option<f64>,
    /// How far repeated timings are apart.
    pub noise: Known<Noise>,
    /// Duplicates and failures.
    pub losses: Losses,
    /// The champion as code.
    pub listing: Known<Listing>,
    /// The ranked table at the end.
    pub standings: Known<Vec<Standing>>,
}

/// Something that may be missing.
#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Known<T> {
    /// It is there.
    Is(T),
    /// It is not: a sentence says why.
    Missing(String),
}

impl<T> Known<T> {
    fn or(value: Option<T>, sentence: &str) -> Known<T> {
        value.map_or_else(|| Known::Missing(sentence.into()), Known::Is)
    }

    fn is(&self) -> Option<&T> {
        match self {
            Known::Is(value) => Some(value),
            Known::Missing(_) => None,
        }
    }
}

/// Who won.
#[derive(Clone, Debug, Serialize)]
pub struct Champion {
    /// The number of the first candidate of its source; none if the journal has no such source.
    pub id: Option<u64>,
    /// Speed as a multiple of Möller-Trumbore's.
    pub ratio: f64,
    /// The relative uncertainty of that; none if it is not known.
    pub uncertainty: Option<f64>,
    /// Whether the speed is that of the shoot-out, or of the search, which is a lucky one.
    pub by_shootout: bool,
    /// Whether it was the fittest when the run was interrupted, and won nothing.
    pub is_provisional: bool,
}

/// A run that was read.
struct Read {
    conditions: Conditions,
    history: History,
    ended: Ended,
    /// The graph that was searched, or why it is not known.
    graph: Result<Graph, String>,
    replayed: Result<Replayed, String>,
    /// The champion and its program.
    champion: Option<(Champion, Program)>,
}

impl RunPage {
    /// Reads a run, and times what its champion's choices are worth if that is asked for.
    pub fn new(path: &Path, times: bool, interrupt: &Interrupt) -> anyhow::Result<RunPage> {
        let directory = RunDirectory::open(path);
        if !directory.journal().is_file() {
            let run = path.display();
            return Err(bad_input(format!(
                "{run} is no run directory: it has no evals.jsonl; name one that `cargo xtask evolve` made"
            )));
        }
        let recorded = directory.recorded()?;
        let conditions = Conditions::of(&recorded, &directory.journal())?;
        let read = Read::new(path, conditions, recorded)?;
        let rustc = Rustc::of_this_build().map_err(|error| error.to_string());
        let elsewhere = elsewhere(&read.conditions, rustc.as_ref().ok());
        let worth = match times {
            true => read.worth(rustc.as_ref(), interrupt)?,
            false => {
                Known::Missing("Nothing was timed for this page, as --no-timing asks for.".into())
            }
        };
        let replayed = read.replayed.as_ref();
        let champion = read.champion.as_ref().map(|(champion, _)| champion.clone());
        let arena = read.conditions.arena();
        let listing = read.champion.as_ref();
        let listing = listing.map(|(_, program)| Listing::of(program, &arena, rustc.as_ref().ok()));
        let redrawn = read.ended.redrawn.or(replayed.ok().map(|it| it.redrawn));
        Ok(RunPage {
            run: directory.display(),
            elsewhere,
            course: Course::of(&read.history),
            ancestry: read.ancestry(),
            survivors: read.survivors(),
            worth,
            reference: Known::or(
                Reference::of(&read.history, &read.ended),
                "Nothing was timed.",
            ),
            noise_floor: read.ended.noise_floor,
            noise: Known::or(Noise::of(&read.history), "Nobody was timed twice."),
            losses: Losses::of(&read.history, redrawn, read.ended.twins),
            standings: Known::or(
                read.ended.standings(),
                "There was no shoot-out: the run was interrupted before it, or was a trial of compare-strategies, which \
                 has none.",
            ),
            champion: Known::or(champion, NOBODY),
            listing: Known::or(listing, NOBODY),
            stopped: read.ended.stopped,
            seconds: read.ended.seconds,
            conditions: read.conditions,
        })
    }
}

const NOBODY: &str =
    "There is no champion: no candidate was timed, or the programs of the run are not known.";

const NOT_IN_JOURNAL: &str = "The champion's source is none of the recorded ones: what is emitted for a program has changed since \
     the run.";

impl Read {
    fn new(path: &Path, conditions: Conditions, recorded: Recorded) -> anyhow::Result<Read> {
        let history = History::of(&recorded.lines);
        let ended = Ended::read(path)?;
        let graph = graph(&conditions, RunDirectory::open(path).graph().as_deref())?;
        // A run that went on with another limit has that in the file alone.
        let settings = Settings {
            limit: ended
                .settings
                .map_or(conditions.settings.limit, |it| it.limit),
            ..conditions.settings
        };
        let arena = conditions.arena();
        let replayed = match &graph {
            Ok(graph) => with_spinner("going through the run again", || {
                Replayed::new(graph, &arena, settings, recorded, &history)
            }),
            Err(sentence) => Err(sentence.clone()),
        };
        let mut read = Read {
            conditions,
            history,
            ended,
            graph,
            replayed,
            champion: None,
        };
        read.champion = read.champion(path)?;
        Ok(read)
    }

    /// The champion of a file or, if there is none, the fittest so far.
    fn champion(&self, path: &Path) -> anyhow::Result<Option<(Champion, Program)>> {
        let is_provisional = !path.join("champion.json").exists();
        let (program, id, bred) = if is_provisional {
            let fittest = self.history.fittest();
            let replayed = self.replayed.as_ref().ok();
            let known = fittest.and_then(|one| replayed?.candidate(one.id));
            match known {
                Some(candidate) => (candidate.program.clone(), Some(candidate.id), None),
                None => return Ok(None),
            }
        } else {
            let recipe = files::read_champion(path)?;
            let source = source(&self.conditions.arena().kernels(&recipe.program));
            let id = self.history.first_of(&source).map(|one| one.id);
            let bred = recipe.provenance.map(|provenance| provenance.ratio);
            (recipe.program, id, bred)
        };
        let standing = self.standing(id);
        let fitness = id.and_then(|id| self.history.find(id)?.fitness);
        let ratio = standing.as_ref().map(|one| one.ratio);
        let Some(ratio) = ratio.or(fitness).or(bred) else {
            return Ok(None);
        };
        let champion = Champion {
            id,
            ratio,
            uncertainty: standing.as_ref().map(|one| one.uncertainty),
            by_shootout: standing.is_some(),
            is_provisional,
        };
        Ok(Some((champion, program)))
    }

    /// The champion's place in the table at the end. In that of a front it has its number for a name.
    fn standing(&self, id: Option<u64>) -> Option<Standing> {
        let mut standings = self.ended.standings()?.into_iter();
        let is_it = |one: &Standing| {
            one.kernel == "champion" || one.candidate.is_some() && one.candidate == id
        };
        standings.find(is_it)
    }

    fn id(&self) -> Result<u64, &'static str> {
        let (champion, _) = self.champion.as_ref().ok_or(NOBODY)?;
        champion.id.ok_or(NOT_IN_JOURNAL)
    }

    fn ancestry(&self) -> Known<Vec<Step>> {
        match self.id() {
            Ok(id) => {
                let replayed = self.replayed.as_ref().ok();
                Known::Is(ancestry::line(&self.history, id, |id| replayed?.traits(id)))
            }
            Err(sentence) => Known::Missing(sentence.into()),
        }
    }

    fn survivors(&self) -> Known<Survivors> {
        match &self.replayed {
            Ok(replayed) => {
                let champion = self.id().ok().and_then(|id| replayed.traits(id));
                let traits = |id| replayed.traits(id);
                Known::Is(Survivors::of(&replayed.generations, champion, traits))
            }
            Err(sentence) => Known::Missing(sentence.clone()),
        }
    }

    fn worth(
        &self,
        rustc: Result<&Rustc, &String>,
        interrupt: &Interrupt,
    ) -> anyhow::Result<Known<Worth>> {
        let arena = self.conditions.arena();
        let ready = || -> Result<_, String> {
            let graph = self.graph.as_ref().map_err(String::clone)?;
            let replayed = self.replayed.as_ref().map_err(String::clone)?;
            let genome = &replayed.candidate(self.id()?).ok_or(NOT_IN_JOURNAL)?.genome;
            if let Some(isa) = arena.isas.iter().find(|isa| !isa.is_available()) {
                return Err(format!(
                    "Nothing could be timed here: this processor has no {isa}."
                ));
            }
            let rustc = rustc.map_err(|error| format!("Nothing could be timed here: {error}."))?;
            Ok((graph, genome, rustc))
        };
        Ok(match ready() {
            Ok((graph, genome, rustc)) => {
                Known::Is(Worth::of(graph, genome, &arena, rustc, interrupt)?)
            }
            Err(sentence) => Known::Missing(sentence),
        })
    }
}

/// What the scene leaves of the graph that was kept, or of the checked-in one, if that is what was searched.
fn graph(conditions: &Conditions, kept: Option<&Path>) -> anyhow::Result<Result<Graph, String>> {
    let (graph, hash) = conditions.arena().graph_to_search(kept)?;
    Ok(match hash == conditions.graph {
        true => Ok(graph),
        false => Err(format!(
            "The run's programs are not known: it searched the graph {}, and the one at hand for this scene is {hash}.",
            conditions.graph
        )),
    })
}

/// What of the machine, the system and the compiler is other than it was.
fn elsewhere(then: &Conditions, rustc: Option<&Rustc>) -> Option<String> {
    let (was, is) = (&then.machine, Machine::here());
    let mut differences = Vec::new();
    for (was, is) in [(&was.cpu, &is.cpu), (&was.system, &is.system)] {
        if was != is {
            differences.push(format!("{was} then, {is} now"));
        }
    }
    if was.cores != is.cores {
        differences.push(format!("{} cores then, {} now", was.cores, is.cores));
    }
    if let Some(now) = rustc.map(Rustc::version).filter(|now| *now != then.rustc) {
        differences.push(format!("{} then, {now} now", then.rustc));
    }
    (!differences.is_empty()).then(|| differences.join("; "))
}

//! `cargo xtask evolve`: the search, from random genomes to a ranked table.

mod champion;
mod conditions;
pub mod cores;
mod costs;
mod course;
mod directory;
mod ending;
mod evaluator;
mod front;
mod progress;
mod reference;
mod replay;
mod session;
mod story;

use std::path::{Path, PathBuf};
use std::time::Duration;

use emit::Name;
use evolve::{Objective, Settings, Strategy};
use measure::Rustc;
use program::Graph;

use crate::arena::{Arena, ArenaFlags};
use crate::failure::bad_input;
use crate::progress::say;
pub use conditions::Conditions;
pub use course::ROUNDS;
pub use directory::{Run, RunDirectory, source_to_read};
pub use evaluator::source;
pub use progress::cause;
use replay::replay;
pub use replay::search_again;
pub use session::Session;

/// Breeds a kernel, and times it beside its rivals.
///
/// A candidate's fitness is its speed as a multiple of Möller-Trumbore's packet kernel, timed in
/// turn with it; its answers are checked before and after. The run is kept in a directory of its
/// own, and whatever ends it, `--resume` goes on from there. Ctrl-C keeps the best so far.
///
/// With `--objective pareto` it is after all kernels that no other one beats in speed, in the error of t and in
/// what leaks at edges and vertices at once, and ends with a table of them.
#[derive(clap::Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "Examples:\n  \
    cargo xtask evolve\n  \
    cargo xtask evolve --scene common-origin --seed 7\n  \
    cargo xtask evolve --budget 30\n  \
    cargo xtask evolve --objective pareto --isa avx2\n  \
    cargo xtask evolve --resume runs/packet-sse2-shrinking-seed1"
)]
pub struct Evolve {
    #[command(flatten)]
    arena: ArenaFlags,

    /// How to search: guided, a population with a model of speed that says who is worth a timing; memetic, the
    /// same without it; hill, neighbours of the best; random; or paper, the genetic algorithm of Kensler and
    /// Shirley [default: guided; paper for a front]
    #[arg(long, value_name = "NAME")]
    strategy: Option<String>,

    /// What to search for: speed; or pareto, the front of speed, error and leaks [default: speed]
    #[arg(long, value_name = "NAME", value_parser = objective)]
    objective: Option<Objective>,

    /// Individuals alive at a time [default: 50; 100 for a front]
    #[arg(long, value_name = "N")]
    population: Option<usize>,

    /// Generations after the first, random one [default: 100; 60 for a front]
    #[arg(long, value_name = "N")]
    generations: Option<usize>,

    /// How many of the best survive a generation unchanged [default: 20; 50 for a front]
    #[arg(long, value_name = "N")]
    elite: Option<usize>,

    /// Populations, which have a generation in turn: while one's is timed, the next one's is compiled [default: 1]
    #[arg(long, value_name = "N")]
    islands: Option<usize>,

    /// Seed of everything random in the search [default: 1]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,

    /// Stop after so many evaluations
    #[arg(long, value_name = "N")]
    evaluations: Option<u64>,

    /// Stop the search after so many seconds; the table at the end takes some more
    #[arg(long, value_name = "SECONDS")]
    budget: Option<f64>,

    /// How many cores time candidates at once [default: all of the faster kind, or with islands half of them; the
    /// others compile]
    #[arg(long, value_name = "N")]
    cores: Option<usize>,

    /// The graph to search [default: the checked-in one that fits the scene]; a run keeps a copy of it
    #[arg(long, value_name = "FILE")]
    graph: Option<PathBuf>,

    /// Where to keep the run [default: a new directory below runs]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Go on with the run in this directory, with its own flags
    #[arg(long, value_name = "DIR", conflicts_with_all = [
        "scene", "isa", "strategy", "objective", "population", "generations", "elite", "islands", "seed", "out",
        "cores", "grouping", "origin", "query", "culling", "outputs", "range", "stored", "numeric",
        "watertight", "regime", "bounds",
    ])]
    resume: Option<PathBuf>,

    /// Search with the timings recorded in this directory, and time nothing
    #[arg(long, value_name = "DIR", conflicts_with_all = [
        "scene", "isa", "objective", "budget", "out", "resume", "cores", "grouping", "origin", "query",
        "culling", "outputs", "range", "stored", "numeric", "watertight", "regime", "bounds",
    ])]
    replay: Option<PathBuf>,

    /// Print JSON: an object a generation, and one for the result
    #[arg(long)]
    json: bool,
}

impl Evolve {
    /// Searches, and ends with the table.
    pub fn run(self) -> anyhow::Result<()> {
        let budget = self.budget.map(Duration::try_from_secs_f64).transpose();
        let budget = budget.map_err(|error| bad_input(format!("--budget: {error}")))?;
        match (&self.resume, &self.replay) {
            (Some(directory), _) => self.resume(directory, budget),
            (_, Some(directory)) => self.replay(directory),
            (None, None) => self.begin(budget),
        }
    }

    fn begin(&self, budget: Option<Duration>) -> anyhow::Result<()> {
        let arena = self.arena.arena()?;
        let objective = self.objective.unwrap_or_default();
        if objective == Objective::Pareto {
            arena.check_for_lab()?;
        }
        let settings = self.settings(Settings::usual(objective))?;
        let (graph, graph_hash) = arena.graph_to_search(self.graph.as_deref())?;
        let rustc = Rustc::of_this_build().map_err(bad_input)?;
        let cores = self.cores(settings.islands)?;
        let conditions = Conditions::here(&arena, &rustc, settings, cores, graph_hash);
        let directory = RunDirectory::create(self.out.as_deref(), &arena, settings.seed)?;
        let journal = directory.begin(&conditions)?;
        if let Some(graph) = &self.graph {
            directory.keep_graph(graph)?;
        }
        let run = Run::new(conditions);
        directory.write_run(&run)?;
        let session = Session {
            graph,
            rustc,
            run,
            directory,
            budget,
            json: self.json,
        };
        session.search(journal, None)
    }

    fn resume(&self, path: &Path, budget: Option<Duration>) -> anyhow::Result<()> {
        let directory = RunDirectory::open(path);
        let (journal, recorded) = directory.resume()?;
        let mut conditions = Conditions::of(&recorded, &directory.journal())?;
        let begun_with = conditions.settings.evaluations();
        conditions.settings.limit = self.evaluations.or(conditions.settings.limit);
        let evaluations = conditions.settings.evaluations();
        if evaluations != begun_with && conditions.settings.strategy != Strategy::Paper {
            return Err(bad_input(format!(
                "--evaluations: the run was begun with {begun_with}, not {evaluations}, and what its strategy tries depends \
                 on that; resume it without the flag, or begin a new run"
            )));
        }
        conditions.settings.validate().map_err(bad_input)?;
        let arena = conditions.arena();
        arena.check()?;
        let (graph, graph_hash) = self.graph_of(&directory, &arena)?;
        let rustc = Rustc::of_this_build().map_err(bad_input)?;
        let Conditions {
            settings, cores, ..
        } = conditions;
        let now = Conditions::here(&arena, &rustc, settings, cores, graph_hash);
        conditions.check_against(&now)?;
        if recorded.torn > 0 {
            say(&format!(
                "torn       the last {} bytes of the journal are no whole line, and are dropped",
                recorded.torn
            ));
        }
        say(&format!(
            "resumed    {} evaluations are recorded",
            recorded.candidates()
        ));
        let session = Session {
            graph,
            rustc,
            run: Run::new(conditions),
            directory,
            budget,
            json: self.json,
        };
        session.search(journal, Some(recorded))
    }

    fn replay(&self, path: &Path) -> anyhow::Result<()> {
        let directory = RunDirectory::open(path);
        let recorded = directory.recorded()?;
        let conditions = Conditions::of(&recorded, &directory.journal())?;
        let settings = self.settings(conditions.settings)?;
        let (graph, _) = self.graph_of(&directory, &conditions.arena())?;
        say(&format!(
            "replay     {} evaluations are recorded in {}",
            recorded.candidates(),
            directory.display()
        ));
        replay(&graph, &conditions.arena(), settings, recorded, self.json)
    }

    /// What a run that is there searches: the graph that is asked for, its own, or the checked-in one; and its hash.
    fn graph_of(&self, run: &RunDirectory, arena: &Arena) -> anyhow::Result<(Graph, Name)> {
        let path = self.graph.clone().or_else(|| run.graph());
        arena.graph_to_search(path.as_deref())
    }

    /// How many cores time.
    fn cores(&self, islands: usize) -> anyhow::Result<usize> {
        let most = cores::most();
        match self.cores {
            Some(asked) if asked == 0 || asked > most => Err(bad_input(format!(
                "--cores {asked}: this machine can time on 1 to {most} cores at once"
            ))),
            asked => Ok(asked.unwrap_or_else(|| cores::timing(islands))),
        }
    }

    fn settings(&self, defaults: Settings) -> anyhow::Result<Settings> {
        let settings = Settings {
            strategy: match &self.strategy {
                Some(name) => name.parse().map_err(bad_input)?,
                None => defaults.strategy,
            },
            population: self.population.unwrap_or(defaults.population),
            elite: self.elite.unwrap_or(defaults.elite),
            islands: self.islands.unwrap_or(defaults.islands),
            generations: self.generations.unwrap_or(defaults.generations),
            seed: self.seed.unwrap_or(defaults.seed),
            objective: defaults.objective,
            limit: self.evaluations.or(defaults.limit),
        };
        settings.validate().map_err(bad_input)
    }
}

/// An objective by its name.
fn objective(name: &str) -> Result<Objective, String> {
    let mut all = [Objective::Speed, Objective::Pareto].into_iter();
    let found = all.find(|objective| objective.name() == name);
    found.ok_or_else(|| "known are speed and pareto".into())
}

//! `cargo xtask evolve`: the search, from random genomes to a ranked table.

mod directory;
mod evaluator;
mod progress;

use std::cell::Cell;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::{Duration, Instant};

use emit::{ErrorProfile, Name, Provenance, Recipe};
use evolve::{Individual, Outcome, Settings, Stop, search};
use measure::{Bench, MeasureError, Rustc};
use serde_json::json;

use crate::arena::{Arena, ArenaFlags, REFERENCE, interrupt_on_ctrl_c, with_spinner};
use crate::failure::{Interrupted, bad_input};
use crate::files;
use crate::promote::CHAMPION_P99_ERROR;
use crate::shootout::{Contestant, Standing, print_table, shootout};
use directory::{Run, RunDirectory};
use evaluator::{Evaluator, Totals};
use progress::{Progress, short};

/// How many of the fittest meet in the shoot-out. The best of the search was timed in a hurry,
/// and owes some of its figure to luck.
const FINALISTS: usize = 8;

/// The packets that the hit fraction is worked out for.
const SAMPLED_PACKETS: usize = 40;

/// Breeds a kernel by the genetic algorithm, and times it beside its rivals.
///
/// A candidate's fitness is its speed as a multiple of Möller-Trumbore's packet kernel, timed in
/// turn with it; its answers are checked before and after. The run is kept in a directory of its
/// own. Ctrl-C ends it and keeps the best so far.
#[derive(clap::Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "Examples:\n  \
    cargo xtask evolve\n  \
    cargo xtask evolve --scene common-origin --seed 7\n  \
    cargo xtask evolve --population 8 --elite 2 --generations 2"
)]
pub struct Evolve {
    #[command(flatten)]
    arena: ArenaFlags,

    /// How to search: paper, the genetic algorithm of Kensler and Shirley
    #[arg(long, value_name = "NAME", default_value = "paper")]
    strategy: String,

    /// Individuals alive at a time
    #[arg(long, value_name = "N", default_value_t = Settings::default().population)]
    population: usize,

    /// Generations after the first, random one
    #[arg(long, value_name = "N", default_value_t = Settings::default().generations)]
    generations: usize,

    /// How many of the best survive a generation unchanged
    #[arg(long, value_name = "N", default_value_t = Settings::default().elite)]
    elite: usize,

    /// Seed of everything random in the search
    #[arg(long, value_name = "N", default_value_t = Settings::default().seed)]
    seed: u64,

    /// The graph to search
    #[arg(long, value_name = "FILE", default_value_os_t = files::graph_path(), hide_default_value = true)]
    graph: PathBuf,

    /// Where to keep the run [default: a new directory below runs]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print JSON: an object a generation, and one for the result
    #[arg(long)]
    json: bool,
}

impl Evolve {
    /// Searches, and ends with the table.
    pub fn run(self) -> anyhow::Result<()> {
        let arena = self.arena.arena()?;
        let settings = self.settings()?;
        let (graph, graph_hash) = files::read_graph(&self.graph)?;
        let rustc = Rustc::of_this_build().map_err(bad_input)?;
        let directory = RunDirectory::create(self.out.as_deref(), &arena, self.seed)?;
        let mut run = Run::begin(
            rustc.version(),
            &self.strategy,
            settings,
            &arena,
            graph_hash,
        );
        directory.write_run(&run)?;
        let interrupt = interrupt_on_ctrl_c()?;
        let start = Instant::now();

        say(&format!(
            "machine    {}; {}",
            run.machine.cpu,
            rustc.version()
        ));
        say(&format!("run        {}", directory.display()));
        say(&format!("scene      {}", describe(&arena)));
        let mut bench = arena.bench(&rustc, &interrupt)?;
        let floor = with_spinner("timing the reference against itself", || noise(&mut bench))?;
        run.noise_floor = Some(floor);
        say(&format!(
            "noise      a copy of the reference times at 1.00 ±{:.1}%",
            floor * 100.0
        ));

        let spent = Rc::new(Cell::new(Totals::default()));
        let journal = directory.journal()?;
        let mut progress = Progress::new(journal, spent.clone(), settings.generations, self.json);
        let mut evaluator = Evaluator::new(&arena, &mut bench, spent.clone());
        let outcome = search(&graph, settings, &mut evaluator, &mut progress);
        progress.finish();
        let searched = start.elapsed();

        run.evaluations = Some(outcome.evaluations);
        run.distinct = Some(spent.get().bench.sources);
        run.stopped = Some(reason(&outcome.stop));
        say_failures(&progress);
        let finalists = finalists(&outcome);
        let Some(&fittest) = finalists.first() else {
            directory.write_run(&run)?;
            return Err(ended_early(
                outcome.stop,
                "no candidate was timed, so there is no champion",
            ));
        };
        let mut champion = self.recipe(&arena, &run, rustc.number(), fittest);
        directory.write_champion(&champion)?;
        directory.write_run(&run)?;
        if !matches!(outcome.stop, Stop::Done) {
            let ratio = champion.provenance.ratio;
            let kept = format!(
                "the best so far, {ratio:.2}x MT in the search, is kept in {}",
                directory.display()
            );
            return Err(ended_early(outcome.stop, &kept));
        }

        let mut contestants: Vec<Contestant> = arena
            .rivals()
            .filter(|rival| rival.name != REFERENCE)
            .map(|rival| Contestant {
                name: rival.name.to_owned(),
                kernel: arena.rival_kernel(rival),
            })
            .collect();
        contestants.extend((1..).zip(&finalists).map(|(number, finalist)| Contestant {
            name: format!("finalist {number}"),
            kernel: arena.kernel(&finalist.program),
        }));
        let what = format!(
            "the shoot-out: {} kernels, full workload",
            contestants.len() + 1
        );
        let mut standings = with_spinner(&what, || shootout(&mut bench, &contestants))?;
        if let Some((finalist, standing)) = crown(&mut standings, &finalists) {
            champion = self.recipe(&arena, &run, rustc.number(), finalist);
            champion.provenance.ratio = standing.ratio;
            directory.write_champion(&champion)?;
        }
        run.shootout = Some(standings.clone());
        directory.write_run(&run)?;

        if self.json {
            println!(
                "{}",
                json!({ "run": directory.display(), "shootout": standings })
            );
        } else {
            print_table(&standings);
        }
        say_time(start.elapsed(), searched, spent.get(), outcome.evaluations);
        say(&format!(
            "champion   {0}/champion.rs; cargo xtask promote {0}",
            directory.display()
        ));
        Ok(())
    }

    fn settings(&self) -> anyhow::Result<Settings> {
        if self.strategy != "paper" {
            let asked = &self.strategy;
            return Err(bad_input(format!(
                "unknown strategy {asked:?}; known: paper"
            )));
        }
        let settings = Settings {
            population: self.population,
            elite: self.elite,
            generations: self.generations,
            seed: self.seed,
        };
        settings.validate().map_err(bad_input)
    }

    fn recipe(&self, arena: &Arena, run: &Run<'_>, rustc: &str, best: &Individual) -> Recipe {
        let accuracy = &best.evaluation.details["accuracy"];
        let figure = |name: &str| accuracy[name].as_f64().unwrap_or(f64::MAX);
        let small = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        Recipe {
            name: Name::of(&format!("{}-{}", arena.scene.name, arena.regime)),
            scene: arena.scene.clone(),
            regime: arena.regime,
            isas: vec![arena.isa],
            provenance: Provenance {
                search: emit::Search {
                    strategy: Name::of(&self.strategy),
                    population: small(self.population),
                    elite: small(self.elite),
                    generations: small(self.generations),
                    seed: self.seed,
                },
                evaluations: run.evaluations.unwrap_or(0),
                distinct: run.distinct.unwrap_or(0),
                ratio: best.weight(),
                cpu: Name::of(&run.machine.cpu),
                rustc: Name::new(rustc).unwrap_or_else(|_| Name::of(rustc)),
                graph: run.graph.clone(),
            },
            error: ErrorProfile {
                hits: accuracy["hits"].as_u64().unwrap_or(0),
                median: figure("median"),
                p99: figure("p99"),
                max: figure("max"),
            },
            program: best.program.clone(),
        }
    }
}

/// The fittest that are accurate enough for the library. In a small run there may be none; then
/// the fittest of all, which can be looked at but not promoted.
fn finalists<E>(outcome: &Outcome<E>) -> Vec<&Individual> {
    let fittest = outcome.best(outcome.population.len());
    let accurate = |finalist: &&Individual| p99_error(finalist) <= CHAMPION_P99_ERROR;
    let mut finalists: Vec<&Individual> = fittest.iter().copied().filter(accurate).collect();
    if finalists.is_empty() && !fittest.is_empty() {
        say(&format!(
            "accuracy   nobody's t is good to {CHAMPION_P99_ERROR:.0e} at the 99th percentile, so \
             the champion cannot be promoted"
        ));
        finalists = fittest;
    }
    finalists.truncate(FINALISTS);
    finalists
}

/// The p99 of the relative error of an individual's `t`.
fn p99_error(individual: &Individual) -> f64 {
    let p99 = &individual.evaluation.details["accuracy"]["p99"];
    p99.as_f64().unwrap_or(f64::INFINITY)
}

/// Relative uncertainty of an evaluation, from the reference against a copy of itself.
fn noise(bench: &mut Bench) -> Result<f64, MeasureError> {
    let verdicts = bench.measure_together(&[], &Evaluator::plan(None))?;
    let summary = verdicts.first().and_then(|verdict| verdict.summary());
    Ok(summary.map_or(0.0, |summary| summary.uncertainty))
}

/// Names the best finalist the champion.
fn crown<'a>(
    standings: &mut [Standing],
    finalists: &[&'a Individual],
) -> Option<(&'a Individual, Standing)> {
    let best = standings
        .iter_mut()
        .find(|s| s.kernel.starts_with("finalist"))?;
    let number: usize = best.kernel.strip_prefix("finalist ")?.parse().ok()?;
    best.kernel = "champion".into();
    Some((finalists[number - 1], best.clone()))
}

fn describe(arena: &Arena) -> String {
    let workload = arena.workload();
    let generated = workload.generator().generate();
    let hits = scene::hit_fraction(generated.part(0..SAMPLED_PACKETS)) * 100.0;
    format!(
        "{}, {}, {}: {} packets of {} rays, {} triangles, {hits:.0}% hits with t fixed",
        arena.scene.name,
        arena.isa,
        arena.regime,
        workload.packets,
        scene::PACKET_SIZE,
        workload.triangles,
    )
}

fn reason(stop: &Stop<MeasureError>) -> String {
    match stop {
        Stop::Done => "done".into(),
        Stop::NobodyFit => "no candidate has any fitness".into(),
        Stop::Graph(error) => format!("the graph makes a program that is none: {error}"),
        Stop::Evaluation(error) => error.to_string(),
        Stop::Observation(error) => format!("the run cannot be recorded: {error}"),
    }
}

fn ended_early(stop: Stop<MeasureError>, kept: &str) -> anyhow::Error {
    let why = reason(&stop);
    match stop {
        Stop::Evaluation(MeasureError::Interrupted) => {
            anyhow::Error::new(Interrupted).context(kept.to_owned())
        }
        _ => anyhow::anyhow!("{why}; {kept}"),
    }
}

fn say(line: &str) {
    eprintln!("{line}");
}

fn say_failures(progress: &Progress) {
    for (verdict, count, example) in &progress.failures {
        say(&format!(
            "failed     {count} {verdict}, for example {example}"
        ));
    }
}

fn say_time(total: Duration, searched: Duration, totals: Totals, evaluations: u64) {
    let Totals { emit, bench } = totals;
    say(&format!(
        "time       {}: emit {:.1}s, compile {}, check and time {}; {evaluations} evaluations \
         of {} sources, {:.1} a second",
        short(total),
        emit.as_secs_f64(),
        short(bench.compile),
        short(bench.measure),
        bench.sources,
        evaluations as f64 / searched.as_secs_f64(),
    ));
}

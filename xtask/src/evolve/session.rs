//! A search from its first batch to its ranked table, begun or resumed; and replayed ones.

use std::cell::Cell;
use std::rc::Rc;
use std::time::{Duration, Instant};

use evolve::{Journal, Memory, MemoryError, Recorded, Settings, Stop, search};
use measure::{Bench, MeasureError, Rustc};
use program::Graph;
use serde_json::json;

use super::champion::{Finalists, recipe};
use super::course::Course;
use super::directory::{Run, RunDirectory, champion_source};
use super::evaluator::{Evaluator, Nobody, Totals};
use super::progress::{Progress, short};
use crate::arena::{Arena, interrupt_on_ctrl_c, with_spinner};
use crate::failure::{Interrupted, bad_input};
use crate::promote::CHAMPION_P99_ERROR;
use crate::shootout::{print_table, shootout};

/// An uncertainty of the reference against itself that is worth a warning.
const NOISY: f64 = 0.03;

/// A search that is ready to begin, or to go on.
pub struct Session {
    /// What is searched.
    pub graph: Graph,
    /// What candidates are compiled with.
    pub rustc: Rustc,
    /// The run's description.
    pub run: Run,
    /// Where it is kept.
    pub directory: RunDirectory,
    /// Its journal.
    pub journal: Journal,
    /// What the journal has already, if the run goes on.
    pub recorded: Option<Recorded>,
    /// How long it may take.
    pub budget: Option<Duration>,
    /// Whether to print JSON.
    pub json: bool,
}

impl Session {
    /// Searches, lets the finalists meet their rivals, and prints who won.
    pub fn search(self) -> anyhow::Result<()> {
        let Session {
            graph,
            rustc,
            mut run,
            directory,
            journal,
            recorded,
            budget,
            json,
        } = self;
        let start = Instant::now();
        let arena = run.conditions.arena();
        let settings = run.conditions.settings;
        let interrupt = interrupt_on_ctrl_c()?;
        say(&format!(
            "machine    {}; {}",
            run.conditions.machine.cpu, run.conditions.rustc
        ));
        say(&format!("run        {}", directory.display()));
        say(&format!("scene      {}", arena.describe()));
        let mut bench = arena.bench(&rustc, &interrupt)?;
        run.noise_floor = Some(noise(&mut bench)?);

        let spent = Rc::new(Cell::new(Totals::default()));
        let before = recorded.as_ref().map_or(0, Recorded::candidates);
        let deadline = budget.map(|budget| start + budget);
        let mut progress = Progress::new(spent.clone(), settings, before, deadline, json);
        let evaluator = Evaluator::new(&arena, &mut bench, spent.clone());
        let mut memory = match recorded {
            None => Memory::new(evaluator, journal),
            Some(recorded) => Memory::resume(evaluator, journal, recorded),
        };
        let outcome = search(&graph, settings, &mut memory, &mut progress);
        progress.finish();
        let distinct = memory.sources() as u64;
        drop(memory);
        let searched = start.elapsed();
        run.evaluations = Some(outcome.evaluations);
        run.distinct = Some(distinct);
        run.stopped = Some(reason(&outcome.stop));
        progress.say_failures();

        let mut finalists = Finalists::of(&outcome);
        let recipe_of = |run: &Run, champion, ratio| {
            recipe(
                &run.conditions,
                outcome.evaluations,
                distinct,
                champion,
                ratio,
            )
        };
        let Some(&fittest) = finalists.individuals.first() else {
            let kept = directory
                .write_run(&run)
                .map_or_else(|e| format!("; {e:#}"), |()| String::new());
            let nobody = format!("no candidate was timed, so there is no champion{kept}");
            return Err(ended_early(outcome.stop, &nobody));
        };
        let mut champion = recipe_of(&run, fittest, fittest.weight());
        let kept = directory
            .write_champion(&champion)
            .and_then(|()| directory.write_run(&run));
        if !matches!(outcome.stop, Stop::Done | Stop::Enough | Stop::Ended) {
            let ratio = champion.provenance.ratio;
            let best = format!("the best so far, {ratio:.2}x MT in the search,");
            let kept = match kept {
                Ok(()) => format!("{best} is kept in {}", directory.display()),
                Err(_) => {
                    println!("{}", champion_source(&champion));
                    format!("{best} is printed above")
                }
            };
            return Err(ended_early(outcome.stop, &kept));
        }
        if !finalists.accurate {
            say(&format!(
                "accuracy   nobody's t is good to {CHAMPION_P99_ERROR:.0e} at the 99th \
                 percentile, so the champion cannot be promoted"
            ));
        }

        let mut standings = with_spinner("the shoot-out, on the full workload", || {
            finalists.heat(&arena, &mut bench)?;
            let mut contestants = arena.contestants();
            contestants.extend(finalists.contestants(&arena));
            shootout(&mut bench, &contestants)
        })?;
        if let Some((finalist, ratio)) = finalists.crown(&mut standings) {
            champion = recipe_of(&run, finalist, ratio);
        }
        if json {
            println!(
                "{}",
                json!({ "run": directory.display(), "shootout": standings })
            );
        } else {
            print_table(&standings);
        }
        let evaluations = outcome.evaluations - before as u64;
        say_time(
            start.elapsed(),
            searched,
            spent.get(),
            evaluations,
            distinct,
        );
        run.shootout = Some(standings);
        kept?;
        directory.write_champion(&champion)?;
        directory.write_run(&run)?;
        say(&format!(
            "champion   {0}/champion.rs; cargo xtask promote {0}",
            directory.display()
        ));
        Ok(())
    }
}

/// Searches with recorded timings, and says who is the fittest by them.
pub fn replay(
    graph: &Graph,
    arena: &Arena,
    settings: Settings,
    recorded: Recorded,
    json: bool,
) -> anyhow::Result<()> {
    let spent = Rc::new(Cell::new(Totals::default()));
    let mut progress = Progress::new(spent, settings, 0, None, json);
    let mut memory = Memory::replay(Nobody(arena), recorded);
    let outcome = search(graph, settings, &mut memory, &mut progress);
    progress.finish();
    if !json {
        say(&match &outcome.stop {
            Stop::Done => "the whole search was replayed".into(),
            stop => reason(stop),
        });
    }
    let best = outcome.best(1);
    let best = best.first().map(|best| {
        json!({
            "source": best.candidate.source,
            "candidate": best.candidate.id,
            "ratio": best.weight(),
        })
    });
    if json {
        println!(
            "{}",
            json!({
                "evaluations": outcome.evaluations,
                "stopped": reason(&outcome.stop),
                "best": best,
            })
        );
    } else if let Some(best) = best {
        println!(
            "{} evaluations; the best is candidate {}, {:.2}x MT",
            outcome.evaluations,
            best["candidate"],
            best["ratio"].as_f64().unwrap_or(0.0)
        );
    } else {
        println!("no generation was complete");
    }
    Ok(())
}

/// Relative uncertainty of an evaluation, from the reference against a copy of itself.
fn noise(bench: &mut Bench) -> Result<f64, MeasureError> {
    let verdicts = with_spinner("timing the reference against itself", || {
        bench.measure(&[], &Course::noise_plan())
    })?;
    let summary = verdicts.first().and_then(|verdict| verdict.summary());
    let floor = summary.map_or(0.0, |summary| summary.uncertainty);
    say(&format!(
        "noise      a copy of the reference times at 1.00 ±{:.1}%",
        floor * 100.0
    ));
    if floor > NOISY {
        say("noise      that is much: something else is running, and close ratios will be luck");
    }
    Ok(floor)
}

fn reason<E: std::fmt::Display>(stop: &Stop<E>) -> String {
    match stop {
        Stop::Done => "done".into(),
        Stop::Enough => "as many evaluations as asked for".into(),
        Stop::Ended => "its time was over".into(),
        Stop::NobodyFit => "no candidate has any fitness".into(),
        Stop::Graph(error) => format!("the graph makes a program that is none: {error}"),
        Stop::Evaluation(error) => error.to_string(),
    }
}

fn ended_early(stop: Stop<MemoryError<MeasureError>>, kept: &str) -> anyhow::Error {
    let why = reason(&stop);
    match stop {
        Stop::Evaluation(MemoryError::Evaluate(MeasureError::Interrupted)) => {
            anyhow::Error::new(Interrupted).context(kept.to_owned())
        }
        Stop::Evaluation(MemoryError::Changed { .. }) => bad_input(why),
        _ => anyhow::anyhow!("{why}; {kept}"),
    }
}

/// Tells the user something beside the result.
pub fn say(line: &str) {
    eprintln!("{line}");
}

fn say_time(total: Duration, searched: Duration, totals: Totals, evaluations: u64, distinct: u64) {
    let Totals { emit, bench } = totals;
    say(&format!(
        "time       {}: emit {:.1}s, compile {:.1}s, check {:.1}s, time {:.1}s; {evaluations} \
         evaluations, {:.1} a second, {distinct} different sources",
        short(total),
        emit.as_secs_f64(),
        bench.compile.as_secs_f64(),
        bench.check.as_secs_f64(),
        bench.time.as_secs_f64(),
        evaluations as f64 / searched.as_secs_f64(),
    ));
}

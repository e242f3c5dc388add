//! `cargo xtask compare-strategies`: which strategy finds the fastest kernels at equal evaluations.
//!
//! ```text
//! flags ─► trials (a search for every strategy and seed, each in a run directory of its own)
//!      ─► champions, all timed in one batch ─► table, Mann-Whitney tests, plot, JSON
//! ```
//!
//! Trials of one seed follow one another, so that what disturbs the machine disturbs all strategies alike. A
//! trial that is there already is not made again, so an experiment that was ended goes on.

mod method;
mod plot;
mod standings;
mod trial;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use evolve::{Settings, Strategy};
use measure::Rustc;
use serde_json::json;

use crate::arena::{Arena, ArenaFlags, Contestant};
use crate::failure::bad_input;
use crate::files;
use crate::interrupt::interrupt_on_ctrl_c;
use crate::progress::{say, short, with_spinner};
use crate::shootout::shootout;
use method::Method;
use standings::{Comparison, compare};
use trial::{Plan, Trial};

/// Compares search strategies at equal evaluations: every one with every seed, then all champions in one batch.
///
/// A trial's champion is who wins a heat of its five fittest. All champions are timed together on the full workload,
/// in turn with Möller-Trumbore's kernel; the tests between strategies are Mann-Whitney's, on the champions' ratios.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    cargo xtask compare-strategies --seeds 10\n  \
    cargo xtask compare-strategies --strategies guided,guided:2 --seeds 5\n  \
    cargo xtask compare-strategies --evaluations 300 --isa avx2 --regime leaf\n  \
    cargo xtask compare-strategies --strategies paper,guided --seeds 3 --out runs/quick")]
pub struct Compare {
    #[command(flatten)]
    arena: ArenaFlags,

    /// The strategies, with commas, each perhaps with a number of islands, as guided:2 [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    strategies: Vec<String>,

    /// How many seeds, from 1 on
    #[arg(long, value_name = "N", default_value_t = 10)]
    seeds: u64,

    /// Evaluations of every search [default: the paper's 3050]
    #[arg(long, value_name = "N")]
    evaluations: Option<u64>,

    /// Where to keep the experiment; one that is there goes on [default: a directory below runs]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print JSON instead of the tables
    #[arg(long)]
    json: bool,
}

impl Compare {
    /// Runs the experiment, or what is left of it, and says what came of it.
    pub fn run(self) -> anyhow::Result<()> {
        let arena = self.arena.arena()?;
        let plans = self.plans()?;
        let directory = self.directory(&arena);
        let rustc = Rustc::of_this_build().map_err(bad_input)?;
        let interrupt = interrupt_on_ctrl_c()?;
        let mut bench = arena.bench(&rustc, &interrupt)?;
        say(&format!("experiment {}", directory.display()));
        say(&format!("scene      {}", arena.describe()));

        let mut trials: Vec<Trial> = Vec::new();
        let (start, mut made) = (Instant::now(), 0);
        for (place, plan) in plans.iter().enumerate() {
            let path = directory.join(plan.name());
            let known = Trial::read(&path, &arena, plan)?;
            let is_known = known.is_some();
            let trial = match known {
                Some(trial) => trial,
                None => {
                    plan.run(&path, &arena, &rustc, &mut bench)?;
                    made += 1;
                    Trial::read(&path, &arena, plan)?.ok_or_else(|| {
                        anyhow::anyhow!("{}: the trial has not come to its end", path.display())
                    })?
                }
            };
            let left = plans.len() - place - 1;
            let pace = start.elapsed() / made.max(1);
            say_trial(
                &trial,
                is_known,
                pace * left as u32,
                (place + 1, plans.len()),
            );
            trials.push(trial);
        }

        let contestants = contestants(&arena, &trials);
        let what = format!(
            "timing {} champions, of {} trials, in one batch",
            contestants.len(),
            trials.len()
        );
        let standings = with_spinner(&what, || shootout(&mut bench, &contestants))?;
        let comparison = compare(&trials, &standings);
        files::write_json(&directory.join("comparison.json"), &comparison)?;
        let plot = plot::svg(&arena.describe(), &trials)?;
        files::write(&directory.join("best-so-far.svg"), &plot)?;
        self.say_result(&comparison);
        say(&format!(
            "plot       {0}/best-so-far.svg; figures {0}/comparison.json",
            directory.display()
        ));
        Ok(())
    }

    /// Every trial that is asked for: seed by seed.
    fn plans(&self) -> anyhow::Result<Vec<Plan>> {
        if self.seeds == 0 {
            return Err(bad_input(
                "--seeds 0: there is nothing to compare; ask for at least 1",
            ));
        }
        let asked = self.strategies.iter().map(|name| name.parse());
        let mut methods: Vec<Method> = asked.collect::<Result<_, _>>().map_err(bad_input)?;
        if methods.is_empty() {
            methods.extend(Strategy::ALL.map(Method::of));
        }
        let mut plans: Vec<Plan> = Vec::new();
        for seed in 1..=self.seeds {
            for &Method { strategy, islands } in &methods {
                let settings = Settings {
                    strategy,
                    islands,
                    seed,
                    limit: self.evaluations,
                    ..Settings::default()
                };
                let plan = Plan {
                    settings: settings.validate().map_err(bad_input)?,
                };
                if !plans.contains(&plan) {
                    plans.push(plan);
                }
            }
        }
        Ok(plans)
    }

    fn directory(&self, arena: &Arena) -> PathBuf {
        let Arena { scene, isas, .. } = arena;
        let evaluations = Settings {
            limit: self.evaluations,
            ..Settings::default()
        };
        let usual = format!(
            "runs/strategies-{}-{isas}-{}-{}",
            scene.name,
            scene.regime,
            evaluations.evaluations()
        );
        let out = self.out.clone();
        out.unwrap_or_else(|| files::in_repository(usual))
    }

    fn say_result(&self, comparison: &Comparison) {
        match self.json {
            true => println!("{}", json!(comparison)),
            false => comparison.print(),
        }
    }
}

/// The champions, each once: two trials may have found the same kernel.
fn contestants(arena: &Arena, trials: &[Trial]) -> Vec<Contestant> {
    let mut contestants: Vec<Contestant> = Vec::new();
    for trial in trials {
        if contestants.iter().all(|one| one.name != trial.champion) {
            contestants.push(Contestant {
                name: trial.champion.clone(),
                kernels: arena.kernels(&trial.program),
            });
        }
    }
    contestants
}

fn say_trial(trial: &Trial, is_known: bool, left: Duration, (number, of): (usize, usize)) {
    let Trial {
        settings,
        evaluations,
        distinct,
        redrawn,
        fitness,
        seconds,
        ..
    } = trial;
    let took = match (is_known, seconds) {
        (true, _) => "known already".to_owned(),
        (false, Some(seconds)) => format!("{seconds:.0}s, ETA {}", short(left)),
        (false, None) => format!("ETA {}", short(left)),
    };
    say(&format!(
        "trial {number:3}/{of}  {:10} seed {:2}  {evaluations:4} evaluations ({distinct:4} sources, {redrawn:5} redrawn)  \
         {fitness:.2}x MT in the search  {took}",
        Method::in_settings(settings),
        settings.seed,
    ));
}

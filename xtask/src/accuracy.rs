//! `cargo xtask accuracy`: what kernels leak, where their verdicts are wrong, and how far their `t` is off.

pub mod stability;
mod table;

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use measure::{Interrupt, Judged, Look, Machine, MeasureError, Rustc, Verdict};
use serde::Serialize;

use crate::arena::interrupt_on_ctrl_c;
use crate::asked::Asked;
use crate::cases::Case;
use crate::failure::{Interrupted, bad_input};

/// Judges kernels by exact arithmetic where it matters: at shared edges and vertices of closed fans
/// and meshes, at extreme triangles and scales, and with inputs that are not finite.
///
/// The rivals take part, the library's kernels, and the champions of the runs that are named.
/// Whatever reports t alone for closest hits of both sides can be judged.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    cargo xtask accuracy --scene packet\n  \
    cargo xtask accuracy runs/packet-edges-avx2-leaf-seed1\n  \
    cargo xtask accuracy --scene single --isa avx2 --kernel woop --samples 1e7 --json")]
pub struct Accuracy {
    #[command(flatten)]
    asked: Asked,

    /// Rays of each of the 22 cases; kernels for a common origin have a 32nd of them
    #[arg(long, value_name = "N", default_value = "20000", value_parser = samples)]
    samples: u64,

    /// Seed of the cases: what is reported is judged on other rays than what was chosen by
    #[arg(long, value_name = "N", default_value_t = HELD_OUT)]
    seed: u64,

    /// Print JSON: a list with an object for every kernel, and every case in it
    #[arg(long)]
    json: bool,
}

/// The seed that reports have.
const HELD_OUT: u64 = 7;

/// How long a worker may be silent beside what a ray takes.
const PATIENCE: Duration = Duration::from_secs(20);

/// What one ray of each case takes at most, on a busy machine.
const A_RAY: Duration = Duration::from_micros(500);

/// How long a worker may be silent in all.
fn patience(look: Look) -> Duration {
    PATIENCE + A_RAY.mul_f64(look.samples as f64)
}

/// A number of rays, also as 1e7.
fn samples(text: &str) -> Result<u64, String> {
    let number: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    match (1.0..=1e12).contains(&number) {
        true => Ok(number as u64),
        false => Err("give a number from 1 to 1e12".into()),
    }
}

/// A kernel as it was judged.
#[derive(Clone, Debug, Serialize)]
pub struct Profiled {
    /// Its name.
    pub kernel: String,
    /// The instruction set.
    pub isa: String,
    /// What is tested together.
    pub grouping: String,
    /// Where packets' rays start.
    pub origin: String,
    /// What is asked of a ray.
    pub query: String,
    /// What the kernel's arithmetic may be.
    pub numeric: String,
    /// Where the kernel promises to be watertight.
    pub watertight: String,
    /// The regime that it is printed for.
    pub regime: String,
    /// What was found; none if it failed.
    pub judged: Option<Judged>,
    /// What became of it.
    pub verdict: &'static str,
}

impl Accuracy {
    /// Judges them and prints the tables.
    pub fn run(self) -> anyhow::Result<()> {
        let cases = self.asked.cases(false)?;
        if let Some(case) = cases.iter().find(|case| !case.arena.scene.is_plain()) {
            return Err(bad_input(format!(
                "the scene {} asks for more than the t of closest hits of both sides, from 0 on, which is \
                 what can be judged; name another one",
                case.arena.scene.name
            )));
        }
        let interrupt = interrupt_on_ctrl_c()?;
        let look = Look {
            samples: self.samples,
            seed: self.seed,
        };
        let mut profiled = Vec::new();
        let judged = judge(&cases, look, &interrupt, &mut profiled);
        let interrupted = match judged {
            Err(error) if matches!(error.downcast_ref(), Some(MeasureError::Interrupted)) => true,
            judged => {
                judged?;
                false
            }
        };
        if self.json {
            println!("{}", serde_json::to_string_pretty(&profiled)?);
        } else {
            println!("{}", Machine::here().cpu);
            table::print(&profiled);
        }
        match interrupted {
            true => Err(anyhow::Error::new(Interrupted)),
            false => Ok(()),
        }
    }
}

/// Judges all kernels of all cases, a few at a time so that there is progress to see.
fn judge(
    cases: &[Case],
    look: Look,
    interrupt: &Interrupt,
    profiled: &mut Vec<Profiled>,
) -> anyhow::Result<()> {
    let rustc = Rustc::of_this_build()?;
    let kernels: usize = cases
        .iter()
        .map(|case| 1 + case.contestants().count())
        .sum();
    let bar = ProgressBar::new(kernels as u64);
    let style = "{bar:24} {msg}, {elapsed} so far, ETA {eta}";
    bar.set_style(ProgressStyle::with_template(style).expect("a fixed template"));
    if bar.is_hidden() {
        eprintln!("judging {kernels} kernels");
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    let done = judge_with(cases, look, interrupt, &rustc, &bar, profiled);
    bar.finish_and_clear();
    done
}

fn judge_with(
    cases: &[Case],
    look: Look,
    interrupt: &Interrupt,
    rustc: &Rustc,
    bar: &ProgressBar,
    profiled: &mut Vec<Profiled>,
) -> anyhow::Result<()> {
    for case in cases {
        let reference = case.arena.reference()?;
        let all: Vec<_> = [&reference].into_iter().chain(case.contestants()).collect();
        let bench = case.arena.bench_on(
            case.arena.workload(),
            reference.kernels[0].clone(),
            rustc,
            interrupt,
        )?;
        let mut bench = bench.with_patience(patience(look));
        // As many at once as cores have something to do.
        for some in all.chunks(2 * measure::timing_cores().len().max(1)) {
            bar.set_message(format!("judging {case}"));
            let kernels: Vec<_> = some.iter().map(|one| &one.kernels[0]).collect();
            let built = bench.build(&kernels, true)?;
            let judged = bench.judge(&built, look)?;
            for (one, judged) in some.iter().zip(judged) {
                profiled.push(profile(case, &one.name, judged));
            }
            bar.inc(some.len() as u64);
        }
    }
    Ok(())
}

fn profile(case: &Case, name: &str, judged: Result<Judged, Verdict>) -> Profiled {
    let (asked, own) = (&case.arena.scene, case.scene_of(name));
    let (judged, verdict) = match judged {
        Ok(judged) => (Some(judged), "judged"),
        Err(verdict) => (None, verdict.name()),
    };
    Profiled {
        kernel: name.to_owned(),
        isa: case.arena.isas.to_string(),
        grouping: asked.grouping.to_string(),
        origin: asked.origin.to_string(),
        query: asked.query.to_string(),
        numeric: own.numeric.to_string(),
        watertight: own.watertight.to_string(),
        regime: asked.regime.to_string(),
        judged,
        verdict,
    }
}

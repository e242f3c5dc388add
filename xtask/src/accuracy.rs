//! `cargo xtask accuracy`: what kernels leak, where their verdicts are wrong, and how far their `t` is off.

pub mod stability;
mod table;
mod tags;

use std::path::PathBuf;
use std::time::Duration;

use measure::{Bench, Interrupt, Judged, Look, Machine, Rustc};
use serde::Serialize;

use crate::arena::Arena;
use crate::asked::{Asked, Usual};
use crate::cases::{Case, Identity};
use crate::failure::Interrupted;
use crate::interrupt::{interrupt_on_ctrl_c, to_its_end};
use crate::progress;
use tags::Tags;

/// Judges kernels by exact arithmetic where it matters: at shared edges and vertices of closed fans
/// and meshes, at extreme triangles and scales, and with inputs that are not finite.
///
/// The rivals take part, the library's kernels, and the champions of the runs that are named.
/// Whatever finds closest hits of both sides can be judged; with --outputs uv, u and v as well.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    cargo xtask accuracy --scene packet\n  \
    cargo xtask accuracy runs/packet-edges-avx2-leaf-seed1\n  \
    cargo xtask accuracy --scene packet --outputs uv\n  \
    cargo xtask accuracy --scene single --isa avx2 --kernel woop --samples 1e7 --json")]
pub struct Accuracy {
    #[command(flatten)]
    asked: Asked,

    /// Run directories, or recipes; without --scene, only their scenes and regimes are looked at
    #[arg(value_name = "RUN_DIR|RECIPE")]
    champions: Vec<PathBuf>,

    /// The same, as `report` takes them
    #[arg(long, value_name = "RUN_DIR|RECIPE")]
    run: Vec<PathBuf>,

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
pub const HELD_OUT: u64 = 7;

/// How long a worker may be silent beside what a ray takes.
const PATIENCE: Duration = Duration::from_secs(20);

/// What one ray of each case takes at most, on a busy machine.
const A_RAY: Duration = Duration::from_micros(500);

/// A number of rays, also as 1e7.
pub fn samples(text: &str) -> Result<u64, String> {
    let number: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    match (1.0..=1e12).contains(&number) {
        true => Ok(number as u64),
        false => Err("give a number from 1 to 1e12".into()),
    }
}

/// A kernel as it was judged.
#[derive(Clone, Debug, Serialize)]
pub struct Profiled {
    /// Of which kernel, in which case.
    #[serde(flatten)]
    pub of: Identity,
    /// What its program's statements say of it; none if it has no program.
    pub tags: Option<Tags>,
    /// What was found; none if it failed.
    pub judged: Option<Judged>,
    /// What became of it.
    pub verdict: &'static str,
}

impl Accuracy {
    /// Judges them and prints the tables.
    pub fn run(self) -> anyhow::Result<()> {
        let champions = [self.champions, self.run].concat();
        let cases = self.asked.cases(&champions, &Usual::presets(false)?)?;
        check_judgeable(&cases)?;
        let interrupt = interrupt_on_ctrl_c()?;
        let look = Look {
            samples: self.samples,
            seed: self.seed,
        };
        let mut profiled = Vec::new();
        let done = to_its_end(judge(&cases, look, &interrupt, &mut profiled))?;
        if self.json {
            println!("{}", serde_json::to_string_pretty(&profiled)?);
        } else {
            println!("{}", Machine::here().cpu);
            table::print(&profiled);
        }
        match done {
            true => Ok(()),
            false => Err(anyhow::Error::new(Interrupted)),
        }
    }
}

/// Refuses cases that the lab does not know.
pub fn check_judgeable(cases: &[Case]) -> anyhow::Result<()> {
    cases.iter().try_for_each(|case| case.arena.check_for_lab())
}

/// Judges all kernels of all cases, a few at a time so that there is progress to see. Whatever ends it, `profiled`
/// has what was judged.
pub fn judge(
    cases: &[Case],
    look: Look,
    interrupt: &Interrupt,
    profiled: &mut Vec<Profiled>,
) -> anyhow::Result<()> {
    let rustc = Rustc::of_this_build()?;
    let kernels = cases.iter().map(|case| 1 + case.contestants().count());
    let kernels: usize = kernels.sum();
    let bar = progress::bar(kernels, &format!("judging {kernels} kernels"));
    for case in cases {
        bar.set_message(format!("judging {case}"));
        let reference = case.arena.reference()?;
        let all: Vec<_> = [&reference].into_iter().chain(case.contestants()).collect();
        let mut bench = bench(&case.arena, &rustc, interrupt, look)?;
        let fuses = case.arena.isas.iter().all(|isa| isa.fuses());
        // As many at once as cores have something to do.
        for some in all.chunks(2 * measure::timing_cores().len().max(1)) {
            let kernels: Vec<_> = some.iter().map(|one| &one.kernels[0]).collect();
            let built = bench.build(&kernels, true)?;
            let judged = bench.judge(&built, look)?;
            for (one, judged) in some.iter().zip(judged) {
                let (judged, verdict) = match judged {
                    Ok(judged) => (Some(judged), "judged"),
                    Err(verdict) => (None, verdict.name()),
                };
                profiled.push(Profiled {
                    of: case.identity(&one.name),
                    tags: case
                        .program(&one.name)
                        .map(|program| Tags::of(program, fuses)),
                    judged,
                    verdict,
                });
            }
            bar.inc(some.len() as u64);
        }
    }
    bar.finish_and_clear();
    Ok(())
}

/// A bench for an arena of one instruction set that waits for its workers as long as judging takes.
fn bench(arena: &Arena, rustc: &Rustc, interrupt: &Interrupt, look: Look) -> anyhow::Result<Bench> {
    let reference = arena.reference()?.kernels.remove(0);
    let bench = arena.bench_on(arena.workload(), reference, rustc, interrupt)?;
    Ok(bench.with_patience(PATIENCE + A_RAY.mul_f64(look.samples as f64)))
}

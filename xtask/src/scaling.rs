//! `cargo xtask scaling`: what a test costs as the work changes: with more triangles, other packets, more hits,
//! more cores.
//!
//! ```text
//! flags ─► axes, each a few points (a workload, a packet's size, a number of cores)
//!      ─► every kernel timed at every point, in turn with the reference ─► tables, CSV, a plot an axis
//! ```

mod axes;
mod plot;

use std::path::PathBuf;

use emit::Kernel;
use indicatif::ProgressBar;
use measure::{Bench, Built, Deal, Interrupt, Machine, Plan, Rustc, Verdict, median};
use scene::PACKET_SIZE;
use serde::Serialize;

use crate::arena::{Arena, ArenaFlags, Contestant, REFERENCE};
use crate::cases::{self, Case, Champion};
use crate::failure::{Interrupted, bad_input};
use crate::files;
use crate::interrupt::{interrupt_on_ctrl_c, to_its_end};
use crate::progress;
use axes::{Axis, Point};

/// Times kernels as the work changes, and plots it.
///
/// The axes are: triangles, from a hundred to ten million, in caches and out of them; rays of a
/// packet, from a vector to 1024; the share of tests that hit; cores that time at once. Möller and
/// Trumbore's kernel always takes part.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    cargo xtask scaling --isa avx2\n  \
    cargo xtask scaling --regime fixed --kernel havel-herout-divided --axis hits\n  \
    cargo xtask scaling --out plots runs/packet-sse2-shrinking-seed1")]
pub struct Scaling {
    /// Time this rival or kernel of the library; may be given several times [default: the
    /// appendix's, Havel and Herout's and those of the library]
    #[arg(long, value_name = "NAME")]
    kernel: Vec<String>,

    /// Run directories, or recipes, to be timed too
    #[arg(value_name = "RUN_DIR|RECIPE")]
    champions: Vec<PathBuf>,

    /// Only this axis: triangles, rays, hits or cores; may be given several times
    #[arg(long, value_name = "NAME")]
    axis: Vec<String>,

    #[command(flatten)]
    arena: ArenaFlags,

    /// Where to write a plot for each axis, and all figures as scaling.csv
    #[arg(long, value_name = "DIR", default_value = "target/scaling")]
    out: PathBuf,

    /// Print JSON: a list with an object for every kernel at every point
    #[arg(long)]
    json: bool,
}

/// Rivals that are timed if none is asked for.
const USUAL: [&str; 2] = ["kensler-shirley", "havel-herout-divided"];

/// A kernel at a point.
#[derive(Clone, Debug, Serialize)]
pub struct Figure {
    /// The axis.
    pub axis: &'static str,
    /// Where on it.
    pub at: f64,
    /// The kernel's name.
    pub kernel: String,
    /// The instruction set.
    pub isa: String,
    /// What becomes of `t`.
    pub regime: String,
    /// Nanoseconds a test of one ray and one triangle, over all cores that time; none if it failed.
    pub nanoseconds: Option<f64>,
    /// Speed as a multiple of the reference's at this point.
    pub ratio: Option<f64>,
    /// What became of it.
    pub verdict: &'static str,
}

impl Scaling {
    /// Times, prints and plots.
    pub fn run(self) -> anyhow::Result<()> {
        let arena = self.arena.arena()?;
        if arena.isas.len() > 1 {
            return Err(bad_input(
                "a plot is of one instruction set; give one with --isa",
            ));
        }
        let axes = axes::all(&arena);
        let asked =
            |axis: &Axis| self.axis.is_empty() || self.axis.iter().any(|it| it == axis.name);
        let names: Vec<&str> = axes.iter().map(|axis| axis.name).collect();
        if let Some(unknown) = self
            .axis
            .iter()
            .find(|name| !names.contains(&name.as_str()))
        {
            return Err(bad_input(format!(
                "no axis {unknown:?} for this scene; known: {}",
                names.join(", ")
            )));
        }
        let axes: Vec<Axis> = axes.into_iter().filter(asked).collect();
        let contestants = self.contestants(&arena)?;
        let interrupt = interrupt_on_ctrl_c()?;
        let mut figures = Vec::new();
        let done = time(&arena, &axes, &contestants, &interrupt, &mut figures);
        let done = to_its_end(done)?;
        // Of what was not begun there is nothing to see.
        let begun = |axis: &&Axis| figures.iter().any(|one| one.axis == axis.name);
        let begun: Vec<&Axis> = axes.iter().filter(begun).collect();
        self.write(&begun, &figures)?;
        if self.json {
            println!("{}", serde_json::to_string_pretty(&figures)?);
        } else {
            println!("{}", Machine::here().cpu);
            for axis in begun {
                print_table(axis, &figures);
            }
            println!("\nplots      {}", self.out.display());
        }
        match done {
            true => Ok(()),
            false => Err(anyhow::Error::new(Interrupted)),
        }
    }

    /// Who takes part, the reference first.
    fn contestants(&self, arena: &Arena) -> anyhow::Result<Vec<Contestant>> {
        let champions = self.champions.iter().map(|path| Champion::read(path));
        let champions: Vec<Champion> = champions.collect::<anyhow::Result<_>>()?;
        let case = Case::new(arena.clone(), None, &files::read_recipes()?, &champions);
        cases::check_names(&self.kernel, std::slice::from_ref(&case))?;
        let is_rival = |name: &str| rivals::all().iter().any(|rival| rival.name == name);
        let mut others = case.into_contestants();
        others.retain(|one| {
            let is_champion = champions.iter().any(|champion| champion.name == one.name);
            is_champion
                || match self.kernel.is_empty() {
                    true => !is_rival(&one.name) || USUAL.contains(&one.name.as_str()),
                    false => self.kernel.contains(&one.name),
                }
        });
        let mut all = vec![arena.reference()?];
        all.extend(others);
        Ok(all)
    }

    fn write(&self, axes: &[&Axis], figures: &[Figure]) -> anyhow::Result<()> {
        let csv = files::to_csv(figures)?;
        files::write(&self.out.join("scaling.csv"), &csv)?;
        for axis in axes {
            let path = self.out.join(format!("{}.svg", axis.name));
            files::write(&path, &plot::svg(axis, figures)?)?;
        }
        Ok(())
    }
}

/// How often all points of an axis are gone through, a part of the rounds each time: no point has a moment of its
/// own.
const PASSES: usize = 3;

/// Times everyone at every point. Whatever ends it, `figures` has what was timed.
fn time(
    arena: &Arena,
    axes: &[Axis],
    contestants: &[Contestant],
    interrupt: &Interrupt,
    figures: &mut Vec<Figure>,
) -> anyhow::Result<()> {
    let points: usize = axes.iter().map(|axis| axis.points.len()).sum();
    let what = format!("timing {} kernels at {points} points", contestants.len());
    let bar = progress::bar(points * (1 + PASSES), &what);
    for axis in axes {
        let mut running = Vec::new();
        let done = time_axis(arena, axis, contestants, interrupt, &bar, &mut running);
        for one in &running {
            figures.extend(one.figures(arena, axis, contestants));
        }
        done?;
    }
    bar.finish_and_clear();
    Ok(())
}

fn time_axis<'a>(
    arena: &Arena,
    axis: &'a Axis,
    contestants: &[Contestant],
    interrupt: &Interrupt,
    bar: &ProgressBar,
    running: &mut Vec<Running<'a>>,
) -> anyhow::Result<()> {
    let rustc = Rustc::of_this_build()?;
    for point in &axis.points {
        bar.set_message(format!(
            "building for {} {}",
            axis.name,
            axis.tick(point.at)
        ));
        running.push(Running::new(arena, point, contestants, &rustc, interrupt)?);
        bar.inc(1);
    }
    for pass in 0..PASSES {
        for one in &mut *running {
            bar.set_message(format!("{} {}", axis.name, axis.tick(one.point.at)));
            one.time(pass)?;
            bar.inc(1);
        }
    }
    Ok(())
}

/// Everyone at a point.
struct Running<'a> {
    point: &'a Point,
    bench: Bench,
    built: Built,
    /// Once a pass is done.
    verdicts: Vec<Verdict>,
}

impl<'a> Running<'a> {
    /// Builds all kernels for a point.
    fn new(
        arena: &Arena,
        point: &'a Point,
        contestants: &[Contestant],
        rustc: &Rustc,
        interrupt: &Interrupt,
    ) -> anyhow::Result<Running<'a>> {
        let of_size = |one: &Contestant| match point.rays {
            PACKET_SIZE => one.kernels[0].clone(),
            rays => one.kernels[0].clone().of_packets(rays),
        };
        let kernels: Vec<Kernel> = contestants.iter().map(of_size).collect();
        // The reference comes first, and is timed against itself like the others.
        let workload = point.workload.clone();
        let mut bench = arena.bench_on(workload, kernels[0].clone(), rustc, interrupt)?;
        let built = bench.build(&kernels.iter().collect::<Vec<&Kernel>>(), true)?;
        Ok(Running {
            point,
            bench,
            built,
            verdicts: Vec::new(),
        })
    }

    /// Times the rounds of a pass.
    fn time(&mut self, pass: usize) -> anyhow::Result<()> {
        let rounds = self.point.rounds.iter().skip(pass).step_by(PASSES);
        let plan = Plan {
            rounds: rounds.cloned().collect(),
            separate: true,
            race: None,
            racers: 0,
            cores: self.point.cores,
            deal: Deal::Rounds,
            noise_floor: false,
            sweep: false,
            trial: None,
        };
        let verdicts = self.bench.time(&self.built, &plan)?;
        let before = std::mem::take(&mut self.verdicts);
        self.verdicts = match before.is_empty() {
            true => verdicts,
            false => {
                let pooled = before.into_iter().zip(verdicts);
                pooled.map(|(one, more)| one.pooled_with(more)).collect()
            }
        };
        Ok(())
    }

    fn figures(&self, arena: &Arena, axis: &Axis, contestants: &[Contestant]) -> Vec<Figure> {
        let Point { at, cores, .. } = *self.point;
        let verdicts = self.verdicts.iter().skip(1);
        let figures = contestants.iter().zip(verdicts).map(|(one, verdict)| {
            let speed = match verdict {
                Verdict::Timed { speeds, .. } if !speeds.is_empty() => Some(median(speeds)),
                _ => None,
            };
            Figure {
                axis: axis.name,
                at,
                kernel: one.name.clone(),
                isa: arena.isas.to_string(),
                regime: arena.scene.regime.to_string(),
                nanoseconds: speed.map(|speed| 1e3 / speed / cores as f64),
                ratio: verdict.summary().map(|summary| summary.ratio),
                verdict: verdict.name(),
            }
        });
        figures.collect()
    }
}

/// Nanoseconds a test, a row a point and a column a kernel; in brackets the ratio to the reference.
fn print_table(axis: &Axis, figures: &[Figure]) {
    let of_axis = || figures.iter().filter(|one| one.axis == axis.name);
    let mut kernels: Vec<&str> = Vec::new();
    for one in of_axis() {
        if !kernels.contains(&one.kernel.as_str()) {
            kernels.push(&one.kernel);
        }
    }
    println!("\n{}: nanoseconds a test (of {REFERENCE})", axis.label);
    let width = kernels
        .iter()
        .map(|name| name.len())
        .max()
        .unwrap_or(0)
        .max(14)
        + 2;
    let heads: String = kernels
        .iter()
        .map(|name| format!("{name:>width$}"))
        .collect();
    println!("{:>10}{heads}", axis.name);
    for point in &axis.points {
        let cell = |kernel: &&str| {
            let mut here = of_axis().filter(|one| one.at == point.at);
            let found = here.find(|one| one.kernel == **kernel);
            let text = match found.map(|one| (one.nanoseconds, one.ratio, one.verdict)) {
                Some((Some(nanoseconds), Some(ratio), _)) => {
                    format!("{nanoseconds:.3} ({ratio:.2})")
                }
                Some((.., verdict)) => verdict.to_owned(),
                None => "-".to_owned(),
            };
            format!("{text:>width$}")
        };
        let cells: String = kernels.iter().map(cell).collect();
        println!("{:>10}{cells}", axis.tick(point.at));
    }
}

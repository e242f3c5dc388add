//! `cargo xtask bench`: the rivals, the library's kernels and any champions on the same work, in one
//! interleaved batch.
//!
//! ```text
//! flags ─► cases (scene × regime × ISA, with who takes part) ─► timed part by part, in turn
//!                                                            ─► figures ─► tables, JSON, CSV
//! ```

pub mod cases;
mod figures;
mod papers;
mod published;
mod table;

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};
use measure::{Interrupt, Machine, Mca, MeasureError, Rustc};

use crate::arena::{self, Arena, TRIANGLES, interrupt_on_ctrl_c};
use crate::failure::{Interrupted, bad_input};
use crate::fields::Fields;
use crate::files;
use crate::isas::Isas;
use cases::{Case, Champion};
use figures::Figures;

/// Times kernels together on the paper's workload.
///
/// The rivals take part, the library's kernels, and the champions of the runs that are named: in
/// packets of general and of common origin and with single rays, in all three regimes. Each kernel
/// is compiled as a library of its own; figures are ratios to Möller-Trumbore's kernel at the same
/// work, timed in turn with it. A kernel that answers wrong is marked and has no figure.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    cargo xtask bench\n  \
    cargo xtask bench --isa all --csv figures.csv\n  \
    cargo xtask bench runs/packet-sse2-shrinking-seed1\n  \
    cargo xtask bench --scene single --isa avx2 --regime leaf --json")]
pub struct Bench {
    /// Time only this rival or kernel of the library; may be given several times
    #[arg(long, value_name = "NAME")]
    kernel: Vec<String>,

    /// Run directories, or recipes; without --scene, only their scenes and regimes are timed
    #[arg(value_name = "RUN_DIR|RECIPE")]
    champions: Vec<PathBuf>,

    /// Time only in this scene: packet, common-origin, single, … (a wrong name lists them all); or
    /// in a scene model's file, NAME.json [default: packet, common-origin and single]
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,

    #[command(flatten)]
    fields: Fields,

    /// Instruction set: scalar, sse2, sse4.1, avx2 or avx512; several with commas, or all that this
    /// machine has, each timed by itself [default: that of the champions, or sse2]
    #[arg(long, value_name = "NAMES")]
    isa: Option<String>,

    /// Triangles of the workload
    #[arg(long, value_name = "N", default_value_t = TRIANGLES)]
    triangles: usize,

    /// Time on a quarter of the rays: a quick look
    #[arg(long)]
    quick: bool,

    /// Print JSON: a list with an object for every kernel in every case
    #[arg(long)]
    json: bool,

    /// Write the same as CSV to a file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// How many parts the rounds are timed in. All cases have one part timed before any has the next, so that
/// no case has an hour of its own.
const PARTS: usize = 4;

impl Bench {
    /// Times them and prints the tables.
    pub fn run(self) -> anyhow::Result<()> {
        let champions = self.champions.iter().map(|path| Champion::read(path));
        let champions: Vec<Champion> = champions.collect::<anyhow::Result<_>>()?;
        let library = files::read_recipes()?;
        let arenas = self.arenas(&champions)?;
        let published = match arenas.iter().any(published::take_part_in) {
            true => published::build(),
            false => None,
        };
        let case = |arena| Case::new(arena, published.as_deref(), &library, &champions);
        let mut cases: Vec<Case> = arenas.into_iter().map(case).collect();
        if let Some(stranger) = champions.iter().find(|one| !cases::any_has(&cases, one)) {
            return Err(bad_input(format!(
                "{} was bred for the scene {}, which none of the scenes asked for is like; name its scene \
                 with --scene, or none",
                stranger.name, stranger.recipe.scene.name
            )));
        }
        self.keep_asked(&mut cases, &champions)?;

        let interrupt = interrupt_on_ctrl_c()?;
        let parts = if self.quick { 1 } else { PARTS };
        let timed = time(&mut cases, parts, &interrupt);
        let interrupted = match timed {
            Err(error) if is_interruption(&error) => true,
            timed => {
                timed?;
                false
            }
        };
        let figures: Vec<Figures> = cases.iter().flat_map(figures::of).collect();
        self.print(&figures)?;
        match interrupted {
            true => Err(anyhow::Error::new(Interrupted)),
            false => Ok(()),
        }
    }

    /// Where kernels meet: every scene in every regime on every instruction set that is asked for.
    fn arenas(&self, champions: &[Champion]) -> anyhow::Result<Vec<Arena>> {
        let of_champions = self.scene.is_none() && !champions.is_empty();
        let scenes = match &self.scene {
            Some(name) => vec![arena::scene(name)?],
            None if of_champions => champions
                .iter()
                .map(|one| one.recipe.scene.clone())
                .collect(),
            None => ["packet", "common-origin", "single"]
                .into_iter()
                .map(arena::scene)
                .collect::<anyhow::Result<_>>()?,
        };
        let all_regimes = !of_champions && !self.fields.name_regime();
        let mut arenas: Vec<Arena> = Vec::new();
        for (place, scene) in scenes.into_iter().enumerate() {
            let scene = self.fields.change(scene)?;
            let isas = match (&self.isa, of_champions) {
                (Some(names), _) => Isas::parse(names, &scene)?,
                (None, true) => Isas(champions[place].recipe.isas.clone()),
                (None, false) => Isas::parse("sse2", &scene)?,
            };
            let regimes = match all_regimes {
                true => scene::Regime::ALL.to_vec(),
                false => vec![scene.regime],
            };
            for &isa in isas.iter() {
                for &regime in &regimes {
                    let arena = Arena {
                        scene: scene::SceneModel {
                            regime,
                            ..scene.clone()
                        },
                        isas: Isas(vec![isa]),
                        triangles: self.triangles,
                    };
                    arena.check()?;
                    if !arenas.contains(&arena) {
                        arenas.push(arena);
                    }
                }
            }
        }
        Ok(arenas)
    }

    /// Leaves only the kernels that were asked for, if any were, and the champions.
    fn keep_asked(&self, cases: &mut [Case], champions: &[Champion]) -> anyhow::Result<()> {
        if self.kernel.is_empty() {
            return Ok(());
        }
        let known = cases::names(cases);
        if let Some(unknown) = self.kernel.iter().find(|name| !known.contains(name)) {
            return Err(bad_input(format!(
                "no kernel {unknown:?} for these scenes and ISAs; known: {}",
                known.join(", ")
            )));
        }
        for case in cases {
            case.keep(|name| {
                self.kernel.iter().any(|asked| asked == name)
                    || champions.iter().any(|champion| champion.name == name)
            });
        }
        Ok(())
    }

    fn print(&self, figures: &[Figures]) -> anyhow::Result<()> {
        if let Some(path) = &self.csv {
            files::write(path, &figures::to_csv(figures)?)?;
        }
        if self.json {
            println!("{}", serde_json::to_string_pretty(figures)?);
            return Ok(());
        }
        println!("{}", Machine::here().cpu);
        table::print(figures);
        if !self.quick && self.triangles == TRIANGLES {
            papers::print(figures);
        }
        Ok(())
    }
}

/// Whether the user stopped it: what was timed until then counts.
fn is_interruption(error: &anyhow::Error) -> bool {
    matches!(error.downcast_ref(), Some(MeasureError::Interrupted))
}

/// Builds all kernels of all cases; then times a part of the rounds in every case, then the next part; the
/// precomputations last, and what the kernels' arithmetic is.
fn time(cases: &mut [Case], parts: usize, interrupt: &Interrupt) -> anyhow::Result<()> {
    let steps = cases.len() * (parts + 3);
    let bar = ProgressBar::new(steps as u64);
    let style = "{bar:24} {msg}, {elapsed} so far, ETA {eta}";
    bar.set_style(ProgressStyle::with_template(style).expect("a fixed template"));
    if bar.is_hidden() {
        eprintln!("timing {} cases", cases.len());
    }
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    let done = time_with(cases, parts, interrupt, &bar);
    bar.finish_and_clear();
    done
}

fn time_with(
    cases: &mut [Case],
    parts: usize,
    interrupt: &Interrupt,
    bar: &ProgressBar,
) -> anyhow::Result<()> {
    let rustc = Rustc::of_this_build()?;
    let mca = Mca::find();
    for case in &mut *cases {
        bar.set_message(format!("building {case}"));
        case.build(&rustc, interrupt)?;
        bar.inc(1);
    }
    for part in 1..=parts {
        for case in &mut *cases {
            bar.set_message(format!("timing {case}, part {part} of {parts}"));
            case.time_part(PARTS)?;
            bar.inc(1);
        }
    }
    for case in cases {
        bar.set_message(format!("timing the precomputations of {case}"));
        case.time_precomputations()?;
        bar.inc(1);
        bar.set_message(format!("counting the operations of {case}"));
        case.count(&rustc, mca.as_ref())?;
        bar.inc(1);
    }
    Ok(())
}

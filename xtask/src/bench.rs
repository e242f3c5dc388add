//! `cargo xtask bench`: the rivals, the library's kernels and any champions on the same work, in one
//! interleaved batch.
//!
//! ```text
//! flags ─► cases (scene × regime × ISA, with who takes part) ─► timed part by part, in turn
//!                                                            ─► figures ─► tables, JSON, CSV
//! ```

pub mod figures;
mod papers;
pub mod running;
mod table;

use std::path::PathBuf;

use measure::{Interrupt, Machine, Mca, Rustc};

use crate::asked::{Asked, Usual};
use crate::cases::Case;
use crate::failure::Interrupted;
use crate::files;
use crate::interrupt::{interrupt_on_ctrl_c, to_its_end};
use crate::progress;
use figures::Figures;
use running::{PARTS, Running};

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
    #[command(flatten)]
    asked: Asked,

    /// Run directories, or recipes; without --scene, only their scenes and regimes are looked at
    #[arg(value_name = "RUN_DIR|RECIPE")]
    champions: Vec<PathBuf>,

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

impl Bench {
    /// Times them and prints the tables.
    pub fn run(self) -> anyhow::Result<()> {
        let cases = self.asked.cases(&self.champions, &Usual::presets(true)?)?;
        let interrupt = interrupt_on_ctrl_c()?;
        let parts = if self.quick { 1 } else { PARTS };
        let mut running = Vec::new();
        let done = to_its_end(time(&cases, parts, &interrupt, &mut running))?;
        let figures: Vec<Figures> = running.iter().flat_map(figures::of).collect();
        self.print(&figures)?;
        match done {
            true => Ok(()),
            false => Err(anyhow::Error::new(Interrupted)),
        }
    }

    fn print(&self, figures: &[Figures]) -> anyhow::Result<()> {
        if let Some(path) = &self.csv {
            files::write(path, &files::to_csv(figures)?)?;
        }
        if self.json {
            println!("{}", serde_json::to_string_pretty(figures)?);
            return Ok(());
        }
        println!("{}", Machine::here().cpu);
        table::print(figures);
        if !self.quick && self.asked.is_full() {
            papers::print(figures);
        }
        Ok(())
    }
}

/// Builds and times all kernels of all cases; their precomputations last, and what their arithmetic is. Whatever ends it, `running` has what was done.
fn time<'a>(
    cases: &'a [Case],
    parts: usize,
    interrupt: &Interrupt,
    running: &mut Vec<Running<'a>>,
) -> anyhow::Result<()> {
    let steps = cases.len() * (parts + 3);
    let bar = progress::bar(steps, &format!("timing {} cases", cases.len()));
    let rustc = Rustc::of_this_build()?;
    let mca = Mca::find();
    running::build_and_time(cases, parts, &rustc, interrupt, &bar, running)?;
    for one in running {
        bar.set_message(format!("timing the precomputations of {}", one.case));
        one.time_precomputations()?;
        bar.inc(1);
        bar.set_message(format!("counting the operations of {}", one.case));
        one.count(&rustc, mca.as_ref())?;
        bar.inc(1);
        if let Some(line) = one.disbelieved() {
            bar.suspend(|| eprintln!("{}: {line}", one.case));
        }
    }
    bar.finish_and_clear();
    Ok(())
}

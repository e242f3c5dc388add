//! `cargo xtask bench`: the rivals, the library's kernels and any champions on the same work, in one
//! interleaved batch.
//!
//! ```text
//! flags ─► cases (scene × regime × ISA, with who takes part) ─► timed part by part, in turn
//!                                                            ─► figures ─► tables, JSON, CSV
//! ```

mod figures;
mod papers;
mod table;

use std::path::PathBuf;

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use measure::{Interrupt, Machine, Mca, MeasureError, Rustc};

use crate::arena::interrupt_on_ctrl_c;
use crate::asked::Asked;
use crate::cases::Case;
use crate::failure::Interrupted;
use crate::files;
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
    #[command(flatten)]
    asked: Asked,

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
        let mut cases = self.asked.cases(true)?;
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
        if !self.quick && self.asked.is_full() {
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
        if bar.is_hidden() {
            let elapsed = HumanDuration(bar.elapsed());
            eprintln!("part {part} of {parts} timed after {elapsed}");
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

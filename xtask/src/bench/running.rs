//! A case while it is timed, and what it has come to.

use std::collections::BTreeMap;

use emit::Kernel;
use indicatif::{HumanDuration, ProgressBar};
use measure::{Counts, Interrupt, Mca, MeasureError, Pipes, Rustc};

use crate::arena::{Contestant, PACKETS};
use crate::benches::{Benches, disbelieved};
use crate::cases::Case;
use crate::shootout::{Shootout, Standing};

/// A case of which all kernels are built.
pub struct Running<'a> {
    /// The case.
    pub case: &'a Case,
    benches: Benches,
    shootout: Shootout,
    /// How often kernels use the words of their lanes.
    counts: BTreeMap<String, Counts>,
    /// llvm-mca's estimates of a test that leaves at the first exit, in cycles.
    estimates: BTreeMap<String, f64>,
    /// Cycles a second, after every part.
    clocks: Vec<f64>,
}

/// A test of one ray and one triangle in cycles.
pub struct Cycles {
    /// What it takes.
    pub taken: f64,
    /// What its arithmetic takes at least.
    pub least: f64,
}

/// How many parts the rounds are timed in. All cases have one part timed before any has the next, so that
/// no case has an hour of its own.
pub const PARTS: usize = 4;

/// Of so many packets, one is run through to count.
const COUNTED_PACKETS: usize = 25;

/// Builds all kernels of all cases; then times a part of the rounds in every case, then the next, until so many of
/// the [`PARTS`] are timed. Whatever ends it, `running` has what was done.
pub fn build_and_time<'a>(
    cases: &'a [Case],
    parts: usize,
    rustc: &Rustc,
    interrupt: &Interrupt,
    bar: &ProgressBar,
    running: &mut Vec<Running<'a>>,
) -> anyhow::Result<()> {
    for case in cases {
        bar.set_message(format!("building {case}"));
        running.push(Running::new(case, rustc, interrupt)?);
        bar.inc(1);
    }
    for part in 1..=parts {
        for one in &mut *running {
            bar.set_message(format!("timing {}, part {part} of {parts}", one.case));
            one.time_part()?;
            bar.inc(1);
        }
        if bar.is_hidden() {
            let elapsed = HumanDuration(bar.elapsed());
            eprintln!("part {part} of {parts} timed after {elapsed}");
        }
    }
    Ok(())
}

impl<'a> Running<'a> {
    /// Builds all kernels of a case.
    fn new(case: &'a Case, rustc: &Rustc, interrupt: &Interrupt) -> anyhow::Result<Running<'a>> {
        let mut benches = case.arena.bench(rustc, interrupt)?;
        let contestants: Vec<&Contestant> = case.contestants().collect();
        let shootout = Shootout::new(&mut benches, &contestants, 0..PACKETS)?;
        Ok(Running {
            case,
            benches,
            shootout,
            counts: BTreeMap::new(),
            estimates: BTreeMap::new(),
            clocks: Vec::new(),
        })
    }

    /// Times the next one of the parts of the rounds.
    fn time_part(&mut self) -> Result<(), MeasureError> {
        self.shootout.time_part(&mut self.benches, PARTS)?;
        self.clocks.push(measure::clock());
        Ok(())
    }

    /// Times how records are made of triangles.
    pub fn time_precomputations(&mut self) -> Result<(), MeasureError> {
        self.shootout.time_precomputations(&mut self.benches)
    }

    /// Counts how often kernels use their words, and has their hot paths estimated if there is llvm-mca.
    pub fn count(&mut self, rustc: &Rustc, mca: Option<&Mca>) -> anyhow::Result<()> {
        let reference = self.case.arena.reference()?;
        let all = [&reference].into_iter().chain(self.case.contestants());
        let all: Vec<&Contestant> = all.collect();
        if let Some(mca) = mca {
            let estimate = |one: &&Contestant| {
                let cycles = mca.cycles(rustc, &one.kernels[0])?;
                Some((one.name.clone(), cycles))
            };
            self.estimates.extend(all.iter().filter_map(estimate));
        }
        let kernels: Vec<&[Kernel]> = all.iter().map(|one| one.kernels.as_slice()).collect();
        let packets = (0..PACKETS).step_by(COUNTED_PACKETS);
        let rounds = packets.map(|packet| packet..packet + 1).collect();
        let counts = std::iter::zip(all, self.benches.count(&kernels, rounds)?);
        let counts = counts.filter_map(|(one, counts)| Some((one.name.clone(), counts?)));
        self.counts.extend(counts);
        Ok(())
    }

    /// How often a worker was not believed, as a line.
    pub fn disbelieved(&self) -> Option<String> {
        disbelieved(self.benches.processes())
    }

    /// How everyone did so far.
    pub fn standings(&self) -> Vec<Standing> {
        self.shootout.standings()
    }

    /// llvm-mca's estimate, in cycles, of a test that leaves a kernel at the first exit.
    pub fn estimate(&self, kernel: &str) -> Option<f64> {
        self.estimates.get(kernel).copied()
    }

    /// The cycles of a kernel of this speed, in millions of tests a second, if its words were counted and the
    /// processor's pipes are known.
    pub fn cycles(&self, kernel: &str, speed: f64) -> Option<Cycles> {
        let counts = self.counts.get(kernel)?;
        if self.clocks.is_empty() || counts.words.iter().all(|&times| times == 0) {
            return None;
        }
        Some(Cycles {
            taken: measure::median(&self.clocks) / (speed * 1e6),
            least: Pipes::here()?.least_cycles(self.case.arena.isas[0], counts)?,
        })
    }
}

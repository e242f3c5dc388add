//! The bench: kernels in, verdicts out.

use std::io;
use std::ops::Range;
use std::time::{Duration, Instant};

use emit::{Isa, Kernel};

use crate::compile::compile;
use crate::driver::{Driver, WorkerCommand};
use crate::interrupt::Interrupt;
use crate::protocol::{Batch, Entry, Race, WorkloadSpec};
use crate::rustc::{CompileError, Rustc};
use crate::verdict::Verdict;

/// Compiles, checks and times kernels on one workload, against one reference.
pub struct Bench {
    rustc: Rustc,
    driver: Driver,
    interrupt: Interrupt,
    reference: Kernel,
    supports: fn(Isa) -> bool,
    spent: Spent,
    batches: u64,
}

/// How kernels are timed.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The packets of each round.
    pub rounds: Vec<Range<usize>>,
    /// Each kernel in a library of its own, so that its place among others plays no part.
    pub separate: bool,
    /// Whom kernels race against, so that no more is timed than must be.
    pub race: Option<Race>,
    /// How many kernels race, the first ones. The others are timed to the end.
    pub racers: usize,
    /// Whether the reference takes part as a kernel like others, which shows what difference
    /// between equals is due to noise.
    pub noise_floor: bool,
}

/// Where the time went.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// Compiling.
    pub compile: Duration,
    /// Loading and checking.
    pub check: Duration,
    /// Timing.
    pub time: Duration,
}

/// Measuring as a whole cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// The user asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// No place for the libraries.
    #[error("cannot make a temporary directory for compiled candidates: {0}")]
    Directory(io::Error),
    /// No worker.
    #[error("cannot run the process that times candidates: {0}")]
    Worker(io::Error),
    /// The reference itself fails.
    #[error("the reference kernel cannot be timed: {0:?}")]
    Reference(Verdict),
}

impl Bench {
    /// A bench on `workload`, timing against `reference`.
    pub fn new(
        rustc: Rustc,
        worker: WorkerCommand,
        workload: WorkloadSpec,
        reference: Kernel,
        interrupt: Interrupt,
    ) -> Bench {
        Bench {
            rustc,
            driver: Driver::new(worker, workload, interrupt.clone()),
            interrupt,
            reference,
            supports: Isa::is_available,
            spent: Spent::default(),
            batches: 0,
        }
    }

    /// The same bench, taken to be on a machine that has only the instruction sets that `supports`
    /// says it has. Kernels of others are neither compiled nor loaded.
    #[must_use]
    pub fn on_a_machine_with(self, supports: fn(Isa) -> bool) -> Bench {
        Bench { supports, ..self }
    }

    /// Where the time went so far.
    pub fn spent(&self) -> Spent {
        self.spent
    }

    /// Builds, checks and times kernels in one batch. The first verdict is that of the reference
    /// against itself, without timings if the plan does not want the noise floor.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all; a kernel that fails is a verdict.
    pub fn measure(
        &mut self,
        kernels: &[&Kernel],
        plan: &Plan,
    ) -> Result<Vec<Verdict>, MeasureError> {
        let directory = tempfile::Builder::new()
            .prefix("raybreed-")
            .tempdir()
            .map_err(MeasureError::Directory)?;
        let start = Instant::now();
        let all: Vec<&Kernel> = [&self.reference]
            .into_iter()
            .chain(kernels.iter().copied())
            .collect();
        // Asked once for each kernel.
        let supported: Vec<bool> = all.iter().map(|one| (self.supports)(one.isa)).collect();
        if !supported[0] {
            return Err(MeasureError::Reference(Verdict::UnsupportedIsa));
        }
        let can_run = all.iter().zip(&supported).filter(|(_, can)| **can);
        let can_run: Vec<&Kernel> = can_run.map(|(kernel, _)| *kernel).collect();
        let built = compile(
            &self.rustc,
            &can_run,
            directory.path(),
            plan.separate,
            &self.interrupt,
        );
        self.spent.compile += start.elapsed();
        let mut verdicts: Vec<Option<Verdict>> = Vec::with_capacity(all.len());
        let mut entries: Vec<Entry> = Vec::with_capacity(all.len());
        let mut built = built.into_iter();
        for supported in supported {
            let (entry, verdict) = match supported.then(|| built.next().expect("built or why not"))
            {
                None => (None, Some(Verdict::UnsupportedIsa)),
                Some(Ok(entry)) => (Some(entry), None),
                Some(Err(CompileError::Refused(message))) => {
                    (None, Some(Verdict::BuildFailed { message }))
                }
                Some(Err(CompileError::TimedOut)) => (None, Some(Verdict::BuildTimedOut)),
                Some(Err(CompileError::Interrupted)) => return Err(MeasureError::Interrupted),
            };
            let number = verdicts.len();
            entries.extend(entry.map(|entry| Entry {
                races: (1..=plan.racers).contains(&number),
                ..entry
            }));
            verdicts.push(verdict);
        }
        if let Some(verdict) = &verdicts[0] {
            return Err(MeasureError::Reference(verdict.clone()));
        }
        let start = Instant::now();
        self.batches += 1;
        let (measured, timed_for) = self.driver.measure(&Batch {
            kernels: entries,
            rounds: plan.rounds.clone(),
            order: self.batches,
            race: plan.race.clone(),
            noise_floor: plan.noise_floor,
        })?;
        self.spent.time += timed_for;
        self.spent.check += start.elapsed().saturating_sub(timed_for);
        let mut measured = measured.into_iter();
        let next = |verdict: Option<Verdict>| {
            verdict.unwrap_or_else(|| measured.next().expect("a verdict for every built kernel"))
        };
        Ok(verdicts.into_iter().map(next).collect())
    }
}

/// The first 16 digits of the BLAKE3 hash of all that makes a kernel's binary.
pub fn source_hash(kernel: &Kernel) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(kernel.isa.name().as_bytes());
    hasher.update(kernel.function.as_bytes());
    hasher.update(kernel.source.as_bytes());
    hasher.finalize().to_hex()[..16].to_owned()
}

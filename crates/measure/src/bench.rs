//! The bench: kernels in, verdicts out.

use std::collections::HashMap;
use std::io;
use std::ops::Range;
use std::time::{Duration, Instant};

use emit::Kernel;

use crate::compile::compile;
use crate::driver::{Driver, WorkerCommand};
use crate::interrupt::Interrupt;
use crate::protocol::{Batch, Entry, WorkloadSpec};
use crate::rustc::{CompileError, Rustc};
use crate::verdict::{Outcome, Verdict};

/// Compiles, checks and times kernels on one workload, against one reference.
pub struct Bench {
    rustc: Rustc,
    driver: Driver,
    interrupt: Interrupt,
    reference: Kernel,
    known: HashMap<String, Verdict>,
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
    /// A kernel whose ratio is below this after a third of the rounds is timed no further: it is
    /// slow, and how slow need not be known well.
    pub cutoff: Option<f64>,
}

/// Where the time went.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// Compiling.
    pub compile: Duration,
    /// Checking and timing.
    pub measure: Duration,
    /// Different sources among what was compiled for timing.
    pub sources: u64,
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
            known: HashMap::new(),
            spent: Spent::default(),
            batches: 0,
        }
    }

    /// Where the time went so far.
    pub fn spent(&self) -> Spent {
        self.spent
    }

    /// What became of each kernel. A source that the bench has measured before costs nothing and
    /// keeps its figures.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all; a kernel that fails is a verdict.
    pub fn measure(
        &mut self,
        kernels: &[Kernel],
        plan: &Plan,
    ) -> Result<Vec<Outcome>, MeasureError> {
        let sources: Vec<String> = kernels.iter().map(source_hash).collect();
        let mut new: Vec<usize> = Vec::new();
        for (index, source) in sources.iter().enumerate() {
            let seen = |&other: &usize| sources[other] == *source;
            if !self.known.contains_key(source) && !new.iter().any(seen) {
                new.push(index);
            }
        }
        if !new.is_empty() {
            let fresh: Vec<&Kernel> = new.iter().map(|&index| &kernels[index]).collect();
            let verdicts = self.measure_together(&fresh, plan)?;
            for (index, verdict) in new.into_iter().zip(verdicts.into_iter().skip(1)) {
                self.known.insert(sources[index].clone(), verdict);
            }
            self.spent.sources = self.known.len() as u64;
        }
        let outcome = |source: String| Outcome {
            verdict: self.known[&source].clone(),
            source,
        };
        Ok(sources.into_iter().map(outcome).collect())
    }

    /// Builds and times kernels once more, whether known or not, and pools what is found with what
    /// was known. A kernel that fails now has failed.
    ///
    /// # Errors
    ///
    /// [`MeasureError`], as for [`Bench::measure`].
    pub fn measure_again(
        &mut self,
        kernels: &[&Kernel],
        plan: &Plan,
    ) -> Result<Vec<Outcome>, MeasureError> {
        if kernels.is_empty() {
            return Ok(Vec::new());
        }
        let verdicts = self.measure_together(kernels, plan)?.into_iter().skip(1);
        let pooled = kernels.iter().zip(verdicts).map(|(kernel, verdict)| {
            let source = source_hash(kernel);
            let verdict = match self.known.remove(&source) {
                Some(known) => known.pooled_with(verdict),
                None => verdict,
            };
            self.known.insert(source.clone(), verdict.clone());
            Outcome { source, verdict }
        });
        Ok(pooled.collect())
    }

    /// Times all kernels in one batch, known or not. The first verdict is that of the reference
    /// against itself: the noise floor.
    ///
    /// # Errors
    ///
    /// [`MeasureError`], as for [`Bench::measure`].
    pub fn measure_together(
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
        let built = compile(
            &self.rustc,
            &all,
            directory.path(),
            plan.separate,
            &self.interrupt,
        );
        self.spent.compile += start.elapsed();
        let mut verdicts: Vec<Option<Verdict>> = Vec::with_capacity(all.len());
        let mut entries: Vec<Entry> = Vec::with_capacity(all.len());
        for built in built {
            let (entry, verdict) = match built {
                Ok(entry) => (Some(entry), None),
                Err(CompileError::Refused(message)) => {
                    (None, Some(Verdict::BuildFailed { message }))
                }
                Err(CompileError::TimedOut) => (None, Some(Verdict::BuildTimedOut)),
                Err(CompileError::Interrupted) => return Err(MeasureError::Interrupted),
            };
            entries.extend(entry);
            verdicts.push(verdict);
        }
        if let Some(verdict) = &verdicts[0] {
            return Err(MeasureError::Reference(verdict.clone()));
        }
        let start = Instant::now();
        self.batches += 1;
        let mut measured = self
            .driver
            .measure(&Batch {
                kernels: entries,
                rounds: plan.rounds.clone(),
                order: self.batches,
                cutoff: plan.cutoff,
            })?
            .into_iter();
        self.spent.measure += start.elapsed();
        let next = |verdict: Option<Verdict>| {
            verdict.unwrap_or_else(|| measured.next().expect("a verdict for every built kernel"))
        };
        Ok(verdicts.into_iter().map(next).collect())
    }
}

/// The first 16 digits of the hash of all that makes a kernel's binary.
fn source_hash(kernel: &Kernel) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(kernel.isa.name().as_bytes());
    hasher.update(kernel.function.as_bytes());
    hasher.update(kernel.source.as_bytes());
    hasher.finalize().to_hex().as_str()[..16].to_owned()
}

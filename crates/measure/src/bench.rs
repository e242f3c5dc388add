//! The bench: kernels in, verdicts out.

use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use emit::{InLibrary, Isa, Kernel};
use tempfile::TempDir;

use crate::built::Built;
use crate::calibrated::{Calibrated, FRESH};
use crate::compile::{Compiled, Shape, compile};
use crate::crew::{Crew, locked};
use crate::driver::WorkerCommand;
use crate::error::MeasureError;
use crate::interrupt::Interrupt;
use crate::job::{Done, Job};
use crate::judge::{Judged, Look};
use crate::plan::Plan;
use crate::processes::Processes;
use crate::protocol::{Batch, Counts, Entry, Work, WorkloadSpec};
use crate::rustc::{CompileError, Rustc};
use crate::tally::Found;
use crate::verdict::Verdict;

/// Compiles, checks and times kernels on one workload, against one reference.
pub struct Bench {
    rustc: Rustc,
    /// Locked by whoever has it work.
    crew: Arc<Mutex<Crew>>,
    interrupt: Interrupt,
    reference: Kernel,
    /// The reference's library, once there is one.
    built_reference: Option<(TempDir, Entry)>,
    supports: fn(Isa) -> bool,
    spent: Spent,
    processes: Processes,
    batches: u64,
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
            crew: Arc::new(Mutex::new(Crew::new(worker, workload, interrupt.clone()))),
            interrupt,
            reference,
            built_reference: None,
            supports: Isa::is_available,
            spent: Spent::default(),
            processes: Processes::default(),
            batches: 0,
        }
    }

    /// The same bench, taken to be on a machine that has only the instruction sets that `supports`
    /// says it has. Kernels of others are neither compiled nor loaded.
    #[must_use]
    pub fn on_a_machine_with(self, supports: fn(Isa) -> bool) -> Bench {
        Bench { supports, ..self }
    }

    /// The same bench, whose workers may be silent for so long.
    #[must_use]
    pub fn with_patience(self, patience: Duration) -> Bench {
        locked(&self.crew).be_patient(patience);
        self
    }

    /// Compiles so many libraries at once from now on.
    ///
    /// # Panics
    ///
    /// If that is none.
    pub fn compile_at_once(&mut self, libraries: usize) {
        self.rustc = self.rustc.clone().at_once(libraries);
    }

    /// Where the time went so far.
    pub fn spent(&self) -> Spent {
        self.spent
    }

    /// What became of worker processes in which the reference was slow, so far.
    pub fn processes(&self) -> Processes {
        self.processes
    }

    /// Times the reference in fresh processes, and expects of every worker from now on that it is as fast there, in
    /// these rounds, on so many cores at once.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn calibrate(
        &mut self,
        rounds: Vec<Range<usize>>,
        cores: usize,
    ) -> Result<Calibrated, MeasureError> {
        let reference = self.reference()?;
        let start = Instant::now();
        self.batches += 1;
        let batch = Batch {
            kernels: vec![reference],
            rounds,
            work: Work::Time,
            order: self.batches,
            race: None,
            noise_floor: true,
            sweep: true,
            trial: None,
        };
        let measured = locked(&self.crew).calibrate(&batch, FRESH, cores)?;
        self.spent.time += start.elapsed();
        Ok(Calibrated::of(measured))
    }

    /// Has fresh processes time what comes next.
    pub fn dismiss_workers(&mut self) {
        locked(&self.crew).dismiss();
    }

    /// Builds, checks and times kernels in one batch. The first verdict is that of the reference
    /// against itself, without timings if the plan does not want the noise floor; if several
    /// cores time, it has the timings of all.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all; a kernel that fails is a verdict.
    pub fn measure(
        &mut self,
        kernels: &[&Kernel],
        plan: &Plan,
    ) -> Result<Vec<Verdict>, MeasureError> {
        let built = self.build(kernels, plan.separate)?;
        self.time(&built, plan)
    }

    /// Builds kernels, and the reference if it is not built yet; `separate` as in a [`Plan`].
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be built at all; a kernel that fails has its verdict when it is to be
    /// timed.
    pub fn build(&mut self, kernels: &[&Kernel], separate: bool) -> Result<Built, MeasureError> {
        let directory = temporary_directory()?;
        let start = Instant::now();
        self.reference()?;
        let shape = match separate {
            true => Shape::Separate,
            false => Shape::Together,
        };
        let kernels = self.build_in(kernels, directory.path(), shape)?;
        self.spent.compile += start.elapsed();
        Ok(Built {
            kernels,
            _directory: directory,
        })
    }

    /// Checks and times what was built, in one batch, with verdicts as of [`Bench::measure`].
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn time(&mut self, built: &Built, plan: &Plan) -> Result<Vec<Verdict>, MeasureError> {
        self.run(built, plan, Work::Time)
            .map(|(verdicts, _)| verdicts)
    }

    /// Times how records are made of triangles, over all of the workload, on one core. Of kernels that have
    /// records of their own, ratios are to a copy of the vertices, and speeds are millions of triangles a
    /// second; the others have no timings. The first verdict is the reference's.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn time_precomputations(
        &mut self,
        built: &Built,
        passes: usize,
    ) -> Result<Vec<Verdict>, MeasureError> {
        let work = Work::TimePrecomputations(passes);
        let (verdicts, _) = self.run(built, &Plan::once(Vec::new()), work)?;
        Ok(verdicts)
    }

    /// How often kernels use the words of their lanes in these rounds: they are built once more, with words
    /// that count themselves. Gives nothing for those that have no such words or fail.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn count(
        &mut self,
        kernels: &[&Kernel],
        rounds: Vec<Range<usize>>,
    ) -> Result<Vec<Option<Counts>>, MeasureError> {
        let directory = temporary_directory()?;
        let built = self.build_in(kernels, directory.path(), Shape::Counted)?;
        let built = Built {
            kernels: built,
            _directory: directory,
        };
        let (_, mut found) = self.run(&built, &Plan::once(rounds), Work::Count)?;
        let counts = (0..kernels.len()).map(|place| found.counts.remove(&place));
        Ok(counts.collect())
    }

    /// Takes kernels that were built to the accuracy lab, on all cores. Gives nothing for those that fail, and why
    /// they do: a verdict each.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be judged at all.
    pub fn judge(
        &mut self,
        built: &Built,
        look: Look,
    ) -> Result<Vec<Result<Judged, Verdict>>, MeasureError> {
        let plan = Plan {
            cores: locked(&self.crew).size(),
            ..Plan::once(Vec::new())
        };
        let (verdicts, mut found) = self.run(built, &plan, Work::Judge(look))?;
        let mut judged = Vec::new();
        for (place, verdict) in verdicts.into_iter().skip(1).enumerate() {
            judged.push(found.judged.remove(&place).ok_or(verdict));
        }
        Ok(judged)
    }

    /// What the workers have to do to check and time what was built, in one batch: for a thread of its own, while this
    /// bench builds others. What was built must be kept until that is done.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn job(&mut self, built: &Built, plan: &Plan) -> Result<Job, MeasureError> {
        self.job_of(built, plan, Work::Time)
    }

    /// The verdicts on what was built, from what the workers did, as of [`Bench::measure`].
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing could be measured at all.
    pub fn verdicts(&mut self, built: &Built, done: Done) -> Result<Vec<Verdict>, MeasureError> {
        self.found(built, done).map(|(verdicts, _)| verdicts)
    }

    fn job_of(&mut self, built: &Built, plan: &Plan, work: Work) -> Result<Job, MeasureError> {
        let reference = self.reference()?;
        let entries = built.entries().map(|(place, entry)| Entry {
            races: place < plan.racers,
            ..entry.clone()
        });
        self.batches += 1;
        Ok(Job::new(
            &self.crew,
            &reference,
            &entries.collect::<Vec<_>>(),
            plan,
            (work, self.batches),
        ))
    }

    /// Runs what was built. Gives verdicts as of [`Bench::measure`], and what was found beside, by places among
    /// what was to be built.
    fn run(
        &mut self,
        built: &Built,
        plan: &Plan,
        work: Work,
    ) -> Result<(Vec<Verdict>, Found), MeasureError> {
        let job = self.job_of(built, plan, work)?;
        self.found(built, job.run())
    }

    /// The same of what the workers did.
    fn found(&mut self, built: &Built, done: Done) -> Result<(Vec<Verdict>, Found), MeasureError> {
        self.spent.time += done.timed_for();
        self.spent.check += done.took().saturating_sub(done.timed_for());
        let (of_reference, measured, found) = done.into_verdicts()?;
        self.processes += found.processes;
        let places: Vec<usize> = built.entries().map(|(place, _)| place).collect();
        let verdicts = built
            .kernels
            .iter()
            .map(|built| built.as_ref().err().cloned());
        let mut verdicts: Vec<Option<Verdict>> = verdicts.collect();
        for (&place, verdict) in places.iter().zip(measured) {
            verdicts[place] = Some(verdict);
        }
        let verdicts = verdicts.into_iter().map(|one| one.expect("built or not"));
        let verdicts = [of_reference].into_iter().chain(verdicts).collect();
        Ok((verdicts, found.renumbered(|entry| places[entry])))
    }

    /// The reference's library, made by the first who asks.
    fn reference(&mut self) -> Result<Entry, MeasureError> {
        if let Some((_, entry)) = &self.built_reference {
            return Ok(entry.clone());
        }
        let directory = temporary_directory()?;
        let built = self.build_in(&[&self.reference], directory.path(), Shape::Separate)?;
        match built.into_iter().next().expect("one was to be built") {
            Ok(Compiled { entry, .. }) => {
                self.built_reference = Some((directory, entry.clone()));
                Ok(entry)
            }
            Err(verdict) => Err(MeasureError::Reference(Box::new(verdict))),
        }
    }

    /// Compiles kernels. Gives every one's place in a library, or why it has none.
    fn build_in(
        &self,
        kernels: &[&Kernel],
        directory: &Path,
        shape: Shape,
    ) -> Result<Vec<Result<Compiled, Verdict>>, MeasureError> {
        // Asked once for each kernel.
        let supported: Vec<bool> = kernels.iter().map(|one| (self.supports)(one.isa)).collect();
        let to_build = kernels.iter().zip(&supported);
        let to_build = to_build.filter(|(kernel, can)| **can && kernel.library.is_none());
        let to_build: Vec<&Kernel> = to_build.map(|(kernel, _)| *kernel).collect();
        let built = compile(&self.rustc, &to_build, directory, shape, &self.interrupt);
        let mut built = built.into_iter();
        let of_each = kernels.iter().zip(supported).map(|(kernel, supported)| {
            if !supported {
                return Ok(Err(Verdict::UnsupportedIsa));
            }
            if let Some(InLibrary { path, index }) = &kernel.library {
                return Ok(Ok(Compiled {
                    entry: Entry::new(path.clone(), *index, kernel.signature),
                    code: None,
                }));
            }
            match built.next().expect("built or why not") {
                Ok(compiled) => Ok(Ok(compiled)),
                Err(CompileError::Refused(message)) => Ok(Err(Verdict::BuildFailed { message })),
                Err(CompileError::TimedOut) => Ok(Err(Verdict::BuildTimedOut)),
                Err(CompileError::Interrupted) => Err(MeasureError::Interrupted),
            }
        });
        of_each.collect()
    }
}

fn temporary_directory() -> Result<TempDir, MeasureError> {
    tempfile::Builder::new()
        .prefix("raybreed-")
        .tempdir()
        .map_err(MeasureError::Directory)
}

/// The first 16 digits of the BLAKE3 hash of all that makes a kernel's binary.
pub fn source_hash(kernel: &Kernel) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(kernel.isa.name().as_bytes());
    hasher.update(kernel.function.as_bytes());
    hasher.update(kernel.source.as_bytes());
    hasher.finalize().to_hex()[..16].to_owned()
}

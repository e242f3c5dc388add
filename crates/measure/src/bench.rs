//! The bench: kernels in, verdicts out.

use std::ops::Range;
use std::path::Path;
use std::time::{Duration, Instant};

use emit::{InLibrary, Isa, Kernel};
use tempfile::TempDir;

use crate::compile::{Compiled, Shape, compile};
use crate::crew::Crew;
use crate::driver::WorkerCommand;
use crate::error::MeasureError;
use crate::interrupt::Interrupt;
use crate::judge::{Judged, Look};
use crate::protocol::{Batch, Counts, Entry, Race, Work, WorkloadSpec};
use crate::rustc::{CompileError, Rustc};
use crate::tally::Found;
use crate::verdict::Verdict;

/// Compiles, checks and times kernels on one workload, against one reference.
pub struct Bench {
    rustc: Rustc,
    crew: Crew,
    interrupt: Interrupt,
    reference: Kernel,
    /// The reference's library, once there is one.
    built_reference: Option<(TempDir, Entry)>,
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
    /// How many cores may time at once. There may be fewer.
    pub cores: usize,
    /// What each of them gets.
    pub deal: Deal,
    /// Whether the reference takes part as a kernel like others, which shows what difference
    /// between equals is due to noise.
    pub noise_floor: bool,
    /// By which rays the accuracy lab tries kernels before they are timed: a [`Trial`](accuracy::Trial), whose
    /// outcome is in their [`Accuracy`](crate::Accuracy).
    pub trial: Option<Look>,
}

impl Plan {
    /// So many rounds of everybody on one core.
    fn once(rounds: Vec<Range<usize>>) -> Plan {
        Plan {
            rounds,
            separate: true,
            race: None,
            racers: 0,
            cores: 1,
            deal: Deal::Kernels,
            noise_floor: false,
            trial: None,
        }
    }
}

/// What every core gets, beside a reference of its own.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Deal {
    /// Some of the kernels, in all rounds.
    Kernels,
    /// All kernels, in some of the rounds, so that those that are compared in a round run on one
    /// core. There are no races then.
    Rounds,
}

/// Kernels that were built, to be timed as often as wanted.
pub struct Built {
    kernels: Vec<Result<Compiled, Verdict>>,
    /// Where their libraries are.
    _directory: TempDir,
}

impl Built {
    /// A hash of every kernel's machine code, the same for kernels that are the same; none of those that were not
    /// built here.
    pub fn codes(&self) -> impl Iterator<Item = Option<&str>> {
        let kernels = self.kernels.iter();
        kernels.map(|built| built.as_ref().ok()?.code.as_deref())
    }

    /// Leaves out the kernels at whose places `keep` is false. Those that stay move up.
    pub fn retain(&mut self, keep: &[bool]) {
        let mut keep = keep.iter();
        self.kernels
            .retain(|_| keep.next().is_none_or(|keep| *keep));
    }
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
            crew: Crew::new(worker, workload, interrupt.clone()),
            interrupt,
            reference,
            built_reference: None,
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

    /// The same bench, whose workers may be silent for so long.
    #[must_use]
    pub fn with_patience(self, patience: Duration) -> Bench {
        Bench {
            crew: self.crew.with_patience(patience),
            ..self
        }
    }

    /// Where the time went so far.
    pub fn spent(&self) -> Spent {
        self.spent
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
            cores: self.crew.size(),
            ..Plan::once(Vec::new())
        };
        let (verdicts, mut found) = self.run(built, &plan, Work::Judge(look))?;
        let verdicts = verdicts.into_iter().skip(1).enumerate();
        let judged = verdicts.map(|(place, verdict)| found.judged.remove(&place).ok_or(verdict));
        Ok(judged.collect())
    }

    /// Runs what was built. Gives verdicts as of [`Bench::measure`], and what was found beside, by places among
    /// what was to be built.
    fn run(
        &mut self,
        built: &Built,
        plan: &Plan,
        work: Work,
    ) -> Result<(Vec<Verdict>, Found), MeasureError> {
        let reference = self.reference()?;
        let Built { kernels, .. } = built;
        let (places, mut entries): (Vec<usize>, Vec<Entry>) = kernels
            .iter()
            .enumerate()
            .filter_map(|(place, built)| Some((place, built.as_ref().ok()?.entry.clone())))
            .unzip();
        for (&place, entry) in places.iter().zip(&mut entries) {
            entry.races = place < plan.racers;
        }
        let (of_reference, measured, found) = self.run_entries(&reference, &entries, plan, work)?;

        let verdicts = kernels.iter().map(|built| built.as_ref().err().cloned());
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
            Err(verdict) => Err(MeasureError::Reference(verdict)),
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

    /// Has kernels timed. Gives the reference's verdict and theirs, and what was found of them beside, by their
    /// places.
    fn run_entries(
        &mut self,
        reference: &Entry,
        kernels: &[Entry],
        plan: &Plan,
        work: Work,
    ) -> Result<(Verdict, Vec<Verdict>, Found), MeasureError> {
        let start = Instant::now();
        self.batches += 1;
        let cores = plan.cores.clamp(1, self.crew.size());
        let batch = |core| self.batch(reference, kernels, plan, work, (core, cores));
        let batches = (0..cores).map(batch);
        let measured = self.crew.measure(batches.collect())?;
        let timed_for = measured.iter().map(|one| one.timed_for);
        let timed_for = timed_for.max().unwrap_or_default();
        self.spent.time += timed_for;
        self.spent.check += start.elapsed().saturating_sub(timed_for);

        let mut found = Found::default();
        let of_cores = measured.into_iter().enumerate().map(|(core, of_core)| {
            // The reference is number 0 everywhere, and nothing is found of it.
            let entry = |number: usize| match plan.deal {
                Deal::Kernels => (number - 1) * cores + core,
                Deal::Rounds => number - 1,
            };
            found.extend(of_core.found.renumbered(entry));
            of_core.verdicts.into_iter()
        });
        let mut of_cores: Vec<_> = of_cores.collect();
        let of_reference = of_cores.iter_mut().filter_map(Iterator::next).collect();
        let verdicts = (0..kernels.len()).map(|kernel| match plan.deal {
            Deal::Kernels => of_cores[kernel % cores].next().expect("a verdict a kernel"),
            Deal::Rounds => {
                Verdict::in_turn(of_cores.iter_mut().filter_map(Iterator::next).collect())
            }
        });
        let verdicts = verdicts.collect();
        Ok((Verdict::in_turn(of_reference), verdicts, found))
    }

    /// What core number `core` of `cores` gets.
    fn batch(
        &self,
        reference: &Entry,
        kernels: &[Entry],
        plan: &Plan,
        work: Work,
        (core, cores): (usize, usize),
    ) -> Batch {
        let (mut of_kernels, mut of_rounds) = ((0, 1), (0, 1));
        match plan.deal {
            Deal::Kernels => of_kernels = (core, cores),
            Deal::Rounds => of_rounds = (core, cores),
        }
        let kernels = kernels.iter().skip(of_kernels.0).step_by(of_kernels.1);
        let rounds = plan.rounds.iter().skip(of_rounds.0).step_by(of_rounds.1);
        Batch {
            kernels: [reference].into_iter().chain(kernels).cloned().collect(),
            rounds: rounds.cloned().collect(),
            work,
            order: self.batches,
            race: plan.race.clone(),
            noise_floor: plan.noise_floor,
            trial: plan.trial,
        }
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

//! A bench for each instruction set, and one verdict on a program of all its kernels.

use std::ops::Range;
use std::thread::JoinHandle;

use emit::Kernel;
use measure::{
    Bench, Built, Calibrated, Counts, Done, Job, LIMIT, MeasureError, Plan, Processes, Spent,
    Verdict,
};

/// Benches for the instruction sets of an arena, in its order.
pub struct Benches {
    of_isas: Vec<Bench>,
    /// The reference in fresh processes, once that was measured.
    calibrated: Option<Calibrated>,
}

/// Rounds in which fresh processes time the reference, at most.
const CALIBRATED_ROUNDS: usize = 16;

/// How often a worker was not believed, as a line; none if it never was.
pub fn disbelieved(Processes { replaced, slowed }: Processes) -> Option<String> {
    (replaced + slowed > 0).then(|| {
        format!(
            "processes  the reference was slower than before by more than {LIMIT} times in {} batches, which were timed \
             again by a fresh process: in {replaced} it was faster there, in {slowed} the machine had become slow",
            replaced + slowed
        )
    })
}

/// Programs that were built for all of them.
pub struct BuiltForAll(Vec<Built>);

/// Programs that are being checked and timed, by a thread of its own.
#[must_use = "what becomes of them is told when they are finished"]
pub struct Running {
    built: BuiltForAll,
    done: JoinHandle<Vec<Done>>,
}

impl BuiltForAll {
    /// What a program is as machine code, on all instruction sets together; none if that is not known of one.
    pub fn codes(&self) -> Vec<Option<String>> {
        let of_each: Vec<Vec<Option<&str>>> =
            self.0.iter().map(|one| one.codes().collect()).collect();
        let programs = of_each.first().map_or(0, Vec::len);
        let code = |place: usize| {
            let parts: Option<Vec<&str>> = of_each.iter().map(|codes| codes[place]).collect();
            parts.map(|parts| parts.join("-"))
        };
        (0..programs).map(code).collect()
    }

    /// Leaves out the programs at whose places `keep` is false. Those that stay move up.
    pub fn retain(&mut self, keep: &[bool]) {
        for built in &mut self.0 {
            built.retain(keep);
        }
    }
}

impl Benches {
    /// At least one.
    pub fn new(benches: Vec<Bench>) -> Benches {
        Benches {
            of_isas: benches,
            calibrated: None,
        }
    }

    /// Builds, checks and times programs, each given by its kernels for all instruction sets. The
    /// first verdict is that of the reference.
    ///
    /// With several instruction sets nobody races: who is ahead on one of them need not be on
    /// average.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn measure(
        &mut self,
        programs: &[&[Kernel]],
        plan: &Plan,
    ) -> Result<Vec<Verdict>, MeasureError> {
        let built = self.build(programs, plan.separate)?;
        self.time(&built, plan)
    }

    /// Builds programs.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be built at all.
    pub fn build(
        &mut self,
        programs: &[&[Kernel]],
        separate: bool,
    ) -> Result<BuiltForAll, MeasureError> {
        let built = self.of_isas.iter_mut().enumerate().map(|(place, bench)| {
            let kernels: Vec<&Kernel> = programs.iter().map(|kernels| &kernels[place]).collect();
            bench.build(&kernels, separate)
        });
        Ok(BuiltForAll(built.collect::<Result<_, _>>()?))
    }

    /// Checks and times programs that were built.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn time(&mut self, built: &BuiltForAll, plan: &Plan) -> Result<Vec<Verdict>, MeasureError> {
        let plan = self.plan(plan);
        self.of_all(built, |bench, built| bench.time(built, &plan))
    }

    /// Begins to check and time programs that were built; others may be built meanwhile, and none timed.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn begin(&mut self, built: BuiltForAll, plan: &Plan) -> Result<Running, MeasureError> {
        let plan = self.plan(plan);
        let benches = self.of_isas.iter_mut().zip(&built.0);
        let jobs = benches.map(|(bench, built)| bench.job(built, &plan));
        let jobs: Vec<Job> = jobs.collect::<Result<_, _>>()?;
        let done = std::thread::spawn(|| jobs.into_iter().map(Job::run).collect());
        Ok(Running { built, done })
    }

    /// The verdicts on programs, as of [`Benches::measure`], when they have been timed.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing could be measured at all.
    ///
    /// # Panics
    ///
    /// If the thread that had them timed did.
    pub fn finish(&mut self, running: Running) -> Result<Vec<Verdict>, MeasureError> {
        let done = running.done.join().expect("the thread comes to its end");
        let mut done = done.into_iter();
        self.of_all(&running.built, |bench, built| {
            bench.verdicts(built, done.next().expect("one a bench"))
        })
    }

    /// The plan, without a race if there are several instruction sets.
    fn plan(&self, plan: &Plan) -> Plan {
        match self.of_isas.len() {
            1 => plan.clone(),
            _ => Plan {
                race: None,
                racers: 0,
                ..plan.clone()
            },
        }
    }

    /// Times the precomputations of programs that were built.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn time_precomputations(
        &mut self,
        built: &BuiltForAll,
        passes: usize,
    ) -> Result<Vec<Verdict>, MeasureError> {
        self.of_all(built, |bench, built| {
            bench.time_precomputations(built, passes)
        })
    }

    /// How often programs use the words of their lanes in these rounds, on the first instruction set.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn count(
        &mut self,
        programs: &[&[Kernel]],
        rounds: Vec<Range<usize>>,
    ) -> Result<Vec<Option<Counts>>, MeasureError> {
        let kernels: Vec<&Kernel> = programs.iter().map(|kernels| &kernels[0]).collect();
        self.of_isas[0].count(&kernels, rounds)
    }

    /// One verdict a program, of those on each instruction set.
    fn of_all(
        &mut self,
        BuiltForAll(built): &BuiltForAll,
        mut time: impl FnMut(&mut Bench, &Built) -> Result<Vec<Verdict>, MeasureError>,
    ) -> Result<Vec<Verdict>, MeasureError> {
        let mut verdicts: Vec<Vec<Verdict>> = Vec::new();
        for (bench, built) in self.of_isas.iter_mut().zip(built) {
            let of_isa = time(bench, built)?;
            verdicts.resize_with(of_isa.len(), Vec::new);
            for (all, one) in verdicts.iter_mut().zip(of_isa) {
                all.push(one);
            }
        }
        Ok(verdicts.into_iter().map(Verdict::on_average).collect())
    }

    /// Compiles on so many cores from now on.
    ///
    /// # Panics
    ///
    /// If that is none.
    pub fn compile_on(&mut self, cores: usize) {
        for bench in &mut self.of_isas {
            bench.compile_at_once(cores);
        }
    }

    /// Times the reference in fresh processes, on each instruction set, on so many cores at once, unless that was done;
    /// gives one of all. From now on workers are told by it that are in a bad state, in some of these rounds at least.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing can be measured at all.
    pub fn calibrate(
        &mut self,
        rounds: &[Range<usize>],
        cores: usize,
    ) -> Result<Calibrated, MeasureError> {
        if let Some(calibrated) = &self.calibrated {
            return Ok(calibrated.clone());
        }
        let some = rounds.len().div_ceil(CALIBRATED_ROUNDS).max(1);
        let rounds: Vec<Range<usize>> = rounds.iter().step_by(some).cloned().collect();
        let benches = self.of_isas.iter_mut();
        let of_each = benches.map(|bench| bench.calibrate(rounds.clone(), cores));
        let of_each: Vec<Calibrated> = of_each.collect::<Result<_, _>>()?;
        let all = Calibrated::on_average(of_each);
        Ok(self.calibrated.insert(all).clone())
    }

    /// Has fresh processes time what comes next.
    pub fn dismiss_workers(&mut self) {
        for bench in &mut self.of_isas {
            bench.dismiss_workers();
        }
    }

    /// What became of worker processes in which the reference was slow, so far.
    pub fn processes(&self) -> Processes {
        let of_each = self.of_isas.iter().map(Bench::processes);
        of_each.fold(Processes::default(), |sum, one| sum + one)
    }

    /// Where the time went so far.
    pub fn spent(&self) -> Spent {
        let spent = self.of_isas.iter().map(Bench::spent);
        spent.fold(Spent::default(), |sum, one| Spent {
            compile: sum.compile + one.compile,
            check: sum.check + one.check,
            time: sum.time + one.time,
        })
    }
}

//! The worker: the process that loads candidate code, checks it and times it.
//!
//! It reads requests from standard input and writes events to standard output, a line of JSON
//! each. It may crash or hang at any time; before it does anything with a kernel it says so, and
//! the driver knows whose doing it was.

use std::collections::BTreeMap;
use std::io::{self, BufRead, Write};
use std::time::Instant;

use accuracy::{Trial, Tried};
use scene::{Layout, List, Lists, NO_HITS, RayHits, RayPacket, Workload, drive_together};

use crate::check::{Accuracy, Answers, Checks, MAX_EXCESS, MAX_P99_ERROR};
use crate::isolation::{isolate, stay_on};
use crate::judge::{Look, Specimen};
use crate::load::{Libraries, Loaded};
use crate::precomputation::precompute;
use crate::protocol::{Batch, Counts, Event, Failure, Phase, Prepare, Request, Work, WorkloadSpec};
use crate::timing::{Step, time};
use crate::track::Numbered;
use crate::witness::{Oracle, Witness};

/// Serves requests until standard input ends.
///
/// # Errors
///
/// If standard input or output fails, or a line of it is no request: the driver is gone.
pub fn run_worker() -> io::Result<()> {
    let (requests, events) = isolate()?;
    let mut events = Events(Box::new(events));
    let mut bench = None;
    for line in requests.lines() {
        match serde_json::from_str(&line?)? {
            Request::Prepare(Prepare { workload, core }) => {
                if let Some(core) = core {
                    stay_on(core);
                }
                bench = Some(Prepared::new(&workload));
                events.say(&Event::Done)?;
            }
            Request::Measure(batch) => match &mut bench {
                Some(bench) => bench.measure(&batch, &mut events)?,
                None => return Err(io::Error::other("asked to measure before to prepare")),
            },
        }
    }
    Ok(())
}

/// Where events go.
struct Events(Box<dyn Write>);

impl Events {
    fn say(&mut self, event: &Event) -> io::Result<()> {
        let mut line = serde_json::to_vec(event)?;
        line.push(b'\n');
        self.0.write_all(&line)?;
        self.0.flush()
    }

    fn begin(&mut self, kernel: usize, phase: Phase) -> io::Result<()> {
        self.say(&Event::Begin { kernel, phase })
    }

    fn fail(&mut self, kernel: usize, failure: Failure) -> io::Result<()> {
        self.say(&Event::Failed { kernel, failure })
    }
}

/// A workload with its right answers.
struct Prepared {
    spec: WorkloadSpec,
    workload: Workload,
    checks: Checks,
    /// The lists of the checks, in every layout that some kernel had.
    lists: BTreeMap<Layout, Lists>,
    /// The last trial that was asked for.
    trial: Option<(Look, Trial)>,
    oracle: Oracle,
}

/// A kernel that has been right so far.
struct Candidate {
    numbered: Numbered,
    /// What it answered to the checks.
    answers: Answers,
}

impl Prepared {
    fn new(spec: &WorkloadSpec) -> Prepared {
        let workload = spec.generator().generate();
        let checks = Checks::new(&spec.scene, workload.whole());
        Prepared {
            spec: spec.clone(),
            workload,
            checks,
            lists: BTreeMap::new(),
            trial: None,
            oracle: Oracle::default(),
        }
    }

    fn measure(&mut self, batch: &Batch, events: &mut Events) -> io::Result<()> {
        let mut libraries = Libraries::default();
        let mut alive = Vec::new();
        for number in 0..batch.kernels.len() {
            alive.extend(self.admit(batch, number, &mut libraries, events)?);
        }
        let mut witness = Witness::new(self.spec.scene.regime);
        let start = Instant::now();
        match batch.work {
            Work::Time => self.time(batch, &alive, &mut witness, events)?,
            Work::TimePrecomputations(passes) => {
                self.time_precomputations(batch, passes, &alive, events)?;
            }
            Work::Count => self.count(batch, &alive, &libraries, events)?,
            Work::Judge(look) => self.judge_kernels(look, &alive, events)?,
        }
        events.say(&Event::TimedFor(start.elapsed().as_secs_f64()))?;
        for candidate in &alive {
            let number = candidate.numbered.number;
            if let Some(failure) = self.judge(number, &witness, events)? {
                events.fail(number, failure)?;
            } else if let Some(failure) = self.check_again(candidate, events)? {
                events.fail(number, failure)?;
            }
        }
        events.say(&Event::Done)
    }

    /// Loads a kernel and checks it.
    fn admit(
        &mut self,
        batch: &Batch,
        number: usize,
        libraries: &mut Libraries,
        events: &mut Events,
    ) -> io::Result<Option<Candidate>> {
        let entry = &batch.kernels[number];
        events.begin(number, Phase::Load)?;
        let loaded = match libraries.load(entry, batch.work == Work::Time) {
            Ok(loaded) => loaded,
            Err(error) => {
                events.fail(number, Failure::NotLoaded(error.to_string()))?;
                return Ok(None);
            }
        };
        let layout = entry.layout;
        let lists = || {
            self.checks
                .lists(layout, |triangle| loaded.prepare(triangle))
        };
        self.lists.entry(layout).or_insert_with(lists);
        let phase = Phase::CheckBefore;
        events.begin(number, phase)?;
        let numbered = Numbered {
            number,
            loaded,
            layout,
        };
        let limit = MAX_EXCESS * MAX_P99_ERROR;
        let failure = match self.check(numbered) {
            Err(why) => Failure::Wrong(phase, why),
            Ok((_, accuracy)) if accuracy.p99 > limit => Failure::Inaccurate(accuracy),
            Ok((answers, mut accuracy)) => {
                accuracy.tried = batch.trial.map(|look| self.try_kernel(numbered, look));
                let kernel = number;
                events.say(&Event::Right { kernel, accuracy })?;
                return Ok(Some(Candidate { numbered, answers }));
            }
        };
        events.fail(number, failure)?;
        Ok(None)
    }

    /// Tries a kernel by rays of the accuracy lab, which are kept for the next ones.
    fn try_kernel(&mut self, kernel: Numbered, look: Look) -> Tried {
        if self.trial.as_ref().is_none_or(|(of, _)| *of != look) {
            self.trial = Some((look, Trial::new(look.samples, look.seed)));
        }
        let (_, trial) = self.trial.as_ref().expect("made where it was missing");
        trial.of(&mut Specimen::new(kernel, &self.spec.scene))
    }

    fn check(&self, kernel: Numbered) -> Result<(Answers, Accuracy), String> {
        let lists = &self.lists[&kernel.layout];
        self.checks.run(lists, caller(kernel.loaded))
    }

    fn time(
        &self,
        batch: &Batch,
        alive: &[Candidate],
        witness: &mut Witness,
        events: &mut Events,
    ) -> io::Result<()> {
        let kernels: Vec<Numbered> = alive.iter().map(|candidate| candidate.numbered).collect();
        let mut result = Ok(());
        let report = |step: Step<'_>| {
            let event = match step {
                Step::Begin(kernel) => Event::Begin {
                    kernel,
                    phase: Phase::Time,
                },
                Step::Left(kernel, packets, left) => {
                    let before = &self.workload.packets[packets.clone()];
                    return witness.see(kernel, packets.start, before, left);
                }
                Step::Timed(sample) => sample.into(),
                Step::Swept(kernel, sweep) => Event::Swept { kernel, sweep },
            };
            if result.is_ok() {
                result = events.say(&event);
            }
        };
        time(
            &self.workload,
            self.spec.scene.regime,
            &kernels,
            batch,
            report,
        );
        result
    }

    fn time_precomputations(
        &self,
        batch: &Batch,
        passes: usize,
        alive: &[Candidate],
        events: &mut Events,
    ) -> io::Result<()> {
        let kernels: Vec<Numbered> = alive.iter().map(|candidate| candidate.numbered).collect();
        let samples = precompute(&self.workload.triangles, &kernels, passes, batch.order);
        for sample in samples {
            events.say(&sample.into())?;
        }
        Ok(())
    }

    /// Runs every kernel whose words are counted through all rounds.
    fn count(
        &self,
        batch: &Batch,
        alive: &[Candidate],
        libraries: &Libraries,
        events: &mut Events,
    ) -> io::Result<()> {
        let whole = self.workload.whole();
        let mut hits = Box::new(NO_HITS);
        for Candidate { numbered, .. } in alive {
            let Numbered {
                number,
                loaded,
                layout,
            } = *numbered;
            let entry = &batch.kernels[number];
            let Some(before) = libraries.counts(entry) else {
                continue;
            };
            events.begin(number, Phase::Time)?;
            let lists = layout.lists_of(whole.lists(self.spec.scene.regime), |triangle| {
                loaded.prepare(triangle)
            });
            let mut tests = 0;
            for packets in &batch.rounds {
                let initial = &self.workload.packets[packets.clone()];
                let mut scratch = initial.to_vec();
                drive_together(
                    loaded.together(),
                    initial,
                    lists.iter(),
                    &mut scratch,
                    |packets, list| loaded.call_all(packets, &mut hits, list),
                );
                tests += self.workload.part(packets.clone()).tests();
            }
            let after = libraries.counts(entry).unwrap_or_default();
            let words = std::iter::zip(after, before).map(|(after, before)| after - before);
            let counts = Counts {
                tests,
                words: words.collect(),
            };
            events.say(&Event::Counted {
                kernel: number,
                counts,
            })?;
        }
        Ok(())
    }

    /// Takes every kernel but the reference to the accuracy lab.
    fn judge_kernels(
        &self,
        look: Look,
        alive: &[Candidate],
        events: &mut Events,
    ) -> io::Result<()> {
        // Workers share the cores already.
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let alone = alone.map_err(io::Error::other)?;
        for Candidate { numbered, .. } in alive.iter().filter(|one| one.numbered.number > 0) {
            let kernel = numbered.number;
            events.begin(kernel, Phase::Time)?;
            let specimen = Specimen::new(*numbered, &self.spec.scene);
            let judged = alone.install(|| specimen.judge(look));
            let judged = Box::new(judged);
            events.say(&Event::Judged { kernel, judged })?;
        }
        Ok(())
    }

    /// Whether a kernel was wrong while it was timed.
    fn judge(
        &mut self,
        kernel: usize,
        witness: &Witness,
        events: &mut Events,
    ) -> io::Result<Option<Failure>> {
        let phase = Phase::Time;
        for doubt in witness.doubts(kernel) {
            // The oracle takes its time, and the driver wants to hear something.
            events.begin(kernel, phase)?;
            if let Some(failure) = self.oracle.settle(&doubt, self.spec.task(), &self.workload) {
                return Ok(Some(failure));
            }
        }
        Ok(None)
    }

    /// Whether a kernel is wrong now, or answers other than it did before it was timed.
    fn check_again(
        &self,
        candidate: &Candidate,
        events: &mut Events,
    ) -> io::Result<Option<Failure>> {
        let phase = Phase::CheckAfter;
        let kernel = candidate.numbered;
        events.begin(kernel.number, phase)?;
        let lists = &self.lists[&kernel.layout];
        if self.checks.answers(lists, caller(kernel.loaded)) == candidate.answers {
            return Ok(None);
        }
        Ok(Some(match self.check(kernel) {
            Err(why) => Failure::Wrong(phase, why),
            Ok(_) => Failure::Nondeterministic,
        }))
    }
}

/// The call of a kernel, as checks take it.
fn caller(loaded: Loaded) -> impl FnMut(&mut RayPacket, &mut RayHits, List<'_>) {
    move |packet, hits, list| loaded.call(packet, hits, list)
}

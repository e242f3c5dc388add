//! The worker: the process that loads candidate code, checks it and times it.
//!
//! It reads requests from standard input and writes events to standard output, a line of JSON
//! each. It may crash or hang at any time; before it does anything with a kernel it says so, and
//! the driver knows whose doing it was.

use std::io::{self, BufRead, Write};
use std::time::Instant;

use scene::Workload;

use crate::check::{Checks, MAX_P99_ERROR};
use crate::isolation::isolate;
use crate::load::{Libraries, Loaded};
use crate::protocol::{Batch, Event, Failure, Phase, Request, WorkloadSpec};
use crate::timing::{Step, time};

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
            Request::Prepare(spec) => {
                bench = Some(Prepared::new(&spec));
                events.say(&Event::Done)?;
            }
            Request::Measure(batch) => match &bench {
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
}

impl Prepared {
    fn new(spec: &WorkloadSpec) -> Prepared {
        let workload = spec.generator().generate();
        let checks = Checks::new(spec.regime, workload.whole());
        Prepared {
            spec: spec.clone(),
            workload,
            checks,
        }
    }

    fn measure(&self, batch: &Batch, events: &mut Events) -> io::Result<()> {
        let mut libraries = Libraries::default();
        let mut alive = Vec::new();
        let mut first_answers = Vec::new();
        for (kernel, entry) in batch.kernels.iter().enumerate() {
            let phase = Phase::Load;
            events.begin(kernel, phase)?;
            let loaded = match libraries.load(entry) {
                Ok(loaded) => loaded,
                Err(error) => {
                    events.fail(kernel, Failure::NotLoaded(error.to_string()))?;
                    continue;
                }
            };
            let phase = Phase::CheckBefore;
            events.begin(kernel, phase)?;
            match self.check(loaded) {
                Err(why) => events.fail(kernel, Failure::Wrong(phase, why))?,
                Ok((_, accuracy)) if accuracy.p99 > MAX_P99_ERROR => {
                    events.fail(kernel, Failure::Inaccurate(accuracy))?;
                }
                Ok((answers, accuracy)) => {
                    events.say(&Event::Right { kernel, accuracy })?;
                    alive.push((kernel, loaded));
                    first_answers.push(answers);
                }
            }
        }
        let start = Instant::now();
        self.time(batch, &alive, events)?;
        events.say(&Event::TimedFor(start.elapsed().as_secs_f64()))?;
        let phase = Phase::CheckAfter;
        for (&(kernel, loaded), answers) in alive.iter().zip(&first_answers) {
            events.begin(kernel, phase)?;
            match self.check(loaded) {
                Err(why) => events.fail(kernel, Failure::Wrong(phase, why))?,
                Ok((again, _)) if again != *answers => {
                    events.fail(kernel, Failure::Nondeterministic)?
                }
                Ok(_) => {}
            }
        }
        events.say(&Event::Done)
    }

    fn check(&self, loaded: Loaded) -> Result<(crate::check::Answers, crate::Accuracy), String> {
        let kernel = |packet: &mut _, triangles: &[_]| loaded.call(packet, triangles);
        self.checks.run(kernel)
    }

    fn time(
        &self,
        batch: &Batch,
        alive: &[(usize, Loaded)],
        events: &mut Events,
    ) -> io::Result<()> {
        let phase = Phase::Time;
        let mut result = Ok(());
        let report = |step| {
            let event = match step {
                Step::Begin(kernel) => Event::Begin { kernel, phase },
                Step::Timed(sample) => Event::Sample {
                    kernel: sample.kernel,
                    seconds: sample.seconds,
                    reference: sample.reference,
                    tests: sample.tests,
                },
            };
            if result.is_ok() {
                result = events.say(&event);
            }
        };
        let regime = self.spec.regime;
        time(&self.workload, regime, alive, batch, report);
        result
    }
}

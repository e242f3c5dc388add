//! The worker: the process that loads candidate code, checks it and times it.
//!
//! It reads requests from standard input and writes events to standard output, a line of JSON
//! each. It may crash or hang at any time; before it does anything with a kernel it says so, and
//! the driver knows whose doing it was.

use std::io::{self, BufRead, Write};
use std::time::Instant;

use scene::Workload;

use crate::check::{Checks, MAX_P99_ERROR};
use crate::load::{Libraries, Loaded};
use crate::protocol::{Batch, Event, Failure, Phase, Request, WorkloadSpec};
use crate::timing::{Step, time};

/// Serves requests until standard input ends.
///
/// # Errors
///
/// If standard input or output fails, or a line of it is no request: the driver is gone.
pub fn run_worker() -> io::Result<()> {
    settle();
    let mut bench = None;
    for line in io::stdin().lock().lines() {
        match serde_json::from_str(&line?)? {
            Request::Prepare(spec) => {
                bench = Some(Prepared::new(&spec));
                say(&Event::Done)?;
            }
            Request::Measure(batch) => match &bench {
                Some(bench) => bench.measure(&batch)?,
                None => return Err(io::Error::other("asked to measure before to prepare")),
            },
        }
    }
    Ok(())
}

/// Ends with the driver, whatever ends that, and stays on one core where the system lets it.
fn settle() {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{Signal, set_parent_process_death_signal};
        // Without it the worker still ends when it next reads its input.
        let _ = set_parent_process_death_signal(Some(Signal::KILL));
    }
    if let Some(core) = core_affinity::get_core_ids().and_then(|cores| cores.last().copied()) {
        core_affinity::set_for_current(core);
    }
}

fn say(event: &Event) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    serde_json::to_writer(&mut stdout, event)?;
    stdout.write_all(b"\n")?;
    stdout.flush()
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

    fn measure(&self, batch: &Batch) -> io::Result<()> {
        let mut libraries = Libraries::default();
        let mut alive = Vec::new();
        let mut first_answers = Vec::new();
        for (kernel, entry) in batch.kernels.iter().enumerate() {
            let phase = Phase::Load;
            say(&Event::Begin { kernel, phase })?;
            let loaded = match libraries.load(entry) {
                Ok(loaded) => loaded,
                Err(error) => {
                    fail(kernel, Failure::NotLoaded(error.to_string()))?;
                    continue;
                }
            };
            let phase = Phase::CheckBefore;
            say(&Event::Begin { kernel, phase })?;
            match self.check(loaded) {
                Err(why) => fail(kernel, Failure::Wrong(phase, why))?,
                Ok((_, accuracy)) if accuracy.p99 > MAX_P99_ERROR => {
                    fail(kernel, Failure::Inaccurate(accuracy))?;
                }
                Ok((answers, accuracy)) => {
                    say(&Event::Right { kernel, accuracy })?;
                    alive.push((kernel, loaded));
                    first_answers.push(answers);
                }
            }
        }
        let start = Instant::now();
        self.time(batch, &alive)?;
        say(&Event::TimedFor(start.elapsed().as_secs_f64()))?;
        let phase = Phase::CheckAfter;
        for (&(kernel, loaded), answers) in alive.iter().zip(&first_answers) {
            say(&Event::Begin { kernel, phase })?;
            match self.check(loaded) {
                Err(why) => fail(kernel, Failure::Wrong(phase, why))?,
                Ok((again, _)) if again != *answers => fail(kernel, Failure::Nondeterministic)?,
                Ok(_) => {}
            }
        }
        say(&Event::Done)
    }

    fn check(&self, loaded: Loaded) -> Result<(crate::check::Answers, crate::Accuracy), String> {
        let kernel = |packet: &mut _, triangles: &[_]| loaded.call(packet, triangles);
        self.checks.run(kernel)
    }

    fn time(&self, batch: &Batch, alive: &[(usize, Loaded)]) -> io::Result<()> {
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
                result = say(&event);
            }
        };
        let regime = self.spec.regime;
        time(&self.workload, regime, alive, batch, report);
        result
    }
}

fn fail(kernel: usize, failure: Failure) -> io::Result<()> {
    say(&Event::Failed { kernel, failure })
}

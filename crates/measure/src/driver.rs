//! The driver's side of the worker: starts it, listens, and kills it when it does not answer.

use std::io::{self, BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use crate::error::MeasureError;
use crate::group::Group;
use crate::interrupt::Interrupt;
use crate::processes::{Calibration, Level, Processes};
use crate::protocol::{Batch, Event, Prepare, Request, Work};
use crate::tally::{Found, Tally, Verdicts};
use crate::verdict::Verdict;

/// How often a waiting driver looks whether it was asked to stop.
const POLL: Duration = Duration::from_millis(50);

/// The longest line that a worker writes is far shorter.
const LONGEST_LINE: usize = 1 << 16;

/// Lines that may wait for the driver. A worker that says more has to wait itself.
const BACKLOG: usize = 1 << 10;

/// How to start a worker: a program that calls [`run_worker`](crate::run_worker).
#[derive(Clone, Debug)]
pub struct WorkerCommand {
    /// The program.
    pub program: PathBuf,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// How long it may be silent before it is killed. The longest things that it does without a
    /// word are to make the workload and to run one kernel through one round's packets.
    pub patience: Duration,
}

/// A batch as it was measured.
#[derive(Default)]
pub(crate) struct Measured {
    /// A verdict a kernel.
    pub verdicts: Vec<Verdict>,
    /// What was found beside that.
    pub found: Found,
    /// How long the timing itself took.
    pub timed_for: Duration,
}

/// A worker that starts when it is needed, and again after it died.
pub(crate) struct Driver {
    command: WorkerCommand,
    prepare: Prepare,
    interrupt: Interrupt,
    process: Option<Process>,
    level: Level,
}

struct Process {
    group: Group,
    stdin: ChildStdin,
    lines: Receiver<String>,
}

impl Driver {
    pub fn new(command: WorkerCommand, prepare: Prepare, interrupt: Interrupt) -> Driver {
        Driver {
            command,
            prepare,
            interrupt,
            process: None,
            level: Level::default(),
        }
    }

    /// Measures a batch. A worker in which the reference is slower than it has been is replaced by a fresh one, which
    /// measures the batch again.
    pub fn measure(
        &mut self,
        batch: &Batch,
        calibration: &Calibration,
    ) -> Result<Measured, MeasureError> {
        let first = self.measure_once(batch)?;
        let state = calibration.state(&first.found.reference);
        let Some(state) = state.filter(|_| batch.work == Work::Time) else {
            return Ok(first);
        };
        if !self.level.doubts(state) {
            self.level.follow(state);
            return Ok(first);
        }
        self.kill();
        let mut again = self.measure_once(batch)?;
        let state = calibration.state(&again.found.reference).unwrap_or(state);
        again.found.processes += match self.level.doubts(state) {
            true => Processes {
                slowed: 1,
                ..Processes::default()
            },
            false => Processes {
                replaced: 1,
                ..Processes::default()
            },
        };
        self.level.follow(state);
        again.timed_for += first.timed_for;
        // A failure is final, in whatever process.
        for (verdict, before) in again.verdicts.iter_mut().zip(first.verdicts) {
            if !is_timed(&before) {
                *verdict = before;
            }
        }
        Ok(again)
    }

    /// Measures a batch. A kernel that crashes or hangs the worker gets that verdict, and the
    /// others are measured again without it. Also gives how long the timing itself took.
    fn measure_once(&mut self, batch: &Batch) -> Result<Measured, MeasureError> {
        let mut verdicts = Verdicts::new();
        let mut measured = Measured::default();
        let mut left: Vec<usize> = (0..batch.kernels.len()).collect();
        while !left.is_empty() {
            let part = Batch {
                kernels: left
                    .iter()
                    .map(|&kernel| batch.kernels[kernel].clone())
                    .collect(),
                ..batch.clone()
            };
            let (told, found, took) = self.attempt(&part)?;
            measured.timed_for += took;
            measured
                .found
                .extend(found.renumbered(|kernel| left[kernel]));
            for (kernel, verdict) in &told {
                verdicts.insert(left[*kernel], verdict.clone());
            }
            if told.contains_key(&0) && left[0] == 0 && !is_timed(&told[&0]) {
                return Err(MeasureError::Reference(Box::new(told[&0].clone())));
            }
            left.retain(|kernel| !verdicts.contains_key(kernel));
        }
        measured.verdicts = verdicts.into_values().collect();
        Ok(measured)
    }

    /// One go at a batch: all verdicts, or if the worker died only those that stand.
    fn attempt(&mut self, batch: &Batch) -> Result<(Verdicts, Found, Duration), MeasureError> {
        self.start()?;
        let mut tally = Tally::default();
        let sent = self.send(&Request::Measure(batch.clone())).is_ok();
        let fell_silent = sent
            && loop {
                match self.listen()? {
                    Heard::Event(Event::Done) => {
                        let took = tally.timed_for;
                        let (verdicts, found) = tally.finish(batch.kernels.len());
                        return Ok((verdicts, found, took));
                    }
                    Heard::Event(event) => tally.add(event),
                    Heard::Silence => break true,
                    Heard::End => break false,
                }
            };
        let verdicts = match self.kill() {
            None if fell_silent => tally.blame(|phase| Verdict::TimedOut { phase })?,
            status => {
                let signal = status.and_then(signal);
                tally.blame(|phase| Verdict::Crashed { phase, signal })?
            }
        };
        Ok((verdicts, Found::default(), Duration::ZERO))
    }

    fn start(&mut self) -> Result<(), MeasureError> {
        if self.process.is_some() {
            return Ok(());
        }
        let mut command = Command::new(&self.command.program);
        command
            .args(&self.command.arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null());
        let mut group = Group::start(&mut command).map_err(MeasureError::Worker)?;
        let stdin = group.leader().stdin.take().expect("stdin is piped");
        let stdout = group.leader().stdout.take().expect("stdout is piped");
        let (sender, lines) = sync_channel(BACKLOG);
        std::thread::spawn(move || {
            let mut stdout = BufReader::new(stdout);
            while let Ok(Some(line)) = read_line(&mut stdout) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        self.process = Some(Process {
            group,
            stdin,
            lines,
        });
        let prepare = Request::Prepare(self.prepare.clone());
        self.send(&prepare).map_err(MeasureError::Worker)?;
        match self.listen()? {
            Heard::Event(Event::Done) => Ok(()),
            _ => {
                self.kill();
                let why = "the worker did not get ready";
                Err(MeasureError::Worker(io::Error::other(why)))
            }
        }
    }

    fn send(&mut self, request: &Request) -> io::Result<()> {
        let process = self.process.as_mut().expect("started");
        let mut line = serde_json::to_vec(request)?;
        line.push(b'\n');
        process.stdin.write_all(&line)?;
        process.stdin.flush()
    }

    /// The worker's next event. Lines that are none are not its own: where the worker cannot keep
    /// its output to itself, candidate code shares it.
    fn listen(&mut self) -> Result<Heard, MeasureError> {
        let process = self.process.as_ref().expect("started");
        let start = Instant::now();
        loop {
            match process.lines.recv_timeout(POLL) {
                Ok(line) => {
                    if let Ok(event) = serde_json::from_str(&line) {
                        return Ok(Heard::Event(event));
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Ok(Heard::End),
            }
            if self.interrupt.is_raised() {
                self.kill();
                return Err(MeasureError::Interrupted);
            }
            if start.elapsed() > self.command.patience {
                return Ok(Heard::Silence);
            }
        }
    }

    /// Kills the worker with everything that it may have started. Gives its status if it had
    /// already ended.
    fn kill(&mut self) -> Option<ExitStatus> {
        let mut process = self.process.take()?;
        // A crashed worker's output ends a moment before the worker has.
        let deadline = Instant::now() + POLL;
        while !process.group.has_ended() && Instant::now() < deadline {
            std::thread::sleep(POLL / 50);
        }
        process.group.end()
    }
}

impl Drop for Driver {
    fn drop(&mut self) {
        self.kill();
    }
}

enum Heard {
    Event(Event),
    /// Nothing for too long.
    Silence,
    /// The worker's output ended.
    End,
}

fn read_line(from: &mut impl BufRead) -> io::Result<Option<String>> {
    let mut line = Vec::new();
    io::Read::take(&mut *from, LONGEST_LINE as u64).read_until(b'\n', &mut line)?;
    let text = String::from_utf8_lossy(&line).into_owned();
    Ok((!line.is_empty()).then_some(text))
}

fn is_timed(verdict: &Verdict) -> bool {
    matches!(verdict, Verdict::Timed { .. })
}

/// The signal that ended a process; none if it exited.
#[cfg(unix)]
fn signal(status: ExitStatus) -> Option<i32> {
    std::os::unix::process::ExitStatusExt::signal(&status)
}

/// What stands for the signal that ended a process.
#[cfg(not(unix))]
fn signal(status: ExitStatus) -> Option<i32> {
    status.code()
}

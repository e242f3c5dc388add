//! Workers that measure at the same time, one a core.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::cores::timing_cores;
use crate::driver::{Driver, Measured, WorkerCommand};
use crate::error::MeasureError;
use crate::interrupt::Interrupt;
use crate::processes::Calibration;
use crate::protocol::{Batch, Prepare, WorkloadSpec};

/// Workers, as many as have been needed so far.
pub(crate) struct Crew {
    command: WorkerCommand,
    workload: WorkloadSpec,
    interrupt: Interrupt,
    cores: Vec<usize>,
    members: Vec<Member>,
    calibration: Arc<Calibration>,
}

/// A thread with a worker of its own. A worker lives no longer than the thread that started it, so
/// this one stays.
struct Member {
    /// None once it has been told that no more will come.
    batches: Option<Sender<(Batch, Arc<Calibration>)>>,
    measured: Receiver<Result<Measured, MeasureError>>,
    thread: Option<JoinHandle<()>>,
}

/// A crew for whoever wants it to work. One that was left in the middle of its work has told why.
pub(crate) fn locked(crew: &Mutex<Crew>) -> MutexGuard<'_, Crew> {
    crew.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Crew {
    pub fn new(command: WorkerCommand, workload: WorkloadSpec, interrupt: Interrupt) -> Crew {
        Crew {
            command,
            workload,
            interrupt,
            cores: timing_cores(),
            members: Vec::new(),
            calibration: Arc::default(),
        }
    }

    /// Lets those who have not started yet be silent for so long.
    pub fn be_patient(&mut self, patience: Duration) {
        self.command.patience = patience;
    }

    /// How many workers there can be.
    pub fn size(&self) -> usize {
        self.cores.len().max(1)
    }

    /// Measures batches at the same time, each with a worker of its own.
    ///
    /// # Panics
    ///
    /// If there are more than [`Crew::size`].
    pub fn measure(&mut self, batches: Vec<Batch>) -> Result<Vec<Measured>, MeasureError> {
        assert!(batches.len() <= self.size(), "a core for every batch");
        while self.members.len() < batches.len() {
            self.members.push(self.fresh(self.members.len()));
        }
        at_once(&self.members, batches, &self.calibration)
    }

    /// Measures a batch in so many fresh processes or a few more, each of which is there for that alone, on so many
    /// cores at once. How fast the reference was is what is expected of it from now on.
    pub fn calibrate(
        &mut self,
        batch: &Batch,
        processes: usize,
        cores: usize,
    ) -> Result<Vec<Measured>, MeasureError> {
        let mut measured = Vec::new();
        // As many at once every time, since a core is slower beside a busy one.
        let count = cores.clamp(1, self.size());
        while measured.len() < processes {
            let fresh: Vec<Member> = (0..count).map(|place| self.fresh(place)).collect();
            let batches = vec![batch.clone(); count];
            measured.extend(at_once(&fresh, batches, &Arc::default())?);
        }
        let of_each: Vec<_> = measured
            .iter()
            .map(|one| one.found.reference.clone())
            .collect();
        self.calibration = Arc::new(Calibration::of(&of_each));
        Ok(measured)
    }

    /// Ends all workers. The next batches are measured by fresh ones.
    pub fn dismiss(&mut self) {
        self.members.clear();
    }

    /// A member on the core at a place, whose worker is yet to start.
    fn fresh(&self, place: usize) -> Member {
        let prepare = Prepare {
            workload: self.workload.clone(),
            core: self.cores.get(place).copied(),
        };
        let (command, interrupt) = (self.command.clone(), self.interrupt.clone());
        Member::start(Driver::new(command, prepare, interrupt))
    }
}

/// Measures batches at the same time, each with a member of its own.
fn at_once(
    members: &[Member],
    batches: Vec<Batch>,
    calibration: &Arc<Calibration>,
) -> Result<Vec<Measured>, MeasureError> {
    let busy = members.iter().take(batches.len());
    for (member, batch) in busy.clone().zip(batches) {
        member.begin(batch, Arc::clone(calibration));
    }
    // All are waited for, so that none still works when the next batches come.
    let measured: Vec<_> = busy.map(Member::finish).collect();
    measured.into_iter().collect()
}

impl Member {
    fn start(mut driver: Driver) -> Member {
        let (batches, to_measure) = channel::<(Batch, Arc<Calibration>)>();
        let (done, measured) = channel();
        let thread = std::thread::spawn(move || {
            for (batch, calibration) in to_measure {
                if done.send(driver.measure(&batch, &calibration)).is_err() {
                    break;
                }
            }
        });
        Member {
            batches: Some(batches),
            measured,
            thread: Some(thread),
        }
    }

    fn begin(&self, batch: Batch, calibration: Arc<Calibration>) {
        let batches = self.batches.as_ref().expect("more may come");
        let sent = batches.send((batch, calibration));
        sent.expect("the thread is there");
    }

    fn finish(&self) -> Result<Measured, MeasureError> {
        self.measured.recv().expect("the thread is there")
    }
}

impl Drop for Member {
    /// Ends the worker too.
    fn drop(&mut self) {
        drop(self.batches.take());
        if let Some(thread) = self.thread.take() {
            // If it panicked, that was told where its answer was missed.
            let _ = thread.join();
        }
    }
}

//! What a bench has its workers do: put together by the bench, done on whichever thread, and read by the bench.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use crate::crew::{Crew, locked};
use crate::driver::Measured;
use crate::error::MeasureError;
use crate::plan::{Deal, Plan};
use crate::protocol::{Batch, Entry, Work};
use crate::tally::Found;
use crate::verdict::Verdict;

/// A batch for the workers of a bench. Those of one bench are done one after another.
#[must_use = "nothing is measured until it is run"]
pub struct Job {
    crew: Arc<Mutex<Crew>>,
    /// One a core.
    batches: Vec<Batch>,
    deal: Deal,
    /// How many kernels there are beside the reference.
    kernels: usize,
}

/// What the workers did.
pub struct Done {
    /// One a core.
    measured: Result<Vec<Measured>, MeasureError>,
    took: Duration,
    deal: Deal,
    kernels: usize,
}

impl Job {
    /// The job of measuring kernels by a plan. `order` is the seed of the order in which they take turns.
    pub(crate) fn new(
        crew: &Arc<Mutex<Crew>>,
        reference: &Entry,
        kernels: &[Entry],
        plan: &Plan,
        (work, order): (Work, u64),
    ) -> Job {
        let cores = plan.cores.clamp(1, locked(crew).size());
        let batch = |core| {
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
                order,
                race: plan.race.clone(),
                noise_floor: plan.noise_floor,
                sweep: plan.sweep,
                trial: plan.trial,
            }
        };
        Job {
            crew: Arc::clone(crew),
            batches: (0..cores).map(batch).collect(),
            deal: plan.deal,
            kernels: kernels.len(),
        }
    }

    /// Does it.
    pub fn run(self) -> Done {
        let start = Instant::now();
        Done {
            measured: locked(&self.crew).measure(self.batches),
            took: start.elapsed(),
            deal: self.deal,
            kernels: self.kernels,
        }
    }
}

impl Done {
    /// How long it took.
    pub(crate) fn took(&self) -> Duration {
        self.took
    }

    /// How much of that was timing.
    pub(crate) fn timed_for(&self) -> Duration {
        let of_cores = self.measured.iter().flatten().map(|one| one.timed_for);
        of_cores.max().unwrap_or_default()
    }

    /// The reference's verdict and the kernels', and what was found of them beside, by their places.
    ///
    /// # Errors
    ///
    /// [`MeasureError`] if nothing could be measured at all.
    pub(crate) fn into_verdicts(self) -> Result<(Verdict, Vec<Verdict>, Found), MeasureError> {
        let measured = self.measured?;
        let cores = measured.len();
        let mut found = Found::default();
        let of_cores = measured.into_iter().enumerate().map(|(core, of_core)| {
            // The reference is number 0 everywhere, and nothing is found of it but a sweep, which is in its verdict.
            let entry = |number: usize| match self.deal {
                Deal::Kernels => (number - 1) * cores + core,
                Deal::Rounds => number - 1,
            };
            let of_kernels = Found {
                sweeps: BTreeMap::new(),
                ..of_core.found
            };
            found.extend(of_kernels.renumbered(entry));
            of_core.verdicts.into_iter()
        });
        let mut of_cores: Vec<_> = of_cores.collect();
        let of_reference = of_cores.iter_mut().filter_map(Iterator::next).collect();
        let verdicts = (0..self.kernels).map(|kernel| match self.deal {
            Deal::Kernels => of_cores[kernel % cores].next().expect("a verdict a kernel"),
            Deal::Rounds => {
                Verdict::in_turn(of_cores.iter_mut().filter_map(Iterator::next).collect())
            }
        });
        let verdicts = verdicts.collect();
        Ok((Verdict::in_turn(of_reference), verdicts, found))
    }
}

//! What driver and worker say to each other: a line of JSON each.

use std::ops::Range;
use std::path::PathBuf;

use emit::Signature;
use scene::{Directions, Generator, Layout, SceneModel, Task};
use serde::{Deserialize, Serialize};

use crate::check::Accuracy;
use crate::judge::{Judged, Look};
use crate::memory_layout::Sweep;
use crate::statistics::Lead;

/// The workload, by what it is generated from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorkloadSpec {
    /// Seed of the appendix's generator.
    pub seed: u32,
    /// How many triangles.
    pub triangles: usize,
    /// How many packets of 64 rays.
    pub packets: usize,
    /// Bound of a packet's target in each coordinate, if not the paper's: the larger, the fewer hits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target_range: Option<f32>,
    /// What the scene requires.
    pub scene: SceneModel,
}

impl WorkloadSpec {
    /// The generator of its rays and triangles.
    pub fn generator(&self) -> Generator {
        let papers = Generator::default();
        Generator {
            seed: self.seed,
            triangles: self.triangles,
            packets: self.packets,
            origin: self.scene.origin,
            range: self.scene.range,
            directions: self
                .scene
                .bounds
                .map_or(Directions::Any, |bounds| bounds.directions),
            target_range: self.target_range.unwrap_or(papers.target_range),
            ..papers
        }
    }

    /// What kernels are asked.
    pub fn task(&self) -> Task {
        Task::of(&self.scene)
    }
}

/// The first line to a worker, then one for every batch.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Request {
    /// Get ready; every later request is about this.
    Prepare(Prepare),
    /// Load, check, time and check again.
    Measure(Batch),
}

/// What a worker works on, and where.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Prepare {
    /// The workload to generate.
    pub workload: WorkloadSpec,
    /// The core to stay on, where a process can choose.
    pub core: Option<usize>,
}

/// Kernels to be measured together.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Batch {
    /// The kernels; the first one is the reference.
    pub kernels: Vec<Entry>,
    /// The packets of each round.
    pub rounds: Vec<Range<usize>>,
    /// What is done in them.
    pub work: Work,
    /// Seed of the order in which they take turns.
    pub order: u64,
    /// Whom kernels race against, so that no more is timed than must be.
    pub race: Option<Race>,
    /// Whether the reference is timed against itself.
    pub noise_floor: bool,
    /// Whether kernels that are still in the race at its end are swept over memory layouts.
    pub sweep: bool,
    /// By which rays of the accuracy lab kernels are tried before they are timed.
    pub trial: Option<Look>,
}

/// What is done with kernels once they have been right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Work {
    /// They are timed, round by round.
    Time,
    /// Their precomputations are timed, in so many passes over all triangles.
    TimePrecomputations(usize),
    /// They run through all rounds once, and their words are counted.
    Count,
    /// They go to the accuracy lab, without the reference.
    Judge(Look),
}

/// Somebody to race against. A kernel is timed until it is clear who is faster.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Race {
    /// The other's ratios to the reference, one a round of the batch; empty if there is nobody,
    /// and then every race ends at the first look.
    pub ratios: Vec<f64>,
    /// How many rounds there are between two looks.
    pub every: usize,
}

impl Race {
    /// How far a kernel with these ratios is ahead; none if there is nobody to race against.
    pub fn lead(&self, ratios: &[f64]) -> Option<Lead> {
        (!self.ratios.is_empty()).then(|| Lead::of(ratios, &self.ratios))
    }

    /// Whether a kernel with these ratios must go on.
    pub(crate) fn is_open(&self, ratios: &[f64]) -> bool {
        self.lead(ratios).is_some_and(|lead| !lead.is_clear())
    }
}

/// A kernel in a library.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Entry {
    /// The library's file.
    pub library: PathBuf,
    /// The kernel's place in it.
    pub index: usize,
    /// How it has its triangles in memory.
    pub layout: Layout,
    /// How many packets, one after the other, it takes at once.
    pub together: usize,
    /// Whether it leaves the batch when its race is decided.
    pub races: bool,
}

impl Entry {
    /// One that does not race.
    pub fn new(library: PathBuf, index: usize, signature: Signature) -> Entry {
        Entry {
            library,
            index,
            layout: signature.layout,
            together: signature.rays.div_ceil(scene::PACKET_SIZE),
            races: false,
        }
    }
}

/// What a worker is doing with a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Phase {
    /// Loading its library.
    Load,
    /// Checking its answers before timing.
    CheckBefore,
    /// Timing it.
    Time,
    /// Checking its answers again.
    CheckAfter,
}

/// A line from a worker.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Event {
    /// From here on, whatever happens to the worker is this kernel's doing.
    Begin { kernel: usize, phase: Phase },
    /// The kernel is out of the batch.
    Failed { kernel: usize, failure: Failure },
    /// Its answers are right, and this accurate.
    Right { kernel: usize, accuracy: Accuracy },
    /// One timing, of packets from this one on, and that of the reference beside it, in seconds for so many tests; or of
    /// a precomputation for so many triangles, and that of a copy.
    Sample {
        kernel: usize,
        packet: usize,
        seconds: f64,
        reference: f64,
        tests: u64,
    },
    /// How the kernel's time depends on where things lie in memory.
    Swept { kernel: usize, sweep: Sweep },
    /// How often the kernel used each word in so many tests.
    Counted { kernel: usize, counts: Counts },
    /// What the accuracy lab says of a kernel.
    Judged { kernel: usize, judged: Box<Judged> },
    /// All timings of the batch together took so many seconds.
    TimedFor(f64),
    /// The batch is done.
    Done,
}

/// How often a kernel used the words that are counted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Tests of a ray and a triangle in which it did.
    pub tests: u64,
    /// How often, in the order of [`emit::COUNTED_WORDS`].
    pub words: Vec<u64>,
}

/// Why the worker put a kernel out of a batch.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Failure {
    NotLoaded(String),
    Wrong(Phase, String),
    Inaccurate(Accuracy),
    Nondeterministic,
}

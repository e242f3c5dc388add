//! Two traced the same rays: how long each took, and where they differ.

use std::fmt;
use std::time::{Duration, Instant};

use indicatif::HumanCount;
use raybreed::Ray;

/// The two on one kind of ray.
pub struct Score {
    kind: &'static str,
    rays: u64,
    kernels: Duration,
    obvhs: Duration,
    disagreements: u64,
}

impl Score {
    /// Nothing yet.
    pub fn new(kind: &'static str) -> Score {
        Score {
            kind,
            rays: 0,
            kernels: Duration::ZERO,
            obvhs: Duration::ZERO,
            disagreements: 0,
        }
    }

    /// Has both trace `rays`, twice by turns, and counts the shorter time of each: a pause of the machine is neither's
    /// fault, and who comes first finds the caches cold. The kernels start from a copy of `start` each time. Both say
    /// which rays hit; given back is what the kernels made of `start`, and what they say.
    pub fn race<T: Clone>(
        &mut self,
        rays: &[Ray],
        start: &T,
        kernels: impl Fn(&mut T) -> Vec<bool>,
        obvhs: impl Fn() -> Vec<bool>,
    ) -> (T, Vec<bool>) {
        let trace = || {
            let mut traced = start.clone();
            let (ours, kernels) = timed(|| kernels(&mut traced));
            let (theirs, obvhs) = timed(&obvhs);
            (kernels, obvhs, traced, ours, theirs)
        };
        let (kernels, obvhs, ..) = trace();
        let (kernels_again, obvhs_again, traced, ours, theirs) = trace();
        self.kernels += kernels.min(kernels_again);
        self.obvhs += obvhs.min(obvhs_again);
        self.rays += rays.iter().filter(|ray| ray.t > 0.0).count() as u64;
        self.disagreements += ours.iter().zip(&theirs).filter(|(a, b)| a != b).count() as u64;
        (traced, ours)
    }

    /// The head of a table of scores.
    pub fn head() -> String {
        let [kind, rays, ratio, differ] = ["Mrays/s", "rays", "ratio", "disagree"];
        format!(
            "{kind:<20}{rays:>14}{:>12}{:>12}{ratio:>8}{differ:>10}",
            "raybreed", "obvhs"
        )
    }
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let speed = |time: Duration| self.rays as f64 / time.as_secs_f64() / 1e6;
        let (ours, theirs) = (speed(self.kernels), speed(self.obvhs));
        let rays = HumanCount(self.rays).to_string();
        let differ = HumanCount(self.disagreements).to_string();
        write!(
            f,
            "{:<20}{rays:>14}{ours:>12.2}{theirs:>12.2}{:>8.2}{differ:>10}",
            self.kind,
            ours / theirs
        )
    }
}

/// What `work` gives, and the time that it takes.
fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let done = work();
    (done, start.elapsed())
}

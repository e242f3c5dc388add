//! Kernels timed in turn with the reference.

use std::ops::Range;
use std::time::Instant;

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use scene::{Regime, Workload, drive};

use crate::load::Loaded;

/// How many kernels share one timing of the reference. The machine's speed drifts, so the
/// reference must be near in time.
const NEIGHBOURS: usize = 6;

/// One timing.
pub(crate) struct Sample {
    pub kernel: usize,
    pub seconds: f64,
    pub reference: f64,
    pub tests: u64,
}

/// What can be said while timing goes on.
pub(crate) enum Step {
    /// This kernel is about to run.
    Begin(usize),
    /// Its time, and that of the reference in its group.
    Timed(Sample),
}

/// Times `kernels` in rounds, each on its own packets. Kernel 0 is the reference; it is timed
/// once in every group of a few neighbours, at a random place among them, and once as a
/// candidate of its own, which gives the noise floor.
pub(crate) fn time(
    workload: &Workload,
    regime: Regime,
    kernels: &[(usize, Loaded)],
    rounds: &[Range<usize>],
    order: u64,
    mut report: impl FnMut(Step),
) {
    let mut rng = ChaCha8Rng::seed_from_u64(order);
    let Some(&reference) = kernels.iter().find(|(index, _)| *index == 0) else {
        return;
    };
    let largest = rounds.iter().map(Range::len).max().unwrap_or(0);
    let mut scratch = workload.packets[..largest].to_vec();
    let mut run = |(index, kernel): (usize, Loaded), packets: &Range<usize>| {
        report(Step::Begin(index));
        let part = workload.part(packets.clone());
        let scratch = &mut scratch[..packets.len()];
        scratch.clone_from_slice(part.packets);
        let start = Instant::now();
        drive(regime, part, scratch, |packet, triangles| {
            kernel.call(packet, triangles);
        });
        (start.elapsed().as_secs_f64(), part.tests())
    };
    let mut samples = Vec::new();
    if let Some(first) = rounds.first() {
        // Caches, page tables and the clock come up to speed on the largest part of the work.
        run(reference, first);
    }
    for packets in rounds {
        let mut turns = kernels.to_vec();
        turns.shuffle(&mut rng);
        for group in turns.chunks(NEIGHBOURS) {
            let mut group: Vec<(bool, (usize, Loaded))> =
                group.iter().map(|&kernel| (false, kernel)).collect();
            group.push((true, reference));
            group.shuffle(&mut rng);
            let mut beside = 0.0;
            let mut timed = Vec::new();
            for (is_beside, kernel) in group {
                let (seconds, tests) = run(kernel, packets);
                if is_beside {
                    beside = seconds;
                } else {
                    timed.push((kernel.0, seconds, tests));
                }
            }
            samples.extend(timed.into_iter().map(|(kernel, seconds, tests)| Sample {
                kernel,
                seconds,
                reference: beside,
                tests,
            }));
        }
    }
    for sample in samples {
        report(Step::Timed(sample));
    }
}

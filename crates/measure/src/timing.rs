//! Kernels timed in turn with the reference.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::ops::Range;

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use scene::{RayPacket, Regime, Workload};

use crate::memory_layout::{COPIES, MemoryLayout, Sweep};
use crate::placed::LINES;
use crate::protocol::{Batch, Event};
use crate::stopwatch::Stopwatch;
use crate::sweep::sweep;
use crate::track::{Numbered, Track};

/// How many kernels share one timing of the reference at most. The machine's speed drifts, so the
/// reference must be near in time.
const NEIGHBOURS: usize = 12;

/// Branches that it takes to make a processor forget others: more than any predictor has entries.
const FORGETTING: usize = 1 << 16;

/// One timing.
pub(crate) struct Sample {
    pub kernel: usize,
    /// The first packet of the round.
    pub packet: usize,
    pub seconds: f64,
    pub reference: f64,
    pub tests: u64,
}

impl From<Sample> for Event {
    fn from(
        Sample {
            kernel,
            packet,
            seconds,
            reference,
            tests,
        }: Sample,
    ) -> Event {
        Event::Sample {
            kernel,
            packet,
            seconds,
            reference,
            tests,
        }
    }
}

/// What can be said while timing goes on.
pub(crate) enum Step<'a> {
    /// This kernel is about to run.
    Begin(usize),
    /// What a kernel left in the packets of a round.
    Left(usize, Range<usize>, &'a [RayPacket]),
    /// Its time, and that of the reference in its group.
    Timed(Sample),
    /// How its time depends on where things lie in memory.
    Swept(usize, Sweep),
}

/// Times `kernels` in the batch's rounds, each on its own packets.
///
/// Kernel 0 is the reference. In every round the kernels take turns in random order, in groups of
/// a few with the reference at a random place among them. If the noise
/// floor is wanted, the reference also takes part as a kernel of its own, by another copy of its code. Every turn has a
/// [`MemoryLayout`] of its own, and every round has the records at a place of its own. In the end, if the batch wants it,
/// kernels that are still in the race are swept over memory layouts.
pub(crate) fn time(
    workload: &Workload,
    regime: Regime,
    kernels: &[Numbered],
    batch: &Batch,
    mut report: impl FnMut(Step<'_>),
) {
    let Some(&reference) = kernels.iter().find(|kernel| kernel.number == 0) else {
        return;
    };
    let mut rng = ChaCha8Rng::seed_from_u64(batch.order);
    let most = batch.rounds.iter().map(ExactSizeIterator::len).max();
    let whole = workload.whole();
    let lists = whole.lists(regime);
    let mut track = Track::new(workload, lists, kernels, most.unwrap_or(0));
    let mut random = 1;
    let mut racing = kernels.to_vec();
    racing.retain(|kernel| kernel.number > 0 || batch.noise_floor);
    let mut ratios: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    if let Some(first) = batch.rounds.first() {
        // Caches, page tables and the clock come up to speed.
        timed(
            &mut track,
            reference,
            MemoryLayout::default(),
            first,
            &mut report,
        );
    }
    for (round, packets) in batch.rounds.iter().enumerate() {
        if let Some(race) = &batch.race
            && round > 0
            && round.is_multiple_of(race.every)
        {
            racing.retain(|kernel| {
                !batch.kernels[kernel.number].races || race.is_open(&ratios[&kernel.number])
            });
        }
        racing.shuffle(&mut rng);
        track.move_records(rng.random_range(0..LINES));
        let groups = racing.len().div_ceil(NEIGHBOURS);
        let size = racing.len().div_ceil(groups.max(1)).max(1);
        for group in racing.chunks(size) {
            let mut turns: Vec<Option<Numbered>> = group.iter().copied().map(Some).collect();
            // The turn of nobody in the group is that of the reference beside them.
            turns.push(None);
            turns.shuffle(&mut rng);
            let mut beside = f64::NAN;
            let code = rng.random_range(0..COPIES);
            let mut times = Vec::with_capacity(group.len());
            for turn in turns {
                let kernel = turn.unwrap_or(reference);
                let mut at = MemoryLayout::random(&mut rng);
                if kernel.number == 0 {
                    // The reference and what it is held against are never one place.
                    at.code = (code + usize::from(turn.is_some())) % COPIES;
                }
                random = forget_branches(random);
                let seconds = timed(&mut track, kernel, at, packets, &mut report);
                match turn {
                    Some(kernel) => times.push((kernel.number, seconds)),
                    None => beside = seconds,
                }
            }
            for (kernel, seconds) in times {
                ratios.entry(kernel).or_default().push(beside / seconds);
                report(Step::Timed(Sample {
                    kernel,
                    packet: packets.start,
                    seconds,
                    reference: beside,
                    tests: workload.part(packets.clone()).tests(),
                }));
            }
        }
    }
    let first = batch.rounds.first().filter(|_| batch.sweep);
    for (kernel, packets) in racing.into_iter().zip(first.into_iter().cycle()) {
        report(Step::Begin(kernel.number));
        let swept = sweep(workload, kernel, packets.start);
        report(Step::Swept(kernel.number, swept));
    }
}

/// Runs a kernel on some packets and gives the seconds that it took.
fn timed(
    track: &mut Track<'_>,
    kernel: Numbered,
    at: MemoryLayout,
    packets: &Range<usize>,
    report: &mut impl FnMut(Step<'_>),
) -> f64 {
    report(Step::Begin(kernel.number));
    let (seconds, left) = track.run(kernel, at, packets, |run| {
        let watch = Stopwatch::start();
        run();
        watch.seconds()
    });
    report(Step::Left(kernel.number, packets.clone(), left));
    seconds
}

/// Makes the processor forget how branches went, by as many that nobody can foretell.
///
/// Kernels of a batch run on the same packets one after another, and their branches go alike. A
/// predictor learns tens of thousands of outcomes by heart, across kernels too where their addresses
/// look alike to it; then those are fastest that lie well in memory, in a state that no renderer is
/// ever in.
fn forget_branches(mut random: u64) -> u64 {
    for _ in 0..FORGETTING {
        // Knuth's linear congruential generator; its high bits are good.
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        if random >> 63 == 0 {
            black_box(random);
        } else {
            black_box(!random);
        }
    }
    random
}

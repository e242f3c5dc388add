//! Kernels timed in turn with the reference.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::ops::Range;

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use scene::{Layout, Lists, NO_HITS, RayHits, RayPacket, Regime, Workload, drive_together};

use crate::load::Loaded;
use crate::protocol::Batch;
use crate::stopwatch::Stopwatch;

/// How many kernels share one timing of the reference at most. The machine's speed drifts, so the
/// reference must be near in time.
const NEIGHBOURS: usize = 12;

/// Branches that it takes to make a processor forget others: more than any predictor has entries.
const FORGETTING: usize = 1 << 16;

/// A kernel to be timed.
#[derive(Clone, Copy)]
pub(crate) struct Numbered {
    /// Its place in the batch.
    pub number: usize,
    /// Its code.
    pub loaded: Loaded,
    /// How it has its triangles in memory.
    pub layout: Layout,
}

/// One timing.
pub(crate) struct Sample {
    pub kernel: usize,
    pub seconds: f64,
    pub reference: f64,
    pub tests: u64,
}

/// What can be said while timing goes on.
pub(crate) enum Step<'a> {
    /// This kernel is about to run.
    Begin(usize),
    /// What a kernel left in the packets of a round.
    Left(usize, Range<usize>, &'a [RayPacket]),
    /// Its time, and that of the reference in its group.
    Timed(Sample),
}

/// Times `kernels` in the batch's rounds, each on its own packets.
///
/// Kernel 0 is the reference. In every round the kernels take turns in random order, in groups of
/// a few with the reference at a random place among them. If the noise
/// floor is wanted, the reference also takes part as a kernel of its own.
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
    let mut track = Track::new(workload, regime, kernels);
    let mut racing = kernels.to_vec();
    racing.retain(|kernel| kernel.number > 0 || batch.noise_floor);
    let mut ratios: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    if let Some(first) = batch.rounds.first() {
        // Caches, page tables and the clock come up to speed.
        track.run(reference, first, &mut report);
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
        let groups = racing.len().div_ceil(NEIGHBOURS);
        let size = racing.len().div_ceil(groups.max(1)).max(1);
        for group in racing.chunks(size) {
            let mut turns: Vec<Option<Numbered>> = group.iter().copied().map(Some).collect();
            // The turn of nobody in the group is that of the reference beside them.
            turns.push(None);
            turns.shuffle(&mut rng);
            let mut beside = f64::NAN;
            let mut times = Vec::with_capacity(group.len());
            for turn in turns {
                let seconds = track.run(turn.unwrap_or(reference), packets, &mut report);
                match turn {
                    Some(kernel) => times.push((kernel.number, seconds)),
                    None => beside = seconds,
                }
            }
            for (kernel, seconds) in times {
                ratios.entry(kernel).or_default().push(beside / seconds);
                report(Step::Timed(Sample {
                    kernel,
                    seconds,
                    reference: beside,
                    tests: workload.part(packets.clone()).tests(),
                }));
            }
        }
    }
}

/// Where kernels run: the workload, with packets to write to.
struct Track<'a> {
    workload: &'a Workload,
    /// The lists of triangles in every layout that some kernel has.
    lists: BTreeMap<Layout, Lists>,
    scratch: Vec<RayPacket>,
    hits: Box<RayHits>,
    /// Where the random numbers of [`forget_branches`] are.
    forgetting: u64,
}

impl<'a> Track<'a> {
    fn new(workload: &'a Workload, regime: Regime, kernels: &[Numbered]) -> Track<'a> {
        let whole = workload.whole();
        let mut lists = BTreeMap::new();
        for Numbered { loaded, layout, .. } in kernels {
            lists.entry(*layout).or_insert_with(|| {
                layout.lists_of(whole.lists(regime), |triangle| loaded.prepare(triangle))
            });
        }
        Track {
            workload,
            lists,
            scratch: workload.packets.clone(),
            hits: Box::new(NO_HITS),
            forgetting: 1,
        }
    }

    /// Seconds that a kernel takes for some packets.
    fn run(
        &mut self,
        kernel: Numbered,
        packets: &Range<usize>,
        report: &mut impl FnMut(Step<'_>),
    ) -> f64 {
        report(Step::Begin(kernel.number));
        let initial = &self.workload.packets[packets.clone()];
        let scratch = &mut self.scratch[packets.clone()];
        let lists = &self.lists[&kernel.layout];
        self.forgetting = forget_branches(self.forgetting);
        let watch = Stopwatch::start();
        drive_together(
            kernel.loaded.together(),
            initial,
            lists.iter(),
            scratch,
            |packets, list| kernel.loaded.call_all(packets, &mut self.hits, list),
        );
        let seconds = watch.seconds();
        report(Step::Left(kernel.number, packets.clone(), scratch));
        // Whatever it wrote, the next kernel finds the same rays.
        scratch.clone_from_slice(initial);
        seconds
    }
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

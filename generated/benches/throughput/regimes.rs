//! What kernels are timed on: the rays and triangles of the paper, in every regime and from every origin.

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, SamplingMode, Throughput};
use scene::{
    Expected, Generator, INITIAL_T, LEAF_TRIANGLES, Origin, PACKET_SIZE, Part, RayPacket, Regime,
    Triangle,
};

use crate::kernels;

/// Packets that are run over in turn. One differs from another by a fifth. They make millions of branches,
/// more than a processor learns by heart.
const PACKETS: usize = 8;

/// Times all kernels, a group for each regime and origin.
pub fn bench(criterion: &mut Criterion) {
    for regime in [Regime::Shrinking, Regime::Leaf] {
        for origin in [Origin::General, Origin::Common] {
            let generator = Generator {
                packets: PACKETS,
                origin,
                ..Generator::default()
            };
            let workload = generator.generate();
            let part = workload.whole();
            let mut group = criterion.benchmark_group(format!("{regime}-{origin}"));
            group.throughput(Throughput::Elements(part.tests()));
            // A run takes a hundredth of a second: samples of ever more runs would take too long.
            group.sampling_mode(SamplingMode::Flat);
            let last_list = part.lists(regime).last().expect("there are triangles");
            let mut bench = Bench {
                group,
                regime,
                part,
                expected: Expected::of(regime, &part.packets[0], last_list),
            };
            kernels::library(&mut bench, origin);
            kernels::rivals(&mut bench, origin);
            bench.group.finish();
        }
    }
}

/// A kernel: a packet of rays against a list of triangles, each as the kernel keeps them.
pub type Test<P, T> = unsafe fn(&mut P, &[T]);

/// A packet as a kernel takes it.
pub trait Rays {
    /// The same rays.
    fn of(packet: &RayPacket) -> Self;

    /// Upper bounds of the ray parameters, and the closest hits.
    fn t(&mut self) -> &mut [f32; PACKET_SIZE];
}

/// Where the kernels of a group are timed.
pub struct Bench<'a> {
    group: BenchmarkGroup<'a, WallTime>,
    regime: Regime,
    part: Part<'a>,
    /// What is right for the first packet and the last list.
    expected: Expected,
}

impl Bench<'_> {
    /// Times `test` on what `record` makes of every triangle. Records lie one after another.
    ///
    /// # Safety
    ///
    /// The processor has the instruction set of `test`.
    ///
    /// # Panics
    ///
    /// The kernel's answers are wrong.
    pub unsafe fn time<P: Rays, T>(
        &mut self,
        name: &str,
        record: fn(&Triangle) -> T,
        test: Test<P, T>,
    ) {
        // Every kernel is called through a pointer, none becomes part of the loop.
        let test = black_box(test);
        let mut packets: Vec<P> = self.part.packets.iter().map(P::of).collect();
        let records: Vec<T> = self.part.triangles.iter().map(record).collect();
        let in_list = match self.regime {
            Regime::Shrinking | Regime::Fixed => records.len(),
            Regime::Leaf => LEAF_TRIANGLES,
        };
        let mut run = || {
            for packet in &mut packets {
                for list in records.chunks(in_list) {
                    *packet.t() = [INITIAL_T; PACKET_SIZE];
                    // SAFETY: the caller knows that the processor has the instruction set.
                    unsafe { test(packet, list) };
                }
            }
        };
        self.group
            .bench_function(name, |bencher| bencher.iter(&mut run));
        run();
        let after = RayPacket {
            t: *packets[0].t(),
            ..self.part.packets[0].clone()
        };
        let wrong = self.expected.first_wrong_ray(&after);
        assert_eq!(wrong, None, "{name}: a ray with a wrong answer");
    }
}

//! How a test is timed, and that its answers are right.

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, SamplingMode, Throughput};
use raybreed::{Packet, Ray};
use scene::{Expected, INITIAL_T, PACKET_SIZE, Part, RayPacket, Regime, Task, Triangle, Workload};

/// A group, and what is timed in it.
pub struct Bench<'a> {
    group: BenchmarkGroup<'a, WallTime>,
    part: Part<'a>,
    task: Task,
    /// What is right for the first packet and the last list.
    expected: Expected,
}

/// A packet's rays as a test takes them.
pub trait Rays {
    /// The same rays.
    fn of(packet: &RayPacket) -> Self;

    /// Makes the upper bounds of the ray parameters what they were.
    fn reset(&mut self);

    /// Upper bounds of the ray parameters, which are the closest hits.
    fn t(&self) -> [f32; PACKET_SIZE];
}

impl<'a> Bench<'a> {
    /// A group of this name, for closest hits.
    pub fn new(
        criterion: &'a mut Criterion,
        name: &str,
        regime: Regime,
        workload: &'a Workload,
    ) -> Self {
        let part = workload.whole();
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(part.tests()));
        // A run takes up to a twentieth of a second: samples of ever more runs would take too long.
        group.sampling_mode(SamplingMode::Flat);
        let task = Task::from(regime);
        Bench {
            group,
            part,
            task,
            expected: expected(task, &part),
        }
    }

    /// What the tests are asked, until it is something else.
    pub fn ask(&mut self, task: Task) {
        self.task = task;
        self.expected = expected(task, &self.part);
    }

    /// Times `test`, which takes a packet's rays, and a list of triangles in records of up to `width`. Every packet
    /// sees the lists in turn, and has forgotten its hits before each.
    ///
    /// # Panics
    ///
    /// The answers are wrong.
    pub fn time<P: Rays, T>(
        &mut self,
        name: &str,
        width: usize,
        record: impl Fn(&[Triangle]) -> T,
        mut test: impl FnMut(&mut P, &[T]),
    ) {
        // Every test is called through a pointer, none becomes part of the loop.
        let test: &mut dyn FnMut(&mut P, &[T]) = black_box(&mut test);
        let mut packets: Vec<P> = self.part.packets.iter().map(P::of).collect();
        let lists = self.part.lists(self.task.regime);
        let in_list = lists
            .clone()
            .next()
            .map_or(1, |list| list.len().div_ceil(width));
        let records: Vec<T> = lists
            .flat_map(|list| list.chunks(width))
            .map(record)
            .collect();
        let mut is_run = false;
        self.group.bench_function(name, |bencher| {
            is_run = true;
            bencher.iter(|| {
                for packet in &mut packets {
                    for list in records.chunks(in_list) {
                        packet.reset();
                        test(packet, list);
                    }
                }
            });
        });
        if is_run {
            let after = RayPacket {
                t: packets[0].t(),
                ..self.part.packets[0].clone()
            };
            let wrong = self.expected.first_wrong_ray(&after);
            assert_eq!(wrong, None, "{name}: a ray with a wrong answer");
        }
    }
}

/// What is right for the first packet and the last list.
fn expected(task: Task, part: &Part<'_>) -> Expected {
    let last_list = part.lists(task.regime).last();
    Expected::of(
        task,
        &part.packets[0],
        last_list.expect("there are triangles"),
    )
}

impl Rays for RayPacket {
    fn of(packet: &RayPacket) -> Self {
        packet.clone()
    }

    fn reset(&mut self) {
        self.t = [INITIAL_T; PACKET_SIZE];
    }

    fn t(&self) -> [f32; PACKET_SIZE] {
        self.t
    }
}

impl Rays for Packet<PACKET_SIZE> {
    fn of(packet: &RayPacket) -> Self {
        Packet::of(&<[Ray; PACKET_SIZE]>::of(packet))
    }

    fn reset(&mut self) {
        self.t = [INITIAL_T; PACKET_SIZE];
    }

    fn t(&self) -> [f32; PACKET_SIZE] {
        self.t
    }
}

/// One by one.
impl Rays for [Ray; PACKET_SIZE] {
    fn of(packet: &RayPacket) -> Self {
        std::array::from_fn(|i| {
            let origin = [packet.ox[i], packet.oy[i], packet.oz[i]];
            let direction = [packet.dx[i], packet.dy[i], packet.dz[i]];
            Ray::new(origin, direction).between(packet.t_min[i], packet.t[i])
        })
    }

    fn reset(&mut self) {
        for ray in self {
            ray.t = INITIAL_T;
        }
    }

    fn t(&self) -> [f32; PACKET_SIZE] {
        self.each_ref().map(|ray| ray.t)
    }
}

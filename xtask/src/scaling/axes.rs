//! Along what the work changes.

use std::ops::Range;

use measure::{WorkloadSpec, timing_cores};
use scene::{Generator, Grouping, PACKET_SIZE};

use crate::arena::{Arena, TRIANGLES};

/// An axis with its points in order.
pub struct Axis {
    /// Its name on the command line and of its file.
    pub name: &'static str,
    /// What is written beside it.
    pub label: &'static str,
    /// Of what the ticks are powers, if equal steps are equal factors.
    pub base: Option<f64>,
    /// The points.
    pub points: Vec<Point>,
}

/// A point on an axis.
pub struct Point {
    /// Where it is.
    pub at: f64,
    /// What kernels are timed on.
    pub workload: WorkloadSpec,
    /// The packets of each round.
    pub rounds: Vec<Range<usize>>,
    /// Rays of a packet.
    pub rays: usize,
    /// Cores that time at once.
    pub cores: usize,
}

/// Tests of a round at least, a millisecond or two: a clock has no finer grain than that on a busy machine.
const TESTS_IN_ROUND: usize = 1_300_000;

/// Tests of a kernel at a point, if the rounds do not become too few or too many.
const TESTS: usize = 150_000_000;

/// Triangles and packets that the share of hits is worked out for.
const SAMPLED_TRIANGLES: usize = 400;
const SAMPLED_PACKETS: usize = 40;

/// How many rounds there are.
const ROUNDS: std::ops::RangeInclusive<usize> = 6..=60;

impl Axis {
    /// A place on it, for people.
    pub fn tick(&self, at: f64) -> String {
        match self.name {
            "hits" => format!("{:.1}%", 100.0 * at),
            _ if at >= 1e6 => format!("{}M", at / 1e6),
            _ if at >= 1e4 => format!("{}k", at / 1e3),
            _ => format!("{at}"),
        }
    }
}

/// All axes of an arena: packets have a size, single rays have none.
pub fn all(arena: &Arena) -> Vec<Axis> {
    let usual = || Work {
        arena,
        triangles: TRIANGLES,
        target_range: None,
        rays: PACKET_SIZE,
        cores: 1,
    };
    let triangles = (2..=7).map(|power| 10_usize.pow(power));
    let triangles = triangles.map(|triangles| {
        let work = Work {
            triangles,
            ..usual()
        };
        work.at(triangles as f64)
    });
    let lanes = arena.isas[0].lane_count();
    let rays = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024];
    let rays = rays.into_iter().filter(|rays| rays % lanes == 0);
    let rays = rays.map(|rays| Work { rays, ..usual() }.at(rays as f64));
    let hits = [3.6_f32, 2.4, 1.8, 1.2, 0.6, 0.3, 0.01].map(|target_range| {
        let work = Work {
            target_range: Some(target_range),
            ..usual()
        };
        work.at_its_hits()
    });
    let cores = (1..=timing_cores().len().max(1)).map(|cores| {
        let work = Work { cores, ..usual() };
        work.at(cores as f64)
    });
    let mut axes = vec![
        Axis {
            name: "triangles",
            label: "triangles",
            base: Some(10.0),
            points: triangles.collect(),
        },
        Axis {
            name: "rays",
            label: "rays of a packet",
            base: Some(2.0),
            points: rays.collect(),
        },
        Axis {
            name: "hits",
            label: "share of tests that hit, if t never rejects",
            base: None,
            points: hits.into(),
        },
        Axis {
            name: "cores",
            label: "cores that time at once",
            base: None,
            points: cores.collect(),
        },
    ];
    let has_packets = arena.scene.grouping == Grouping::Packet && !arena.scene.has_hits();
    axes.retain(|axis| has_packets || axis.name != "rays");
    axes
}

/// What there is to do at a point.
struct Work<'a> {
    arena: &'a Arena,
    triangles: usize,
    target_range: Option<f32>,
    rays: usize,
    cores: usize,
}

impl Work<'_> {
    fn at(&self, at: f64) -> Point {
        let together = self.rays.div_ceil(PACKET_SIZE);
        let tests = self.triangles * PACKET_SIZE;
        let packets = TESTS_IN_ROUND.div_ceil(tests).next_multiple_of(together);
        let rounds = TESTS / (packets * tests);
        let rounds = rounds.clamp(*ROUNDS.start(), *ROUNDS.end()) * self.cores;
        Point {
            at,
            workload: WorkloadSpec {
                triangles: self.triangles,
                packets: rounds * packets,
                target_range: self.target_range,
                ..self.arena.workload()
            },
            rounds: (0..rounds)
                .map(|round| round * packets..(round + 1) * packets)
                .collect(),
            rays: self.rays,
            cores: self.cores,
        }
    }

    /// The point at the share of hits that the workload has.
    fn at_its_hits(&self) -> Point {
        let mut point = self.at(0.0);
        let sample = Generator {
            triangles: SAMPLED_TRIANGLES,
            packets: SAMPLED_PACKETS,
            ..point.workload.generator()
        };
        point.at = scene::hit_fraction(sample.generate().whole());
        point
    }
}

#[cfg(test)]
impl Point {
    /// A place without work.
    pub fn nowhere(at: f64) -> Point {
        let scene = scene::SceneModel::preset("packet").expect("a preset");
        Point {
            at,
            workload: WorkloadSpec {
                seed: 0,
                triangles: 0,
                packets: 0,
                target_range: None,
                scene,
            },
            rounds: Vec::new(),
            rays: PACKET_SIZE,
            cores: 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use emit::Isa;
    use scene::SceneModel;

    use super::*;
    use crate::isas::Isas;

    fn axes(scene: &str, isa: Isa) -> Vec<Axis> {
        all(&Arena {
            scene: SceneModel::preset(scene).unwrap(),
            isas: Isas(vec![isa]),
            triangles: TRIANGLES,
        })
    }

    #[test]
    fn every_round_is_whole_packets_of_the_workload() {
        for isa in Isa::ALL {
            for point in axes("packet", isa).into_iter().flat_map(|axis| axis.points) {
                let together = point.rays.div_ceil(PACKET_SIZE);
                let mut next = 0;
                for round in &point.rounds {
                    assert_eq!(round.start, next);
                    assert!(round.len().is_multiple_of(together) && !round.is_empty());
                    next = round.end;
                }
                assert_eq!(next, point.workload.packets);
            }
        }
    }

    #[test]
    fn points_are_in_order_and_a_single_ray_is_no_packet() {
        for axis in axes("packet", Isa::Avx2) {
            assert!(
                axis.points.is_sorted_by(|a, b| a.at < b.at),
                "{}",
                axis.name
            );
        }
        let names: Vec<&str> = axes("single", Isa::Avx2)
            .iter()
            .map(|axis| axis.name)
            .collect();
        assert_eq!(names, ["triangles", "hits", "cores"]);
    }
}

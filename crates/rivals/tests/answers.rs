//! Every rival gives the oracle's answers, and none where there is none to give.
#![cfg(target_arch = "x86_64")]

use emit::Isa;
use rivals::{Rival, methods};
use scene::{
    Expected, Generator, Origin, RayPacket, Regime, Triangle, Workload, answers, drive, rays_mut,
};

/// A rival as a function.
struct Kernel {
    name: &'static str,
    /// Fixed or not, what it makes of a packet.
    run: fn(bool, &mut RayPacket, &[Triangle]),
}

impl Kernel {
    /// What the kernel for `regime` makes of `packet`.
    fn run(&self, regime: Regime, packet: &RayPacket, triangles: &[Triangle]) -> RayPacket {
        let mut after = packet.clone();
        (self.run)(regime == Regime::Fixed, &mut after, triangles);
        after
    }
}

/// A kernel that takes what `$made` makes of triangles: for packets, or for every ray by itself.
macro_rules! kernel {
    ($name:literal, $($function:ident)::+, packet of $made:expr) => {
        Kernel {
            name: $name,
            run: |fixed, packet, triangles| {
                let records = $made(triangles);
                // SAFETY: every x86-64 CPU has SSE2, and `kernels_and_regimes` leaves out what this one
                // has not.
                unsafe {
                    match fixed {
                        false => rivals::$($function)::+::<64, false>(packet, &records),
                        true => rivals::$($function)::+::<64, true>(packet, &records),
                    }
                }
            },
        }
    };
    ($name:literal, $($function:ident)::+, single of $made:expr) => {
        Kernel {
            name: $name,
            run: |fixed, packet, triangles| {
                let blocks = $made(triangles);
                for ray in 0..64 {
                    // SAFETY: every x86-64 CPU has SSE2, and `kernels_and_regimes` leaves out what this one
                // has not.
                    unsafe {
                        match fixed {
                            false => rivals::$($function)::+::<64, false>(packet, ray, &blocks),
                            true => rivals::$($function)::+::<64, true>(packet, ray, &blocks),
                        }
                    }
                }
            },
        }
    };
}

const KERNELS: [Kernel; 32] = [
    kernel!("moller-trumbore", packet::moller_trumbore::moller_trumbore, packet of <[Triangle]>::to_vec),
    kernel!("kensler-shirley", packet::kensler_shirley::kensler_shirley, packet of <[Triangle]>::to_vec),
    kernel!("kensler-shirley-common", methods::kensler_shirley::common_origin, packet of <[Triangle]>::to_vec),
    kernel!("badouel", methods::badouel::packet, packet of |triangles: &[Triangle]| records(triangles, methods::badouel::prepare)),
    kernel!("wald", methods::wald::packet, packet of |triangles: &[Triangle]| records(triangles, methods::wald::prepare)),
    kernel!("wald-deferred", methods::wald::packet_deferred, packet of |triangles: &[Triangle]| records(triangles, methods::wald::prepare)),
    kernel!("shevtsov", methods::shevtsov::packet, packet of |triangles: &[Triangle]| records(triangles, methods::shevtsov::prepare)),
    kernel!("shevtsov-distance-first", methods::shevtsov::packet_distance_first, packet of |triangles: &[Triangle]| records(triangles, methods::shevtsov::prepare)),
    kernel!("shevtsov-divided", methods::shevtsov::packet_divided, packet of |triangles: &[Triangle]| records(triangles, methods::shevtsov::prepare)),
    kernel!("shevtsov-branchless", methods::shevtsov::packet_branchless, packet of |triangles: &[Triangle]| records(triangles, methods::shevtsov::prepare)),
    kernel!("havel-herout", methods::havel_herout::packet, packet of |triangles: &[Triangle]| records(triangles, methods::havel_herout::prepare)),
    kernel!("havel-herout-parallel", methods::havel_herout::packet, packet of |triangles: &[Triangle]| records(triangles, methods::havel_herout::prepare_parallel)),
    kernel!("havel-herout-divided", methods::havel_herout::packet_divided, packet of |triangles: &[Triangle]| records(triangles, methods::havel_herout::prepare)),
    kernel!("baldwin-weber", methods::havel_herout::packet_divided, packet of |triangles: &[Triangle]| records(triangles, methods::havel_herout::prepare_transformation)),
    kernel!("pluecker", methods::pluecker::packet, packet of |triangles: &[Triangle]| records(triangles, methods::pluecker::prepare)),
    kernel!("woop", methods::woop::packet, packet of <[Triangle]>::to_vec),
    kernel!("benthin", methods::benthin::packet, packet of <[Triangle]>::to_vec),
    kernel!("moller-trumbore", single::moller_trumbore::moller_trumbore, single of blocks),
    kernel!("kensler-shirley", single::kensler_shirley::kensler_shirley, single of blocks),
    kernel!("badouel", methods::badouel::single, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::badouel::prepare)),
    kernel!("wald", methods::wald::single, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::wald::prepare)),
    kernel!("wald-deferred", methods::wald::single_deferred, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::wald::prepare)),
    kernel!("shevtsov", methods::shevtsov::single, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::shevtsov::prepare)),
    kernel!("shevtsov-distance-first", methods::shevtsov::single_distance_first, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::shevtsov::prepare)),
    kernel!("shevtsov-divided", methods::shevtsov::single_divided, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::shevtsov::prepare)),
    kernel!("shevtsov-branchless", methods::shevtsov::single_branchless, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::shevtsov::prepare)),
    kernel!("havel-herout", methods::havel_herout::single, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::havel_herout::prepare)),
    kernel!("havel-herout-parallel", methods::havel_herout::single, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::havel_herout::prepare_parallel)),
    kernel!("havel-herout-divided", methods::havel_herout::single_divided, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::havel_herout::prepare)),
    kernel!("havel-herout-dpps", methods::havel_herout::dot_product, single of |triangles: &[Triangle]| blocks_of_records::<_, 1>(triangles, methods::havel_herout::prepare)),
    kernel!("baldwin-weber", methods::havel_herout::single_divided, single of |triangles: &[Triangle]| blocks_of_records(triangles, methods::havel_herout::prepare_transformation)),
    kernel!("woop", methods::woop::single, single of blocks),
];

/// Records of triangles.
fn records<const NUMBERS: usize>(
    triangles: &[Triangle],
    prepare: fn(&Triangle) -> [f32; NUMBERS],
) -> Vec<[f32; NUMBERS]> {
    triangles.iter().map(prepare).collect()
}

/// Records in blocks, the last one filled up with NaN.
fn blocks_of_records<const NUMBERS: usize, const LANES: usize>(
    triangles: &[Triangle],
    prepare: fn(&Triangle) -> [f32; NUMBERS],
) -> Vec<[[f32; LANES]; NUMBERS]> {
    let block = |triangles: &[Triangle]| {
        let mut block = [[f32::NAN; LANES]; NUMBERS];
        for (lane, triangle) in triangles.iter().enumerate() {
            for (lanes, number) in block.iter_mut().zip(prepare(triangle)) {
                lanes[lane] = number;
            }
        }
        block
    };
    triangles.chunks(LANES).map(block).collect()
}

/// Triangles in blocks of four, the last one filled up with triangles without area.
fn blocks(triangles: &[Triangle]) -> Vec<Triangle<[f32; 4]>> {
    let block = |triangles: &[Triangle]| {
        let vertex = |of: fn(&Triangle) -> [f32; 3]| {
            let lane = |lane, axis: usize| triangles.get(lane).map_or(0.0, |one| of(one)[axis]);
            [0, 1, 2].map(|axis| [0, 1, 2, 3].map(|number| lane(number, axis)))
        };
        Triangle {
            p0: vertex(|one| one.p0),
            p1: vertex(|one| one.p1),
            p2: vertex(|one| one.p2),
        }
    };
    triangles.chunks(4).map(block).collect()
}

fn workload(seed: u32, origin: Origin, triangles: usize) -> Workload {
    Generator {
        seed,
        origin,
        triangles,
        packets: 2,
        ..Generator::default()
    }
    .generate()
}

/// The bits of `t`, then of `hit_t`.
fn bits(packet: &RayPacket) -> Vec<u32> {
    let values = packet.t.iter().chain(&packet.hit_t);
    values.copied().map(f32::to_bits).collect()
}

/// Every kernel that takes rays from these origins, in every regime.
fn kernels_and_regimes(origin: Origin) -> impl Iterator<Item = (&'static Kernel, Regime)> {
    let takes = move |(_, rival): &(&Kernel, &Rival)| {
        let is_available = rival.is_for(Isa::Sse2) || is_x86_feature_detected!("sse4.1");
        if !is_available {
            println!(
                "skipped: {}, whose instructions this machine lacks",
                rival.name
            );
        }
        is_available && (origin == Origin::Common || !rival.common_origin)
    };
    let kernels = KERNELS.iter().zip(rivals::all()).filter(takes);
    let kernels = kernels.map(|(kernel, _)| kernel);
    kernels.flat_map(|kernel| Regime::ALL.iter().map(move |&regime| (kernel, regime)))
}

#[test]
fn every_rival_is_in_the_table() {
    let names: Vec<&str> = rivals::all().iter().map(|rival| rival.name).collect();
    assert_eq!(names, KERNELS.map(|kernel| kernel.name));
}

#[test]
fn the_oracle_accepts_every_answer_in_every_regime() {
    for origin in [Origin::General, Origin::Common] {
        for seed in 0..3 {
            let workload = workload(seed, origin, 5_000);
            for (kernel, regime) in kernels_and_regimes(origin) {
                let mut hits = 0;
                let mut scratch = workload.packets.clone();
                drive(
                    &workload.packets,
                    workload.whole().lists(regime),
                    &mut scratch,
                    |packet, triangles| {
                        let before = packet.clone();
                        (kernel.run)(regime == Regime::Fixed, packet, triangles);
                        let expected = Expected::of(regime, &before, triangles);
                        if let Some(ray) = expected.first_wrong_ray(packet) {
                            let answer = answers(regime, packet)[ray];
                            let clear = expected.clear_hit(ray);
                            let name = kernel.name;
                            panic!(
                                "{name}, {regime}, {origin:?}, seed {seed}: {answer} for {clear:?}"
                            );
                        }
                        hits += (0..64)
                            .filter(|&ray| expected.clear_hit(ray).is_some())
                            .count();
                    },
                );
                assert!(hits >= 64, "{regime}: the test is empty");
            }
        }
    }
}

#[test]
fn what_is_not_finite_in_a_lane_misses_there_and_leaves_the_others_alone() {
    let Workload { triangles, packets } = workload(4, Origin::General, 50);
    for (kernel, regime) in kernels_and_regimes(Origin::General) {
        let clean = bits(&kernel.run(regime, &packets[0], &triangles));
        for component in 0..6 {
            for lane in [0, 5, 63] {
                for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                    let mut before = packets[0].clone();
                    rays_mut(&mut before)[component][lane] = bad;
                    let mut expected = clean.clone();
                    expected[lane] = before.t[lane].to_bits();
                    expected[64 + lane] = before.hit_t[lane].to_bits();
                    let after = bits(&kernel.run(regime, &before, &triangles));
                    assert_eq!(
                        after, expected,
                        "{}, {regime}, {component}, {bad}",
                        kernel.name
                    );
                }
            }
        }
    }
}

#[test]
fn inactive_lanes_keep_their_bytes() {
    let Workload { triangles, packets } = workload(5, Origin::General, 50);
    let odd_nan = f32::from_bits(0x7fa1_2345);
    for (kernel, regime) in kernels_and_regimes(Origin::General) {
        let mut expected = bits(&kernel.run(regime, &packets[0], &triangles));
        let mut before = packets[0].clone();
        let inactive = [0.0, -0.0, -1.0, f32::NEG_INFINITY, f32::NAN, odd_nan];
        for (lane, t) in std::iter::zip([0, 1, 6, 11, 42, 63], inactive) {
            before.t[lane] = t;
            before.hit_t[lane] = odd_nan;
            expected[lane] = t.to_bits();
            expected[64 + lane] = odd_nan.to_bits();
        }
        let after = bits(&kernel.run(regime, &before, &triangles));
        assert_eq!(after, expected, "{}, {regime}", kernel.name);
    }
}

#[test]
fn triangles_that_are_not_finite_miss() {
    let Workload { triangles, packets } = workload(6, Origin::General, 20);
    for (kernel, regime) in kernels_and_regimes(Origin::General) {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for (vertex, axis) in (0..3).flat_map(|v| (0..3).map(move |a| (v, a))) {
                let spoilt: Vec<Triangle> = triangles
                    .iter()
                    .map(|&Triangle { p0, p1, p2 }| {
                        let mut vertices = [p0, p1, p2];
                        vertices[vertex][axis] = bad;
                        let [p0, p1, p2] = vertices;
                        Triangle { p0, p1, p2 }
                    })
                    .collect();
                let after = bits(&kernel.run(regime, &packets[0], &spoilt));
                assert_eq!(after, bits(&packets[0]), "{}, {regime}, {bad}", kernel.name);
            }
        }
    }
}

/// On a small lattice `f32` is exact, so `V` is 0 and no rounding can excuse a hit. The rays go
/// through points on, before and beyond the triangles. Only Woop's shear divides before anything is
/// tested: it maps vertices of one line to some of none.
#[test]
fn degenerate_triangles_miss() {
    let collinear = |p0, p1, p2| Triangle { p0, p1, p2 };
    let (a, b, c) = ([-1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [2.0, 3.0, 1.0]);
    let triangles = [
        collinear(a, b, c),
        collinear(c, a, b),
        collinear(a, a, b),
        collinear(a, b, a),
        collinear(b, a, a),
        collinear(b, b, b),
        collinear([0.0; 3], [0.0; 3], [0.0; 3]),
    ];
    let mut packet = workload(7, Origin::General, 0).packets[0].clone();
    for ray in 0..64 {
        let origin = [(ray % 4) as f32 - 1.0, (ray / 4 % 4) as f32 - 1.0, -1.0];
        let target = [[0.0; 3], a, b, c][ray / 16];
        let values = [origin, [0, 1, 2].map(|axis| target[axis] - origin[axis])].concat();
        for (component, value) in rays_mut(&mut packet).into_iter().zip(values) {
            component[ray] = value;
        }
    }
    let all = kernels_and_regimes(Origin::General);
    for (kernel, regime) in all.filter(|(kernel, _)| kernel.name != "woop") {
        let after = kernel.run(regime, &packet, &triangles);
        assert_eq!(bits(&after), bits(&packet), "{}, {regime}", kernel.name);
    }
}

#[test]
fn rays_without_a_direction_miss() {
    let Workload { triangles, packets } = workload(8, Origin::General, 50);
    let mut packet = packets[0].clone();
    (packet.dx, packet.dy, packet.dz) = ([0.0; 64], [-0.0; 64], [0.0; 64]);
    for (kernel, regime) in kernels_and_regimes(Origin::General) {
        let after = kernel.run(regime, &packet, &triangles);
        assert_eq!(bits(&after), bits(&packet), "{}, {regime}", kernel.name);
    }
}

//! Published crates give the oracle's answers, but for what each of them does otherwise.
#![cfg(feature = "published")]

use std::iter::zip;

use rivals::published::{self, Published, code};
use scene::{
    Culling, Expected, Generator, NO_HITS, Origin, PACKET_SIZE, RayPacket, Regime, Task, Triangle,
    Workload, answers, drive, rays_mut,
};

/// What a test makes of `packet`. Records are aligned as numbers are, and no better.
fn run(test: &Published, regime: Regime, packet: &mut RayPacket, triangles: &[Triangle]) {
    let (code, numbers) = (code::of(test), test.numbers.unwrap_or(9));
    let mut records = vec![f32::NAN; numbers * triangles.len() + 1];
    for (record, triangle) in zip(records[1..].chunks_exact_mut(numbers), triangles) {
        match code.prepare {
            // SAFETY: the record has as many numbers as the test says.
            Some(prepare) => unsafe { prepare(triangle, 1, record.as_mut_ptr()) },
            None => {
                let Triangle { p0, p1, p2 } = *triangle;
                record.copy_from_slice([p0, p1, p2].as_flattened());
            }
        }
    }
    let (kernel, records, mut hits) = (code.kernel_for(regime), &records[1..], NO_HITS);
    // SAFETY: packet and hits are borrowed for the call alone, and there is a record for every triangle.
    unsafe { kernel(packet, &mut hits, records.as_ptr(), triangles.len()) };
}

fn workload(seed: u32, origin: Origin, triangles: usize) -> Workload {
    Generator {
        seed,
        origin,
        triangles,
        packets: 4,
        ..Generator::default()
    }
    .generate()
}

/// The bits of `t`, then of `hit_t`.
fn bits(packet: &RayPacket) -> Vec<u32> {
    let values = packet.t.iter().chain(&packet.hit_t);
    values.copied().map(f32::to_bits).collect()
}

/// The bits that a test leaves of a packet.
fn bits_after(
    test: &Published,
    regime: Regime,
    before: &RayPacket,
    triangles: &[Triangle],
) -> Vec<u32> {
    let mut after = before.clone();
    run(test, regime, &mut after, triangles);
    bits(&after)
}

/// Every test in every regime.
fn tests_and_regimes() -> impl Iterator<Item = (&'static Published, Regime)> {
    published::all()
        .iter()
        .flat_map(|test| Regime::ALL.iter().map(move |&regime| (test, regime)))
}

/// How many answers a test gives to a workload, and how many of them the oracle does not accept.
fn judged(test: &Published, task: Task, workload: &Workload) -> (usize, usize) {
    let (mut all, mut wrong) = (0, 0);
    drive(
        &workload.packets,
        workload.whole().lists(task.regime),
        &mut workload.packets.clone(),
        |packet, triangles| {
            let expected = Expected::of(task, packet, triangles);
            let before = packet.clone();
            run(test, task.regime, packet, triangles);
            let is_wrong = |&ray: &usize| !expected.accepts(ray, answers(task.regime, packet)[ray]);
            all += PACKET_SIZE;
            wrong += (0..PACKET_SIZE).filter(is_wrong).count();
            let kept = |packet: &RayPacket| match task.regime {
                Regime::Shrinking | Regime::Leaf => packet.hit_t.map(f32::to_bits),
                Regime::Fixed => packet.t.map(f32::to_bits),
            };
            assert_eq!(
                kept(packet),
                kept(&before),
                "{}, {}",
                test.name,
                task.regime
            );
        },
    );
    (all, wrong)
}

/// The task that a test can do: it may not see all sides.
fn task(test: &Published, regime: Regime) -> Task {
    Task {
        culling: test.culling,
        ..regime.into()
    }
}

#[test]
fn names_and_versions_are_those_of_the_lock_file() {
    for test in published::all() {
        let (package, version) = (test.package, test.version);
        let entry = format!("name = \"{package}\"\nversion = \"{version}\"\n");
        assert!(
            include_str!("../../../Cargo.lock").contains(&entry),
            "{entry}"
        );
        assert!(test.reference.starts_with(package), "{}", test.reference);
        assert_eq!(
            published::find(test.name).map(|found| found.name),
            Some(test.name)
        );
        let same_name = published::all()
            .iter()
            .filter(|other| other.name == test.name);
        assert_eq!(same_name.count(), 1, "{}", test.name);
    }
}

#[test]
fn the_oracle_accepts_every_answer_to_what_a_crate_sees() {
    for origin in [Origin::General, Origin::Common] {
        for seed in 0..2 {
            let workload = workload(seed, origin, 2_000);
            for (test, regime) in tests_and_regimes() {
                let (all, wrong) = judged(test, task(test, regime), &workload);
                assert_eq!(wrong, 0, "{}, {regime}, {origin:?}: of {all}", test.name);
            }
        }
    }
}

/// Half of the triangles are seen from behind, so half of the answers are another triangle's. In lists of eight
/// a third of the rays hit nothing in the first place.
#[test]
fn answers_of_a_crate_that_culls_differ_from_those_of_both_sides() {
    let workload = workload(0, Origin::General, 2_000);
    for (test, regime) in tests_and_regimes() {
        let (all, wrong) = judged(test, regime.into(), &workload);
        match test.culling {
            Culling::None => assert_eq!(wrong, 0, "{}", test.name),
            Culling::Back | Culling::Front => {
                let part = wrong as f64 / all as f64;
                println!("{}, {regime}: {wrong} of {all}", test.name);
                assert!(
                    (0.3..0.6).contains(&part),
                    "{}, {regime}: {part}",
                    test.name
                );
            }
        }
    }
}

/// Epsilons have units. The workload, made smaller by a power of two, has the same answers, but a crate that
/// compares a volume or an area with an epsilon finds none of them in the end.
#[test]
fn absolute_epsilons_lose_small_triangles() {
    // Of all answers in the leaf regime. Not all of them are hits.
    let lost = |name: &str, exponent: i32| match (name, exponent) {
        ("bvh", -10) | ("rayx", -16) => 0.01..0.3,
        ("bvh", -16 | -20) | ("rayx", -20) => 0.5..1.0,
        _ => 0.0..f64::MIN_POSITIVE,
    };
    for exponent in [20, -6, -10, -16, -20] {
        let scale = f32::powi(2.0, exponent);
        let mut workload = workload(0, Origin::General, 2_000);
        for Triangle { p0, p1, p2 } in &mut workload.triangles {
            for vertex in [p0, p1, p2] {
                *vertex = vertex.map(|x| x * scale);
            }
        }
        for packet in &mut workload.packets {
            for component in rays_mut(packet) {
                *component = component.map(|x| x * scale);
            }
        }
        for test in published::all() {
            let (all, wrong) = judged(test, task(test, Regime::Leaf), &workload);
            let part = wrong as f64 / all as f64;
            println!("{}, 2^{exponent}: {wrong} of {all}", test.name);
            assert!(
                lost(test.name, exponent).contains(&part),
                "{}, 2^{exponent}: {part}",
                test.name
            );
        }
    }
}

/// What `differs` says, one ray and one triangle each, where `f32` is exact.
#[test]
fn a_hit_is_missed_by_those_that_say_so() {
    let triangle = |side: f32, height: f32| Triangle {
        p0: [0.0, 0.0, height],
        p1: [0.0, side, height],
        p2: [side, 0.0, height],
    };
    let unit = triangle(1.0, 1.0);
    let Triangle { p0, p1, p2 } = unit;
    let turned = Triangle { p0, p1: p2, p2: p1 };
    let (up, tiny) = ([0.0, 0.0, 1.0], f32::powi(2.0, -24));
    let small = |exponent| {
        (
            triangle(f32::powi(2.0, exponent), 1.0),
            [f32::powi(2.0, exponent - 2); 2],
            up,
        )
    };
    let cases = [
        ("midst, front", (unit, [0.25; 2], up), ""),
        ("midst, back", (turned, [0.25; 2], up), "bvh"),
        ("edge, front", (unit, [0.0, 0.5], up), ""),
        ("edge, back", (turned, [0.0, 0.5], up), "obvhs obvhs-rt bvh"),
        (
            "second edge, back",
            (turned, [0.5, 0.0], up),
            "obvhs obvhs-rt bvh",
        ),
        ("third edge, back", (turned, [0.5; 2], up), "bvh"),
        ("near", (triangle(1.0, tiny), [0.25; 2], up), "bvh"),
        (
            "short direction",
            (unit, [0.25; 2], [0.0, 0.0, tiny]),
            "rayx",
        ),
        ("small", small(-14), "bvh"),
        ("smaller", small(-18), "bvh rayx"),
    ];
    let mut packet = workload(0, Origin::General, 0).packets[0].clone();
    for (case, (triangle, [x, y], direction), missed_by) in cases {
        let values = [[x, y, 0.0], direction];
        for (component, &value) in zip(rays_mut(&mut packet), values.as_flattened()) {
            *component = [value; PACKET_SIZE];
        }
        packet.t = [f32::INFINITY; PACKET_SIZE];
        for (test, regime) in tests_and_regimes() {
            let mut after = packet.clone();
            run(test, regime, &mut after, &[triangle]);
            let t = answers(regime, &after)[0];
            let right = match missed_by.split(' ').any(|name| name == test.name) {
                true => f32::INFINITY,
                false => triangle.p0[2] / direction[2],
            };
            assert_eq!(t, right, "{}, {regime}: {case}", test.name);
        }
    }
}

#[test]
fn what_is_not_finite_in_a_ray_misses_and_leaves_the_others_alone() {
    let Workload { triangles, packets } = workload(4, Origin::General, 50);
    for (test, regime) in tests_and_regimes() {
        let clean = bits_after(test, regime, &packets[0], &triangles);
        for component in 0..6 {
            for ray in [0, 5, 63] {
                for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                    let mut before = packets[0].clone();
                    rays_mut(&mut before)[component][ray] = bad;
                    let mut expected = clean.clone();
                    expected[ray] = before.t[ray].to_bits();
                    expected[PACKET_SIZE + ray] = before.hit_t[ray].to_bits();
                    let after = bits_after(test, regime, &before, &triangles);
                    assert_eq!(
                        after, expected,
                        "{}, {regime}, {component}, {bad}",
                        test.name
                    );
                }
            }
        }
    }
}

#[test]
fn inactive_rays_keep_their_bytes() {
    let Workload { triangles, packets } = workload(5, Origin::General, 50);
    let odd_nan = f32::from_bits(0x7fa1_2345);
    for (test, regime) in tests_and_regimes() {
        let mut expected = bits_after(test, regime, &packets[0], &triangles);
        let mut before = packets[0].clone();
        let inactive = [0.0, -0.0, -1.0, f32::NEG_INFINITY, f32::NAN, odd_nan];
        for (ray, t) in zip([0, 1, 6, 11, 42, 63], inactive) {
            before.t[ray] = t;
            before.hit_t[ray] = odd_nan;
            expected[ray] = t.to_bits();
            expected[PACKET_SIZE + ray] = odd_nan.to_bits();
        }
        let after = bits_after(test, regime, &before, &triangles);
        assert_eq!(after, expected, "{}, {regime}", test.name);
    }
}

#[test]
fn triangles_that_are_not_finite_miss() {
    let Workload { triangles, packets } = workload(6, Origin::General, 20);
    for (test, regime) in tests_and_regimes() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for number in 0..9 {
                let spoilt = triangles.iter().map(|&Triangle { p0, p1, p2 }| {
                    let mut vertices = [p0, p1, p2];
                    vertices.as_flattened_mut()[number] = bad;
                    let [p0, p1, p2] = vertices;
                    Triangle { p0, p1, p2 }
                });
                let spoilt: Vec<Triangle> = spoilt.collect();
                let after = bits_after(test, regime, &packets[0], &spoilt);
                assert_eq!(after, bits(&packets[0]), "{}, {regime}, {bad}", test.name);
            }
        }
    }
}

/// On a small lattice `f32` is exact. The rays go through points on, before and beyond the triangles.
#[test]
fn triangles_without_area_and_rays_without_direction_miss() {
    let (a, b, c) = ([-1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [2.0, 3.0, 1.0]);
    let collinear = [
        [a, b, c],
        [c, a, b],
        [a, a, b],
        [a, b, a],
        [b, a, a],
        [b; 3],
        [[0.0; 3]; 3],
    ];
    let collinear = collinear.map(|[p0, p1, p2]| Triangle { p0, p1, p2 });
    let Workload { triangles, packets } = workload(7, Origin::General, 50);
    let mut through = packets[0].clone();
    for ray in 0..PACKET_SIZE {
        let origin = [(ray % 4) as f32 - 1.0, (ray / 4 % 4) as f32 - 1.0, -1.0];
        let target = [[0.0; 3], a, b, c][ray / 16];
        let values = [origin, [0, 1, 2].map(|axis| target[axis] - origin[axis])];
        for (component, &value) in zip(rays_mut(&mut through), values.as_flattened()) {
            component[ray] = value;
        }
    }
    let mut still = packets[0].clone();
    (still.dx, still.dy, still.dz) = ([0.0; 64], [-0.0; 64], [0.0; 64]);
    for (test, regime) in tests_and_regimes() {
        let after = bits_after(test, regime, &through, &collinear);
        assert_eq!(after, bits(&through), "{}, {regime}", test.name);
        let after = bits_after(test, regime, &still, &triangles);
        assert_eq!(after, bits(&still), "{}, {regime}", test.name);
    }
}

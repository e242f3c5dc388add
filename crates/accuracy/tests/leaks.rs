//! Kernels that are known to leak are caught leaking, and a watertight one passes.

mod kernels;

use accuracy::{
    Block, Case, CaseLeaks, Class, Exact, Leaks, Packets, Rate, Scalar, watertightness,
};
use kernels::{kensler_shirley, moller_trumbore, three_volumes, woop};
use scene::{Packet, Ray, Regime, Triangle};

/// Rays a case.
const RAYS: u64 = 10_000;

type Kernel = fn(&Ray, &Triangle) -> Option<f32>;

fn leaks_of(kernel: Kernel, case: Case) -> Leaks {
    watertightness(|| Scalar(kernel), &[case], RAYS, 1)[0].leaks
}

fn in_percent(rate: Rate) -> f64 {
    100.0 * rate.share()
}

#[test]
fn moller_trumbore_leaks_at_edges_and_vertices() {
    for case in [Case::Fan, Case::MeshInside, Case::MeshOutside] {
        let leaks = leaks_of(moller_trumbore, case);
        assert!(
            (4.0..20.0).contains(&in_percent(leaks.edge.leak)),
            "{case}: {leaks:?}"
        );
        assert!(
            (1.0..20.0).contains(&in_percent(leaks.vertex.leak)),
            "{case}: {leaks:?}"
        );
        assert!(
            (25.0..50.0).contains(&in_percent(leaks.edge.double)),
            "{case}: {leaks:?}"
        );
    }
}

#[test]
fn the_appendix_kernel_leaks_at_edges_and_vertices() {
    for case in [Case::Fan, Case::MeshInside, Case::MeshOutside] {
        let leaks = leaks_of(kensler_shirley, case);
        assert!(
            (4.0..20.0).contains(&in_percent(leaks.edge.leak)),
            "{case}: {leaks:?}"
        );
        assert!(
            (1.0..20.0).contains(&in_percent(leaks.vertex.leak)),
            "{case}: {leaks:?}"
        );
        assert!(
            (10.0..40.0).contains(&in_percent(leaks.edge.double)),
            "{case}: {leaks:?}"
        );
    }
}

/// A block with all triangles beginning with the vertex that they share.
fn beginning_with_the_centre(mut block: Block) -> Block {
    let [first, second] = [block.triangles[0], block.triangles[2]].map(|t| [t.p0, t.p1, t.p2]);
    let centre = first
        .into_iter()
        .find(|vertex| second.contains(vertex))
        .unwrap();
    for triangle in &mut block.triangles {
        while triangle.p0 != centre {
            let Triangle { p0, p1, p2 } = *triangle;
            (triangle.p0, triangle.p1, triangle.p2) = (p1, p2, p0);
        }
    }
    block
}

/// Why the cases rotate their triangles. Every spoke begins with the centre then, and what the kernel
/// computes of it for its two triangles is antisymmetric by luck.
#[test]
fn the_appendix_kernel_shows_no_edge_leak_if_every_triangle_begins_with_the_centre() {
    let mut subject = Scalar(kensler_shirley);
    let (mut rotated, mut not_rotated) = (0, 0);
    for number in 0..40 {
        let block = Case::Fan.block(1, number);
        rotated += Leaks::of_block(&mut subject, &block).edge.leak.events;
        let block = beginning_with_the_centre(block);
        not_rotated += Leaks::of_block(&mut subject, &block).edge.leak.events;
    }
    assert!(rotated > 100, "{rotated}");
    assert_eq!(not_rotated, 0);
}

#[test]
fn volumes_relative_to_the_origin_do_not_leak_at_edges_but_do_at_vertices() {
    for case in [
        Case::Fan,
        Case::AxisAligned,
        Case::FarFan,
        Case::MeshInside,
        Case::MeshOutside,
    ] {
        let leaks = leaks_of(three_volumes, case);
        assert_eq!(leaks.edge.leak.events, 0, "{case}: {leaks:?}");
        assert!(leaks.edge.double.share() > 0.05, "{case}: {leaks:?}");
    }
    for case in [Case::Fan, Case::MeshInside, Case::MeshOutside] {
        let leaks = leaks_of(three_volumes, case);
        assert!(
            (0.05..5.0).contains(&in_percent(leaks.vertex.leak)),
            "{case}: {leaks:?}"
        );
    }
    let shared = leaks_of(three_volumes, Case::SharedEdge);
    assert_eq!(shared.edge.leak.events, 0);
}

#[test]
fn woops_shear_with_exact_signs_leaks_nowhere() {
    for CaseLeaks { case, leaks } in watertightness(|| Scalar(woop), &Case::ALL, RAYS, 2) {
        let all = [
            leaks.edge.leak,
            leaks.vertex.leak,
            leaks.elsewhere.leak,
            leaks.unpaired,
        ];
        assert!(all.iter().all(|rate| rate.events == 0), "{case}: {leaks:?}");
        let samples: u64 = all[..3].iter().map(|rate| rate.samples).sum();
        assert!(samples > RAYS * 9 / 10, "{case}: {samples} certain rays");
        if leaks.edge.leak.samples > 0 {
            assert!(leaks.edge.leak.bound_of_zero().unwrap() < 1e-2);
        }
    }
    // What is next to a border is where it is for all triangles: no ray hits two.
    for case in [Case::Fan, Case::SharedEdge, Case::MeshInside] {
        assert_eq!(leaks_of(woop, case).edge.double.events, 0, "{case}");
    }
}

#[test]
fn a_kernel_that_counts_zero_as_outside_leaks_on_the_lattice() {
    let strict = |ray: &Ray, triangle: &Triangle| {
        let exact = Exact::new(ray, triangle)?;
        (exact.class() == Class::Interior).then(|| exact.t().unwrap() as f32)
    };
    let leaks = leaks_of(strict, Case::Lattice);
    assert_eq!(leaks.edge.leak.share(), 1.0);
    assert_eq!(leaks.vertex.leak.share(), 1.0);
}

#[test]
fn a_kernel_that_reports_every_triangle_is_caught_hitting_twice() {
    let greedy: Kernel = |_, _| Some(1.0);
    let leaks = leaks_of(greedy, Case::SharedEdge);
    assert_eq!(leaks.edge.leak.events, 0);
    assert!(leaks.edge.double.share() > 0.5, "{leaks:?}");
    // Half of the time as many triangles face the ray as do not, or fewer.
    let leaks = leaks_of(greedy, Case::MeshInside);
    for passage in [leaks.edge, leaks.vertex, leaks.elsewhere] {
        assert!(passage.double.share() > 0.3, "{leaks:?}");
    }
}

#[test]
fn a_kernel_that_sees_one_side_only_is_caught_not_leaving() {
    let culling: Kernel = |ray, triangle| {
        let is_seen = Exact::new(ray, triangle)?.facing().is_gt();
        is_seen.then(|| woop(ray, triangle))?
    };
    let leaks = leaks_of(culling, Case::MeshOutside);
    assert_eq!(leaks.unpaired.share(), 1.0, "{leaks:?}");
    assert!(leaks.unpaired.samples > 1000);
}

#[test]
fn a_kernel_with_a_hole_leaks_where_it_aims_at_nothing() {
    let blind_upwards: Kernel = |ray, triangle| {
        let hit = woop(ray, triangle);
        hit.filter(|_| ray.direction[2] < 0.5)
    };
    let leaks = leaks_of(blind_upwards, Case::MeshInside);
    assert!(leaks.elsewhere.leak.share() > 0.1, "{leaks:?}");
}

#[test]
fn the_same_seed_gives_the_same_report_on_any_number_of_threads() {
    let on = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let cases = [Case::Fan, Case::SharedEdge];
            watertightness(|| Scalar(moller_trumbore), &cases, RAYS, seed)
        })
    };
    assert_eq!(on(1, 7), on(3, 7));
    assert_ne!(on(2, 7), on(2, 8));
}

/// What the harness takes for certain, counted exactly: the crossings of every ray that touches no
/// side.
#[test]
fn every_shot_crosses_as_often_as_it_says() {
    for case in Case::ALL {
        let mut counted = 0;
        for number in 0..3 {
            let block = case.block(3, number);
            for shot in block.shots.iter().take(64) {
                let among = |number: &usize| match &shot.among {
                    Some(faces) => faces.contains(&(*number as u32)),
                    None => true,
                };
                let exact: Vec<Exact> = (0..block.triangles.len())
                    .filter(among)
                    .map(|number| Exact::new(&shot.ray, &block.triangles[number]).unwrap())
                    .collect();
                let classes: Vec<Class> = exact.iter().map(Exact::class).collect();
                if classes
                    .iter()
                    .all(|&class| matches!(class, Class::Exterior | Class::Interior))
                {
                    let crossed = exact
                        .iter()
                        .filter(|exact| exact.class() == Class::Interior);
                    let crossings: i32 = crossed.map(|exact| exact.facing() as i32).sum();
                    assert_eq!(crossings, shot.winding, "{case}: {shot:?}");
                    counted += 1;
                } else {
                    assert!(
                        !classes.iter().all(|&class| class == Class::Exterior),
                        "{case}"
                    );
                }
            }
        }
        assert!(counted > 0 || case == Case::Lattice, "{case}");
    }
}

#[test]
fn rays_on_the_lattice_are_exact_ties() {
    let block = Case::Lattice.block(1, 0);
    for shot in &block.shots {
        let is_tie = |triangle: &Triangle| {
            let class = Exact::new(&shot.ray, triangle).unwrap().class();
            matches!(class, Class::Edge(_) | Class::Vertex(_))
        };
        assert!(block.triangles.iter().any(is_tie), "{shot:?}");
    }
}

/// Möller-Trumbore's test in each lane of a packet, as a kernel of the regime does it.
fn in_lanes<const N: usize>(regime: Regime, packet: &mut Packet<N>, triangles: &[Triangle]) {
    for triangle in triangles {
        for lane in 0..N {
            if let Some(t) = moller_trumbore(&Ray::of(packet, lane, scene::Range::TMax), triangle) {
                match regime {
                    Regime::Fixed => packet.hit_t[lane] = t,
                    Regime::Shrinking | Regime::Leaf => packet.t[lane] = t,
                }
            }
        }
    }
}

#[test]
fn a_packet_kernel_leaks_as_its_scalar_twin_does() {
    let cases = [Case::Fan, Case::Lattice, Case::MeshOutside];
    let scalar = watertightness(|| Scalar(moller_trumbore), &cases, 2000, 4);
    for &regime in Regime::ALL {
        let full = || Packets::<64, _>::new(regime, move |p, _, list| in_lanes(regime, p, list));
        assert_eq!(watertightness(full, &cases, 2000, 4), scalar, "{regime}");
        // 24 do not divide the rays of a call.
        let rest = || Packets::<24, _>::new(regime, move |p, _, list| in_lanes(regime, p, list));
        assert_eq!(watertightness(rest, &cases, 2000, 4), scalar, "{regime}");
    }
}

//! What every kernel answers, against `f64`.

use raybreed::{Culling, Ray, Triangle};

use crate::checks::one_nan;
use crate::kernels::{Answer, Calls, Kernel, RAYS, Rays, kernels};
use crate::reference::{Hit, Verdict, closest};
use crate::worlds::{Random, World};

/// Relative to the numbers of a scene of size 1: what no `f32` kernel should miss clear of edges and at no
/// grazing angle. The median is a thousandth of it.
const TOLERANCE: f64 = 1e-3;

/// Worlds for every kernel, with the verdicts on the rays as a call takes them.
fn worlds(culling: Culling) -> Vec<(World, [[Verdict; RAYS]; 2])> {
    let mut random = Random(1);
    let worlds = (0..60).map(|_| {
        let world = random.world();
        let verdicts = [Calls::Packet, Calls::CommonOrigin].map(|calls| {
            let rays = world.packet(calls);
            std::array::from_fn(|i| closest(&rays.ray(i), &world.triangles, culling))
        });
        (world, verdicts)
    });
    worlds.collect()
}

fn verdicts<'a>(kernel: &Kernel, verdicts: &'a [[Verdict; RAYS]; 2]) -> &'a [Verdict; RAYS] {
    &verdicts[usize::from(kernel.family.calls == Calls::CommonOrigin)]
}

#[test]
fn closest_hits_are_those_of_f64_away_from_edges() {
    let worlds = worlds(Culling::None);
    for kernel in kernels() {
        let (mut hits, mut unsure) = (0, 0);
        for (world, both) in &worlds {
            let rays = world.packet(kernel.family.calls);
            for (record, answer) in kernel.of_each_record(&rays, &world.triangles) {
                for (i, verdict) in verdicts(kernel, both).iter().enumerate() {
                    let what = || {
                        format!(
                            "{kernel} of {record}: {:?} of {:?}",
                            rays.ray(i),
                            world.triangles
                        )
                    };
                    match verdict {
                        Verdict::Unsure => unsure += 1,
                        Verdict::Miss => assert_eq!(answer.rays.t[i], rays.t[i], "{}", what()),
                        Verdict::Hit(hit) => {
                            hits += 1;
                            assert_hit(&answer, i, hit, what);
                        }
                    }
                }
            }
        }
        assert!(
            hits > 300 && hits > 2 * unsure,
            "{kernel}: {hits} hits, {unsure} unsure"
        );
    }
}

/// Whether all that is reported of ray `i` is what `f64` says.
fn assert_hit(answer: &Answer, i: usize, expected: &Hit, what: impl Fn() -> String) {
    let hit = answer.hits.hit(i, answer.rays.t[i]);
    assert_eq!(
        hit.triangle as usize,
        expected.triangle,
        "{hit:?} for {expected:?}: {}",
        what()
    );
    let found = [hit.t, hit.u, hit.v]
        .into_iter()
        .chain(hit.normal)
        .chain(hit.point);
    let Hit {
        t,
        u,
        v,
        normal,
        point,
        ..
    } = *expected;
    let expected = [t, u, v].into_iter().chain(normal).chain(point);
    for (found, expected) in found.zip(expected) {
        let error = (f64::from(found) - expected).abs();
        assert!(
            error < TOLERANCE,
            "{hit:?}, of which {found} is {expected}: {}",
            what()
        );
    }
}

#[test]
fn a_culled_side_is_not_there() {
    for culling in [Culling::Back, Culling::Front] {
        let worlds = worlds(culling);
        for kernel in kernels() {
            for (world, both) in &worlds {
                let rays = world.packet(kernel.family.calls);
                let after = kernel.culled(culling, &rays, &world.triangles);
                assert_closest(kernel, &rays, &after, verdicts(kernel, both));
            }
        }
    }
}

fn assert_closest(kernel: &Kernel, before: &Rays, after: &Rays, verdicts: &[Verdict; RAYS]) {
    for (i, verdict) in verdicts.iter().enumerate() {
        let expected = match verdict {
            Verdict::Unsure => continue,
            Verdict::Miss => f64::from(before.t[i]),
            Verdict::Hit(hit) => hit.t,
        };
        let t = f64::from(after.t[i]);
        let is_right = t == expected || (t - expected).abs() < TOLERANCE;
        assert!(
            is_right,
            "{kernel}: {t} for {expected}, {:?}",
            before.ray(i)
        );
    }
}

#[test]
fn packets_common_origins_and_single_rays_agree_away_from_edges() {
    let worlds = worlds(Culling::None);
    for family in kernels().chunk_by(|one, other| {
        let [one, other] = [one, other].map(|kernel| kernel.family);
        (one.numeric, one.watertight, one.lists) == (other.numeric, other.watertight, other.lists)
    }) {
        for (world, [_, verdicts]) in &worlds {
            // All can take rays of one origin.
            let rays = world.packet(Calls::CommonOrigin);
            let answer = |kernel: &Kernel| kernel.closest_hits(&rays, &world.triangles);
            let first = answer(&family[0]);
            for kernel in &family[1..] {
                let other = answer(kernel);
                for i in (0..RAYS).filter(|&i| verdicts[i] != Verdict::Unsure) {
                    let (t, expected) = (other.rays.t[i], first.rays.t[i]);
                    let is_right = t == expected || f64::from((t - expected).abs()) < TOLERANCE;
                    assert!(
                        is_right,
                        "{kernel}: {t} for {expected} by {}, {:?}",
                        family[0],
                        rays.ray(i)
                    );
                    assert_eq!(other.hits.triangle[i], first.hits.triangle[i], "{kernel}");
                }
            }
        }
    }
}

#[test]
fn a_scene_of_a_thousandth_is_hit_as_one_of_a_thousand() {
    let mut random = Random(2);
    for _ in 0..20 {
        let world = random.world();
        for scale in [2.0_f32.powi(-10), 2.0_f32.powi(10)] {
            let point = |point: [f32; 3]| point.map(|x| scale * x);
            let scaled = World {
                // `t` is in units of the direction.
                rays: world
                    .rays
                    .iter()
                    .map(|&ray| Ray {
                        origin: point(ray.origin),
                        direction: point(ray.direction),
                        ..ray
                    })
                    .collect(),
                triangles: world
                    .triangles
                    .iter()
                    .map(|triangle| {
                        Triangle::new(point(triangle.p0), point(triangle.p1), point(triangle.p2))
                    })
                    .collect(),
            };
            for kernel in kernels() {
                let ordinary = kernel.closest(&world.packet(kernel.family.calls), &world.triangles);
                let answer = kernel.closest(&scaled.packet(kernel.family.calls), &scaled.triangles);
                for i in 0..RAYS {
                    let [t, expected] = [answer.t[i], ordinary.t[i]].map(|t| one_nan(t.to_bits()));
                    assert_eq!(t, expected, "{kernel}: {:?} times {scale}", world.rays[i]);
                }
            }
        }
    }
}

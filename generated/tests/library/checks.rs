//! What holds for a kernel whatever the numbers are: a function a promise, each for a kernel and a world.

use raybreed::{Culling, Hits, Packet, Ray, Triangle};

use crate::calls::UNWRITTEN;
use crate::kernels::{Answer, Calls, Kernel, RAYS, Rays, kernels};
use crate::worlds::World;

/// All that no input may break.
pub fn nothing_surprises(world: &World) {
    for kernel in kernels() {
        only_what_is_hit_is_written(kernel, world);
        all_questions_agree(kernel, world);
        nothing_is_nothing(kernel, world);
        lanes_are_alone(kernel, world);
        a_side_is_seen_or_culled(kernel, world);
    }
    portable_kernels_answer_alike(world);
}

/// Of a ray that is hit, `t` lies in its range and the hit's number is a triangle's. Of others, of inactive rays
/// too, no bit changes, and of the rest of a ray never.
pub fn only_what_is_hit_is_written(kernel: &Kernel, world: &World) {
    let before = world.packet(kernel.family.calls);
    let after = kernel.closest_hits(&before, &world.triangles);
    for i in 0..RAYS {
        let what = || format!("{kernel}: ray {i}, {:?}", before.ray(i));
        let (ray, now) = (before.ray(i), after.rays.ray(i));
        let at_old_t = Ray { t: ray.t, ..now };
        assert_eq!(
            ray_bits(&at_old_t),
            ray_bits(&ray),
            "all but t is kept: {}",
            what()
        );
        if now.t.to_bits() == ray.t.to_bits() {
            assert_eq!(
                hit_bits(&after.hits, i),
                [UNWRITTEN; 9],
                "it is no hit: {}",
                what()
            );
            continue;
        }
        // The greater of zero and it, or zero if it is NaN.
        let t_min = ray.t_min.max(0.0);
        assert!(t_min < now.t && now.t < ray.t, "t {}: {}", now.t, what());
        let place = after.hits.triangle[i] as usize;
        assert!(
            place < world.triangles.len(),
            "triangle {place}: {}",
            what()
        );
        let is_written = hit_bits(&after.hits, i)
            .iter()
            .all(|&bits| bits != UNWRITTEN);
        assert!(is_written, "all is reported: {}", what());
    }
}

/// Without hits `t` is the same, and any hit is where a closest is.
pub fn all_questions_agree(kernel: &Kernel, world: &World) {
    let before = world.packet(kernel.family.calls);
    let with_hits = kernel.closest_hits(&before, &world.triangles).rays;
    let closest = kernel.closest(&before, &world.triangles);
    let any = kernel.any(&before, &world.triangles);
    for i in 0..RAYS {
        let (t, what) = (before.t[i], || {
            format!("{kernel}: ray {i}, {:?}", before.ray(i))
        });
        assert_same(&closest, &with_hits, i, what);
        let is_hit = closest.t[i].to_bits() != t.to_bits();
        let expected = Ray {
            t: if is_hit { f32::NEG_INFINITY } else { t },
            ..before.ray(i)
        };
        assert_eq!(ray_bits(&any.ray(i)), ray_bits(&expected), "{}", what());
    }
}

/// Without triangles nothing changes.
pub fn nothing_is_nothing(kernel: &Kernel, world: &World) {
    let before = world.packet(kernel.family.calls);
    let answer = kernel.closest_hits(&before, &[]);
    for rays in [
        &answer.rays,
        &kernel.closest(&before, &[]),
        &kernel.any(&before, &[]),
    ] {
        for i in 0..RAYS {
            assert_same(rays, &before, i, || format!("{kernel}: ray {i}"));
        }
    }
    assert_eq!(
        all_hit_bits(&answer.hits),
        vec![[UNWRITTEN; 9]; RAYS],
        "{kernel}"
    );
}

/// A ray has the same answer if every other ray is inactive, NaN, or as it was.
pub fn lanes_are_alone(kernel: &Kernel, world: &World) {
    let all = world.packet(kernel.family.calls);
    let together = kernel.closest_hits(&all, &world.triangles);
    let any = kernel.any(&all, &world.triangles);
    let nothing = Ray::new([0.0; 3], [0.0; 3]).between(0.0, 0.0);
    let nan = Ray::new([f32::NAN; 3], [f32::NAN; 3]);
    for (parity, other) in [(0, nothing), (1, nothing), (0, nan), (1, nan)] {
        let mut some = all.clone();
        for i in (0..RAYS).filter(|i| i % 2 != parity) {
            let origin = match kernel.family.calls {
                Calls::CommonOrigin => all.ray(0).origin,
                Calls::Packet | Calls::Ray => other.origin,
            };
            some.set(i, Ray { origin, ..other });
        }
        let apart = kernel.closest_hits(&some, &world.triangles);
        let any_apart = kernel.any(&some, &world.triangles);
        for i in (parity..RAYS).step_by(2) {
            let what = || format!("{kernel}: ray {i}, {:?}", all.ray(i));
            assert_same(&apart.rays, &together.rays, i, what);
            assert_same_hit(&apart, &together, i, what);
            assert_same(&any_apart, &any, i, what);
        }
    }
}

/// A triangle is hit from one side or the other; of a culled side, from the other alone.
pub fn a_side_is_seen_or_culled(kernel: &Kernel, world: &World) {
    let before = world.packet(kernel.family.calls);
    for triangle in world.triangles.iter().take(4) {
        let [both, front, back] = [Culling::None, Culling::Back, Culling::Front]
            .map(|culling| kernel.culled(culling, &before, &[*triangle]).t);
        for i in 0..RAYS {
            let missed = before.t[i].to_bits();
            let [both, front, back] = [both[i], front[i], back[i]].map(f32::to_bits);
            let right = if both == missed {
                front == missed && back == missed
            } else {
                (front == both && back == missed) || (front == missed && back == both)
            };
            assert!(
                right,
                "{kernel}: ray {i}, {:?} at {triangle:?}: {:?}",
                before.ray(i),
                [both, front, back].map(f32::from_bits)
            );
        }
    }
}

/// What is no triangle is as good as what fills a block up, and alone it is nothing.
pub fn what_is_no_triangle_is_missed(kernel: &Kernel, world: &World, nonsense: &[Triangle]) {
    let rays = world.packet(kernel.family.calls);
    let alone = kernel.closest_hits(&rays, nonsense);
    let any = kernel.any(&rays, nonsense);
    let every_second = |nonsense: &dyn Fn(usize) -> Triangle| -> Vec<Triangle> {
        let triangles = world.triangles.iter().enumerate();
        triangles
            .flat_map(|(i, &triangle)| [nonsense(i), triangle])
            .collect()
    };
    let filling = Triangle::new([f32::NAN; 3], [f32::NAN; 3], [f32::NAN; 3]);
    let expected = kernel.closest_hits(&rays, &every_second(&|_| filling));
    let mixed = kernel.closest_hits(&rays, &every_second(&|i| nonsense[i % nonsense.len()]));
    for i in 0..RAYS {
        let what = || format!("{kernel}: ray {i}, {:?} at {nonsense:?}", rays.ray(i));
        assert_same(&alone.rays, &rays, i, what);
        assert_same(&any, &rays, i, what);
        assert_eq!(hit_bits(&alone.hits, i), [UNWRITTEN; 9], "{}", what());
        assert_same(&mixed.rays, &expected.rays, i, what);
        assert_same_hit(&mixed, &expected, i, what);
    }
}

/// Portable kernels of a family answer bit for bit alike on all instruction sets.
pub fn portable_kernels_answer_alike(world: &World) {
    let portable = kernels()
        .iter()
        .filter(|kernel| kernel.family.numeric == raybreed::Numeric::Portable);
    let portable: Vec<&Kernel> = portable.collect();
    for family in portable.chunk_by(|one, other| std::ptr::eq(one.family, other.family)) {
        let rays = world.packet(family[0].family.calls);
        let answer = |kernel: &Kernel| kernel.closest_hits(&rays, &world.triangles);
        let expected = answer(family[0]);
        for kernel in &family[1..] {
            let found = answer(kernel);
            for i in 0..RAYS {
                let what = || format!("{kernel}: ray {i}, {:?}", rays.ray(i));
                assert_same(&found.rays, &expected.rays, i, what);
                assert_same_hit(&found, &expected, i, what);
            }
        }
    }
}

/// Whether ray `i` is the same in both, to the last bit.
fn assert_same(found: &Rays, expected: &Rays, i: usize, what: impl Fn() -> String) {
    let (found, expected) = (found.ray(i), expected.ray(i));
    assert_eq!(
        ray_bits(&found),
        ray_bits(&expected),
        "t {} for {}: {}",
        found.t,
        expected.t,
        what()
    );
}

/// Whether the hit of ray `i` is the same in both, to the last bit; which NaN is reported, nobody says.
fn assert_same_hit(found: &Answer, expected: &Answer, i: usize, what: impl Fn() -> String) {
    let [found, expected] = [found, expected].map(|answer| hit_bits(&answer.hits, i).map(one_nan));
    assert_eq!(found, expected, "{}", what());
}

pub fn ray_bits(ray: &Ray) -> [u32; 8] {
    let Ray {
        origin: [ox, oy, oz],
        direction: [dx, dy, dz],
        t_min,
        t,
    } = *ray;
    [ox, oy, oz, dx, dy, dz, t_min, t].map(f32::to_bits)
}

/// The bits of what is reported of ray `i`.
pub fn hit_bits<const N: usize>(hits: &Hits<N>, i: usize) -> [u32; 9] {
    let [nx, ny, nz] = hits.normal.map(|axis| axis[i].to_bits());
    let [x, y, z] = hits.point.map(|axis| axis[i].to_bits());
    [
        hits.u[i].to_bits(),
        hits.v[i].to_bits(),
        hits.triangle[i],
        nx,
        ny,
        nz,
        x,
        y,
        z,
    ]
}

pub fn all_hit_bits<const N: usize>(hits: &Hits<N>) -> Vec<[u32; 9]> {
    (0..N).map(|i| hit_bits(hits, i)).collect()
}

pub fn all_ray_bits<const N: usize>(packet: &Packet<N>) -> Vec<[u32; 8]> {
    (0..N).map(|i| ray_bits(&packet.ray(i))).collect()
}

/// The bits of a number, or of the one NaN; what is unwritten stays apart.
pub fn one_nan(bits: u32) -> u32 {
    let is_nan = f32::from_bits(bits).is_nan() && bits != UNWRITTEN;
    if is_nan { f32::NAN.to_bits() } else { bits }
}

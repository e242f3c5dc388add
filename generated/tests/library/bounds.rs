//! Both ends of a ray, to the last bit: what is there is no hit.

use raybreed::{Packet, Ray, Scene, Triangle};

use crate::calls::test;
use crate::checks::ray_bits;
use crate::kernels::{Calls, Kernel, RAYS, Rays, available, kernels};
use crate::worlds::{Random, World, at, minus};

/// Rays of one origin that hit a triangle of any shape far from its edges, and the triangle.
fn hits(random: &mut Random) -> (Rays, Triangle) {
    let triangle = Triangle::new(random.point(), random.point(), random.point());
    let origin = [0, 1, 2].map(|axis| triangle.p0[axis] + 1.5 + random.number());
    let rays = (0..RAYS).map(|_| {
        let [u, v] = [(); 2].map(|()| 0.3 + 0.1 * random.number());
        Ray::new(origin, minus(at(&triangle, u, v), origin))
    });
    let rays = rays.collect();
    let world = World {
        rays,
        triangles: Vec::new(),
    };
    (world.packet(Calls::CommonOrigin), triangle)
}

/// Whether each ray hits the triangle, by all questions.
fn is_hit(kernel: &Kernel, rays: &Rays, triangle: Triangle) -> [bool; RAYS] {
    let closest = kernel.closest(rays, &[triangle]);
    let any = kernel.any(rays, &[triangle]);
    std::array::from_fn(|i| {
        let is_hit = closest.t[i].to_bits() != rays.t[i].to_bits();
        assert_eq!(
            any.t[i] == f32::NEG_INFINITY,
            is_hit,
            "{kernel}: {:?} at {triangle:?}",
            rays.ray(i)
        );
        is_hit
    })
}

#[test]
fn what_is_at_an_end_is_no_hit_and_what_is_clear_of_it_is_one() {
    let mut random = Random(21);
    for _ in 0..50 {
        let (rays, triangle) = hits(&mut random);
        for kernel in kernels() {
            let t = kernel.closest(&rays, &[triangle]).t;
            let between = |t_min: fn(f32) -> f32, t_max: fn(f32) -> f32| {
                let rays = Rays {
                    t_min: t.map(t_min),
                    t: t.map(t_max),
                    ..rays.clone()
                };
                is_hit(kernel, &rays, triangle)
            };
            let around = between(|t| t * (1.0 - 1e-5), |t| t * (1.0 + 1e-5));
            let up_to = between(|_| 0.0, |t| t);
            let from = between(|t| t, |_| f32::INFINITY);
            for i in (0..RAYS).filter(|&i| t[i].is_finite()) {
                let found = (around[i], up_to[i], from[i]);
                let expected = (true, false, false);
                assert_eq!(
                    found,
                    expected,
                    "{kernel}: t {}, {:?} at {triangle:?}",
                    t[i],
                    rays.ray(i)
                );
            }
        }
    }
}

#[test]
fn of_equal_triangles_the_first_is_reported() {
    let mut random = Random(3);
    for _ in 0..20 {
        let (rays, triangle) = hits(&mut random);
        // Whole blocks of the same, and more than one.
        let triangles = [triangle; 40];
        for kernel in kernels() {
            let answer = kernel.closest_hits(&rays, &triangles);
            for i in (0..RAYS).filter(|&i| answer.rays.t[i].is_finite()) {
                assert_eq!(
                    answer.hits.triangle[i],
                    0,
                    "{kernel}: {:?} at {triangle:?}",
                    rays.ray(i)
                );
            }
        }
    }
}

#[test]
fn a_negative_lower_bound_is_zero() {
    for t_min in [-0.0, -1.0, f32::MIN, f32::NEG_INFINITY] {
        assert_is_zero(t_min);
    }
}

#[test]
fn no_t_is_above_a_lower_bound_that_is_nan() {
    for t_min in [f32::NAN, -f32::NAN] {
        let (rays, triangle) = hits(&mut Random(24));
        let bounded = Rays {
            t_min: [t_min; RAYS],
            ..rays
        };
        for kernel in kernels() {
            let found = kernel.closest(&bounded, &[triangle]);
            assert_eq!(found.t, bounded.t, "{kernel}");
        }
    }
}

/// Whether every kernel has the same answers with this lower bound as with zero.
fn assert_is_zero(t_min: f32) {
    let mut random = Random(22);
    for _ in 0..10 {
        let (rays, triangle) = hits(&mut random);
        let bounded = Rays {
            t_min: [t_min; RAYS],
            ..rays.clone()
        };
        for kernel in kernels() {
            let expected = kernel.closest(&rays, &[triangle]);
            let found = kernel.closest(&bounded, &[triangle]);
            for i in 0..RAYS {
                let found = Ray {
                    t_min: 0.0,
                    ..found.ray(i)
                };
                let expected = expected.ray(i);
                assert_eq!(
                    ray_bits(&found),
                    ray_bits(&expected),
                    "{kernel} from {t_min}: {found:?}"
                );
            }
        }
    }
}

#[test]
fn scenes_without_a_lower_bound_do_not_read_it() {
    /// Nothing but what is the default.
    struct Unbounded;
    impl Scene for Unbounded {}

    let (rays, triangle) = hits(&mut Random(23));
    for isa in available() {
        let mut packet = Packet {
            t_min: [f32::INFINITY; RAYS],
            ..rays.clone()
        };
        test::<Unbounded>(isa).closest(&mut packet, &[triangle]);
        assert!(packet.t.into_iter().any(f32::is_finite), "packet on {isa}");
        let ray = packet.ray(0).between(f32::NAN, f32::INFINITY);
        let block = Triangle::<[f32; 16]>::block(&[triangle]);
        assert!(
            test::<Unbounded>(isa).ray_any(&ray, &[block]),
            "ray on {isa}"
        );
    }
}

//! Scales over which verdicts stay, and inputs that are not finite.

mod kernels;

use accuracy::{Hit, Hostile, Rate, Scalar, Scaling, Subject, hostile, scale_range};
use kernels::{kensler_shirley, moller_trumbore, three_volumes, woop};
use scene::{Ray, Triangle};

/// Rays.
const RAYS: u64 = 2000;

#[test]
fn the_appendix_kernel_compares_sixth_powers_of_the_scale() {
    let range = scale_range(&mut Scalar(kensler_shirley), Scaling::Everything, RAYS, 1);
    assert!((-25..=-15).contains(range.start()), "{range:?}");
    assert!((15..=25).contains(range.end()), "{range:?}");
}

#[test]
fn third_powers_go_farther() {
    let range = scale_range(&mut Scalar(three_volumes), Scaling::Everything, RAYS, 1);
    assert!(*range.start() < -28 && *range.end() > 30, "{range:?}");
    // Differences of coordinates, divided by directions, and then f64.
    let range = scale_range(&mut Scalar(woop), Scaling::Everything, RAYS, 1);
    assert!(*range.start() < -50 && *range.end() > 90, "{range:?}");
}

/// Whether a vector has a component that is not small.
fn is_long(vector: [f32; 3]) -> bool {
    vector.into_iter().any(|component| component.abs() > 1e-3)
}

#[test]
fn an_absolute_epsilon_ends_the_range_of_what_it_is_compared_with() {
    let of_directions =
        |ray: &Ray, triangle: &Triangle| is_long(ray.direction).then(|| woop(ray, triangle))?;
    let of_positions = |ray: &Ray, triangle: &Triangle| {
        let edge = [0, 1, 2].map(|axis| triangle.p1[axis] - triangle.p0[axis]);
        is_long(edge).then(|| woop(ray, triangle))?
    };
    let ends = |range: &std::ops::RangeInclusive<i32>| (-12..=-5).contains(range.start());
    let goes_on = |range: &std::ops::RangeInclusive<i32>| *range.start() < -50;
    let [directions, positions] = [Scaling::Directions, Scaling::Positions];
    let range = scale_range(&mut Scalar(of_directions), directions, RAYS, 1);
    assert!(ends(&range), "{range:?}");
    let range = scale_range(&mut Scalar(of_directions), positions, RAYS, 1);
    assert!(goes_on(&range), "{range:?}");
    let range = scale_range(&mut Scalar(of_positions), positions, RAYS, 1);
    assert!(ends(&range), "{range:?}");
    let range = scale_range(&mut Scalar(of_positions), directions, RAYS, 1);
    assert!(goes_on(&range), "{range:?}");
}

fn events(rate: Rate) -> u64 {
    assert!(rate.samples > 0);
    rate.events
}

#[test]
fn kernels_with_ordered_comparisons_miss_what_is_not_finite() {
    for kernel in [moller_trumbore, kensler_shirley] {
        let Hostile {
            ray_hit,
            triangle_hit,
            inactive_hit,
            disturbed,
        } = hostile(&mut Scalar(kernel), 20 * RAYS, 1);
        let all = [ray_hit, triangle_hit, inactive_hit, disturbed];
        assert_eq!(all.map(events), [0; 4]);
    }
}

/// Tests that something is outside, not that it is inside: NaN is not outside.
#[test]
fn a_kernel_with_comparisons_the_wrong_way_round_is_caught() {
    let negated = |ray: &Ray, triangle: &Triangle| {
        let is_finite = |vector: &[f32; 3]| vector.iter().all(|x| x.is_finite());
        let Triangle { p0, p1, p2 } = triangle;
        let all = [&ray.origin, &ray.direction, p0, p1, p2];
        if all.into_iter().all(is_finite) {
            let unlimited = Ray {
                t_max: 1e30,
                ..*ray
            };
            woop(&unlimited, triangle)
                .filter(|&t| !matches!(t.partial_cmp(&ray.t_max), Some(o) if o.is_ge()))
        } else {
            Some(f32::NAN)
        }
    };
    let found = hostile(&mut Scalar(negated), RAYS, 1);
    assert_eq!(found.ray_hit.share(), 1.0);
    assert_eq!(found.triangle_hit.share(), 1.0);
    // Only the NaN among what t_max may be.
    assert!(found.inactive_hit.events > 0, "{found:?}");
    assert_eq!(found.disturbed.events, 0);
}

/// Stops at the first ray that is not finite.
struct Fragile;

impl Subject for Fragile {
    fn hits(&mut self, rays: &[Ray], triangles: &[Triangle], answers: &mut [Option<Hit>]) {
        Scalar(moller_trumbore).hits(rays, triangles, answers);
        let bad = rays
            .iter()
            .any(|ray| ray.direction.iter().any(|x| x.is_nan()));
        if bad {
            answers.fill(None);
        }
    }
}

#[test]
fn a_kernel_that_lets_one_lane_spoil_another_is_caught() {
    let found = hostile(&mut Fragile, 5 * RAYS, 1);
    assert_eq!(found.ray_hit.events, 0);
    assert!(found.disturbed.events > 0, "{found:?}");
}

//! What every kernel promises of any input whatever.

use proptest::collection::vec;
use proptest::prelude::*;
use raybreed::{Edges, Ray, Triangle};

use crate::checks;
use crate::kernels::{Kernel, kernels};
use crate::worlds::{World, any_world, flat_triangle, infinite_triangle, points_on_a_line, world};

/// The check for every kernel; proptest makes the worlds, and smaller ones if it fails.
fn every_kernel(world: &World, check: fn(&Kernel, &World)) {
    kernels().iter().for_each(|kernel| check(kernel, world));
}

/// The triangles are missed by rays that are aimed at them, and change nothing among others.
fn missed(world: &World, other: &World) {
    for kernel in kernels() {
        checks::what_is_no_triangle_is_missed(kernel, world, &world.triangles);
        checks::what_is_no_triangle_is_missed(kernel, other, &world.triangles);
    }
}

/// Whether the edges' cross product is anything, in integers.
fn has_area([p0, p1, p2]: [[i32; 3]; 3]) -> bool {
    let edge = |p: [i32; 3], axis: usize| i64::from(p[axis] - p0[axis]);
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .any(|&(x, y)| edge(p1, x) * edge(p2, y) != edge(p1, y) * edge(p2, x))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, max_shrink_iters: 4096, ..ProptestConfig::default() })]

    #[test]
    fn only_what_is_hit_is_written(world in any_world()) {
        every_kernel(&world, checks::only_what_is_hit_is_written);
    }

    #[test]
    fn closest_and_any_agree_with_hits_and_without(world in any_world()) {
        every_kernel(&world, checks::all_questions_agree);
    }

    #[test]
    fn empty_slices_change_nothing(world in any_world()) {
        every_kernel(&world, checks::nothing_is_nothing);
    }

    #[test]
    fn no_lane_changes_another(world in any_world()) {
        every_kernel(&world, checks::lanes_are_alone);
    }

    #[test]
    fn what_is_hit_is_hit_from_one_side(world in any_world()) {
        every_kernel(&world, checks::a_side_is_seen_or_culled);
    }

    #[test]
    fn portable_kernels_answer_alike_on_every_instruction_set(world in any_world()) {
        checks::portable_kernels_answer_alike(&world);
    }

    #[test]
    fn triangles_without_area_are_missed(
        world in world(flat_triangle(), 1..4),
        other in any_world(),
    ) {
        missed(&world, &other);
    }

    /// Of points on a line, or a step away from one, which is an area of one in 10^8.
    #[test]
    fn a_block_has_no_place_for_triangles_without_area_and_for_every_other(
        mut points in points_on_a_line(),
        away in (0..9_usize, -1..2_i32),
    ) {
        points[away.0 / 3][away.0 % 3] += away.1;
        let [p0, p1, p2] = points.map(|p| p.map(|x| x as f32));
        let triangle = Triangle { p0, p1, p2 };
        let [there, there_by_edges] = [
            Triangle::<[f32; 4]>::block(&[triangle]).p0[0][0].is_finite(),
            Edges::<[f32; 4]>::block(&[triangle.into()]).p0[0][0].is_finite(),
        ];
        prop_assert_eq!((there, there_by_edges), (has_area(points), has_area(points)));
    }

    #[test]
    fn triangles_that_are_not_finite_are_missed(
        world in world(infinite_triangle(), 1..4),
        other in any_world(),
    ) {
        missed(&world, &other);
    }

    /// Numbers that have nothing to do with each other.
    #[test]
    fn no_bits_make_a_kernel_panic(
        numbers in vec(any::<u32>(), 8 * 8),
        vertices in vec(any::<u32>(), 9 * 4),
    ) {
        let number = |bits: &u32| f32::from_bits(*bits);
        let rays = numbers.chunks_exact(8).map(|ray| {
            let [ox, oy, oz, dx, dy, dz, t_min, t] = std::array::from_fn(|i| number(&ray[i]));
            Ray::new([ox, oy, oz], [dx, dy, dz]).between(t_min, t)
        });
        let triangles = vertices.chunks_exact(9).map(|triangle| {
            let [p0, p1, p2] = std::array::from_fn(|p| std::array::from_fn(|axis| number(&triangle[3 * p + axis])));
            Triangle { p0, p1, p2 }
        });
        let world = World { rays: rays.collect(), triangles: triangles.collect() };
        checks::nothing_surprises(&world);
    }
}

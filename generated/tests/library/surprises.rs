//! Inputs that surprised some kernel once: every kernel is asked, every time.

use raybreed::{Ray, Triangle};

use crate::checks;
use crate::kernels::kernels;
use crate::worlds::World;

/// Origin, direction, lower bound; vertices.
type Case = ([f32; 3], [f32; 3], f32, [[f32; 3]; 3]);

#[test]
fn t_stays_in_its_range_where_it_is_near_an_end_or_overflows() {
    let cases: [Case; 5] = [
        // `t` is at `t_min`, and `t_min V² < Va V`.
        (
            [1.0, 2.0, 0.9263661],
            [-2.0288038, -2.485598, -1.5697443],
            1.0,
            [
                [-2.0, 0.0, -1.2507308],
                [0.0, -1.0, 0.0],
                [-2.0, -1.1853466, 2.0],
            ],
        ),
        // `Va` is infinite, and `Va V < ∞ V²`; or `V²` is.
        (
            [f32::MAX, 0.0, 0.0],
            [1.0, 0.0, -1.6045376],
            0.0,
            [
                [1.2772504, -0.32272714, 1.0],
                [0.0, -1.0, -1.3416681],
                [-0.9953614, -0.76181746, 0.6410985],
            ],
        ),
        (
            [f32::MAX, 0.0, 0.0],
            [-0.3890074, -1.7648565, 1.0],
            0.0,
            [
                [-1.8157763, 0.0, -1.400826],
                [0.0, -2.0, 0.19577631],
                [-0.8951766, -2.0, 0.0],
            ],
        ),
        (
            [0.0, f32::MIN, 0.0],
            [-2.0, -2.5, 1.3375093],
            0.0,
            [
                [-1.0, 0.45071387, -1.7057611],
                [-2.0, -2.0, -1.0],
                [-2.0, 1.3581389, -1.1177115],
            ],
        ),
        // `t` is less than any number.
        (
            [f32::from_bits(1), -0.0, 0.0],
            [-f32::from_bits(1), 0.0, 1.3983281],
            0.0,
            [
                [-3.3826616e-18, 1.1754944e-38, 0.0],
                [0.0, -2.0, 2.0],
                [1.0, 2.0, -1.3045269],
            ],
        ),
    ];
    for case in cases {
        checks::nothing_surprises(&world(case));
    }
}

#[test]
fn collapsed_triangles_are_missed_where_their_normal_is_a_rounding() {
    let cases: [Case; 3] = [
        (
            [-1.3450159, 2.0, 1.6489843],
            [0.17709076, -2.0, -1.0650218],
            0.0,
            [[-2.0, 0.0, 1.0], [-2.0, 0.0, 1.0], [0.0, 0.0, 0.0]],
        ),
        (
            [2.0, -1.0, 2.0],
            [-3.0267038, 2.089542, -1.7268214],
            0.0,
            [
                [-0.053408075, 1.0224121, 0.6630442],
                [-2.0, 1.1566718, -0.11668721],
                [-0.053408075, 1.0224121, 0.6630442],
            ],
        ),
        (
            [-2.0, -2.0, 0.0],
            [1.4027467e38, 2.0, 0.0],
            0.0,
            [
                [0.0, -1.8430697, 676806140.0],
                [0.0, -1.8430697, 676806140.0],
                [-2.0, -2.0, 0.0],
            ],
        ),
    ];
    for case in cases {
        let world = world(case);
        for kernel in kernels() {
            checks::what_is_no_triangle_is_missed(kernel, &world, &world.triangles);
        }
    }
}

/// The ray, and the triangle with each vertex as its first.
fn world((origin, direction, t_min, [p0, p1, p2]): Case) -> World {
    World {
        rays: vec![Ray::new(origin, direction).between(t_min, f32::INFINITY)],
        triangles: [[p0, p1, p2], [p1, p2, p0], [p2, p0, p1]]
            .map(|[p0, p1, p2]| Triangle { p0, p1, p2 })
            .to_vec(),
    }
}

//! Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection", for packets whose rays may differ in
//! the axis along which they are longest: a ray's axes are renamed by selecting, lane by lane.
//!
//! As in the paper's appendix, without culling: the shear once a ray, edge functions in single precision, and
//! in double precision where one of them is zero.

use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of each ray in `t`; if `FIXED`, every hit in `hit_t`, `t` staying.
#[target_feature(enable = "sse2")]
#[inline]
pub fn woop<const N: usize, const FIXED: bool>(packet: &mut Packet<N>, triangles: &[Triangle]) {
    const { assert!(N.is_multiple_of(LANES)) };
    let zero = zeros();
    let mut shears = [[0.0; N]; 3];
    for row in 0..N / LANES {
        let direction = [
            load(&packet.dx, row),
            load(&packet.dy, row),
            load(&packet.dz, row),
        ];
        let [dx, dy, dz] = renamed(direction, direction);
        let [x, y, z] = &mut shears;
        store(x, row, div(dx, dz));
        store(y, row, div(dy, dz));
        store(z, row, div(splat(1.0), dz));
    }
    for triangle in triangles {
        for row in 0..N / LANES {
            let direction = [
                load(&packet.dx, row),
                load(&packet.dy, row),
                load(&packet.dz, row),
            ];
            let [x, y, z] = &shears;
            let shear = [load(x, row), load(y, row), load(z, row)];
            let origin = [
                load(&packet.ox, row),
                load(&packet.oy, row),
                load(&packet.oz, row),
            ];
            let [ax, ay, az] = sheared(triangle.p0, origin, direction, shear);
            let [bx, by, bz] = sheared(triangle.p1, origin, direction, shear);
            let [cx, cy, cz] = sheared(triangle.p2, origin, direction, shear);

            // Scaled barycentric coordinates by edge functions.
            let mut u = sub(mul(cx, by), mul(cy, bx));
            let mut v = sub(mul(ax, cy), mul(ay, cx));
            let mut w = sub(mul(bx, ay), mul(by, ax));
            let is_zero = either(either(zero_in(u), zero_in(v)), zero_in(w));
            if !is_empty(is_zero) {
                u = select(is_zero, exact_difference(cx, by, cy, bx), u);
                v = select(is_zero, exact_difference(ax, cy, ay, cx), v);
                w = select(is_zero, exact_difference(bx, ay, by, ax), w);
            }
            let least = min(min(u, v), w);
            let greatest = max(max(u, v), w);
            let mut mask = either(at_most(zero, least), at_most(greatest, zero));
            if is_empty(mask) {
                continue;
            }

            // Scaled distances, and the division.
            let det = add(add(u, v), w);
            let t = div(add(add(mul(u, az), mul(v, bz)), mul(w, cz)), det);
            let t_max = load(&packet.t, row);
            mask = both(mask, both(less(zero, t), less(t, t_max)));
            if is_empty(mask) {
                continue;
            }
            if FIXED {
                let hit_t = load(&packet.hit_t, row);
                store(&mut packet.hit_t, row, select(mask, t, hit_t));
            } else {
                store(&mut packet.t, row, select(mask, t, t_max));
            }
        }
    }
}

/// A vertex in a ray's sheared frame.
#[target_feature(enable = "sse2")]
#[inline]
fn sheared(
    [px, py, pz]: [f32; 3],
    [ox, oy, oz]: [Vector; 3],
    direction: [Vector; 3],
    [sx, sy, sz]: [Vector; 3],
) -> [Vector; 3] {
    let from_origin = [sub(splat(px), ox), sub(splat(py), oy), sub(splat(pz), oz)];
    let [x, y, z] = renamed(from_origin, direction);
    [sub(x, mul(sx, z)), sub(y, mul(sy, z)), mul(sz, z)]
}

/// The components of a vector, last the one along the axis of which the direction has most, the others in
/// turn.
#[target_feature(enable = "sse2")]
#[inline]
fn renamed([x, y, z]: [Vector; 3], [dx, dy, dz]: [Vector; 3]) -> [Vector; 3] {
    let [mx, my, mz] = [flip_sign(dx, dx), flip_sign(dy, dy), flip_sign(dz, dz)];
    let is_x = both(at_most(my, mx), at_most(mz, mx));
    let is_y = at_most(mz, my);
    [
        select(is_x, y, select(is_y, z, x)),
        select(is_x, z, select(is_y, x, y)),
        select(is_x, x, select(is_y, y, z)),
    ]
}

/// The lanes that are zero.
#[target_feature(enable = "sse2")]
#[inline]
fn zero_in(a: Vector) -> Mask {
    both(at_most(a, zeros()), at_most(zeros(), a))
}

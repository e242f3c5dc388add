//! Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection", one ray against as many triangles as
//! a vector has lanes.
//!
//! As in the paper's appendix, without culling: the axes renamed and the shear computed once, edge functions
//! in single precision, and in double precision where one of them is zero.

use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of ray `ray` in `t`; if `FIXED`, the last one in `hit_t`, `t` staying.
#[target_feature(enable = "sse2")]
#[inline]
pub fn woop<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    ray: usize,
    blocks: &[Triangle<[f32; LANES]>],
) {
    let zero = zeros();
    let origin = [packet.ox[ray], packet.oy[ray], packet.oz[ray]];
    let direction = [packet.dx[ray], packet.dy[ray], packet.dz[ray]];
    let axes = axes_along(direction);
    let [dx, dy, dz] = axes.map(|axis| direction[axis]);
    let shear = [splat(dx / dz), splat(dy / dz), splat(1.0 / dz)];
    let t_before = splat(packet.t[ray]);
    let mut t_max = t_before;
    let mut hit_t = zero;
    let mut block_of_hit = zero;
    for (place, block) in (1..).zip(blocks) {
        let [ax, ay, az] = sheared(&block.p0, origin, axes, shear);
        let [bx, by, bz] = sheared(&block.p1, origin, axes, shear);
        let [cx, cy, cz] = sheared(&block.p2, origin, axes, shear);

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
        let least_of = min(min(u, v), w);
        let greatest = max(max(u, v), w);
        let mut mask = either(at_most(zero, least_of), at_most(greatest, zero));
        if is_empty(mask) {
            continue;
        }

        // Scaled distances, and the division.
        let det = add(add(u, v), w);
        let t = div(add(add(mul(u, az), mul(v, bz)), mul(w, cz)), det);
        mask = both(mask, both(less(zero, t), less(t, t_max)));
        if is_empty(mask) {
            continue;
        }
        if FIXED {
            hit_t = select(mask, t, hit_t);
            let number = splat(f32::from_bits(place));
            block_of_hit = select(mask, number, block_of_hit);
        } else {
            t_max = select(mask, t, t_max);
        }
    }

    if FIXED {
        let blocks_of_hits = to_array(block_of_hit).map(f32::to_bits);
        let lane = last_of_most(blocks_of_hits);
        if blocks_of_hits[lane] > 0 {
            packet.hit_t[ray] = to_array(hit_t)[lane];
        }
    } else if !is_empty(less(t_max, t_before)) {
        packet.t[ray] = least(to_array(t_max));
    }
}

/// Vertices in the ray's sheared frame.
#[target_feature(enable = "sse2")]
#[inline]
fn sheared(
    points: &[[f32; LANES]; 3],
    origin: [f32; 3],
    [kx, ky, kz]: [usize; 3],
    [sx, sy, sz]: [Vector; 3],
) -> [Vector; 3] {
    let x = sub(load(&points[kx], 0), splat(origin[kx]));
    let y = sub(load(&points[ky], 0), splat(origin[ky]));
    let z = sub(load(&points[kz], 0), splat(origin[kz]));
    [sub(x, mul(sx, z)), sub(y, mul(sy, z)), mul(sz, z)]
}

/// The lanes that are zero.
#[target_feature(enable = "sse2")]
#[inline]
fn zero_in(a: Vector) -> Mask {
    both(at_most(a, zeros()), at_most(zeros(), a))
}

//! Möller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection", without culling.
//!
//! The direct packet and SIMD adaptation that Kensler and Shirley time against (their section 5,
//! table 1, row MT): the edges are found once per triangle, then four rays at a time go through
//! the paper's statements in the paper's order, and a vector in which no ray is left goes no
//! further. The paper's test of `det` against an epsilon is left out: with `det` 0 or NaN, `u` or
//! `v` is NaN or infinite, and that misses.

use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of each ray in `t`; if `FIXED`, every hit in `hit_t`, `t` staying.
#[target_feature(enable = "sse2")]
#[inline]
pub fn moller_trumbore<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    triangles: &[Triangle],
) {
    align_frame();
    const { assert!(N.is_multiple_of(LANES)) };
    let zero = zeros();
    let one = splat(1.0);
    for triangle in triangles {
        let p0x = splat(triangle.p0[0]);
        let p0y = splat(triangle.p0[1]);
        let p0z = splat(triangle.p0[2]);
        let edge1x = sub(splat(triangle.p1[0]), p0x);
        let edge1y = sub(splat(triangle.p1[1]), p0y);
        let edge1z = sub(splat(triangle.p1[2]), p0z);
        let edge2x = sub(splat(triangle.p2[0]), p0x);
        let edge2y = sub(splat(triangle.p2[1]), p0y);
        let edge2z = sub(splat(triangle.p2[2]), p0z);

        for row in 0..N / LANES {
            let dx = load(&packet.dx, row);
            let dy = load(&packet.dy, row);
            let dz = load(&packet.dz, row);

            // pvec = d × edge2, det = edge1 · pvec
            let pvecx = sub(mul(dy, edge2z), mul(dz, edge2y));
            let pvecy = sub(mul(dz, edge2x), mul(dx, edge2z));
            let pvecz = sub(mul(dx, edge2y), mul(dy, edge2x));
            let det = dot(edge1x, edge1y, edge1z, pvecx, pvecy, pvecz);
            let inv_det = div(one, det);

            // tvec = a - p0, u = tvec · pvec / det
            let tvecx = sub(load(&packet.ox, row), p0x);
            let tvecy = sub(load(&packet.oy, row), p0y);
            let tvecz = sub(load(&packet.oz, row), p0z);
            let u = mul(dot(tvecx, tvecy, tvecz, pvecx, pvecy, pvecz), inv_det);
            let mut mask = both(at_most(zero, u), at_most(u, one));
            if is_empty(mask) {
                continue;
            }

            // qvec = tvec × edge1, v = d · qvec / det
            let qvecx = sub(mul(tvecy, edge1z), mul(tvecz, edge1y));
            let qvecy = sub(mul(tvecz, edge1x), mul(tvecx, edge1z));
            let qvecz = sub(mul(tvecx, edge1y), mul(tvecy, edge1x));
            let v = mul(dot(dx, dy, dz, qvecx, qvecy, qvecz), inv_det);
            mask = both(mask, at_most(zero, v));
            mask = both(mask, at_most(add(u, v), one));
            if is_empty(mask) {
                continue;
            }

            // t = edge2 · qvec / det
            let t = mul(dot(edge2x, edge2y, edge2z, qvecx, qvecy, qvecz), inv_det);
            let t_max = load(&packet.t, row);
            mask = both(mask, less(zero, t));
            mask = both(mask, less(t, t_max));
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

/// The dot product of two vectors.
#[target_feature(enable = "sse2")]
#[inline]
fn dot(ax: Vector, ay: Vector, az: Vector, bx: Vector, by: Vector, bz: Vector) -> Vector {
    add(add(mul(ax, bx), mul(ay, by)), mul(az, bz))
}

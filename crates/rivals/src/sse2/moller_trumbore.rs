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
    const { assert!(N.is_multiple_of(LANES)) };
    let zero = _mm_setzero_ps();
    let one = _mm_set1_ps(1.0);
    for triangle in triangles {
        let p0x = _mm_set1_ps(triangle.p0[0]);
        let p0y = _mm_set1_ps(triangle.p0[1]);
        let p0z = _mm_set1_ps(triangle.p0[2]);
        let edge1x = _mm_sub_ps(_mm_set1_ps(triangle.p1[0]), p0x);
        let edge1y = _mm_sub_ps(_mm_set1_ps(triangle.p1[1]), p0y);
        let edge1z = _mm_sub_ps(_mm_set1_ps(triangle.p1[2]), p0z);
        let edge2x = _mm_sub_ps(_mm_set1_ps(triangle.p2[0]), p0x);
        let edge2y = _mm_sub_ps(_mm_set1_ps(triangle.p2[1]), p0y);
        let edge2z = _mm_sub_ps(_mm_set1_ps(triangle.p2[2]), p0z);

        for row in 0..N / LANES {
            let dx = load(&packet.dx, row);
            let dy = load(&packet.dy, row);
            let dz = load(&packet.dz, row);

            // pvec = d × edge2, det = edge1 · pvec
            let pvecx = _mm_sub_ps(_mm_mul_ps(dy, edge2z), _mm_mul_ps(dz, edge2y));
            let pvecy = _mm_sub_ps(_mm_mul_ps(dz, edge2x), _mm_mul_ps(dx, edge2z));
            let pvecz = _mm_sub_ps(_mm_mul_ps(dx, edge2y), _mm_mul_ps(dy, edge2x));
            let det = dot(edge1x, edge1y, edge1z, pvecx, pvecy, pvecz);
            let inv_det = _mm_div_ps(one, det);

            // tvec = a - p0, u = tvec · pvec / det
            let tvecx = _mm_sub_ps(load(&packet.ox, row), p0x);
            let tvecy = _mm_sub_ps(load(&packet.oy, row), p0y);
            let tvecz = _mm_sub_ps(load(&packet.oz, row), p0z);
            let u = _mm_mul_ps(dot(tvecx, tvecy, tvecz, pvecx, pvecy, pvecz), inv_det);
            let mut mask = _mm_and_ps(_mm_cmpge_ps(u, zero), _mm_cmple_ps(u, one));
            if is_empty(mask) {
                continue;
            }

            // qvec = tvec × edge1, v = d · qvec / det
            let qvecx = _mm_sub_ps(_mm_mul_ps(tvecy, edge1z), _mm_mul_ps(tvecz, edge1y));
            let qvecy = _mm_sub_ps(_mm_mul_ps(tvecz, edge1x), _mm_mul_ps(tvecx, edge1z));
            let qvecz = _mm_sub_ps(_mm_mul_ps(tvecx, edge1y), _mm_mul_ps(tvecy, edge1x));
            let v = _mm_mul_ps(dot(dx, dy, dz, qvecx, qvecy, qvecz), inv_det);
            mask = _mm_and_ps(mask, _mm_cmpge_ps(v, zero));
            mask = _mm_and_ps(mask, _mm_cmple_ps(_mm_add_ps(u, v), one));
            if is_empty(mask) {
                continue;
            }

            // t = edge2 · qvec / det
            let t = _mm_mul_ps(dot(edge2x, edge2y, edge2z, qvecx, qvecy, qvecz), inv_det);
            let t_max = load(&packet.t, row);
            mask = _mm_and_ps(mask, _mm_cmpgt_ps(t, zero));
            mask = _mm_and_ps(mask, _mm_cmplt_ps(t, t_max));
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
fn dot(ax: __m128, ay: __m128, az: __m128, bx: __m128, by: __m128, bz: __m128) -> __m128 {
    _mm_add_ps(
        _mm_add_ps(_mm_mul_ps(ax, bx), _mm_mul_ps(ay, by)),
        _mm_mul_ps(az, bz),
    )
}

//! Kensler and Shirley 2006, "Optimizing ray-triangle intersection via automated search",
//! appendix: their best kernel for general packets (GA+), statement by statement.
//!
//! The formulation is the cheapest one of the paper's section 4 for packets. Names, the order of
//! tests and exits, and the reciprocal estimate with one round of Newton are the appendix's.

use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of each ray in `t`; if `FIXED`, every hit in `hit_t`, `t` staying.
#[target_feature(enable = "sse2")]
#[inline]
pub fn kensler_shirley<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    triangles: &[Triangle],
) {
    const { assert!(N.is_multiple_of(LANES)) };
    for triangle in triangles {
        // Get triangle corners, compute two edges and normal.
        let p1x = _mm_set1_ps(triangle.p1[0]);
        let p1y = _mm_set1_ps(triangle.p1[1]);
        let p1z = _mm_set1_ps(triangle.p1[2]);
        let p0x = _mm_set1_ps(triangle.p0[0]);
        let p0y = _mm_set1_ps(triangle.p0[1]);
        let p0z = _mm_set1_ps(triangle.p0[2]);
        let edge0x = _mm_sub_ps(p1x, p0x);
        let edge0y = _mm_sub_ps(p1y, p0y);
        let edge0z = _mm_sub_ps(p1z, p0z);
        let p2x = _mm_set1_ps(triangle.p2[0]);
        let p2y = _mm_set1_ps(triangle.p2[1]);
        let p2z = _mm_set1_ps(triangle.p2[2]);
        let edge1x = _mm_sub_ps(p0x, p2x);
        let edge1y = _mm_sub_ps(p0y, p2y);
        let edge1z = _mm_sub_ps(p0z, p2z);
        let normalx = _mm_sub_ps(_mm_mul_ps(edge0y, edge1z), _mm_mul_ps(edge0z, edge1y));
        let normaly = _mm_sub_ps(_mm_mul_ps(edge0z, edge1x), _mm_mul_ps(edge0x, edge1z));
        let normalz = _mm_sub_ps(_mm_mul_ps(edge0x, edge1y), _mm_mul_ps(edge0y, edge1x));
        let zeroes = _mm_setzero_ps();

        for row in 0..N / LANES {
            // Load origin, current t-value and direction.
            let ox = load(&packet.ox, row);
            let oy = load(&packet.oy, row);
            let oz = load(&packet.oz, row);
            let oldt = load(&packet.t, row);
            let dx = load(&packet.dx, row);
            let dy = load(&packet.dy, row);
            let dz = load(&packet.dz, row);
            // Compute volume V, the denominator.
            let v = dot(normalx, normaly, normalz, dx, dy, dz);
            // Reciprocal estimate of V with one round of Newton.
            let rcpi = _mm_rcp_ps(v);
            let rcp = _mm_sub_ps(
                _mm_add_ps(rcpi, rcpi),
                _mm_mul_ps(_mm_mul_ps(rcpi, rcpi), v),
            );
            // Edge from ray origin to first triangle vertex.
            let edge2x = _mm_sub_ps(p0x, ox);
            let edge2y = _mm_sub_ps(p0y, oy);
            let edge2z = _mm_sub_ps(p0z, oz);
            // Compute volume Va.
            let va = dot(normalx, normaly, normalz, edge2x, edge2y, edge2z);
            // Find Va/V to get t-value.
            let t = _mm_mul_ps(rcp, va);
            let tmaskb = _mm_cmplt_ps(t, oldt);
            let tmaska = _mm_cmpgt_ps(t, zeroes);
            let mut mask = _mm_and_ps(tmaska, tmaskb);
            if is_empty(mask) {
                continue;
            }
            // Compute the single intermediate cross product.
            let intermx = _mm_sub_ps(_mm_mul_ps(edge2y, dz), _mm_mul_ps(edge2z, dy));
            let intermy = _mm_sub_ps(_mm_mul_ps(edge2z, dx), _mm_mul_ps(edge2x, dz));
            let intermz = _mm_sub_ps(_mm_mul_ps(edge2x, dy), _mm_mul_ps(edge2y, dx));
            // Compute volume V1.
            let v1 = dot(intermx, intermy, intermz, edge1x, edge1y, edge1z);
            // Find V1/V to get barycentric beta.
            let beta = _mm_mul_ps(rcp, v1);
            let bmask = _mm_cmpge_ps(beta, zeroes);
            mask = _mm_and_ps(mask, bmask);
            if is_empty(mask) {
                continue;
            }
            // Compute volume V2.
            let v2 = dot(intermx, intermy, intermz, edge0x, edge0y, edge0z);
            // Test if alpha > 0.
            let v1plusv2 = _mm_add_ps(v1, v2);
            let v12mask = _mm_cmple_ps(_mm_mul_ps(v1plusv2, v), _mm_mul_ps(v, v));
            // Find V2/V to get barycentric gamma.
            let gamma = _mm_mul_ps(rcp, v2);
            let gmask = _mm_cmpge_ps(gamma, zeroes);
            mask = _mm_and_ps(mask, v12mask);
            mask = _mm_and_ps(mask, gmask);
            if is_empty(mask) {
                continue;
            }
            // Update stored t-value for closest hits.
            if FIXED {
                let hit_t = load(&packet.hit_t, row);
                store(&mut packet.hit_t, row, select(mask, t, hit_t));
            } else {
                store(&mut packet.t, row, select(mask, t, oldt));
            }
        }
    }
}

/// The dot product of two vectors, summed as the appendix does.
#[target_feature(enable = "sse2")]
#[inline]
fn dot(ax: __m128, ay: __m128, az: __m128, bx: __m128, by: __m128, bz: __m128) -> __m128 {
    _mm_add_ps(
        _mm_add_ps(_mm_mul_ps(ax, bx), _mm_mul_ps(ay, by)),
        _mm_mul_ps(az, bz),
    )
}

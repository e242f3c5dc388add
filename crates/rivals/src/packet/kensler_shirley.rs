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
    align_frame();
    const { assert!(N.is_multiple_of(LANES)) };
    for triangle in triangles {
        // Get triangle corners, compute two edges and normal.
        let p1x = splat(triangle.p1[0]);
        let p1y = splat(triangle.p1[1]);
        let p1z = splat(triangle.p1[2]);
        let p0x = splat(triangle.p0[0]);
        let p0y = splat(triangle.p0[1]);
        let p0z = splat(triangle.p0[2]);
        let edge0x = sub(p1x, p0x);
        let edge0y = sub(p1y, p0y);
        let edge0z = sub(p1z, p0z);
        let p2x = splat(triangle.p2[0]);
        let p2y = splat(triangle.p2[1]);
        let p2z = splat(triangle.p2[2]);
        let edge1x = sub(p0x, p2x);
        let edge1y = sub(p0y, p2y);
        let edge1z = sub(p0z, p2z);
        let normalx = sub(mul(edge0y, edge1z), mul(edge0z, edge1y));
        let normaly = sub(mul(edge0z, edge1x), mul(edge0x, edge1z));
        let normalz = sub(mul(edge0x, edge1y), mul(edge0y, edge1x));
        let zeroes = zeros();

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
            let rcpi = estimate_reciprocal(v);
            let rcp = sub(add(rcpi, rcpi), mul(mul(rcpi, rcpi), v));
            // Edge from ray origin to first triangle vertex.
            let edge2x = sub(p0x, ox);
            let edge2y = sub(p0y, oy);
            let edge2z = sub(p0z, oz);
            // Compute volume Va.
            let va = dot(normalx, normaly, normalz, edge2x, edge2y, edge2z);
            // Find Va/V to get t-value.
            let t = mul(rcp, va);
            let tmaskb = less(t, oldt);
            let tmaska = less(zeroes, t);
            let mut mask = both(tmaska, tmaskb);
            if is_empty(mask) {
                continue;
            }
            // Compute the single intermediate cross product.
            let intermx = sub(mul(edge2y, dz), mul(edge2z, dy));
            let intermy = sub(mul(edge2z, dx), mul(edge2x, dz));
            let intermz = sub(mul(edge2x, dy), mul(edge2y, dx));
            // Compute volume V1.
            let v1 = dot(intermx, intermy, intermz, edge1x, edge1y, edge1z);
            // Find V1/V to get barycentric beta.
            let beta = mul(rcp, v1);
            let bmask = at_most(zeroes, beta);
            mask = both(mask, bmask);
            if is_empty(mask) {
                continue;
            }
            // Compute volume V2.
            let v2 = dot(intermx, intermy, intermz, edge0x, edge0y, edge0z);
            // Test if alpha > 0.
            let v1plusv2 = add(v1, v2);
            let v12mask = at_most(mul(v1plusv2, v), mul(v, v));
            // Find V2/V to get barycentric gamma.
            let gamma = mul(rcp, v2);
            let gmask = at_most(zeroes, gamma);
            mask = both(mask, v12mask);
            mask = both(mask, gmask);
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
fn dot(ax: Vector, ay: Vector, az: Vector, bx: Vector, by: Vector, bz: Vector) -> Vector {
    add(add(mul(ax, bx), mul(ay, by)), mul(az, bz))
}

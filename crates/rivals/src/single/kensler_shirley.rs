//! Kensler and Shirley 2006, "Optimizing ray-triangle intersection via automated search",
//! appendix: the statements of their best kernel for general packets (GA+), one ray against as many
//! triangles as a vector has lanes.
//!
//! The paper has it for packets. Here each lane is a triangle and keeps its closest hit; the closest
//! of them is looked up at the end.

use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of ray `ray` in `t`; if `FIXED`, the last one in `hit_t`, `t` staying.
#[target_feature(enable = "sse2")]
#[inline]
pub fn kensler_shirley<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    ray: usize,
    blocks: &[Triangle<[f32; LANES]>],
) {
    align_frame();
    let zeroes = zeros();
    let ox = splat(packet.ox[ray]);
    let oy = splat(packet.oy[ray]);
    let oz = splat(packet.oz[ray]);
    let dx = splat(packet.dx[ray]);
    let dy = splat(packet.dy[ray]);
    let dz = splat(packet.dz[ray]);
    let t_before = splat(packet.t[ray]);
    let mut t_max = t_before;
    let mut hit_t = zeroes;
    let mut block_of_hit = zeroes;
    for (place, block) in (1..).zip(blocks) {
        // Get triangle corners, compute two edges and normal.
        let p1x = load(&block.p1[0], 0);
        let p1y = load(&block.p1[1], 0);
        let p1z = load(&block.p1[2], 0);
        let p0x = load(&block.p0[0], 0);
        let p0y = load(&block.p0[1], 0);
        let p0z = load(&block.p0[2], 0);
        let edge0x = sub(p1x, p0x);
        let edge0y = sub(p1y, p0y);
        let edge0z = sub(p1z, p0z);
        let p2x = load(&block.p2[0], 0);
        let p2y = load(&block.p2[1], 0);
        let p2z = load(&block.p2[2], 0);
        let edge1x = sub(p0x, p2x);
        let edge1y = sub(p0y, p2y);
        let edge1z = sub(p0z, p2z);
        let normalx = sub(mul(edge0y, edge1z), mul(edge0z, edge1y));
        let normaly = sub(mul(edge0z, edge1x), mul(edge0x, edge1z));
        let normalz = sub(mul(edge0x, edge1y), mul(edge0y, edge1x));
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
        let tmaskb = less(t, t_max);
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

/// The dot product of two vectors, summed as the appendix does.
#[target_feature(enable = "sse2")]
#[inline]
fn dot(ax: Vector, ay: Vector, az: Vector, bx: Vector, by: Vector, bz: Vector) -> Vector {
    add(add(mul(ax, bx), mul(ay, by)), mul(az, bz))
}

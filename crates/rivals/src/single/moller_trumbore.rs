//! Möller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection", without culling,
//! one ray against as many triangles as a vector has lanes.
//!
//! The statements, their order and the exits are those of the packet form; the lanes are triangles
//! instead of rays, each keeps its closest hit, and the closest of them is looked up at the end.

use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of ray `ray` in `t`; if `FIXED`, the last one in `hit_t`, `t` staying.
#[target_feature(enable = "sse2")]
#[inline]
pub fn moller_trumbore<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    ray: usize,
    blocks: &[Triangle<[f32; LANES]>],
) {
    align_frame();
    let zero = zeros();
    let one = splat(1.0);
    let ox = splat(packet.ox[ray]);
    let oy = splat(packet.oy[ray]);
    let oz = splat(packet.oz[ray]);
    let dx = splat(packet.dx[ray]);
    let dy = splat(packet.dy[ray]);
    let dz = splat(packet.dz[ray]);
    let t_before = splat(packet.t[ray]);
    let mut t_max = t_before;
    let mut hit_t = zero;
    let mut block_of_hit = zero;
    for (place, block) in (1..).zip(blocks) {
        let p0x = load(&block.p0[0], 0);
        let p0y = load(&block.p0[1], 0);
        let p0z = load(&block.p0[2], 0);
        let edge1x = sub(load(&block.p1[0], 0), p0x);
        let edge1y = sub(load(&block.p1[1], 0), p0y);
        let edge1z = sub(load(&block.p1[2], 0), p0z);
        let edge2x = sub(load(&block.p2[0], 0), p0x);
        let edge2y = sub(load(&block.p2[1], 0), p0y);
        let edge2z = sub(load(&block.p2[2], 0), p0z);

        // pvec = d × edge2, det = edge1 · pvec
        let pvecx = sub(mul(dy, edge2z), mul(dz, edge2y));
        let pvecy = sub(mul(dz, edge2x), mul(dx, edge2z));
        let pvecz = sub(mul(dx, edge2y), mul(dy, edge2x));
        let det = dot(edge1x, edge1y, edge1z, pvecx, pvecy, pvecz);
        let inv_det = div(one, det);

        // tvec = a - p0, u = tvec · pvec / det
        let tvecx = sub(ox, p0x);
        let tvecy = sub(oy, p0y);
        let tvecz = sub(oz, p0z);
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
        mask = both(mask, less(zero, t));
        mask = both(mask, less(t, t_max));
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

/// The dot product of two vectors.
#[target_feature(enable = "sse2")]
#[inline]
fn dot(ax: Vector, ay: Vector, az: Vector, bx: Vector, by: Vector, bz: Vector) -> Vector {
    add(add(mul(ax, bx), mul(ay, by)), mul(az, bz))
}

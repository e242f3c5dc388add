//! Kensler and Shirley 2006, "Optimizing ray-triangle intersection via automated search", section 4: the cheapest
//! formulation for rays of one origin, of which all but three dot products is done once a triangle.
//!
//! The paper does not print its kernel for that (Table 1, GA+ (co)). Tests, their order, exits and the reciprocal
//! estimate with one round of Newton are those of the appendix's kernel for general packets.

use super::common::*;
use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of each ray in `t`; if `FIXED`, every hit in `hit_t`, `t` staying. The origin is
/// that of ray 0.
#[target_feature(enable = "sse2")]
#[inline]
pub fn common_origin<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    triangles: &[Triangle],
) {
    align_frame();
    const { assert!(N.is_multiple_of(LANES)) };
    let a = [packet.ox[0], packet.oy[0], packet.oz[0]];
    let minus = |p: [f32; 3], q: [f32; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    for &Triangle { p0, p1, p2 } in triangles {
        let edges = [minus(p1, p0), minus(p0, p2), minus(p0, a)];
        let normal = cross3(edges[0], edges[1]);
        let va = splat(dot3(normal, edges[2]));
        let of_v = splatted(&normal);
        let of_v1 = splatted(&cross3(edges[1], edges[2]));
        let of_v2 = splatted(&cross3(edges[0], edges[2]));
        for row in 0..N / LANES {
            let Ray { direction, .. } = Ray::of_row(packet, row);
            let t_max = load(&packet.t, row);
            let hit = test([of_v, of_v1, of_v2], va, direction, t_max);
            if let Some((mask, t)) = hit {
                keep::<N, FIXED>(packet, row, mask, t, t_max);
            }
        }
    }
}

/// The appendix's tests. Nothing if no lane is hit.
#[target_feature(enable = "sse2")]
#[inline]
fn test(
    [of_v, of_v1, of_v2]: [[Vector; 3]; 3],
    va: Vector,
    direction: [Vector; 3],
    t_max: Vector,
) -> Option<(Mask, Vector)> {
    let zero = zeros();
    let v = dot(of_v, direction);
    let estimate = estimate_reciprocal(v);
    let reciprocal = sub(add(estimate, estimate), mul(mul(estimate, estimate), v));
    let t = mul(reciprocal, va);
    let mask = any(both(less(zero, t), less(t, t_max)))?;
    let v1 = dot(of_v1, direction);
    let mask = any(both(mask, at_most(zero, mul(reciprocal, v1))))?;
    let v2 = dot(of_v2, direction);
    let sum = at_most(mul(add(v1, v2), v), mul(v, v));
    let mask = any(both(mask, both(sum, at_most(zero, mul(reciprocal, v2)))))?;
    Some((mask, t))
}

//! The Plücker form of the test for rays of one origin (Benthin 2006, "Realtime ray tracing on current CPU
//! architectures"; Kensler and Shirley 2006, section 4, find the same volumes to be the cheapest for a common
//! origin): every side spans a plane with the origin, once a packet and triangle, and a ray's direction is
//! on one side of it or the other.

use super::common::*;
use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of each ray in `t`; if `FIXED`, every hit in `hit_t`, `t` staying. The origin is
/// that of ray 0.
#[target_feature(enable = "sse2")]
#[inline]
pub fn packet<const N: usize, const FIXED: bool>(packet: &mut Packet<N>, triangles: &[Triangle]) {
    align_frame();
    const { assert!(N.is_multiple_of(LANES)) };
    let origin = [packet.ox[0], packet.oy[0], packet.oz[0]];
    for &Triangle { p0, p1, p2 } in triangles {
        let from_origin = |p: [f32; 3]| [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]];
        let [a, b, c] = [from_origin(p0), from_origin(p1), from_origin(p2)];
        let normals = [cross3(b, c), cross3(c, a), cross3(a, b)];
        // The volume of the origin and the triangle, of the same sign as those of hits.
        let volume = splat(dot3(a, normals[0]));
        let [bc, ca, ab] = [
            splatted(&normals[0]),
            splatted(&normals[1]),
            splatted(&normals[2]),
        ];
        for row in 0..N / LANES {
            let Ray { direction, .. } = Ray::of_row(packet, row);
            let v0 = dot(bc, direction);
            let v1 = dot(ca, direction);
            let v2 = dot(ab, direction);
            let mask = of_one_sign(v0, v1, v2);
            if is_empty(mask) {
                continue;
            }
            let t = div(volume, add(add(v0, v1), v2));
            let t_max = load(&packet.t, row);
            if let Some((mask, t)) = in_range(mask, t, t_max) {
                keep::<N, FIXED>(packet, row, mask, t, t_max);
            }
        }
    }
}

//! The Plücker form of the test for rays of one origin (Benthin 2006, "Realtime ray tracing on current CPU
//! architectures"; Kensler and Shirley 2006, section 4, find the same volumes to be the cheapest for a common
//! origin): every side spans a plane with the origin, once a packet and triangle, and a ray's direction is
//! on one side of it or the other.

use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of each ray in `t`; if `FIXED`, every hit in `hit_t`, `t` staying. The origin is
/// that of ray 0.
#[target_feature(enable = "sse2")]
#[inline]
pub fn benthin<const N: usize, const FIXED: bool>(packet: &mut Packet<N>, triangles: &[Triangle]) {
    const { assert!(N.is_multiple_of(LANES)) };
    let origin = [packet.ox[0], packet.oy[0], packet.oz[0]];
    let zero = zeros();
    for &Triangle { p0, p1, p2 } in triangles {
        let from_origin = |p: [f32; 3]| [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]];
        let [a, b, c] = [from_origin(p0), from_origin(p1), from_origin(p2)];
        let [bc, ca, ab] = [cross(b, c), cross(c, a), cross(a, b)];
        // The volume of the origin and the triangle, of the same sign as those of hits.
        let volume = splat(a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2]);
        for row in 0..N / LANES {
            let dx = load(&packet.dx, row);
            let dy = load(&packet.dy, row);
            let dz = load(&packet.dz, row);
            let v0 = dot(bc, dx, dy, dz);
            let v1 = dot(ca, dx, dy, dz);
            let v2 = dot(ab, dx, dy, dz);
            let least = min(min(v0, v1), v2);
            let greatest = max(max(v0, v1), v2);
            let mut mask = either(at_most(zero, least), at_most(greatest, zero));
            if is_empty(mask) {
                continue;
            }
            let t = div(volume, add(add(v0, v1), v2));
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

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The dot product of a vector that all rays share and one of each.
#[target_feature(enable = "sse2")]
#[inline]
fn dot([x, y, z]: [f32; 3], dx: Vector, dy: Vector, dz: Vector) -> Vector {
    add(add(mul(splat(x), dx), mul(splat(y), dy)), mul(splat(z), dz))
}

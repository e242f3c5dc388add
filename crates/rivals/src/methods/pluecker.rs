//! The Plücker test as Shevtsov, Soupikov and Kapustin 2007 begin with it (section 3): every side's line by
//! six numbers, and the signs of three inner products with the ray's line.

use super::common::*;
use super::lanes::*;
use crate::{Packet, Triangle};

/// What is kept of a triangle: of the sides `b c`, `c a`, `a b` the vector from end to end and the moment,
/// the cross product of the ends: 18 numbers; and `d` of the plane, of which the moments' sum is the normal.
/// 76 bytes.
pub type Record<T = f32> = [T; 19];

/// The precomputation.
pub fn prepare(triangle: &Triangle) -> Record {
    let Triangle {
        p0: a,
        p1: b,
        p2: c,
    } = *triangle;
    let mut record = [0.0; 19];
    let mut normal = [0.0; 3];
    for (side, (from, to)) in [(b, c), (c, a), (a, b)].into_iter().enumerate() {
        let moment = cross3(from, to);
        for axis in 0..3 {
            record[6 * side + axis] = to[axis] - from[axis];
            record[6 * side + 3 + axis] = moment[axis];
            normal[axis] += moment[axis];
        }
    }
    record[18] = dot3(a, normal);
    record
}

/// Stores the closest hit of each ray in `t`; if `FIXED`, every hit in `hit_t`, `t` staying.
#[target_feature(enable = "sse2")]
#[inline]
pub fn packet<const N: usize, const FIXED: bool>(packet: &mut Packet<N>, triangles: &[Record]) {
    align_frame();
    const { assert!(N.is_multiple_of(LANES)) };
    // The moments of the rays' lines, d × o.
    let mut moments = [const { OfRays([0.0; N]) }; 3];
    for row in 0..N / LANES {
        let Ray { origin, direction } = Ray::of_row(packet, row);
        for (moment, axis) in moments.iter_mut().zip(0..) {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let lanes = sub(mul(direction[j], origin[k]), mul(direction[k], origin[j]));
            store(&mut moment.0, row, lanes);
        }
    }
    for record in triangles {
        let numbers = splatted(record);
        let side = |number: usize| {
            let at = 6 * number;
            [
                [numbers[at], numbers[at + 1], numbers[at + 2]],
                [numbers[at + 3], numbers[at + 4], numbers[at + 5]],
            ]
        };
        let sides = [side(0), side(1), side(2)];
        let normal = [0, 1, 2].map(|axis| record[3 + axis] + record[9 + axis] + record[15 + axis]);
        let normal = splatted(&normal);
        for row in 0..N / LANES {
            let Ray { origin, direction } = Ray::of_row(packet, row);
            let [mx, my, mz] = &moments;
            let moment = [load(&mx.0, row), load(&my.0, row), load(&mz.0, row)];
            let s0 = inner_product(sides[0], direction, moment);
            let s1 = inner_product(sides[1], direction, moment);
            let s2 = inner_product(sides[2], direction, moment);
            let mask = of_one_sign(s0, s1, s2);
            if is_empty(mask) {
                continue;
            }
            let t = div(sub(numbers[18], dot(normal, origin)), add(add(s0, s1), s2));
            let t_max = load(&packet.t, row);
            if let Some((mask, t)) = in_range(mask, t, t_max) {
                keep::<N, FIXED>(packet, row, mask, t, t_max);
            }
        }
    }
}

/// The permuted inner product of a side's line and a ray's: `d · m - (d × o) · e`.
#[target_feature(enable = "sse2")]
#[inline]
fn inner_product(
    [edge, moment_of_side]: [[Vector; 3]; 2],
    direction: [Vector; 3],
    moment: [Vector; 3],
) -> Vector {
    sub(dot(direction, moment_of_side), dot(moment, edge))
}

//! Baldwin and Weber 2016, "Fast ray-triangle intersections by coordinate transformation": an affine map takes
//! the triangle to the unit one in the plane z = 0, where everything that a test asks is a comparison.
//!
//! A map of that kind has a column that may be chosen; the paper takes the axis of which the normal has most,
//! so every row has a zero or a one there. All twelve numbers are kept, and rays are mapped without looking at
//! which axis it was: with the axes renamed instead, the map's numbers and the test are Wald's.

use super::common::*;
use super::lanes::*;
use crate::{Packet, Triangle};

/// What is kept of a triangle: three rows of the map, four numbers each. 48 bytes.
pub type Record<T = f32> = [T; 12];

/// The precomputation (section 2.2): the inverse of the matrix with the columns `AB`, `AC`, the axis `r` and
/// the vertex `A`.
pub fn prepare(triangle: &Triangle) -> Record {
    let Plane { a, ab, ac, n } = Plane::new(triangle);
    let [_, _, r] = axes_of(n);
    let axis = [0, 1, 2].map(|axis| if axis == r { 1.0 } else { 0.0 });
    let n_r = component(n, r);
    let [x, y, z] = [cross3(ac, axis), cross3(axis, ab), n].map(|row| row.map(|e| e / n_r));
    [
        x[0],
        x[1],
        x[2],
        -dot3(x, a),
        y[0],
        y[1],
        y[2],
        -dot3(y, a),
        z[0],
        z[1],
        z[2],
        -dot3(z, a),
    ]
}

/// There is one form.
const ONLY: u8 = 0;

forms! {
    /// The ray is mapped a row at a time, the last one first.
    packet, single: ONLY;
}

/// A ray's axes stay as they are.
fn axes(_: &Record) -> [usize; 3] {
    [0, 1, 2]
}

/// One ray, the same for all triangles.
#[target_feature(enable = "sse2")]
#[inline]
fn ray_in_block<const N: usize>(packet: &Packet<N>, ray: usize, _: &Record<[f32; LANES]>) -> Ray {
    Ray::of_ray(packet, ray)
}

/// No triangle is treated apart.
fn is_apart(_: &Record) -> bool {
    false
}

/// Section 3: `t` where the mapped ray has z = 0, then x and y there. Nothing if no lane is hit.
#[target_feature(enable = "sse2")]
#[inline]
fn test<const FORM: u8>(
    &[xx, xy, xz, x1, yx, yy, yz, y1, zx, zy, zz, z1]: &Record<Vector>,
    _: bool,
    &Ray { origin, direction }: &Ray,
    t_max: Vector,
) -> Option<(Mask, Vector)> {
    let (zero, z) = (zeros(), [zx, zy, zz]);
    let height = add(dot(z, origin), z1);
    let t = div(sub(zero, height), dot(z, direction));
    let mut mask = both(less(zero, t), less(t, t_max));
    if is_empty(mask) {
        return None;
    }
    let hit = along(origin, t, direction);
    let u = add(dot([xx, xy, xz], hit), x1);
    mask = both(mask, at_most(zero, u));
    if is_empty(mask) {
        return None;
    }
    let v = add(dot([yx, yy, yz], hit), y1);
    mask = both(mask, both(at_most(zero, v), at_most(add(u, v), splat(1.0))));
    if is_empty(mask) {
        return None;
    }
    Some((mask, t))
}

//! Badouel 1990, "An efficient ray-polygon intersection" (Graphics Gems): the hit of the ray and the plane
//! is projected along the axis of which the normal has most, and two equations in two unknowns are solved
//! there, with two divisions.
//!
//! The original finds the projection in every test. Here, as in the methods that came of it, what depends on
//! the triangle alone is kept.

use super::common::*;
use super::lanes::*;
use crate::{Packet, Triangle};

/// What is kept of a triangle: `N` and `d` of its plane, its first vertex and its two edges without the axis
/// `r`, and `r`, as the bits of an integer. 44 bytes.
pub type Record<T = f32> = [T; 11];

/// The precomputation: the plane, and the projection. `N` has the order `p`, `q`, `r`.
pub fn prepare(triangle: &Triangle) -> Record {
    let Plane { a, ab, ac, n } = Plane::new(triangle);
    let [p, q, r] = axes_of(n);
    let of = |vector: [f32; 3], axis| component(vector, axis);
    [
        of(n, p),
        of(n, q),
        of(n, r),
        dot3(a, n),
        of(a, p),
        of(a, q),
        of(ab, p),
        of(ab, q),
        of(ac, p),
        of(ac, q),
        f32::from_bits(r as u32),
    ]
}

/// There is one form.
const ONLY: u8 = 0;

forms! {
    axes: after 10;
    apart: never;
    /// The plane, then the projection.
    packet, single: ONLY;
}

/// The listing of the gem, of a ray whose axes are `p`, `q`, `r`. Where the first edge has nothing of `p`,
/// which the listing asks in a branch, its two equations are solved in the other order. Nothing if no lane is
/// hit.
#[target_feature(enable = "sse2")]
#[inline]
fn test<const FORM: u8>(
    &[np, nq, nr, d, ap, aq, u1, v1, u2, v2, _]: &Record<Vector>,
    _: bool,
    ray: &Ray,
    t_max: Vector,
) -> Option<(Mask, Vector)> {
    let (zero, one) = (zeros(), splat(1.0));
    let n = [np, nq, nr];
    let t = div(sub(d, dot(n, ray.origin)), dot(n, ray.direction));
    let mask = any(both(less(zero, t), less(t, t_max)))?;
    let [hp, hq, _] = along(ray.origin, t, ray.direction);
    let (u0, v0) = (sub(hp, ap), sub(hq, aq));
    let upright = both(at_most(zero, u1), at_most(u1, zero));
    let beta = div(
        select(upright, u0, sub(mul(v0, u1), mul(u0, v1))),
        select(upright, u2, sub(mul(v2, u1), mul(u2, v1))),
    );
    let mask = any(both(mask, both(at_most(zero, beta), at_most(beta, one))))?;
    let alpha = div(
        select(upright, sub(v0, mul(beta, v2)), sub(u0, mul(beta, u2))),
        select(upright, v1, u1),
    );
    let mask = any(both(
        mask,
        both(at_most(zero, alpha), at_most(add(alpha, beta), one)),
    ))?;
    Some((mask, t))
}

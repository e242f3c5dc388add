//! Wald 2004, "Realtime ray tracing and interactive global illumination", as Havel and Herout 2010 describe
//! it in section II.A: the triangle is projected along the axis of which its normal has most, and six numbers
//! give the barycentric coordinates of a point of its plane.

use super::common::*;
use super::lanes::*;
use crate::{Packet, Triangle};

/// What is kept of a triangle: `n_p`, `n_q`, `d` of its plane; `U_p`, `U_q`, `U_d`; `V_p`, `V_q`, `V_d`;
/// and the axis `r` that is left out, as the bits of an integer. 40 bytes.
pub type Record<T = f32> = [T; 10];

/// The precomputation (equations 5 and 6). `p` and `q` are the axes after `r` in turn, so the denominator of
/// equation 6 is the component `N_r`.
pub fn prepare(triangle: &Triangle) -> Record {
    let Plane { a, ab, ac, n } = Plane::new(triangle);
    let [p, q, r] = axes_of(n);
    let of = |vector: [f32; 3]| [p, q, r].map(|axis| component(vector, axis));
    let ([ap, aq, _], [bp, bq, _], [cp, cq, _]) = (of(a), of(ab), of(ac));
    let [np, nq, nr] = of(n);
    [
        np / nr,
        nq / nr,
        dot3(a, n) / nr,
        cq / nr,
        -cp / nr,
        (aq * cp - ap * cq) / nr,
        -bq / nr,
        bp / nr,
        (ap * bq - aq * bp) / nr,
        f32::from_bits(r as u32),
    ]
}

/// The division comes first.
const DIVIDED: u8 = 0;
/// The division is put off until all tests are passed (Havel and Herout, section V).
const DEFERRED: u8 = 1;

forms! {
    axes: after 9;
    apart: never;
    /// The division comes first.
    packet, single: DIVIDED;
    /// The division is put off until all tests are passed (Havel and Herout, section V).
    packet_deferred, single_deferred: DEFERRED;
}

/// Equations 5 and 7, of a ray whose axes are `p`, `q`, `r`; or the same in units of `det`, everything in
/// the sign that `det` gives it. Nothing if no lane is hit.
#[target_feature(enable = "sse2")]
#[inline]
fn test<const FORM: u8>(
    &[np, nq, d, up, uq, ud, vp, vq, vd, _]: &Record<Vector>,
    _: bool,
    ray: &Ray,
    t_max: Vector,
) -> Option<(Mask, Vector)> {
    let Ray {
        origin: [op, oq, or],
        direction: [dp, dq, dr],
    } = *ray;
    let zero = zeros();
    let det = add(add(mul(np, dp), mul(nq, dq)), dr);
    let above = sub(d, add(add(mul(np, op), mul(nq, oq)), or));
    if FORM == DIVIDED {
        let t = div(above, det);
        let mask = any(both(less(zero, t), less(t, t_max)))?;
        let (hp, hq) = (add(op, mul(t, dp)), add(oq, mul(t, dq)));
        let u = add(add(mul(hp, up), mul(hq, uq)), ud);
        let mask = any(both(mask, at_most(zero, u)))?;
        let v = add(add(mul(hp, vp), mul(hq, vq)), vd);
        let mask = any(both(
            mask,
            both(at_most(zero, v), at_most(add(u, v), splat(1.0))),
        ))?;
        return Some((mask, t));
    }
    let size = flip_sign(det, det);
    let scaled = flip_sign(above, det);
    let mask = any(both(less(zero, scaled), less(scaled, mul(size, t_max))))?;
    let hp = add(mul(det, op), mul(above, dp));
    let hq = add(mul(det, oq), mul(above, dq));
    let u = flip_sign(add(add(mul(hp, up), mul(hq, uq)), mul(det, ud)), det);
    let mask = any(both(mask, at_most(zero, u)))?;
    let v = flip_sign(add(add(mul(hp, vp), mul(hq, vq)), mul(det, vd)), det);
    let mask = any(both(mask, both(at_most(zero, v), at_most(add(u, v), size))))?;
    divided(mask, above, det)
}

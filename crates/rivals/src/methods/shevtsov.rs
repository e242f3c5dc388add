//! Shevtsov, Soupikov and Kapustin 2007, "Ray-triangle intersection algorithm for modern CPU architectures",
//! as Havel and Herout 2010 describe it in section II.B: the Plücker test of a triangle that is projected
//! along the axis of which its normal has most, with edges scaled by that component, and the division last.

use super::common::*;
use super::lanes::*;
use crate::{Packet, Triangle};

/// What is kept of a triangle: `n_p`, `n_q`, `d` of its plane; `A_p`, `A_q`; the edges `AB_p`, `AB_q`,
/// `AC_p`, `AC_q` in units of `N_r`; and the axis `r` that is left out, as the bits of an integer. 40 bytes.
pub type Record<T = f32> = [T; 10];

/// The precomputation (equations 5 and 8). `p` and `q` are the axes after `r` in turn, for which no edge
/// needs another sign.
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
        ap,
        aq,
        bp / nr,
        bq / nr,
        cp / nr,
        cq / nr,
        f32::from_bits(r as u32),
    ]
}

/// The aperture test first, then the distance, the division last: Shevtsov's order.
const APERTURE_FIRST: u8 = 0;
/// The distance test first, the division last.
const DISTANCE_FIRST: u8 = 1;
/// The division first, as before (Havel and Herout, section V).
const DIVIDED: u8 = 2;
/// Without a branch, as for processors on which one costs more than what it saves (section 2).
const BRANCHLESS: u8 = 3;

forms! {
    axes: after 9;
    apart: is_orthogonal;
    /// The aperture test comes first, the division last.
    packet, single: APERTURE_FIRST;
    /// The distance test comes first, the division last.
    packet_distance_first, single_distance_first: DISTANCE_FIRST;
    /// The division comes first.
    packet_divided, single_divided: DIVIDED;
    /// Without a branch.
    packet_branchless, single_branchless: BRANCHLESS;
}

/// Whether a triangle is orthogonal to its axis: nothing of the others is in its normal.
fn is_orthogonal(record: &Record) -> bool {
    record[0] == 0.0 && record[1] == 0.0
}

/// Equation 9 and the conditions of equation 10, of a ray whose axes are `p`, `q`, `r`, with everything in
/// the sign that `det` gives it. Nothing if no lane is hit.
#[target_feature(enable = "sse2")]
#[inline]
fn test<const FORM: u8>(
    &[np, nq, d, ap, aq, e0p, e0q, e1p, e1q, _]: &Record<Vector>,
    is_orthogonal: bool,
    ray: &Ray,
    t_max: Vector,
) -> Option<(Mask, Vector)> {
    let Ray {
        origin: [op, oq, or],
        direction: [dp, dq, dr],
    } = *ray;
    let zero = zeros();
    let (det, above) = match is_orthogonal {
        true => (dr, sub(d, or)),
        false => (
            add(add(mul(dp, np), mul(dq, nq)), dr),
            sub(d, add(add(mul(op, np), mul(oq, nq)), or)),
        ),
    };
    if FORM == DIVIDED {
        let t = div(above, det);
        let mask = any(both(less(zero, t), less(t, t_max)))?;
        let (tp, tq) = (sub(mul(t, dp), sub(ap, op)), sub(mul(t, dq), sub(aq, oq)));
        let u = sub(mul(e1q, tp), mul(e1p, tq));
        let mask = any(both(mask, at_most(zero, u)))?;
        let v = sub(mul(e0p, tq), mul(e0q, tp));
        let mask = any(both(
            mask,
            both(at_most(zero, v), at_most(add(u, v), splat(1.0))),
        ))?;
        return Some((mask, t));
    }
    let size = flip_sign(det, det);
    let scaled = flip_sign(above, det);
    let mut mask = both(less(zero, scaled), less(scaled, mul(size, t_max)));
    if FORM == DISTANCE_FIRST && is_empty(mask) {
        return None;
    }
    // T = t' D - det (A - O), which is det (P - A)
    let tp = sub(mul(above, dp), mul(det, sub(ap, op)));
    let tq = sub(mul(above, dq), mul(det, sub(aq, oq)));
    let u = flip_sign(sub(mul(e1q, tp), mul(e1p, tq)), det);
    let mut inside = both(at_most(zero, u), at_most(u, size));
    if FORM == DISTANCE_FIRST {
        inside = both(inside, mask);
    }
    if FORM != BRANCHLESS && is_empty(inside) {
        return None;
    }
    let v = flip_sign(sub(mul(e0p, tq), mul(e0q, tp)), det);
    inside = both(inside, both(at_most(zero, v), at_most(add(u, v), size)));
    if FORM == APERTURE_FIRST && is_empty(inside) {
        return None;
    }
    mask = both(mask, inside);
    if FORM != BRANCHLESS {
        mask = any(mask)?;
    }
    divided(mask, above, det)
}

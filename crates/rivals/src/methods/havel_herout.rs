//! Havel and Herout 2010, "Yet faster ray-triangle intersection (using SSE4)", section III: the triangle's
//! plane, and two planes by which the barycentric coordinates are distances.
//!
//! The print has slips: the sign of `d` differs between equations 4 and 13. Here `t' = d - O · N` and so
//! `d = A · N`.

use super::common::*;
use super::lanes::*;
use crate::{Packet, Triangle};

/// What is kept of a triangle: its plane `N`, `d`, and the planes `N1`, `d1` and `N2`, `d2`. 48 bytes.
pub type Record<T = f32> = [T; 12];

/// The precomputation, with planes perpendicular to the triangle's (equation 11).
pub fn prepare(triangle: &Triangle) -> Record {
    let Plane { a, ab, ac, n } = Plane::new(triangle);
    let square = dot3(n, n);
    let n1 = cross3(ac, n).map(|x| x / square);
    let n2 = cross3(n, ab).map(|x| x / square);
    record(a, n, n1, n2)
}

/// The precomputation, with planes parallel to the axis of which the normal has most: the other kind that
/// section III names.
pub fn prepare_parallel(triangle: &Triangle) -> Record {
    let Plane { a, ab, ac, n } = Plane::new(triangle);
    let [_, _, r] = axes_of(n);
    // The cross products with the axis r, in units of N_r.
    let axis = [0, 1, 2].map(|axis| if axis == r { 1.0 } else { 0.0 });
    let n_r = component(n, r);
    let n1 = cross3(ac, axis).map(|x| x / n_r);
    let n2 = cross3(axis, ab).map(|x| x / n_r);
    record(a, n, n1, n2)
}

/// The precomputation of Baldwin and Weber 2016, "Fast ray-triangle intersections by coordinate transformation",
/// section 2.2: the affine map that takes the triangle to the unit one in the plane z = 0. Of its column that
/// may be chosen they take the axis of which the normal has most. Its rows are the planes parallel to that axis,
/// the triangle's own in units of `N_r`; and to ask where the mapped ray has z = 0, and then whether x and y are in
/// the unit triangle, is the test that divides first.
pub fn prepare_transformation(triangle: &Triangle) -> Record {
    let [nx, ny, nz, d, planes @ ..] = prepare_parallel(triangle);
    let [_, _, r] = axes_of([nx, ny, nz]);
    let n_r = component([nx, ny, nz], r);
    let [n1x, n1y, n1z, d1, n2x, n2y, n2z, d2] = planes;
    let [x, y, z, w] = [nx, ny, nz, d].map(|number| number / n_r);
    [x, y, z, w, n1x, n1y, n1z, d1, n2x, n2y, n2z, d2]
}

fn record(a: [f32; 3], n: [f32; 3], n1: [f32; 3], n2: [f32; 3]) -> Record {
    let [nx, ny, nz] = n;
    let [n1x, n1y, n1z] = n1;
    let [n2x, n2y, n2z] = n2;
    let (d, d1, d2) = (dot3(a, n), -dot3(n1, a), -dot3(n2, a));
    [nx, ny, nz, d, n1x, n1y, n1z, d1, n2x, n2y, n2z, d2]
}

/// The division comes last.
const DEFERRED: u8 = 0;
/// The division comes first (section V).
const DIVIDED: u8 = 1;

forms! {
    axes: as_they_are;
    apart: never;
    /// The division comes last.
    packet, single: DEFERRED;
    /// The division comes first (section V).
    packet_divided, single_divided: DIVIDED;
}

/// One ray and one triangle after another, by the dot products of SSE4.1 (section IV), the records being the
/// same as those of the other forms. The estimated reciprocal has one step of Newton.
///
/// The listing's slips are mended: `pt` is `detp`, and a hit is a hit. Its tests compare signs, which are right
/// for zeros too, so `t` is looked at once more.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn dot_product<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    ray: usize,
    triangles: &[Record<[f32; 1]>],
) {
    use core::arch::x86_64::{
        __m128, _mm_add_ps, _mm_add_ss, _mm_cvtss_f32, _mm_dp_ps, _mm_movemask_ps, _mm_mul_ps,
        _mm_mul_ss, _mm_rcp_ss, _mm_set_ss, _mm_setr_ps, _mm_sub_ss, _mm_xor_ps,
    };
    /// Whether the first lanes have other signs.
    #[target_feature(enable = "sse4.1")]
    #[inline]
    fn differ(a: __m128, b: __m128) -> bool {
        _mm_movemask_ps(_mm_xor_ps(a, b)) & 1 != 0
    }
    let origin = _mm_setr_ps(packet.ox[ray], packet.oy[ray], packet.oz[ray], 1.0);
    let direction = _mm_setr_ps(packet.dx[ray], packet.dy[ray], packet.dz[ray], 0.0);
    let coefficients = _mm_setr_ps(-1.0, -1.0, -1.0, 1.0);
    let mut t_max = packet.t[ray];
    for &[
        [nx],
        [ny],
        [nz],
        [nd],
        [ux],
        [uy],
        [uz],
        [ud],
        [vx],
        [vy],
        [vz],
        [vd],
    ] in triangles
    {
        let n = _mm_setr_ps(nx, ny, nz, nd);
        let det = _mm_dp_ps::<0x7f>(n, direction);
        let dett = _mm_dp_ps::<0xff>(_mm_mul_ps(coefficients, n), origin);
        let before_end = _mm_sub_ss(_mm_mul_ss(_mm_set_ss(t_max), det), dett);
        if differ(dett, before_end) {
            continue;
        }
        let detp = _mm_add_ps(_mm_mul_ps(origin, det), _mm_mul_ps(dett, direction));
        let detu = _mm_dp_ps::<0xf1>(detp, _mm_setr_ps(ux, uy, uz, ud));
        if differ(detu, _mm_sub_ss(det, detu)) {
            continue;
        }
        let detv = _mm_dp_ps::<0xf1>(detp, _mm_setr_ps(vx, vy, vz, vd));
        if differ(detv, _mm_sub_ss(det, _mm_add_ss(detu, detv))) {
            continue;
        }
        let estimate = _mm_rcp_ss(det);
        let square = _mm_mul_ss(estimate, estimate);
        let reciprocal = _mm_sub_ss(_mm_add_ss(estimate, estimate), _mm_mul_ss(square, det));
        let t = _mm_cvtss_f32(_mm_mul_ss(dett, reciprocal));
        if 0.0 < t && t < t_max {
            if FIXED {
                packet.hit_t[ray] = t;
            } else {
                t_max = t;
                packet.t[ray] = t;
            }
        }
    }
}

/// Equation 13, and the conditions of equation 10 with everything in the sign that `det` gives it; or
/// equation 12. Nothing if no lane is hit.
#[target_feature(enable = "sse2")]
#[inline]
fn test<const FORM: u8>(
    &[nx, ny, nz, d, n1x, n1y, n1z, d1, n2x, n2y, n2z, d2]: &Record<Vector>,
    _: bool,
    ray: &Ray,
    t_max: Vector,
) -> Option<(Mask, Vector)> {
    let (n, n1, n2) = ([nx, ny, nz], [n1x, n1y, n1z], [n2x, n2y, n2z]);
    let Ray { origin, direction } = *ray;
    let zero = zeros();
    let det = dot(n, direction);
    let above = sub(d, dot(n, origin));
    if FORM == DIVIDED {
        let t = div(above, det);
        let mask = any(both(less(zero, t), less(t, t_max)))?;
        let hit = along(origin, t, direction);
        let u = add(dot(n1, hit), d1);
        let mask = any(both(mask, at_most(zero, u)))?;
        let v = add(dot(n2, hit), d2);
        let mask = any(both(
            mask,
            both(at_most(zero, v), at_most(add(u, v), splat(1.0))),
        ))?;
        return Some((mask, t));
    }
    let size = flip_sign(det, det);
    let scaled = flip_sign(above, det);
    let mask = any(both(less(zero, scaled), less(scaled, mul(size, t_max))))?;
    // P' = det O + t' D
    let hit = along(
        [
            mul(det, origin[0]),
            mul(det, origin[1]),
            mul(det, origin[2]),
        ],
        above,
        direction,
    );
    let u = flip_sign(add(dot(n1, hit), mul(det, d1)), det);
    let mask = any(both(mask, both(at_most(zero, u), at_most(u, size))))?;
    let v = flip_sign(add(dot(n2, hit), mul(det, d2)), det);
    let mask = any(both(mask, both(at_most(zero, v), at_most(add(u, v), size))))?;
    divided(mask, above, det)
}

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

fn record(a: [f32; 3], n: [f32; 3], n1: [f32; 3], n2: [f32; 3]) -> Record {
    let [nx, ny, nz] = n;
    let [n1x, n1y, n1z] = n1;
    let [n2x, n2y, n2z] = n2;
    let (d, d1, d2) = (dot3(a, n), -dot3(n1, a), -dot3(n2, a));
    [nx, ny, nz, d, n1x, n1y, n1z, d1, n2x, n2y, n2z, d2]
}

/// Stores the closest hit of each ray in `t`; if `FIXED`, every hit in `hit_t`, `t` staying. The division
/// comes last.
#[target_feature(enable = "sse2")]
#[inline]
pub fn packet<const N: usize, const FIXED: bool>(packet: &mut Packet<N>, triangles: &[Record]) {
    in_packet::<N, FIXED, true>(packet, triangles);
}

/// The same with the division first (section V).
#[target_feature(enable = "sse2")]
#[inline]
pub fn packet_divided<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    triangles: &[Record],
) {
    in_packet::<N, FIXED, false>(packet, triangles);
}

#[target_feature(enable = "sse2")]
#[inline]
fn in_packet<const N: usize, const FIXED: bool, const DEFERRED: bool>(
    packet: &mut Packet<N>,
    triangles: &[Record],
) {
    const { assert!(N.is_multiple_of(LANES)) };
    for record in triangles {
        let record = splatted(record);
        for row in 0..N / LANES {
            let ray = Ray::of_row(packet, row);
            let t_max = load(&packet.t, row);
            let Some((mask, t)) = test::<DEFERRED>(&record, &ray, t_max) else {
                continue;
            };
            keep::<N, FIXED>(packet, row, mask, t, t_max);
        }
    }
}

/// Stores the closest hit of ray `ray` in `t`; if `FIXED`, the last one in `hit_t`, `t` staying. The
/// division comes last.
#[target_feature(enable = "sse2")]
#[inline]
pub fn single<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    ray: usize,
    blocks: &[Record<[f32; LANES]>],
) {
    of_one_ray::<N, FIXED, true>(packet, ray, blocks);
}

/// The same with the division first (section V).
#[target_feature(enable = "sse2")]
#[inline]
pub fn single_divided<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    ray: usize,
    blocks: &[Record<[f32; LANES]>],
) {
    of_one_ray::<N, FIXED, false>(packet, ray, blocks);
}

#[target_feature(enable = "sse2")]
#[inline]
fn of_one_ray<const N: usize, const FIXED: bool, const DEFERRED: bool>(
    packet: &mut Packet<N>,
    ray: usize,
    blocks: &[Record<[f32; LANES]>],
) {
    let one = Ray::of_ray(packet, ray);
    let mut closest = Closest::new(packet, ray);
    for (place, block) in (1..).zip(blocks) {
        let record = loaded(block);
        let Some((mask, t)) = test::<DEFERRED>(&record, &one, closest.t_max) else {
            continue;
        };
        closest.keep::<FIXED>(mask, t, place);
    }
    closest.store::<N, FIXED>(packet, ray);
}

/// Equation 13, and the conditions of equation 10 with everything in the sign that `det` gives it; or
/// equation 12. Nothing if no lane is hit.
#[target_feature(enable = "sse2")]
#[inline]
fn test<const DEFERRED: bool>(
    &[nx, ny, nz, d, n1x, n1y, n1z, d1, n2x, n2y, n2z, d2]: &Record<Vector>,
    ray: &Ray,
    t_max: Vector,
) -> Option<(Mask, Vector)> {
    let (n, n1, n2) = ([nx, ny, nz], [n1x, n1y, n1z], [n2x, n2y, n2z]);
    let Ray { origin, direction } = *ray;
    let zero = zeros();
    let det = dot(n, direction);
    let above = sub(d, dot(n, origin));
    if !DEFERRED {
        let t = div(above, det);
        let mut mask = both(less(zero, t), less(t, t_max));
        if is_empty(mask) {
            return None;
        }
        let hit = along(origin, t, direction);
        let u = add(dot(n1, hit), d1);
        mask = both(mask, at_most(zero, u));
        if is_empty(mask) {
            return None;
        }
        let v = add(dot(n2, hit), d2);
        mask = both(mask, both(at_most(zero, v), at_most(add(u, v), splat(1.0))));
        if is_empty(mask) {
            return None;
        }
        return Some((mask, t));
    }
    let size = flip_sign(det, det);
    let scaled = flip_sign(above, det);
    let mut mask = both(less(zero, scaled), less(scaled, mul(size, t_max)));
    if is_empty(mask) {
        return None;
    }
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
    mask = both(mask, both(at_most(zero, u), at_most(u, size)));
    if is_empty(mask) {
        return None;
    }
    let v = flip_sign(add(dot(n2, hit), mul(det, d2)), det);
    mask = both(mask, both(at_most(zero, v), at_most(add(u, v), size)));
    if is_empty(mask) {
        return None;
    }
    divided(mask, above, det)
}

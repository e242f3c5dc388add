//! Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection".
//!
//! As in the paper's appendix, without culling: the axes renamed and the shear computed once a ray, edge
//! functions in single precision, and in double precision where one of them is zero. The rays of a packet may
//! differ in the axis along which they are longest: theirs are renamed by selecting, lane by lane.

use super::common::*;
use super::lanes::*;
use crate::{Packet, Triangle};

/// Stores the closest hit of each ray in `t`; if `FIXED`, every hit in `hit_t`, `t` staying.
#[target_feature(enable = "sse2")]
#[inline]
pub fn packet<const N: usize, const FIXED: bool>(packet: &mut Packet<N>, triangles: &[Triangle]) {
    align_frame();
    const { assert!(N.is_multiple_of(LANES)) };
    let mut shears = [const { OfRays([0.0; N]) }; 3];
    for row in 0..N / LANES {
        let Ray { direction, .. } = Ray::of_row(packet, row);
        let shear = shear_along(renamed(direction, direction));
        for (lanes, shear) in shears.iter_mut().zip(shear) {
            store(&mut lanes.0, row, shear);
        }
    }
    for triangle in triangles {
        for row in 0..N / LANES {
            let ray = Ray::of_row(packet, row);
            let [x, y, z] = &shears;
            let shear = [load(&x.0, row), load(&y.0, row), load(&z.0, row)];
            let a = sheared_of_row(triangle.p0, &ray, shear);
            let b = sheared_of_row(triangle.p1, &ray, shear);
            let c = sheared_of_row(triangle.p2, &ray, shear);
            let t_max = load(&packet.t, row);
            if let Some((mask, t)) = test(a, b, c, t_max) {
                keep::<N, FIXED>(packet, row, mask, t, t_max);
            }
        }
    }
}

/// Stores the closest hit of ray `ray` in `t`; if `FIXED`, the last one in `hit_t`, `t` staying.
#[target_feature(enable = "sse2")]
#[inline]
pub fn single<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    ray: usize,
    blocks: &[Triangle<[f32; LANES]>],
) {
    align_frame();
    let origin = [packet.ox[ray], packet.oy[ray], packet.oz[ray]];
    let direction = [packet.dx[ray], packet.dy[ray], packet.dz[ray]];
    let axes = axes_along(direction);
    let [dx, dy, dz] = axes.map(|axis| component(direction, axis));
    let shear = shear_along(splatted(&[dx, dy, dz]));
    let mut closest = Closest::new(packet, ray);
    for (place, block) in (1..).zip(blocks) {
        let a = sheared_in_block(&block.p0, origin, axes, shear);
        let b = sheared_in_block(&block.p1, origin, axes, shear);
        let c = sheared_in_block(&block.p2, origin, axes, shear);
        if let Some((mask, t)) = test(a, b, c, closest.t_max) {
            closest.keep::<FIXED>(mask, t, place);
        }
    }
    closest.store::<N, FIXED>(packet, ray);
}

/// The edge functions of sheared vertices, and `t`. Nothing if no lane is hit.
#[target_feature(enable = "sse2")]
#[inline]
fn test(
    [ax, ay, az]: [Vector; 3],
    [bx, by, bz]: [Vector; 3],
    [cx, cy, cz]: [Vector; 3],
    t_max: Vector,
) -> Option<(Mask, Vector)> {
    // Scaled barycentric coordinates.
    let mut u = sub(mul(cx, by), mul(cy, bx));
    let mut v = sub(mul(ax, cy), mul(ay, cx));
    let mut w = sub(mul(bx, ay), mul(by, ax));
    let is_zero = either(either(zero_in(u), zero_in(v)), zero_in(w));
    if !is_empty(is_zero) {
        u = select(is_zero, exact_difference(cx, by, cy, bx), u);
        v = select(is_zero, exact_difference(ax, cy, ay, cx), v);
        w = select(is_zero, exact_difference(bx, ay, by, ax), w);
    }
    let mask = any(of_one_sign(u, v, w))?;
    // Scaled distances, and the division.
    let det = add(add(u, v), w);
    let t = div(add(add(mul(u, az), mul(v, bz)), mul(w, cz)), det);
    in_range(mask, t, t_max)
}

/// The shear of a ray, of its direction with the axes renamed.
#[target_feature(enable = "sse2")]
#[inline]
fn shear_along([dx, dy, dz]: [Vector; 3]) -> [Vector; 3] {
    [div(dx, dz), div(dy, dz), div(splat(1.0), dz)]
}

/// A vertex in the sheared frame of every ray of a row.
#[target_feature(enable = "sse2")]
#[inline]
fn sheared_of_row([px, py, pz]: [f32; 3], ray: &Ray, shear: [Vector; 3]) -> [Vector; 3] {
    let Ray {
        origin: [ox, oy, oz],
        direction,
    } = *ray;
    let from_origin = [sub(splat(px), ox), sub(splat(py), oy), sub(splat(pz), oz)];
    sheared(renamed(from_origin, direction), shear)
}

/// The vertices of a block in the sheared frame of one ray.
#[target_feature(enable = "sse2")]
#[inline]
fn sheared_in_block(
    points: &[[f32; LANES]; 3],
    origin: [f32; 3],
    [x, y, z]: [usize; 3],
    shear: [Vector; 3],
) -> [Vector; 3] {
    let from_origin = [
        sub(load(&component(*points, x), 0), splat(component(origin, x))),
        sub(load(&component(*points, y), 0), splat(component(origin, y))),
        sub(load(&component(*points, z), 0), splat(component(origin, z))),
    ];
    sheared(from_origin, shear)
}

/// A vector from a ray's origin, its axes renamed, in the sheared frame.
#[target_feature(enable = "sse2")]
#[inline]
fn sheared([x, y, z]: [Vector; 3], [sx, sy, sz]: [Vector; 3]) -> [Vector; 3] {
    [sub(x, mul(sx, z)), sub(y, mul(sy, z)), mul(sz, z)]
}

/// The components of a vector, last the one along the axis of which the direction has most, the others in
/// turn.
#[target_feature(enable = "sse2")]
#[inline]
fn renamed([x, y, z]: [Vector; 3], [dx, dy, dz]: [Vector; 3]) -> [Vector; 3] {
    let [mx, my, mz] = [flip_sign(dx, dx), flip_sign(dy, dy), flip_sign(dz, dz)];
    let is_x = both(at_most(my, mx), at_most(mz, mx));
    let is_y = at_most(mz, my);
    [
        select(is_x, y, select(is_y, z, x)),
        select(is_x, z, select(is_y, x, y)),
        select(is_x, x, select(is_y, y, z)),
    ]
}

/// The lanes that are zero.
#[target_feature(enable = "sse2")]
#[inline]
fn zero_in(a: Vector) -> Mask {
    both(at_most(a, zeros()), at_most(zeros(), a))
}

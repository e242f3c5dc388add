//! Kernels for one ray and one triangle whose leaks are known: what the harness is tested with.

use scene::{Ray, Triangle};

type Vector = [f32; 3];

/// Möller and Trumbore 1997, section 3, without culling and without the epsilon.
pub fn moller_trumbore(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let edge1 = sub(triangle.p1, triangle.p0);
    let edge2 = sub(triangle.p2, triangle.p0);
    let pvec = cross(ray.direction, edge2);
    let inv_det = 1.0 / dot(edge1, pvec);
    let tvec = sub(ray.origin, triangle.p0);
    let u = dot(tvec, pvec) * inv_det;
    let qvec = cross(tvec, edge1);
    let v = dot(ray.direction, qvec) * inv_det;
    let t = dot(edge2, qvec) * inv_det;
    let is_hit = (0.0..=1.0).contains(&u) && 0.0 <= v && u + v <= 1.0 && 0.0 < t && t < ray.t_max;
    is_hit.then_some(t)
}

/// Kensler and Shirley 2006, appendix, with an exact division.
pub fn kensler_shirley(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let Triangle { p0, p1, p2 } = *triangle;
    let edge0 = sub(p1, p0);
    let edge1 = sub(p0, p2);
    let normal = cross(edge0, edge1);
    let v = dot(normal, ray.direction);
    let edge2 = sub(p0, ray.origin);
    let va = dot(normal, edge2);
    let rcp = 1.0 / v;
    let t = rcp * va;
    let interm = cross(edge2, ray.direction);
    let v1 = dot(interm, edge1);
    let v2 = dot(interm, edge0);
    let is_hit =
        0.0 < t && t < ray.t_max && 0.0 <= rcp * v1 && (v1 + v2) * v <= v * v && 0.0 <= rcp * v2;
    is_hit.then_some(t)
}

/// Three volumes relative to the ray's origin, each a function of a side and the ray alone that
/// negates when the side is walked the other way; ordered tests for the same sign.
pub fn three_volumes(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let [q0, q1, q2] = [triangle.p0, triangle.p1, triangle.p2].map(|p| sub(p, ray.origin));
    let v0 = dot(ray.direction, cross(q2, q1));
    let v1 = dot(ray.direction, cross(q0, q2));
    let v2 = dot(ray.direction, cross(q1, q0));
    let normal = cross(sub(triangle.p2, triangle.p0), sub(triangle.p1, triangle.p0));
    let t = dot(normal, q0) / dot(normal, ray.direction);
    let is_inside = (v0 >= 0.0 && v1 >= 0.0 && v2 >= 0.0) || (v0 <= 0.0 && v1 <= 0.0 && v2 <= 0.0);
    (is_inside && 0.0 < t && t < ray.t_max).then_some(t)
}

/// Woop, Benthin and Wald 2013, "Watertight ray/triangle intersection": vertices are sheared so that
/// the ray is an axis, in `f32`, the same in every triangle; the edge functions of what comes out are
/// exact in sign in `f64`.
pub fn woop(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let d = ray.direction;
    let z = (0..3).max_by(|&i, &j| d[i].abs().total_cmp(&d[j].abs()))?;
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let shear = [d[x] / d[z], d[y] / d[z], 1.0 / d[z]];
    let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(|p| {
        let q = sub(p, ray.origin);
        [
            q[x] - shear[0] * q[z],
            q[y] - shear[1] * q[z],
            shear[2] * q[z],
        ]
    });
    let edge = |p: Vector, q: Vector| {
        f64::from(p[0]) * f64::from(q[1]) - f64::from(p[1]) * f64::from(q[0])
    };
    let [u, v, w] = [edge(c, b), edge(a, c), edge(b, a)];
    if !((u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)) {
        return None;
    }
    let det = u + v + w;
    let t = ((u * f64::from(a[2]) + v * f64::from(b[2]) + w * f64::from(c[2])) / det) as f32;
    (0.0 < t && t < ray.t_max).then_some(t)
}

fn sub(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn cross(a: Vector, b: Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

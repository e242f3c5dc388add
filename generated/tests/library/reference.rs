//! Möller and Trumbore's test in `f64`: what is right, and where `f32` may say either.

use raybreed::{Culling, Ray, Triangle};

/// The verdict on a ray and some triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    Miss,
    Hit(Hit),
    /// So near an edge, a bound or another triangle, or so nearly in a triangle's plane, that `f32` may say either.
    Unsure,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    pub t: f64,
    pub u: f64,
    pub v: f64,
    pub triangle: usize,
    pub normal: [f64; 3],
    pub point: [f64; 3],
}

/// The closest hit of a ray that starts within some units of triangles about 1 across.
pub fn closest(ray: &Ray, triangles: &[Triangle], culling: Culling) -> Verdict {
    let (a, d) = (wide(ray.origin), wide(ray.direction));
    let (t_min, t_max) = (f64::from(ray.t_min).max(0.0), f64::from(ray.t));
    let mut closest = Verdict::Miss;
    for (place, triangle) in triangles.iter().enumerate() {
        let [p0, p1, p2] = [triangle.p0, triangle.p1, triangle.p2].map(wide);
        let (e1, e2, s) = (sub(p1, p0), sub(p2, p0), sub(a, p0));
        let (p, q) = (cross(d, e2), cross(s, e1));
        let volume = dot(e1, p);
        let (u, v, t) = (dot(s, p) / volume, dot(d, q) / volume, dot(e2, q) / volume);
        let inside = u.min(v).min(1.0 - u - v);
        if inside.abs() < 1e-3 || volume.abs() < 1e-2 {
            return Verdict::Unsure;
        }
        let is_seen = match culling {
            Culling::None => true,
            Culling::Back => volume > 0.0,
            Culling::Front => volume < 0.0,
        };
        if inside < 0.0 || !is_seen {
            continue;
        }
        let nearest = match closest {
            Verdict::Hit(hit) => hit.t,
            _ => t_max,
        };
        if [t_min, t_max, nearest]
            .iter()
            .any(|bound| (t - bound).abs() < 1e-3)
        {
            return Verdict::Unsure;
        }
        if t_min < t && t < nearest {
            closest = Verdict::Hit(Hit {
                t,
                u,
                v,
                triangle: place,
                normal: cross(e1, e2),
                point: [0, 1, 2].map(|axis| p0[axis] + u * e1[axis] + v * e2[axis]),
            });
        }
    }
    closest
}

fn wide(a: [f32; 3]) -> [f64; 3] {
    a.map(f64::from)
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let component = |j: usize, k: usize| a[j] * b[k] - a[k] * b[j];
    [component(1, 2), component(2, 0), component(0, 1)]
}

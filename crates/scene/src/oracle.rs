//! The oracle: one `f32` ray against one `f32` triangle, evaluated in `f64`, and how far from it
//! an `f32` kernel may end up.
//!
//! Widening `f32` is exact, so the verdict's own error is about 2^-29 of what it grants a kernel.
//!
//! The bounds are forward error bounds of the volumes (paper, section 3). Let `M` be the longest
//! edge among the ray's origin and the triangle's vertices, and `u` = 2^-24. A kernel that begins
//! with differences of coordinates gets `V`, `V0`, `V1`, `V2` within `C u |d| M²` and `Va` within
//! `C u M³`, whichever triple product it takes and whether it sums volumes or subtracts them; so
//! a side is decided where its volume is farther from zero than that, and `t = Va / V` is good to
//! `C u M³ / |V|`. Not covered are `f32` intermediates that overflow or underflow, and plane
//! constants taken at the world's origin.

use std::ops::{Mul, Sub};

use crate::{Culling, Packet, Part, Range, Regime, Task, Triangle};

/// `C`, in roundings of 2^-24. A triple product makes about 14 in the worst case, a volume summed
/// of three of them 42.
const ROUNDINGS: f64 = 64.0 / (1 << 24) as f64;

/// One ray. `t` is in units of `direction`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Where it goes, of any length.
    pub direction: [f32; 3],
    /// Hits count strictly after this, or after 0 if it is negative.
    pub t_min: f32,
    /// Hits count strictly before this. The ray is inactive if it is NaN or not positive.
    pub t_max: f32,
}

impl Ray {
    /// Ray `ray` of `packet`, bounded by its `t` and in some ranges otherwise. The direction of a
    /// segment is that of its ends, in `f32` as a kernel has it.
    ///
    /// # Panics
    ///
    /// `ray` is not less than `N`.
    pub fn of<const N: usize>(packet: &Packet<N>, ray: usize, range: Range) -> Self {
        let origin = [packet.ox[ray], packet.oy[ray], packet.oz[ray]];
        let direction = [packet.dx[ray], packet.dy[ray], packet.dz[ray]];
        let t_max = packet.t[ray];
        Self {
            origin,
            direction: match range {
                Range::TMax | Range::TMinMax => direction,
                Range::Segment => sub(direction, origin),
            },
            t_min: match range {
                Range::TMinMax => packet.t_min[ray],
                Range::TMax | Range::Segment => 0.0,
            },
            t_max: match range {
                Range::Segment if t_max > 1.0 => 1.0,
                _ => t_max,
            },
        }
    }
}

/// What an `f32` kernel may answer for a ray and a triangle.
///
/// A hit is `t_min < t < t_max`, both strictly, with `α`, `β` and `γ` not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Every kernel has to miss: beyond the error bounds, or something is not finite.
    Miss,
    /// Every kernel has to hit.
    Hit {
        /// The parameter of the hit.
        t: f64,
        /// How far from it an `f32` kernel may be. Always less than `t`.
        tolerance: f64,
    },
    /// Some condition lies within its error bound: a miss is right, and so is a hit near `t`.
    Unsure {
        /// The parameter of the possible hit.
        t: f64,
        /// How far from it an `f32` kernel may be; infinite if `V` is within its error bound of
        /// zero, so that nothing is known of `t`.
        tolerance: f64,
    },
}

/// Judges one ray against one triangle.
///
/// ```
/// use scene::{Ray, Triangle, Verdict, judge};
///
/// let triangle = Triangle { p0: [0.0; 3], p1: [1.0, 0.0, 0.0], p2: [0.0, 1.0, 0.0] };
/// let ray = |x| Ray { origin: [x, 0.25, -2.0], direction: [0.0, 0.0, 1.0], t_min: 0.0, t_max: 9.0 };
/// assert!(matches!(judge(&ray(0.25), &triangle), Verdict::Hit { t: 2.0, .. }));
/// assert!(matches!(judge(&ray(0.75), &triangle), Verdict::Unsure { t: 2.0, .. }));
/// assert_eq!(judge(&ray(0.76), &triangle), Verdict::Miss);
/// ```
pub fn judge(ray: &Ray, triangle: &Triangle) -> Verdict {
    WideTriangle::new(triangle).judge(&WideRay::new(ray), Culling::None)
}

/// The barycentric coordinates of `p1` and `p2` where a ray meets a triangle's plane, and how far
/// from them an `f32` kernel may be.
pub fn barycentric(ray: &Ray, triangle: &Triangle) -> ([f64; 2], f64) {
    let triangle = WideTriangle::new(triangle);
    let ray = WideRay::new(ray);
    let from_origin = sub(triangle.p0, ray.origin);
    let [v, _, v1, v2] = triangle.volumes(&ray, from_origin);
    // The quotient of two volumes that are both off by their bound.
    let bound = ray.rounding * triangle.longest_edge_squared(from_origin);
    let (v1, v2, off) = (v1 / v, v2 / v, bound / v.abs());
    ([v1, v2], off * (1.0 + v1.abs().max(v2.abs())) * 2.0)
}

/// The share of ray-triangle pairs of `part` that hit, with `t` fixed.
pub fn hit_fraction(part: Part<'_>) -> f64 {
    let mut hits = 0_u64;
    for packet in part.packets {
        let task = Regime::Fixed.into();
        for_each_verdict(task, packet, part.triangles, |_, _, verdict| {
            hits += u64::from(matches!(verdict, Verdict::Hit { .. }));
        });
    }
    hits as f64 / part.tests() as f64
}

/// Calls `visit` with a ray's and a triangle's number and the verdict, triangle by triangle, for all
/// that do not clearly miss. Every triangle is judged against `t` as it is in `packet`.
pub(crate) fn for_each_verdict<const N: usize>(
    task: Task,
    packet: &Packet<N>,
    triangles: &[Triangle],
    mut visit: impl FnMut(usize, usize, Verdict),
) {
    let rays: [WideRay; N] =
        std::array::from_fn(|ray| WideRay::new(&Ray::of(packet, ray, task.range)));
    for (place, triangle) in triangles.iter().enumerate() {
        let triangle = WideTriangle::new(triangle);
        for (number, ray) in rays.iter().enumerate() {
            match triangle.judge(ray, task.culling) {
                Verdict::Miss => {}
                verdict => visit(number, place, verdict),
            }
        }
    }
}

type Vector = [f64; 3];

/// A ray in `f64`.
struct WideRay {
    origin: Vector,
    direction: Vector,
    t_min: f64,
    t_max: f64,
    /// `C u |d|`.
    rounding: f64,
    /// Whether the ray is active and finite.
    can_hit: bool,
}

impl WideRay {
    fn new(ray: &Ray) -> Self {
        let direction = ray.direction.map(f64::from);
        let finite = ray
            .origin
            .iter()
            .chain(&ray.direction)
            .all(|x| x.is_finite());
        Self {
            origin: ray.origin.map(f64::from),
            direction,
            t_min: f64::from(ray.t_min).max(0.0),
            t_max: f64::from(ray.t_max),
            rounding: ROUNDINGS * dot(direction, direction).sqrt(),
            can_hit: finite && ray.t_max > 0.0 && !ray.t_min.is_nan(),
        }
    }
}

/// A triangle in `f64`, with what its rays share.
struct WideTriangle {
    p0: Vector,
    /// `p1 - p0`.
    edge1: Vector,
    /// `p2 - p0`.
    edge2: Vector,
    /// `edge1 × edge2`.
    normal: Vector,
    /// Length of its longest edge, squared.
    longest_squared: f64,
    finite: bool,
}

impl WideTriangle {
    fn new(triangle: &Triangle) -> Self {
        let [p0, p1, p2] = [triangle.p0, triangle.p1, triangle.p2].map(|p| p.map(f64::from));
        let (edge1, edge2, opposite) = (sub(p1, p0), sub(p2, p0), sub(p2, p1));
        let squared = [edge1, edge2, opposite].map(|edge| dot(edge, edge));
        Self {
            p0,
            edge1,
            edge2,
            normal: cross(edge1, edge2),
            longest_squared: squared.into_iter().fold(0.0, f64::max),
            // A square is finite in f64 if what was squared is a finite f32.
            finite: squared.into_iter().all(f64::is_finite),
        }
    }

    /// Möller-Trumbore's system `t d − β edge1 − γ edge2 = p0 − a`, by Cramer's rule.
    #[inline]
    fn judge(&self, ray: &WideRay, culling: Culling) -> Verdict {
        if !(self.finite && ray.can_hit) {
            return Verdict::Miss;
        }
        let from_origin = sub(self.p0, ray.origin);
        let [v, v0, v1, v2] = self.volumes(ray, from_origin);

        // Different signs are a miss, whatever the sign of V. Most misses are settled by a bound
        // that is quick to find and up to four times too wide.
        let (low, high) = (min(v0, min(v1, v2)), max(v0, max(v1, v2)));
        let differ = |bound: f64| low < -bound && high > bound;
        let near = dot(from_origin, from_origin);
        if differ(ray.rounding * 2.0 * (near + self.longest_squared)) {
            return Verdict::Miss;
        }
        let m_squared = self.longest_edge_squared(from_origin);
        let bound = ray.rounding * m_squared;
        if differ(bound) {
            return Verdict::Miss;
        }
        if v.abs() <= bound {
            return Verdict::Unsure {
                t: 0.0,
                tolerance: f64::INFINITY,
            };
        }

        if culling.lets_through(v) {
            return Verdict::Miss;
        }
        let t = dot(self.normal, from_origin) / v;
        let tolerance = ROUNDINGS * m_squared * m_squared.sqrt() / v.abs();
        if t + tolerance < ray.t_min || t - tolerance > ray.t_max {
            return Verdict::Miss;
        }
        let inside = if v > 0.0 { low > bound } else { high < -bound };
        let before = t - tolerance > ray.t_min && t + tolerance < ray.t_max;
        if inside && before {
            Verdict::Hit { t, tolerance }
        } else {
            Verdict::Unsure { t, tolerance }
        }
    }

    /// `V`, `V0`, `V1`, `V2`, with the signs of the normal `edge1 × edge2`.
    #[inline]
    fn volumes(&self, ray: &WideRay, from_origin: Vector) -> [f64; 4] {
        let moment = cross(from_origin, ray.direction);
        let v = dot(self.normal, ray.direction);
        let v1 = dot(moment, self.edge2);
        let v2 = -dot(moment, self.edge1);
        [v, v - v1 - v2, v1, v2]
    }

    /// `M²`: the longest edge among the ray's origin and the triangle's vertices, squared.
    #[inline]
    fn longest_edge_squared(&self, from_origin: Vector) -> f64 {
        let edges = [self.edge1, self.edge2].map(|edge| add(from_origin, edge));
        let longest = max(dot(from_origin, from_origin), self.longest_squared);
        let squares = edges.into_iter().map(|edge| dot(edge, edge));
        squares.fold(longest, max)
    }
}

/// Quicker than `f64::min`, which minds NaN; there is none here.
fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

fn max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

/// The difference of two vectors.
pub(crate) fn sub<T: Copy + Sub<Output = T>>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product of two vectors.
pub(crate) fn cross<T>(a: [T; 3], b: [T; 3]) -> [T; 3]
where
    T: Copy + Mul<Output = T> + Sub<Output = T>,
{
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests;

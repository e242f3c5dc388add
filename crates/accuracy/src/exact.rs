//! The exact oracle: one ray against one triangle, without any rounding in a verdict.
//!
//! The signs of the five volumes, and of `t` and `t_max - t`, are those of the real numbers that
//! the `f32` inputs are. An `f64` filter settles most of them; what is within its error bound of
//! zero is evaluated in big integers.

mod dyadic;
mod filter;

use std::cmp::Ordering;

use scene::{Ray, Triangle};

use dyadic::Dyadic;
use filter::Estimate;

/// A side of a triangle, named by the vertex that it does not touch: where that vertex's
/// barycentric coordinate is zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// From `p1` to `p2`.
    Opposite0,
    /// From `p2` to `p0`.
    Opposite1,
    /// From `p0` to `p1`.
    Opposite2,
}

/// A vertex of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Corner {
    /// `p0`.
    P0,
    /// `p1`.
    P1,
    /// `p2`.
    P2,
}

/// Where the line of a ray meets the plane of a triangle, and whether the ray gets there.
///
/// A hit is `0 < t < t_max`, both strictly, with barycentric coordinates that are not negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// Strictly inside the triangle, with `0 < t < t_max`: a hit.
    Interior,
    /// Outside of the triangle, or before the ray, or beyond its end: a miss.
    Exterior,
    /// On a side, with `0 < t < t_max`. For one triangle either answer is right.
    Edge(Side),
    /// At a vertex, with `0 < t < t_max`. For one triangle either answer is right.
    Vertex(Corner),
    /// `V` is zero: the ray lies in a parallel of the triangle's plane, or the triangle has no
    /// area, or the direction is zero. A miss.
    Parallel,
    /// In the triangle or on its border, with `t` exactly zero or exactly `t_max`: a miss.
    TBoundary,
}

/// One finite ray and one finite triangle.
///
/// ```
/// use accuracy::{Class, Exact, Side};
/// use scene::{Ray, Triangle};
///
/// let triangle = Triangle { p0: [0.0; 3], p1: [1.0, 0.0, 0.0], p2: [0.0, 1.0, 0.0] };
/// let ray = |x| Ray { origin: [x, 0.25, -2.0], direction: [0.0, 0.0, 1.0], t_min: 0.0, t_max: 9.0 };
/// let class = |x| Exact::new(&ray(x), &triangle).unwrap().class();
/// assert_eq!(class(0.25), Class::Interior);
/// assert_eq!(class(0.75), Class::Edge(Side::Opposite0));
/// assert_eq!(class(0.750_000_06), Class::Exterior);
/// assert_eq!(Exact::new(&ray(0.25), &triangle).unwrap().t(), Some(2.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    ray: Ray,
    points: [[f32; 3]; 3],
    estimate: Estimate,
}

impl Exact {
    /// The ray against the triangle; `None` if a coordinate is infinite or NaN. `t_max` may be
    /// infinite, and if it is NaN or not positive the ray hits nothing.
    pub fn new(ray: &Ray, triangle: &Triangle) -> Option<Self> {
        let points = [triangle.p0, triangle.p1, triangle.p2];
        let coordinates = points.iter().chain([&ray.origin, &ray.direction]);
        coordinates.flatten().all(|x| x.is_finite()).then(|| Self {
            ray: *ray,
            points,
            estimate: Estimate::new(&ray.origin, &ray.direction, &points),
        })
    }

    /// Where the ray meets the triangle.
    pub fn class(&self) -> Class {
        let estimated = self.estimate;
        let signs =
            [estimated.v, estimated.v0, estimated.v1, estimated.v2].map(filter::Bounded::sign);
        // Most rays pass clearly on different sides of two sides.
        let [v, sides @ ..] = &signs;
        let clearly = |sign| sides.contains(&Some(sign));
        let is_across = v.is_some_and(Ordering::is_ne);
        if is_across && clearly(Ordering::Less) && clearly(Ordering::Greater) {
            return Class::Exterior;
        }
        let [v, v0, v1, v2] = match signs {
            [Some(v), Some(v0), Some(v1), Some(v2)] => [v, v0, v1, v2],
            _ => {
                let Dyadic { v, v0, v1, v2, .. } = &self.dyadic();
                [v, v0, v1, v2].map(dyadic::sign)
            }
        };
        if v.is_eq() {
            return Class::Parallel;
        }
        let sides = [v0, v1, v2];
        if sides.contains(&v.reverse()) {
            return Class::Exterior;
        }
        match self.t_order() {
            TOrder::Outside => return Class::Exterior,
            TOrder::Boundary => return Class::TBoundary,
            TOrder::Between => {}
        }
        match sides.map(Ordering::is_eq) {
            [false, false, false] => Class::Interior,
            [true, false, false] => Class::Edge(Side::Opposite0),
            [false, true, false] => Class::Edge(Side::Opposite1),
            [false, false, true] => Class::Edge(Side::Opposite2),
            [false, true, true] => Class::Vertex(Corner::P0),
            [true, false, true] => Class::Vertex(Corner::P1),
            [true, true, false] => Class::Vertex(Corner::P2),
            [true, true, true] => unreachable!("V is the sum of V0, V1 and V2, and is not zero"),
        }
    }

    /// `Va / V`, where the ray's line meets the triangle's plane; `None` if `V` is zero.
    ///
    /// It is within 2^-40 of itself, 2^-16 of an ulp of `f32`. Where the filter is not as good as
    /// that, both volumes are rounded to `f64` from their exact values.
    pub fn t(&self) -> Option<f64> {
        let Estimate { v, va, .. } = self.estimate;
        if v.is_accurate() && va.is_accurate() {
            return Some(va.value / v.value);
        }
        self.dyadic().t()
    }

    /// `V0 / V`, `V1 / V`, `V2 / V`: the barycentric coordinates of `p0`, `p1` and `p2` where the
    /// ray's line meets the triangle's plane, as good as [`Exact::t`]. `None` if `V` is zero.
    pub fn barycentric(&self) -> Option<[f64; 3]> {
        let Estimate { v, v0, v1, v2, .. } = self.estimate;
        if [v, v0, v1, v2]
            .into_iter()
            .all(filter::Bounded::is_accurate)
        {
            return Some([v0, v1, v2].map(|volume| volume.value / v.value));
        }
        self.dyadic().barycentric()
    }

    /// The sign of `V`: positive if `p0`, `p1`, `p2` are counterclockwise as seen along the ray, in
    /// right-handed coordinates.
    pub fn facing(&self) -> Ordering {
        let estimated = self.estimate.v.sign();
        estimated.unwrap_or_else(|| dyadic::sign(&self.dyadic().v))
    }

    /// Where `t` is among 0 and `t_max`. `V` is not zero.
    fn t_order(&self) -> TOrder {
        let t_max = self.ray.t_max;
        if t_max.is_nan() || t_max <= 0.0 {
            return TOrder::Outside;
        }
        let Estimate { v, va, .. } = self.estimate;
        if v.is_accurate() && va.is_accurate() {
            let (t, t_max) = (va.value / v.value, f64::from(t_max));
            let margin = t.abs() * filter::T_ERROR;
            if t < 0.0 || t - margin > t_max {
                return TOrder::Outside;
            }
            if t + margin < t_max {
                return TOrder::Between;
            }
        }
        match self.dyadic().t_orders(t_max) {
            (Ordering::Greater, Ordering::Less) => TOrder::Between,
            (Ordering::Less, _) | (_, Ordering::Greater) => TOrder::Outside,
            (Ordering::Equal, _) | (_, Ordering::Equal) => TOrder::Boundary,
        }
    }

    fn dyadic(&self) -> Dyadic {
        Dyadic::new(&self.ray.origin, &self.ray.direction, &self.points)
    }
}

/// `t` against 0 and `t_max`.
enum TOrder {
    Between,
    Outside,
    Boundary,
}

//! The volumes in `f64`, with a forward error bound each.
//!
//! `f32` coordinates are exact in `f64`. All volumes are taken from `q_i = p_i - a`, the vertices
//! seen from the ray's origin, and `n = (p2-p0) × (p1-p0)`. Written out, a triple product has six
//! terms of three factors. On its way into the sum a term is rounded at most eight times, by
//! `u` = 2^-53 of itself at most: in up to three differences of coordinates, in two products, and in
//! three sums. So the sum is within `8 u (1 + 8 u)` of the terms' magnitudes, whose sum, computed
//! alongside, is itself good to `8 u`. `16 u` times the computed sum leaves room for both.
//!
//! Nothing overflows: the greatest product of three differences of `f32` is below 2^387. Nothing
//! underflows: every difference is a multiple of 2^-149, so products are multiples of 2^-447.

use std::cmp::Ordering;

/// `16 u`, see the module's text.
const BOUND: f64 = 16.0 / (1_u64 << 53) as f64;

/// What a quotient of two accurate values may be off, relative to itself.
pub(super) const T_ERROR: f64 = 1.0 / (1_u64 << 40) as f64;

/// A value and how far it may be from the real one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounded {
    pub value: f64,
    pub bound: f64,
}

impl Bounded {
    /// The real value's sign, if it is certain.
    pub fn sign(self) -> Option<Ordering> {
        if self.value > self.bound {
            Some(Ordering::Greater)
        } else if self.value < -self.bound {
            Some(Ordering::Less)
        } else if self.bound == 0.0 {
            // All terms are zero, exactly.
            Some(Ordering::Equal)
        } else {
            None
        }
    }

    /// Whether a quotient of two such values is good to [`T_ERROR`].
    pub fn is_accurate(self) -> bool {
        self.bound <= self.value.abs() * (T_ERROR / 4.0) && self.value != 0.0
    }
}

/// The five volumes, with the signs of `volumes::Volume`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    pub v: Bounded,
    pub v0: Bounded,
    pub v1: Bounded,
    pub v2: Bounded,
    pub va: Bounded,
}

impl Estimate {
    pub fn new(origin: &[f32; 3], direction: &[f32; 3], points: &[[f32; 3]; 3]) -> Self {
        let d = direction.map(f64::from);
        let [q0, q1, q2] = [0, 1, 2].map(|i| difference(&points[i], origin));
        let edge1 = difference(&points[1], &points[0]);
        let edge2 = difference(&points[2], &points[0]);
        let normal = cross(edge2, edge1);
        Self {
            v: dot(d, normal),
            v0: dot(d, cross(q2, q1)),
            v1: dot(d, cross(q0, q2)),
            v2: dot(d, cross(q1, q0)),
            va: dot(q0, normal),
        }
    }
}

fn difference(p: &[f32; 3], q: &[f32; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| f64::from(p[axis]) - f64::from(q[axis]))
}

/// A cross product, each component with the sum of the magnitudes of its two terms.
fn cross(a: [f64; 3], b: [f64; 3]) -> [(f64, f64); 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let (plus, minus) = (a[i] * b[j], a[j] * b[i]);
        (plus - minus, plus.abs() + minus.abs())
    })
}

fn dot(a: [f64; 3], b: [(f64, f64); 3]) -> Bounded {
    Bounded {
        value: a[0] * b[0].0 + a[1] * b[1].0 + a[2] * b[2].0,
        bound: BOUND * (a[0].abs() * b[0].1 + a[1].abs() * b[1].1 + a[2].abs() * b[2].1),
    }
}

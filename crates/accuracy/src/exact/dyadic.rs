//! The volumes as big integers.
//!
//! A finite `f32` is an integer times a power of two. Points are brought to one exponent,
//! directions to another, and from there on everything is integers: volumes with the direction are
//! in units of `2^(2 point + direction)`, `Va` in units of `2^(3 point)`.

use std::cmp::Ordering;

use dashu_int::IBig;

type Vector = [IBig; 3];

/// The five volumes, with the signs of `volumes::Volume`.
#[derive(Debug)]
pub(super) struct Dyadic {
    pub v: IBig,
    pub v0: IBig,
    pub v1: IBig,
    pub v2: IBig,
    pub va: IBig,
    /// Units of `t = Va / V` are `2^t_exponent`.
    t_exponent: i32,
}

impl Dyadic {
    pub fn new(origin: &[f32; 3], direction: &[f32; 3], points: &[[f32; 3]; 3]) -> Self {
        let exponent = common_exponent(points.iter().chain([origin]).flatten());
        let direction_exponent = common_exponent(direction);
        let d = integers(direction, direction_exponent);
        let a = integers(origin, exponent);
        let [q0, q1, q2] = [0, 1, 2].map(|i| difference(&integers(&points[i], exponent), &a));
        let v0 = dot(&d, &cross(&q2, &q1));
        let v1 = dot(&d, &cross(&q0, &q2));
        let v2 = dot(&d, &cross(&q1, &q0));
        let va = dot(&q0, &cross(&q2, &q1));
        Self {
            v: &v0 + &v1 + &v2,
            v0,
            v1,
            v2,
            va,
            t_exponent: exponent - direction_exponent,
        }
    }

    /// `Va / V`, of both rounded to `f64`: within 2^-51 of itself. `None` if `V` is zero.
    ///
    /// Volumes have at most 850 bits, so neither they nor `t` leave the range of `f64`.
    pub fn t(&self) -> Option<f64> {
        let quotient = || self.va.to_f64().value() / self.v.to_f64().value();
        (self.v != IBig::ZERO).then(|| quotient() * f64::from(self.t_exponent).exp2())
    }

    /// `V0 / V`, `V1 / V` and `V2 / V`, as good as that.
    pub fn barycentric(&self) -> Option<[f64; 3]> {
        let quotient = |volume: &IBig| volume.to_f64().value() / self.v.to_f64().value();
        let coordinates = || [&self.v0, &self.v1, &self.v2].map(quotient);
        (self.v != IBig::ZERO).then(coordinates)
    }

    /// `t` against 0, and `t` against `t_max`, which is positive. `V` is not zero.
    pub fn t_orders(&self, t_max: f32) -> (Ordering, Ordering) {
        let (v, va) = match sign(&self.v) {
            Ordering::Less => (-&self.v, -&self.va),
            _ => (self.v.clone(), self.va.clone()),
        };
        let to_t_max = if t_max == f32::INFINITY {
            Ordering::Less
        } else {
            // Va 2^t_exponent against V t_max.
            let (mantissa, t_max_exponent) = parts(t_max);
            let shift = self.t_exponent - t_max_exponent;
            let (va, limit) = (&va, v * IBig::from(mantissa));
            let amount = shift.unsigned_abs() as usize;
            if shift < 0 {
                va.cmp(&(limit << amount))
            } else {
                (va << amount).cmp(&limit)
            }
        };
        (sign(&va), to_t_max)
    }
}

pub(super) fn sign(x: &IBig) -> Ordering {
    x.cmp(&IBig::ZERO)
}

/// The mantissa, sign included, and exponent of a finite `f32`.
fn parts(x: f32) -> (i32, i32) {
    let bits = x.to_bits();
    let (biased, fraction) = ((bits >> 23 & 0xff) as i32, (bits & 0x7f_ffff) as i32);
    let (magnitude, exponent) = match biased {
        0 => (fraction, -149),
        _ => (fraction | 0x80_0000, biased - 150),
    };
    (
        if x.is_sign_negative() {
            -magnitude
        } else {
            magnitude
        },
        exponent,
    )
}

/// The least exponent among those that are not zero; any, if all are.
fn common_exponent<'a>(coordinates: impl IntoIterator<Item = &'a f32>) -> i32 {
    let nonzero = coordinates.into_iter().filter(|&&x| x != 0.0);
    nonzero.map(|&x| parts(x).1).min().unwrap_or(0)
}

fn integers(vector: &[f32; 3], exponent: i32) -> Vector {
    vector.map(|x| match parts(x) {
        (0, _) => IBig::ZERO,
        (mantissa, own) => IBig::from(mantissa) << (own - exponent) as usize,
    })
}

fn difference(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|axis| &a[axis] - &b[axis])
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

fn dot(a: &Vector, b: &Vector) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

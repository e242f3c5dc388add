//! Triple products multiplied out: the proof that two are the same volume.

use std::collections::BTreeMap;
use std::ops::{Add, Mul, Sub};

use crate::{Cross, Edge, Point, TripleProduct, Vector, Volume};

/// A coordinate of a point or of the direction: one of 15 unknowns.
type Unknown = u8;

/// A polynomial in the coordinates of the four points and the direction, with integer
/// coefficients, multiplied out. Two are equal exactly if they have the same value everywhere.
///
/// ```
/// # use volumes::{Polynomial, Volume};
/// for product in Volume::Va.triple_products() {
///     assert_eq!(Polynomial::of_product(product), Polynomial::of_volume(Volume::Va));
/// }
/// ```
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Polynomial {
    /// The coefficient of every product of unknowns, in ascending order of these; none is zero.
    terms: BTreeMap<Vec<Unknown>, i64>,
}

impl Polynomial {
    /// A triple product, as it is written.
    pub fn of_product(product: TripleProduct) -> Self {
        let Cross { left, right } = product.cross;
        let [left, right, dot] = [left, right, product.dot].map(vector);
        let axes = (0..3).map(|axis| {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            &(&(&left[j] * &right[k]) - &(&left[k] * &right[j])) * &dot[axis]
        });
        axes.fold(Self::default(), |total, axis| &total + &axis)
    }

    /// A volume, by its definition in the paper's equations 2, and `V0 = V - V1 - V2`.
    pub fn of_volume(volume: Volume) -> Self {
        let edge = |to, from| Vector::Edge(Edge { to, from });
        let product = |left, right, dot| {
            let cross = Cross { left, right };
            Self::of_product(TripleProduct { cross, dot })
        };
        let (first, second) = (edge(Point::P1, Point::P0), edge(Point::P2, Point::P0));
        let origin = edge(Point::A, Point::P0);
        match volume {
            Volume::V => product(Vector::Direction, second, first),
            Volume::V1 => product(Vector::Direction, second, origin),
            Volume::V2 => product(origin, first, Vector::Direction),
            Volume::Va => product(origin, first, second),
            Volume::Vb => product(edge(Point::B, Point::P0), first, second),
            Volume::V0 => {
                let [v, v1, v2] = [Volume::V, Volume::V1, Volume::V2].map(Self::of_volume);
                &(&v - &v1) - &v2
            }
        }
    }

    fn unknown(unknown: Unknown) -> Self {
        Self {
            terms: BTreeMap::from([(vec![unknown], 1)]),
        }
    }

    /// Adds a multiple of another.
    fn accumulate(&mut self, other: &Self, factor: i64) {
        for (unknowns, coefficient) in &other.terms {
            let sum = self.terms.entry(unknowns.clone()).or_default();
            *sum += coefficient * factor;
        }
        self.terms.retain(|_, coefficient| *coefficient != 0);
    }
}

/// The components of a vector.
fn vector(vector: Vector) -> [Polynomial; 3] {
    match vector {
        Vector::Direction => direction(),
        Vector::Edge(Edge { to, from }) => {
            let [to, from] = [to, from].map(point);
            std::array::from_fn(|axis| &to[axis] - &from[axis])
        }
    }
}

fn direction() -> [Polynomial; 3] {
    unknowns(Point::ALL.len() as u8)
}

fn point(point: Point) -> [Polynomial; 3] {
    match point {
        Point::B => {
            let (a, d) = (unknowns(Point::A as u8), direction());
            std::array::from_fn(|axis| &a[axis] + &d[axis])
        }
        corner => unknowns(corner as u8),
    }
}

/// Three unknowns, the first of them `3 * number`.
fn unknowns(number: u8) -> [Polynomial; 3] {
    [0, 1, 2].map(|axis| Polynomial::unknown(3 * number + axis))
}

impl Add for &Polynomial {
    type Output = Polynomial;

    fn add(self, other: Self) -> Polynomial {
        let mut sum = self.clone();
        sum.accumulate(other, 1);
        sum
    }
}

impl Sub for &Polynomial {
    type Output = Polynomial;

    fn sub(self, other: Self) -> Polynomial {
        let mut difference = self.clone();
        difference.accumulate(other, -1);
        difference
    }
}

impl Mul for &Polynomial {
    type Output = Polynomial;

    fn mul(self, other: Self) -> Polynomial {
        let mut product = Polynomial::default();
        for (left, a) in &self.terms {
            for (right, b) in &other.terms {
                let mut unknowns: Vec<Unknown> = left.iter().chain(right).copied().collect();
                unknowns.sort_unstable();
                *product.terms.entry(unknowns).or_default() += a * b;
            }
        }
        product.terms.retain(|_, coefficient| *coefficient != 0);
        product
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_write_a_volume_is_the_same_polynomial() {
        for volume in Volume::ALL {
            let known = Polynomial::of_volume(volume);
            for product in volume.triple_products() {
                assert_eq!(
                    Polynomial::of_product(product),
                    known,
                    "{volume} = {product}"
                );
            }
        }
    }

    #[test]
    fn the_volumes_and_their_negatives_are_different_polynomials() {
        for volume in Volume::ALL {
            let known = Polynomial::of_volume(volume);
            for other in Volume::ALL {
                assert_eq!(Polynomial::of_volume(other) == known, other == volume);
            }
            let product = volume.triple_products()[0];
            assert_ne!(Polynomial::of_product(product.negated()), known);
        }
    }
}

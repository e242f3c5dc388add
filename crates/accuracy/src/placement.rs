//! Where a case is put in the world: turned, moved, scaled.

use rand::{Rng, RngExt};

use crate::random::unit_vector;
use crate::vector::{Vector, add, cross, narrow, perpendicular, scale};

/// The offset of the case that the paper of the far origin reports, and of the other far ones.
pub(crate) const FAR: [Vector; 3] = [
    [1e3, -1e3, 1e3],
    [1e5, 1e5, -1e5],
    [148_376.0, 1234.0, -223_423.0],
];

/// A map from the space that a case is made in, where it is about 1 across and around zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    /// Images of the axes, of unit length.
    axes: [Vector; 3],
    offset: Vector,
    /// A power of two, applied last, to rays as well.
    factor: f64,
}

impl Placement {
    /// Turned at random, moved by up to 1 in each axis.
    pub fn near(rng: &mut impl Rng) -> Self {
        let offset = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        Self::at(rng, offset)
    }

    /// Turned at random, moved by one of [`FAR`].
    pub fn far(rng: &mut impl Rng) -> Self {
        let offset = FAR[rng.random_range(0..FAR.len())];
        Self::at(rng, offset)
    }

    /// Turned at random, moved by `distance` in any direction.
    pub fn distant(rng: &mut impl Rng, distance: f64) -> Self {
        let offset = scale(unit_vector(rng), distance);
        Self::at(rng, offset)
    }

    /// As [`Placement::near`], then everything by `2^exponent`.
    pub fn scaled(rng: &mut impl Rng, exponent: i32) -> Self {
        Self {
            factor: f64::from(exponent).exp2(),
            ..Self::near(rng)
        }
    }

    fn at(rng: &mut impl Rng, offset: Vector) -> Self {
        let first = unit_vector(rng);
        let [second, _] = perpendicular(first);
        Self {
            axes: [first, second, cross(first, second)],
            offset,
            factor: 1.0,
        }
    }

    /// How much longer things become.
    pub fn factor(&self) -> f64 {
        self.factor
    }

    /// A vector's image.
    pub fn vector(&self, vector: Vector) -> Vector {
        let turned = std::iter::zip(self.axes, vector)
            .map(|(axis, x)| scale(axis, x))
            .fold([0.0; 3], add);
        scale(turned, self.factor)
    }

    /// A point's image, rounded once.
    pub fn point(&self, point: Vector) -> [f32; 3] {
        narrow(add(self.vector(point), scale(self.offset, self.factor)))
    }
}

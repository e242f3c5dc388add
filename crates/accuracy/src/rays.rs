//! Rays that are aimed at something.

use rand::{Rng, RngExt};
use scene::{INITIAL_T, Ray};

use crate::placement::Placement;
use crate::random::log_uniform;
use crate::vector::{Vector, add, length, narrow, scale, sub, wide};

/// What a ray is aimed at. The point in the world is not rounded, the ray's direction is: most
/// rays miss what they are aimed at by a rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Aim {
    /// A vertex that is not on the border; or a point of a side that another side passes by within a
    /// rounding or so, which is no different.
    Vertex,
    /// A point of an inner side, from a tenth to nine tenths of its length, and no other side near.
    Edge,
    /// Anywhere.
    Elsewhere,
}

/// Length of a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Length {
    /// From the origin to the target.
    Raw,
    /// One.
    Unit,
}

impl Length {
    /// Either, as often.
    pub fn either(rng: &mut impl Rng) -> Self {
        if rng.random() { Self::Raw } else { Self::Unit }
    }
}

/// The ray from `origin` to `target`, and some 10^5 times farther or more in a space `factor` times
/// as large as usual.
pub(crate) fn aimed(origin: [f32; 3], target: Vector, kind: Length, factor: f64) -> Ray {
    let way = sub(target, wide(origin));
    let (direction, t_max) = match kind {
        Length::Raw => (way, INITIAL_T),
        Length::Unit => (scale(way, 1.0 / length(way)), INITIAL_T * factor as f32),
    };
    Ray {
        origin,
        direction: narrow(direction),
        t_min: 0.0,
        t_max,
    }
}

/// A ray to `target` exactly along an axis, its other components zeros of either sign.
pub(crate) fn along_axis(rng: &mut impl Rng, target: [f32; 3]) -> Ray {
    let axis = rng.random_range(0..3);
    let mut direction = [(); 3].map(|()| if rng.random() { 0.0 } else { -0.0 });
    let length = rng.random_range(0.5..2.0);
    direction[axis] = if rng.random() { length } else { -length };
    let mut origin = target;
    origin[axis] -= direction[axis] * log_uniform(rng, 0.5..20.0) as f32;
    Ray {
        origin,
        direction,
        t_min: 0.0,
        t_max: INITIAL_T,
    }
}

/// An origin from half to 20 away from `point` of the space that cases are made in, at most 75
/// degrees off the third axis, on either side.
pub(crate) fn above(rng: &mut impl Rng, point: Vector, placement: &Placement) -> [f32; 3] {
    let elevation = rng.random_range(15.0..90.0_f64).to_radians();
    from_angle(rng, point, elevation, placement)
}

/// The same, `elevation` in radians above the plane of the first two axes or below.
pub(crate) fn from_angle(
    rng: &mut impl Rng,
    point: Vector,
    elevation: f64,
    placement: &Placement,
) -> [f32; 3] {
    let turn = rng.random_range(0.0..std::f64::consts::TAU);
    let distance = log_uniform(rng, 0.5..20.0);
    let side = if rng.random() { 1.0 } else { -1.0 };
    let flat = elevation.cos();
    let way = [flat * turn.cos(), flat * turn.sin(), side * elevation.sin()];
    placement.point(add(point, scale(way, distance)))
}

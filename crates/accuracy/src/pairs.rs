//! Single triangles with rays all over them, to ask how far answers are off.

use std::fmt;

use rand::{Rng, RngExt};
use rand_chacha::ChaCha8Rng;
use scene::{INITIAL_T, Ray, Triangle};
use serde::{Deserialize, Serialize};

use crate::patch::starting_at;
use crate::placement::Placement;
use crate::random::{block_rng, log_uniform, unit_vector};
use crate::rays::{Length, aimed, from_angle};
use crate::vector::{Vector, add, narrow, scale, sub, wide};

/// Rays that a triangle gets.
pub const TRIANGLE_RAYS: usize = 64;

/// Blocks of cases and of pairs do not share streams of random numbers.
const FIRST_STREAM: u16 = 0x100;

/// The stream of ordinary triangles at a distance.
const DISTANT_STREAM: u16 = 0x300;

/// A kind of triangle and of rays near it.
///
/// Half of the rays go to points that are uniform in the triangle, the others to points next to a
/// side, from a tenth of the triangle down to 10^-7 of it away and on either side. Triangles are about
/// 1 across, turned at random and at random distances up to 1.7 from the world's origin, and seen
/// from 0.5 to 20 away at 15 to 90 degrees, in raw and in unit directions, if nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PairCase {
    /// Any triangles that are not thin.
    Ordinary,
    /// Heights from 10^-6 to 10^-2 of the longest side.
    Sliver,
    /// Sides as 11.15 : 9.74 : 1.44, seen at 0.52 degrees. (They are known as 11.2, 9.7 and 1.4, which
    /// is rounded too much to be a triangle.)
    Grazing,
    /// Seen at 10^-6 to 10^-2 degrees.
    NearlyParallel,
    /// Rays that begin on the triangle, to the rounding of their origin, in any direction: whether `t`
    /// is positive is decided by that rounding. Hits are re-hits.
    SelfHit,
    /// Legs from 2·10^-6 to 2·10^-4.
    Small,
    /// At 1e3, at 1e5 and at (148376, 1234, −223423), rays beside them.
    Far,
    /// Everything times 2^k for a k from -20 to 20.
    Scaled,
    /// Everything times 2^-140: most coordinates are subnormal.
    Subnormal,
    /// Two or three equal vertices, or three exactly on a line: nothing may be hit.
    Degenerate,
    /// `t` exactly 0, exactly `t_max`, and the least that `t_max` or the origin can be away from that.
    Limits,
}

/// A triangle and the rays it is tested with.
#[derive(Clone)]
pub struct PairBlock {
    /// The triangle.
    pub triangle: Triangle,
    /// [`TRIANGLE_RAYS`] rays.
    pub rays: Vec<Ray>,
}

impl PairCase {
    /// All cases, in the order in which tables print them.
    pub const ALL: [Self; 11] = [
        Self::Ordinary,
        Self::Sliver,
        Self::Grazing,
        Self::NearlyParallel,
        Self::SelfHit,
        Self::Small,
        Self::Far,
        Self::Scaled,
        Self::Subnormal,
        Self::Degenerate,
        Self::Limits,
    ];

    /// Its name in reports, `[a-z-]`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ordinary => "ordinary",
            Self::Sliver => "sliver",
            Self::Grazing => "grazing",
            Self::NearlyParallel => "nearly-parallel",
            Self::SelfHit => "self-hit",
            Self::Small => "small",
            Self::Far => "far",
            Self::Scaled => "scaled",
            Self::Subnormal => "subnormal",
            Self::Degenerate => "degenerate",
            Self::Limits => "limits",
        }
    }

    /// Block `number` of this case: the same for the same seed, whatever other blocks are made.
    pub fn block(self, seed: u64, number: u64) -> PairBlock {
        let rng = &mut block_rng(seed, FIRST_STREAM + self as u16, number);
        let seen_from = match self {
            Self::Grazing => 0.52..0.520_01,
            Self::NearlyParallel => {
                let degrees = log_uniform(rng, 1e-6..1e-2);
                degrees..2.0 * degrees
            }
            _ => 15.0..90.0,
        };
        let placement = match self {
            Self::Far => Placement::far(rng),
            Self::Scaled => {
                let exponent = rng.random_range(-20..21);
                Placement::scaled(rng, exponent)
            }
            Self::Subnormal => Placement::scaled(rng, -140),
            _ => Placement::near(rng),
        };
        let flat = match self {
            Self::Limits => return limits(rng),
            Self::Degenerate => return block(rng, degenerate, &placement, seen_from),
            Self::Sliver => sliver(rng),
            Self::Grazing => [[0.0, 0.0], [1.0, 0.0], [0.8732, 0.0245]],
            Self::Small => {
                let leg = log_uniform(rng, 2e-6..2e-4);
                ordinary(rng).map(|point| point.map(|x| x * leg))
            }
            _ => ordinary(rng),
        };
        let triangle =
            |_: &mut _, placement: &Placement| flat.map(|[x, y]| placement.point([x, y, 0.0]));
        let mut block = block(rng, triangle, &placement, seen_from);
        if self == Self::SelfHit {
            let Triangle { p0, p1, p2 } = block.triangle;
            for ray in &mut block.rays {
                ray.origin = narrow(target(rng, [p0, p1, p2].map(wide)));
                ray.direction = narrow(unit_vector(rng));
            }
        }
        block
    }
}

/// Block `number` of ordinary triangles, so far from the world's origin, in whatever direction. At all distances they
/// are the same triangles and rays, but for the rounding.
pub(crate) fn ordinary_at(distance: f64, seed: u64, number: u64) -> PairBlock {
    let rng = &mut block_rng(seed, DISTANT_STREAM, number);
    let placement = Placement::distant(rng, distance);
    let flat = ordinary(rng);
    let triangle =
        |_: &mut _, placement: &Placement| flat.map(|[x, y]| placement.point([x, y, 0.0]));
    block(rng, triangle, &placement, 15.0..90.0)
}

impl fmt::Display for PairCase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

fn block(
    rng: &mut ChaCha8Rng,
    triangle: impl FnOnce(&mut ChaCha8Rng, &Placement) -> [[f32; 3]; 3],
    placement: &Placement,
    seen_from: std::ops::Range<f64>,
) -> PairBlock {
    let vertices = triangle(rng, placement);
    let rays = (0..TRIANGLE_RAYS)
        .map(|_| {
            let target = target(rng, vertices.map(wide));
            let angle = rng.random_range(seen_from.clone()).to_radians();
            let origin = from_angle(rng, [0.3, 0.3, 0.0], angle, placement);
            aimed(origin, target, Length::either(rng), placement.factor())
        })
        .collect();
    PairBlock {
        triangle: starting_at(rng.random_range(0..3), vertices),
        rays,
    }
}

/// Uniform in the triangle, or next to a side of it.
fn target(rng: &mut impl Rng, [p0, p1, p2]: [Vector; 3]) -> Vector {
    let [mut beta, mut gamma]: [f64; 2] = rng.random();
    if beta + gamma > 1.0 {
        (beta, gamma) = (1.0 - beta, 1.0 - gamma);
    }
    let (mut p0, mut p1, mut p2) = (p0, p1, p2);
    if rng.random() {
        let distance = log_uniform(rng, 1e-7..0.1);
        gamma = if rng.random() { distance } else { -distance };
        for _ in 0..rng.random_range(0..3) {
            (p0, p1, p2) = (p1, p2, p0);
        }
    }
    let edges = [scale(sub(p1, p0), beta), scale(sub(p2, p0), gamma)];
    edges.into_iter().fold(p0, add)
}

/// A triangle of the unit square's that is not thin.
fn ordinary(rng: &mut impl Rng) -> [[f64; 2]; 3] {
    loop {
        let [a, b, c]: [[f64; 2]; 3] = rng.random();
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area.abs() > 0.1 {
            return [a, b, c];
        }
    }
}

fn sliver(rng: &mut impl Rng) -> [[f64; 2]; 3] {
    let (along, height) = (rng.random(), log_uniform(rng, 1e-6..1e-2));
    [[0.0, 0.0], [1.0, 0.0], [along, height]]
}

fn degenerate(rng: &mut ChaCha8Rng, placement: &Placement) -> [[f32; 3]; 3] {
    let mut point = || placement.point([rng.random(), rng.random(), 0.0]);
    let [p, q] = [point(), point()];
    match rng.random_range(0..3) {
        0 => [p, p, p],
        1 => [p, p, q],
        _ => {
            // In steps of 1/16: no rounding.
            let mut coarse =
                || std::array::from_fn(|_| f32::from(rng.random_range(-16_i8..17)) / 16.0);
            let [p, step]: [[f32; 3]; 2] = [coarse(), coarse()];
            let at = |steps: f32| std::array::from_fn(|axis| p[axis] + steps * step[axis]);
            [at(0.0), at(3.0), at(1.0)]
        }
    }
}

/// Rays along an axis through a triangle across it, in numbers that `f32` divides exactly.
fn limits(rng: &mut ChaCha8Rng) -> PairBlock {
    let axis = rng.random_range(0..3);
    let put = |[x, y, across]: [f32; 3]| {
        let mut point = [x, y, across];
        point.rotate_right((axis + 1) % 3);
        point
    };
    let plane = f32::from(rng.random_range(1_i8..9));
    let vertices = [[-4.0, -4.0], [8.0, -4.0], [-4.0, 8.0]].map(|[x, y]| put([x, y, plane]));
    let rays = (0..TRIANGLE_RAYS)
        .map(|_| {
            let speed = f32::from(rng.random_range(-3_i8..4)).exp2();
            let t = f32::from(rng.random_range(1_i8..9));
            let one_ulp = |rng: &mut ChaCha8Rng, x: f32| match rng.random_range(0..3) {
                0 => x.next_down(),
                1 => x,
                _ => x.next_up(),
            };
            let (start, t_max) = if rng.random() {
                (one_ulp(rng, plane), INITIAL_T)
            } else {
                (plane - t * speed, one_ulp(rng, t))
            };
            let [x, y] = [(); 2].map(|()| f32::from(rng.random_range(-3_i8..2)));
            Ray {
                origin: put([x, y, start]),
                direction: put([0.0, 0.0, speed]),
                t_min: 0.0,
                t_max,
            }
        })
        .collect();
    PairBlock {
        triangle: starting_at(rng.random_range(0..3), vertices),
        rays,
    }
}

#[cfg(test)]
mod tests {
    use super::{PairCase, TRIANGLE_RAYS};
    use crate::exact::{Class, Exact};

    /// Number of rays of a case, and how many of them are of a class.
    fn count(case: PairCase, is_counted: impl Fn(Class) -> bool) -> (usize, usize) {
        let (mut rays, mut counted) = (0, 0);
        for number in 0..40 {
            let block = case.block(1, number);
            assert_eq!(block.rays.len(), TRIANGLE_RAYS);
            for ray in &block.rays {
                let class = Exact::new(ray, &block.triangle).unwrap().class();
                rays += 1;
                counted += usize::from(is_counted(class));
            }
        }
        (rays, counted)
    }

    #[test]
    fn hits_and_misses_are_both_common() {
        for case in PairCase::ALL {
            if case == PairCase::Degenerate {
                continue;
            }
            let (rays, interior) = count(case, |class| class == Class::Interior);
            let (_, exterior) = count(case, |class| class == Class::Exterior);
            assert!(interior > rays / 10, "{case}: {interior} of {rays} hit");
            assert!(exterior > rays / 20, "{case}: {exterior} of {rays} miss");
        }
    }

    #[test]
    fn degenerate_triangles_have_no_area() {
        let (rays, parallel) = count(PairCase::Degenerate, |class| class == Class::Parallel);
        assert_eq!(parallel, rays);
    }

    #[test]
    fn limits_are_reached_exactly() {
        let (rays, boundary) = count(PairCase::Limits, |class| class == Class::TBoundary);
        assert!(boundary > rays / 5, "{boundary} of {rays}");
    }
}

//! Over which scales a subject's verdicts stay what they are.

use std::ops::RangeInclusive;

use scene::{Ray, Triangle};
use serde::{Deserialize, Serialize};

use crate::pairs::{PairBlock, PairCase, TRIANGLE_RAYS};
use crate::subject::{Subject, for_each_hit};

/// What is multiplied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scaling {
    /// Vertices, origins and directions; `t` stays.
    Everything,
    /// Vertices and origins; `t` is multiplied as well.
    Positions,
    /// Directions; `t` is divided.
    Directions,
}

/// Exponents that are tried on either side of 0.
const GREATEST_EXPONENT: i32 = 100;

impl Scaling {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Everything, Self::Positions, Self::Directions];

    /// The exponents of positions and of directions.
    fn exponents(self, exponent: i32) -> (i32, i32) {
        match self {
            Self::Everything => (exponent, exponent),
            Self::Positions => (exponent, 0),
            Self::Directions => (0, exponent),
        }
    }

    /// The exponent of what `t` is multiplied by.
    fn of_t(self, exponent: i32) -> i32 {
        let (positions, directions) = self.exponents(exponent);
        positions - directions
    }

    /// A block with what is multiplied times `2^exponent`, and `t_max` so that nothing is changed
    /// otherwise. `None` if something is not what it should be in `f32`.
    fn apply(self, block: &PairBlock, exponent: i32) -> Option<PairBlock> {
        let (positions, directions) = self.exponents(exponent);
        let Triangle { p0, p1, p2 } = block.triangle;
        let rays = block.rays.iter().map(|ray| {
            Some(Ray {
                origin: scaled(ray.origin, positions)?,
                direction: scaled(ray.direction, directions)?,
                t_min: 0.0,
                t_max: scaled([ray.t_max], self.of_t(exponent))?[0],
            })
        });
        Some(PairBlock {
            triangle: Triangle {
                p0: scaled(p0, positions)?,
                p1: scaled(p1, positions)?,
                p2: scaled(p2, positions)?,
            },
            rays: rays.collect::<Option<_>>()?,
        })
    }
}

/// `None` if a product is rounded or infinite.
fn scaled<const N: usize>(vector: [f32; N], exponent: i32) -> Option<[f32; N]> {
    let products = vector.map(|x| f64::from(x) * f64::from(exponent).exp2());
    let rounded = products.map(|x| x as f32);
    (rounded.map(f64::from) == products && rounded.iter().all(|x| x.is_finite())).then_some(rounded)
}

/// How far `t` may be from where the scale takes it, relatively, and still be the same: estimates of a reciprocal
/// need not be as good everywhere.
const SAME: f64 = 1e-5;

/// The exponents `k` around 0, within 100, for which the verdicts on `rays` rays at ordinary triangles
/// 1 across are the same with `scaling` by `2^k` as without, and `t` is where that takes it, within 10^-5. It
/// ends where coordinates leave the numbers that `f32` has all bits of.
pub fn scale_range(
    subject: &mut impl Subject,
    scaling: Scaling,
    rays: u64,
    seed: u64,
) -> RangeInclusive<i32> {
    let blocks: Vec<(PairBlock, Vec<Option<f64>>)> = (0..rays.div_ceil(TRIANGLE_RAYS as u64))
        .map(|number| {
            let block = PairCase::Ordinary.block(seed, number);
            let answers = answers(subject, &block);
            (block, answers)
        })
        .collect();
    let mut is_same = |exponent: i32| {
        blocks.iter().all(|(block, expected)| {
            let Some(scaled) = scaling.apply(block, exponent) else {
                return false;
            };
            let factor = f64::from(scaling.of_t(exponent)).exp2();
            let found = answers(subject, &scaled);
            found.iter().zip(expected).all(|pair| match pair {
                (Some(found), Some(expected)) => (found / (expected * factor) - 1.0).abs() <= SAME,
                (found, expected) => found == expected,
            })
        })
    };
    let mut extent = |sign: i32| {
        let same = (1..=GREATEST_EXPONENT).take_while(|&steps| is_same(sign * steps));
        sign * same.count() as i32
    };
    extent(-1)..=extent(1)
}

/// The `t` of those rays that are reported with a finite one.
fn answers(subject: &mut impl Subject, block: &PairBlock) -> Vec<Option<f64>> {
    let mut answers = vec![None; block.rays.len()];
    let triangle = std::slice::from_ref(&block.triangle);
    for_each_hit(subject, &block.rays, triangle, |ray, _, hit| {
        answers[ray] = Some(f64::from(hit.t)).filter(|t| t.is_finite());
    });
    answers
}

//! How errors and wrong verdicts go with the size of everything, and with the distance from the world's origin.

use rayon::prelude::*;
use scene::{Ray, Triangle};
use serde::{Deserialize, Serialize};

use crate::distribution::Summary;
use crate::metrics::profile;
use crate::pairs::{PairBlock, PairCase, TRIANGLE_RAYS, ordinary_at};
use crate::rate::Rate;
use crate::subject::Subject;

/// What becomes more along a sweep, the triangles being ordinary ones otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sweep {
    /// The factor of vertices, origins and directions: powers of two, from where most coordinates are
    /// subnormal to where they nearly are too large for `f32`. `t` stays.
    Scale,
    /// The distance of triangles and rays from the world's origin, in half decades from 1 to 3·10^6, where
    /// neighbours in `f32` are a quarter of a triangle's length apart.
    Distance,
}

/// A subject along a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Swept {
    /// The sweep.
    pub sweep: Sweep,
    /// All points of it, in order.
    pub points: Vec<SweepPoint>,
}

/// A subject at a point of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepPoint {
    /// The factor, or the distance.
    pub at: f64,
    /// `|t - exact| / exact` of hits that are hits; `None` if there are none.
    pub relative_error: Option<Summary>,
    /// Wrong verdicts: interior hits that are not reported, and reports of rays that miss or are parallel.
    pub wrong: Rate,
}

/// Exponents of the least and the greatest scale, and of the step between scales. Coordinates of ordinary
/// triangles and rays are up to 32.
const SCALES: (i32, i32, usize) = (-136, 120, 4);

/// Steps of a decade, and how many there are of them, for the distance.
const DISTANCES: (i32, i32) = (2, 13);

impl Sweep {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Scale, Self::Distance];

    /// Its points, in order.
    pub fn points(self) -> Vec<f64> {
        match self {
            Self::Scale => {
                let (least, greatest, step) = SCALES;
                let exponents = (least..=greatest).step_by(step);
                exponents
                    .map(|exponent| f64::from(exponent).exp2())
                    .collect()
            }
            Self::Distance => {
                let (steps, greatest) = DISTANCES;
                let decades = (0..=greatest).map(|step| f64::from(step) / f64::from(steps));
                decades.map(|decades| 10_f64.powf(decades)).collect()
            }
        }
    }

    /// Block `number` at a point: at all points the same triangles and rays, but for the rounding.
    fn block(self, at: f64, seed: u64, number: u64) -> PairBlock {
        match self {
            Self::Scale => scaled(PairCase::Ordinary.block(seed, number), at),
            Self::Distance => ordinary_at(at, seed, number),
        }
    }
}

/// A block `factor` times as large, rounded.
fn scaled(block: PairBlock, factor: f64) -> PairBlock {
    let scaled = |vector: [f32; 3]| vector.map(|x| (f64::from(x) * factor) as f32);
    let Triangle { p0, p1, p2 } = block.triangle;
    let rays = block.rays.into_iter().map(|ray| Ray {
        origin: scaled(ray.origin),
        direction: scaled(ray.direction),
        ..ray
    });
    PairBlock {
        triangle: Triangle {
            p0: scaled(p0),
            p1: scaled(p1),
            p2: scaled(p2),
        },
        rays: rays.collect(),
    }
}

/// Tests single triangles with `rays` rays a point, rounded up to whole blocks.
///
/// Each thread of rayon's current pool has a subject of its own. The result depends on the subject,
/// the number and the seed alone.
///
/// ```
/// use accuracy::{Scalar, Sweep, sweeps};
/// # use scene::{Ray, Triangle};
/// let blind = || Scalar(|_: &Ray, _: &Triangle| None::<f32>);
/// let swept = sweeps(blind, &[Sweep::Distance], 64, 1);
/// assert!(swept[0].points.iter().all(|point| point.wrong.events > 0));
/// ```
pub fn sweeps<S: Subject>(
    subjects: impl Fn() -> S + Sync,
    sweeps: &[Sweep],
    rays: u64,
    seed: u64,
) -> Vec<Swept> {
    let blocks = rays.div_ceil(TRIANGLE_RAYS as u64);
    let point = |sweep: Sweep, at: f64| {
        let profile = profile(&subjects, blocks, |number| sweep.block(at, seed, number));
        let counts = profile.counts;
        SweepPoint {
            at,
            relative_error: profile.relative_error,
            wrong: [counts.missed, counts.wrong_hit()].into_iter().sum(),
        }
    };
    let swept = |&sweep: &Sweep| Swept {
        sweep,
        points: sweep
            .points()
            .into_par_iter()
            .map(|at| point(sweep, at))
            .collect(),
    };
    sweeps.iter().map(swept).collect()
}

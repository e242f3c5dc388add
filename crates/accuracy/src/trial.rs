//! A trial: the same few rays for many subjects, their right answers known beforehand.
//!
//! A search asks of every candidate how far its `t` is off and how much leaks through it. It need
//! not know that of every extreme case, but of all candidates by the same rays, and soon.

use serde::{Deserialize, Serialize};

use crate::cases::{BLOCK_RAYS, Block, Case};
use crate::distribution::Distribution;
use crate::exact::{Class, Exact};
use crate::leaks::Leaks;
use crate::pairs::{PairBlock, PairCase, TRIANGLE_RAYS};
use crate::rate::Rate;
use crate::subject::{Subject, for_each_hit};

/// Surfaces that a trial has rays for: those on which kernels differ, of few triangles each.
const SURFACES: [Case; 3] = [Case::Fan, Case::SharedEdge, Case::AxisAligned];

/// So many rays at ordinary triangles for each at surfaces: a share of one in 10,000 needs more of them.
const AT_TRIANGLES: u64 = 4;

/// Rays, surfaces and triangles, with what is exactly true of them.
pub struct Trial {
    surfaces: Vec<Block>,
    triangles: Vec<Known>,
}

/// Rays at a triangle, and the exact `t` of those that hit it inside.
struct Known {
    block: PairBlock,
    exact: Vec<Option<f64>>,
}

/// What a subject's speed is paid for with, by a [`Trial`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tried {
    /// 9,999 of 10,000 relative errors of `t` are at most this, at ordinary triangles.
    pub t_p9999: f64,
    /// Rays aimed at sides and vertices of closed surfaces that no triangle reports.
    pub leak: Rate,
}

impl Tried {
    /// The worse of each.
    #[must_use]
    pub fn or_worse(self, other: Self) -> Self {
        let is_worse = other.leak.share() > self.leak.share();
        Self {
            t_p9999: self.t_p9999.max(other.t_p9999),
            leak: if is_worse { other.leak } else { self.leak },
        }
    }
}

impl Trial {
    /// A trial by `rays` rays at surfaces of each kind, rounded up to whole blocks, and four times as many at
    /// triangles.
    pub fn new(rays: u64, seed: u64) -> Self {
        let blocks = 0..rays.div_ceil(BLOCK_RAYS as u64);
        let of_case = |case: Case| blocks.clone().map(move |number| case.block(seed, number));
        let triangles = 0..(AT_TRIANGLES * rays).div_ceil(TRIANGLE_RAYS as u64);
        let known = |number| Known::new(PairCase::Ordinary.block(seed, number));
        Self {
            surfaces: SURFACES.into_iter().flat_map(of_case).collect(),
            triangles: triangles.map(known).collect(),
        }
    }

    /// Tries a subject.
    pub fn of(&self, subject: &mut impl Subject) -> Tried {
        let leaks = self.surfaces.iter().map(|block| {
            let Leaks { edge, vertex, .. } = Leaks::of_block(subject, block);
            [edge.leak, vertex.leak].into_iter().sum::<Rate>()
        });
        let leak = leaks.sum();
        let mut errors = Distribution::default();
        for Known { block, exact } in &self.triangles {
            let triangle = std::slice::from_ref(&block.triangle);
            for_each_hit(subject, &block.rays, triangle, |ray, _, hit| {
                if let Some(exact) = exact[ray] {
                    errors.add((f64::from(hit.t) - exact).abs() / exact);
                }
            });
        }
        Tried {
            t_p9999: errors.quantile(0.9999),
            leak,
        }
    }
}

impl Known {
    fn new(block: PairBlock) -> Self {
        let exact = block.rays.iter().map(|ray| {
            let exact = Exact::new(ray, &block.triangle)?;
            (exact.class() == Class::Interior)
                .then(|| exact.t())
                .flatten()
        });
        Self {
            exact: exact.collect(),
            block,
        }
    }
}

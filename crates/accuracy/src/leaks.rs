//! Watertightness: how many of the rays that must hit a closed surface go through it, and how many
//! are reported twice.

use std::cmp::Ordering;

use rayon::prelude::*;
use scene::Triangle;
use serde::{Deserialize, Serialize};

use crate::cases::{BLOCK_RAYS, Block, Case, Shot};
use crate::exact::{Class, Exact};
use crate::rate::Rate;
use crate::rays::Aim;
use crate::subject::{Subject, for_each_hit};

/// What a subject did with rays that must hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Passage {
    /// Rays that no triangle reports, of those that could be the one that must be hit.
    pub leak: Rate,
    /// Rays that are reported more often than they cross the surface, triangles that they see
    /// clockwise counting negatively, and that are not exactly on a side or at a vertex of a triangle
    /// that reports them.
    pub double: Rate,
}

/// What a subject did with the rays of one case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Leaks {
    /// With the rays aimed at sides.
    pub edge: Passage,
    /// With the rays aimed at vertices.
    pub vertex: Passage,
    /// With the rays aimed at nothing in particular.
    pub elsewhere: Passage,
    /// Rays through a whole mesh that do not leak and are reported only where they enter, or only
    /// where they leave.
    pub unpaired: Rate,
}

/// The leaks of one case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseLeaks {
    /// The case.
    pub case: Case,
    /// What happened.
    pub leaks: Leaks,
}

impl Leaks {
    /// What a subject does with the rays of one block.
    pub fn of_block(subject: &mut impl Subject, block: &Block) -> Self {
        let rays: Vec<_> = block.shots.iter().map(|shot| shot.ray).collect();
        let mut hits = vec![Vec::new(); rays.len()];
        for_each_hit(subject, &rays, &block.triangles, |ray, triangle, _| {
            hits[ray].push(triangle);
        });
        let mut leaks = Self::default();
        for (shot, hits) in block.shots.iter().zip(&hits) {
            leaks.add(shot, &block.triangles, hits);
        }
        leaks
    }

    fn merge(mut self, other: Self) -> Self {
        self.edge.merge(other.edge);
        self.vertex.merge(other.vertex);
        self.elsewhere.merge(other.elsewhere);
        self.unpaired += other.unpaired;
        self
    }

    /// Judges the triangles that are reported as hit by a ray.
    fn add(&mut self, shot: &Shot, triangles: &[Triangle], hits: &[usize]) {
        let counts = |hit: &usize| {
            let among = shot.among.as_ref();
            among.is_none_or(|faces| faces.contains(&(*hit as u32)))
        };
        let is_leak = !hits.iter().any(counts);
        let exact = |hit: &usize| Exact::new(&shot.ray, &triangles[*hit]);
        let counted = hits.iter().filter(|hit| counts(hit));
        let is_double = hits.len() > 1 && is_double(shot.winding, counted.filter_map(exact));
        let passage = match shot.aim {
            Aim::Edge => &mut self.edge,
            Aim::Vertex => &mut self.vertex,
            Aim::Elsewhere => &mut self.elsewhere,
        };
        passage.leak.count(is_leak);
        passage.double.count(is_double);
        if shot.among.is_some() && !is_leak {
            let facings = || hits.iter().filter_map(exact).map(|exact| exact.facing());
            let enters = facings().any(Ordering::is_lt);
            let leaves = facings().any(Ordering::is_gt);
            self.unpaired.count(!(enters && leaves));
        }
    }
}

impl Passage {
    fn merge(&mut self, other: Self) {
        self.leak += other.leak;
        self.double += other.double;
    }
}

fn is_double(winding: i32, reported: impl Iterator<Item = Exact>) -> bool {
    let mut crossings = 0;
    for exact in reported {
        match exact.class() {
            Class::Edge(_) | Class::Vertex(_) | Class::TBoundary => return false,
            Class::Interior | Class::Exterior | Class::Parallel => {}
        }
        crossings += exact.facing() as i32;
    }
    crossings * winding.signum() > winding.abs()
}

/// Shoots `rays` rays, rounded up to whole blocks, at the surfaces of each case: all that are
/// certain to hit.
///
/// Each thread of rayon's current pool has a subject of its own. The result depends on the subject,
/// the number and the seed alone.
///
/// ```
/// use accuracy::{Case, Scalar, watertightness};
/// # use scene::{Ray, Triangle};
/// let blind = || Scalar(|_: &Ray, _: &Triangle| None::<f32>);
/// let report = watertightness(blind, &[Case::Fan], 512, 1);
/// assert_eq!(report[0].leaks.vertex.leak.share(), 1.0);
/// ```
pub fn watertightness<S: Subject>(
    subjects: impl Fn() -> S + Sync,
    cases: &[Case],
    rays: u64,
    seed: u64,
) -> Vec<CaseLeaks> {
    let blocks = rays.div_ceil(BLOCK_RAYS as u64);
    let leaks_of = |&case: &Case| CaseLeaks {
        case,
        leaks: (0..blocks)
            .into_par_iter()
            .map_init(&subjects, |subject, number| {
                Leaks::of_block(subject, &case.block(seed, number))
            })
            .reduce(Leaks::default, Leaks::merge),
    };
    cases.iter().map(leaks_of).collect()
}

//! Watertightness: how many of the rays that must hit a closed surface go through it, and how many
//! are reported twice.

use rayon::prelude::*;
use scene::Triangle;
use serde::{Deserialize, Serialize};

use crate::cases::{BLOCK_RAYS, Block, Case, Shot};
use crate::exact::{Class, Exact};
use crate::rate::Rate;
use crate::rays::Aim;
use crate::subject::{Subject, for_each_hit};

/// What a subject did with the rays of one case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Leaks {
    /// Rays aimed at sides: no triangle that could be the one that must be hit reports a hit.
    pub edge: Rate,
    /// The same, of rays aimed at vertices.
    pub vertex: Rate,
    /// The same, of rays aimed at nothing in particular.
    pub elsewhere: Rate,
    /// Rays that are reported by a triangle which they go through the interior of, and also by one
    /// that they exactly miss and that faces them from the same side.
    pub double: Rate,
    /// Rays through a whole mesh that are reported only where they enter, or only where they leave.
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
    /// All rays aimed anywhere.
    pub fn any(&self) -> Rate {
        let mut all = self.edge;
        all += self.vertex;
        all += self.elsewhere;
        all
    }

    fn merge(mut self, other: Self) -> Self {
        self.edge += other.edge;
        self.vertex += other.vertex;
        self.elsewhere += other.elsewhere;
        self.double += other.double;
        self.unpaired += other.unpaired;
        self
    }

    fn of_block(subject: &mut impl Subject, block: &Block) -> Self {
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

    /// Judges the triangles that are reported as hit by a ray.
    fn add(&mut self, shot: &Shot, triangles: &[Triangle], hits: &[usize]) {
        let counts = |hit: &usize| {
            let among = shot.among.as_ref();
            among.is_none_or(|faces| faces.contains(&(*hit as u32)))
        };
        let is_leak = !hits.iter().any(counts);
        let leaks = match shot.aim {
            Aim::Edge => &mut self.edge,
            Aim::Vertex => &mut self.vertex,
            Aim::Elsewhere => &mut self.elsewhere,
        };
        leaks.count(is_leak);

        let is_mesh_crossed = shot.among.is_some();
        if hits.len() < 2 && !is_mesh_crossed {
            self.double.count(false);
            return;
        }
        let exact: Vec<Exact> = hits
            .iter()
            .filter_map(|&hit| Exact::new(&shot.ray, &triangles[hit]))
            .collect();
        self.double.count(is_double(&exact));
        if is_mesh_crossed && !is_leak {
            let facings = exact.iter().map(Exact::facing);
            let enters = facings.clone().any(|facing| facing.is_lt());
            let leaves = facings.into_iter().any(|facing| facing.is_gt());
            self.unpaired.count(!(enters && leaves));
        }
    }
}

fn is_double(reported: &[Exact]) -> bool {
    let missed = reported
        .iter()
        .filter(|exact| exact.class() == Class::Exterior);
    let missed: Vec<_> = missed.map(Exact::facing).collect();
    let hit = |exact: &&Exact| exact.class() == Class::Interior;
    let mut hit_facings = reported.iter().filter(hit).map(Exact::facing);
    hit_facings.any(|facing| missed.contains(&facing))
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
/// let blind = || Scalar(|_: &Ray, _: &Triangle| None);
/// let report = watertightness(blind, &[Case::Fan], 512, 1);
/// assert_eq!(report[0].leaks.vertex.share(), 1.0);
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

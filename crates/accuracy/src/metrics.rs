//! Wrong verdicts, by what is exactly true, and how far `t` is off.

use rayon::prelude::*;
use scene::Ray;
use serde::{Deserialize, Serialize};

use crate::distribution::{Distribution, Summary};
use crate::exact::{Class, Exact};
use crate::pairs::{PairBlock, PairCase, TRIANGLE_RAYS};
use crate::rate::Rate;
use crate::subject::{Hit, Subject, for_each_hit};
use crate::vector::{add, length, scale, wide};

/// Blocks that make up a task for a thread, so that there are few distributions to merge.
const TASK_BLOCKS: u64 = 64;

/// How a subject's verdicts and `t` compare with the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// How often something happened.
    pub counts: Counts,
    /// `|t - exact| / exact` of hits that are hits, ties included; `None` if there are none.
    pub relative_error: Option<Summary>,
    /// `|t - exact|` of the same, in ulps of `f32` at `exact`, fractions of which count: `exact` is
    /// not rounded.
    pub ulps: Option<Summary>,
    /// How far the reported point, `origin + t direction` without rounding, is from the exact one, in
    /// terms of the greatest coordinate of the origin and the exact point, of the same.
    pub position_error: Option<Summary>,
    /// `|u - exact|` and `|v - exact|` of the same, two a hit; `None` if the subject does not report them.
    pub uv_error: Option<Summary>,
    /// How wrong wrong verdicts are: of false hits outside of the triangle, how negative the least
    /// barycentric coordinate is, and of missed hits, how positive. False hits that are outside of
    /// the ray's range of `t` alone are 0.
    pub wrong_by: Option<Summary>,
}

/// Verdicts, by what is exactly true.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Interior hits that are not reported.
    pub missed: Rate,
    /// Exact misses that are reported.
    pub false_hit: Rate,
    /// Rays parallel to the triangle, and triangles without area, that are reported.
    pub parallel_hit: Rate,
    /// Ties on a side that are reported: either answer is right.
    pub edge_hit: Rate,
    /// Ties at a vertex that are reported: either answer is right.
    pub vertex_hit: Rate,
    /// Reported though `t` is exactly 0 or exactly `t_max`.
    pub t_boundary_hit: Rate,
    /// Reports whose `t` is NaN or infinite.
    pub not_finite: Rate,
    /// Reports whose `t` is not strictly between 0 and `t_max`, those that are not finite included.
    pub out_of_range: Rate,
}

/// The profile of one case.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseProfile {
    /// The case.
    pub case: PairCase,
    /// What came out.
    pub profile: Profile,
}

impl Counts {
    /// Reports of rays that miss, or are parallel.
    pub fn wrong_hit(&self) -> Rate {
        [self.false_hit, self.parallel_hit].into_iter().sum()
    }

    fn merge(&mut self, other: &Self) {
        self.missed += other.missed;
        self.false_hit += other.false_hit;
        self.parallel_hit += other.parallel_hit;
        self.edge_hit += other.edge_hit;
        self.vertex_hit += other.vertex_hit;
        self.t_boundary_hit += other.t_boundary_hit;
        self.not_finite += other.not_finite;
        self.out_of_range += other.out_of_range;
    }
}

/// A profile in the making.
#[derive(Clone, Debug, Default)]
struct Tally {
    counts: Counts,
    relative_error: Distribution,
    ulps: Distribution,
    position_error: Distribution,
    uv_error: Distribution,
    wrong_by: Distribution,
}

impl Tally {
    fn add_block(&mut self, subject: &mut impl Subject, block: &PairBlock) {
        let mut answers = vec![None; block.rays.len()];
        let triangle = std::slice::from_ref(&block.triangle);
        for_each_hit(subject, &block.rays, triangle, |ray, _, hit| {
            answers[ray] = Some(hit);
        });
        for (ray, answer) in block.rays.iter().zip(answers) {
            if let Some(exact) = Exact::new(ray, &block.triangle) {
                self.add(ray, &exact, answer);
            }
        }
    }

    /// Judges one answer.
    fn add(&mut self, ray: &Ray, exact: &Exact, answer: Option<Hit>) {
        let (class, is_hit) = (exact.class(), answer.is_some());
        let counts = &mut self.counts;
        match class {
            Class::Interior => counts.missed.count(!is_hit),
            Class::Exterior => counts.false_hit.count(is_hit),
            Class::Parallel => counts.parallel_hit.count(is_hit),
            Class::Edge(_) => counts.edge_hit.count(is_hit),
            Class::Vertex(_) => counts.vertex_hit.count(is_hit),
            Class::TBoundary => counts.t_boundary_hit.count(is_hit),
        }
        let is_wrong = match class {
            Class::Interior => !is_hit,
            Class::Exterior => is_hit,
            _ => false,
        };
        if let (true, Some(coordinates)) = (is_wrong, exact.barycentric()) {
            let least = coordinates.into_iter().fold(f64::INFINITY, f64::min);
            let is_beside = class == Class::Interior || least < 0.0;
            self.wrong_by.add(if is_beside { least.abs() } else { 0.0 });
        }

        let Some(Hit { t, uv }) = answer else {
            return;
        };
        counts.not_finite.count(!t.is_finite());
        counts.out_of_range.count(!(0.0 < t && t < ray.t_max));
        let coordinates = exact.barycentric();
        if let (Class::Interior | Class::Edge(_) | Class::Vertex(_), Some(exact)) =
            (class, exact.t())
        {
            let error = (f64::from(t) - exact).abs();
            self.relative_error.add(error / exact);
            self.ulps.add(error / ulp(exact));
            let (origin, direction) = (wide(ray.origin), wide(ray.direction));
            let point = add(origin, scale(direction, exact));
            let all = origin.into_iter().chain(point);
            let greatest = all.fold(f64::MIN_POSITIVE, |greatest, x| x.abs().max(greatest));
            self.position_error
                .add(error * length(direction) / greatest);
            if let (Some(uv), Some([_, exact_uv @ ..])) = (uv, coordinates) {
                for (coordinate, exact) in uv.into_iter().zip(exact_uv) {
                    self.uv_error.add((f64::from(coordinate) - exact).abs());
                }
            }
        }
    }

    fn merge(mut self, other: Self) -> Self {
        self.counts.merge(&other.counts);
        self.relative_error.merge(&other.relative_error);
        self.ulps.merge(&other.ulps);
        self.position_error.merge(&other.position_error);
        self.uv_error.merge(&other.uv_error);
        self.wrong_by.merge(&other.wrong_by);
        self
    }

    fn profile(&self) -> Profile {
        Profile {
            counts: self.counts,
            relative_error: self.relative_error.summary(),
            ulps: self.ulps.summary(),
            position_error: self.position_error.summary(),
            uv_error: self.uv_error.summary(),
            wrong_by: self.wrong_by.summary(),
        }
    }
}

/// The distance of `f32` from `x`, which is positive, to the next, were its range of exponents not
/// bounded above.
fn ulp(x: f64) -> f64 {
    let binade = f64::from_bits(x.to_bits() & f64::INFINITY.to_bits());
    (binade * f64::from(f32::EPSILON)).max(f64::from(f32::from_bits(1)))
}

/// Tests single triangles with `rays` rays a case, rounded up to whole blocks.
///
/// Each thread of rayon's current pool has a subject of its own. The result depends on the subject,
/// the number and the seed alone.
pub fn profiles<S: Subject>(
    subjects: impl Fn() -> S + Sync,
    cases: &[PairCase],
    rays: u64,
    seed: u64,
) -> Vec<CaseProfile> {
    let blocks = rays.div_ceil(TRIANGLE_RAYS as u64);
    let profile_of = |&case: &PairCase| CaseProfile {
        case,
        profile: profile(&subjects, blocks, |number| case.block(seed, number)),
    };
    cases.iter().map(profile_of).collect()
}

/// The profile of so many blocks, which are made by their numbers.
pub(crate) fn profile<S: Subject>(
    subjects: impl Fn() -> S + Sync,
    blocks: u64,
    block: impl Fn(u64) -> PairBlock + Sync,
) -> Profile {
    let tally = (0..blocks.div_ceil(TASK_BLOCKS))
        .into_par_iter()
        .map_init(&subjects, |subject, task| {
            let mut tally = Tally::default();
            for number in task * TASK_BLOCKS..blocks.min((task + 1) * TASK_BLOCKS) {
                tally.add_block(subject, &block(number));
            }
            tally
        })
        .reduce(Tally::default, Tally::merge);
    tally.profile()
}

#[cfg(test)]
mod tests {
    use super::ulp;

    #[test]
    fn an_ulp_is_the_distance_to_the_next_number() {
        for x in [1.0_f32, 1.999, 2.0, 3.0e-30, f32::MIN_POSITIVE, 1e-45] {
            assert_eq!(ulp(f64::from(x)), f64::from(x.next_up()) - f64::from(x));
        }
    }
}

//! What is found of a kernel as a list of figures. Whatever a judgment comes to hold is taken apart here, field by
//! field, so that it cannot be left out.

use std::collections::BTreeMap;

use accuracy::{
    Aim, CaseLeaks, CaseProfile, Counts, Hostile, Leaks, PairCase, Passage, Profile, Rate, Scaling,
    Sweep, Swept,
};
use measure::Judged;

/// What is found of a kernel, one number each: a share of rays, or an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Metric {
    /// Share of rays that no triangle reports.
    Leak(Aim),
    /// Share of rays that are reported once too often.
    Double(Aim),
    /// Share of rays through a mesh that only enter it, or only leave.
    Unpaired,
    /// Share of interior hits that are not reported, and of exact misses that are.
    Wrong(PairCase),
    /// How far inside, or outside, that is at most, in barycentric coordinates.
    WrongBy(PairCase),
    /// Share of rays in the plane of a triangle, or at one without area, that are reported.
    ParallelHit,
    /// Share of exact ties that are reported.
    Tie,
    /// Share of hits exactly at an end of the range that are reported.
    TBoundaryHit,
    /// Share of reports whose `t` is no number.
    NotFinite,
    /// Share of reports whose `t` is not in the ray's range.
    OutOfRange,
    /// Relative error of `t`, p99.99.
    RelativeError(PairCase),
    /// Error of `t` in ulps at ordinary triangles, median.
    Ulps,
    /// Error of the point that is hit by its greatest coordinate, p99.99.
    PositionError(PairCase),
    /// Absolute error of u and v, p99.99.
    UvError(PairCase),
    /// Relative error of `t`, p99, where it is worst along a sweep: at any distance, or at scales of 2^-16 to 2^16.
    Swept(Sweep),
    /// `1 / k` for the least exponent `k` of which `2^k` or `2^-k` changes a verdict, less one.
    Scale(Scaling),
    /// Share of inputs that are no rays or no triangles, or are inactive, and are reported.
    HostileHit,
    /// Share of other rays of the same call that they change.
    Disturbed,
}

/// All that is in a judgment.
pub fn figures(judged: &Judged) -> Vec<(Metric, f64, u64)> {
    let Judged {
        leaks,
        profiles,
        scales,
        hostile,
        sweeps,
    } = judged;
    let mut rates: BTreeMap<Metric, Rate> = BTreeMap::new();
    let mut count = |metric, rate: Rate| *rates.entry(metric).or_default() += rate;
    for CaseLeaks { case: _, leaks } in leaks {
        let Leaks {
            edge,
            vertex,
            elsewhere,
            unpaired,
        } = *leaks;
        for (aim, Passage { leak, double }) in [
            (Aim::Edge, edge),
            (Aim::Vertex, vertex),
            (Aim::Elsewhere, elsewhere),
        ] {
            count(Metric::Leak(aim), leak);
            count(Metric::Double(aim), double);
        }
        count(Metric::Unpaired, unpaired);
    }
    let mut numbers = Vec::new();
    for CaseProfile { case, profile } in profiles {
        let Profile {
            counts,
            relative_error,
            ulps,
            position_error,
            uv_error,
            wrong_by,
        } = *profile;
        let Counts {
            missed,
            false_hit,
            parallel_hit,
            edge_hit,
            vertex_hit,
            t_boundary_hit,
            not_finite,
            out_of_range,
        } = counts;
        for (metric, rate) in [
            (Metric::Wrong(*case), missed),
            (Metric::Wrong(*case), false_hit),
            (Metric::ParallelHit, parallel_hit),
            (Metric::Tie, edge_hit),
            (Metric::Tie, vertex_hit),
            (Metric::TBoundaryHit, t_boundary_hit),
            (Metric::NotFinite, not_finite),
            (Metric::OutOfRange, out_of_range),
        ] {
            count(metric, rate);
        }
        let errors = [
            relative_error.map(|one| (Metric::RelativeError(*case), one.p9999, one.samples)),
            position_error.map(|one| (Metric::PositionError(*case), one.p9999, one.samples)),
            uv_error.map(|one| (Metric::UvError(*case), one.p9999, one.samples)),
            wrong_by.map(|one| (Metric::WrongBy(*case), one.max, one.samples)),
            ulps.filter(|_| *case == PairCase::Ordinary)
                .map(|one| (Metric::Ulps, one.median, one.samples)),
        ];
        numbers.extend(errors.into_iter().flatten());
    }
    for Swept { sweep, points } in sweeps {
        let points = points.iter().filter(|point| match sweep {
            Sweep::Distance => true,
            Sweep::Scale => (-16.0..=16.0).contains(&point.at.log2()),
        });
        let errors = points.filter_map(|point| point.relative_error);
        let worst = errors.max_by(|a, b| a.p99.total_cmp(&b.p99));
        numbers.extend(worst.map(|one| (Metric::Swept(*sweep), one.p99, one.samples)));
    }
    let Hostile {
        ray_hit,
        triangle_hit,
        inactive_hit,
        disturbed,
    } = *hostile;
    for rate in [ray_hit, triangle_hit, inactive_hit] {
        count(Metric::HostileHit, rate);
    }
    count(Metric::Disturbed, disturbed);
    for &(scaling, least, most) in scales {
        let least_exponent = most.min(-least);
        numbers.push((Metric::Scale(scaling), 1.0 / f64::from(least_exponent), 1));
    }
    let rates = rates.into_iter().map(|(metric, rate)| {
        let share = if rate.samples == 0 { 0.0 } else { rate.share() };
        (metric, share, rate.samples)
    });
    numbers.into_iter().chain(rates).collect()
}

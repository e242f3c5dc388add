//! Every metric catches a subject that is wrong in that metric alone.

mod kernels;
mod truth;

use accuracy::{Class, Exact, Hit, PairCase, Profile, Scalar, profiles};
use kernels::{kensler_shirley, moller_trumbore, three_volumes, woop};
use scene::{Ray, Triangle};
use truth::right;

/// Rays a case.
const RAYS: u64 = 20_000;

fn profile_of<F>(case: PairCase, kernel: F) -> Profile
where
    F: Fn(&Ray, &Triangle) -> Option<f32> + Copy + Sync,
{
    profiles(|| Scalar(kernel), &[case], RAYS, 1)[0].profile
}

fn class(ray: &Ray, triangle: &Triangle) -> Class {
    Exact::new(ray, triangle).unwrap().class()
}

#[test]
fn the_right_answer_is_off_by_half_an_ulp_at_most() {
    for case in PairCase::ALL {
        let profile = profile_of(case, right);
        let counts = profile.counts;
        for wrong in [
            counts.missed,
            counts.false_hit,
            counts.parallel_hit,
            counts.t_boundary_hit,
        ] {
            assert_eq!(wrong.events, 0, "{case}: {profile:?}");
        }
        assert_eq!(profile.wrong_by, None, "{case}");
        assert_eq!(counts.not_finite.events, 0, "{case}");
        if let Some(ulps) = profile.ulps {
            assert!(ulps.max <= 0.5 + 1e-4, "{case}: {ulps:?}");
            assert!(ulps.samples > RAYS / 10, "{case}: {ulps:?}");
        }
    }
}

#[test]
fn a_kernel_that_misses_is_caught_missing() {
    let blind =
        |ray: &Ray, triangle: &Triangle| right(ray, triangle).filter(|_| ray.direction[0] < 0.0);
    let profile = profile_of(PairCase::Ordinary, blind);
    assert!(
        (0.3..0.7).contains(&profile.counts.missed.share()),
        "{profile:?}"
    );
    assert_eq!(profile.counts.false_hit.events, 0);
    assert!(profile.wrong_by.unwrap().max > 0.1, "{profile:?}");
}

#[test]
fn a_kernel_with_swollen_triangles_is_caught_hitting_beside_them() {
    let swollen = |ray: &Ray, triangle: &Triangle| {
        let exact = Exact::new(ray, triangle)?;
        let is_near = exact
            .barycentric()?
            .iter()
            .all(|&coordinate| coordinate > -1e-3);
        is_near.then(|| exact.t().unwrap() as f32)
    };
    let profile = profile_of(PairCase::Ordinary, swollen);
    assert!(profile.counts.false_hit.share() > 0.3, "{profile:?}");
    assert_eq!(profile.counts.missed.events, 0);
    let wrong_by = profile.wrong_by.unwrap();
    assert!((0.9e-3..=1e-3).contains(&wrong_by.max), "{wrong_by:?}");
}

#[test]
fn a_kernel_that_hits_what_has_no_area_is_caught() {
    let careless = |ray: &Ray, triangle: &Triangle| {
        right(ray, triangle).or((class(ray, triangle) == Class::Parallel).then_some(1.0))
    };
    let profile = profile_of(PairCase::Degenerate, careless);
    assert_eq!(profile.counts.parallel_hit.share(), 1.0);
    assert_eq!(
        profile_of(PairCase::Ordinary, careless)
            .counts
            .false_hit
            .events,
        0
    );
}

#[test]
fn a_kernel_that_takes_the_limits_of_t_in_is_caught() {
    let inclusive = |ray: &Ray, triangle: &Triangle| {
        let is_on_boundary = class(ray, triangle) == Class::TBoundary;
        let exact = Exact::new(ray, triangle)?;
        right(ray, triangle).or(is_on_boundary.then(|| exact.t().unwrap() as f32))
    };
    let counts = profile_of(PairCase::Limits, inclusive).counts;
    assert_eq!(counts.t_boundary_hit.share(), 1.0);
    assert_eq!(counts.out_of_range.events, counts.t_boundary_hit.events);
    assert_eq!(counts.missed.events + counts.false_hit.events, 0);
}

#[test]
fn a_kernel_that_returns_nan_is_caught() {
    for bad in [f32::NAN, f32::INFINITY] {
        let broken = |ray: &Ray, triangle: &Triangle| right(ray, triangle).map(|_| bad);
        let profile = profile_of(PairCase::Ordinary, broken);
        assert_eq!(profile.counts.not_finite.share(), 1.0);
        assert_eq!(profile.counts.out_of_range.share(), 1.0);
        assert_eq!(profile.ulps.unwrap().median, f64::INFINITY);
    }
}

#[test]
fn errors_of_t_are_measured_against_the_number_that_is_not_rounded() {
    let late = |ray: &Ray, triangle: &Triangle| right(ray, triangle).map(|t| t * (1.0 + 1e-3));
    let profile = profile_of(PairCase::Ordinary, late);
    let relative = profile.relative_error.unwrap();
    for quantile in [relative.median, relative.p99, relative.p9999, relative.max] {
        assert!((0.99e-3..1.01e-3).contains(&quantile), "{relative:?}");
    }
    // Raw and unit directions alike: a thousandth of the way.
    let position = profile.position_error.unwrap();
    assert!((1e-4..4e-3).contains(&position.max), "{position:?}");
    // One in a thousand is far off: seen at 99.99% and not at 99%.
    let seldom = |ray: &Ray, triangle: &Triangle| {
        let is_chosen = ray.direction[0].to_bits() & 0x3ff == 0;
        right(ray, triangle).map(|t| if is_chosen { t * 1.5 } else { t })
    };
    let ulps = profile_of(PairCase::Ordinary, seldom).ulps.unwrap();
    assert!(ulps.p99 < 0.51 && ulps.p9999 > 1e6, "{ulps:?}");
}

#[test]
fn kernels_of_the_literature_are_right_where_nothing_is_extreme() {
    for kernel in [moller_trumbore, kensler_shirley, three_volumes, woop] {
        let profile = profile_of(PairCase::Ordinary, kernel);
        let counts = profile.counts;
        assert!(
            counts.missed.share() < 0.1 && counts.false_hit.share() < 0.1,
            "{profile:?}"
        );
        assert!(profile.wrong_by.unwrap().max < 1e-4, "{profile:?}");
        assert!(profile.relative_error.unwrap().median < 1e-6, "{profile:?}");
        assert_eq!(
            profile_of(PairCase::Degenerate, kernel)
                .counts
                .not_finite
                .events,
            0
        );
    }
}

#[test]
fn the_same_seed_gives_the_same_profile_on_any_number_of_threads() {
    let on = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let cases = [PairCase::Ordinary, PairCase::Sliver];
            profiles(|| Scalar(moller_trumbore), &cases, RAYS, seed)
        })
    };
    assert_eq!(on(1, 3), on(3, 3));
    assert_ne!(on(2, 3), on(2, 4));
}

#[test]
fn wrong_coordinates_are_caught_even_where_t_is_right() {
    let with_uv = |off: [f64; 2]| {
        let kernel = move |ray: &Ray, triangle: &Triangle| {
            let t = right(ray, triangle)?;
            let [_, u, v] = Exact::new(ray, triangle)?.barycentric()?;
            let uv = [u + off[0], v + off[1]].map(|coordinate| coordinate as f32);
            Some(Hit { t, uv: Some(uv) })
        };
        profiles(|| Scalar(kernel), &[PairCase::Ordinary], RAYS, 1)[0].profile
    };
    let errors = |off| with_uv(off).uv_error.unwrap();
    let rounded = errors([0.0, 0.0]);
    assert!(rounded.max <= 0.5 * f64::from(f32::EPSILON), "{rounded:?}");
    for off in [[1e-3, 0.0], [0.0, -1e-3]] {
        let found = errors(off);
        assert!((9e-4..1.1e-3).contains(&found.p9999), "{found:?}");
        assert!(found.median < 1e-3, "of one of the two: {found:?}");
    }
    let lost = errors([f64::NAN, 0.0]);
    assert_eq!(lost.max, f64::INFINITY);
    let profile = with_uv([1e-3, 0.0]);
    assert!(profile.ulps.unwrap().max <= 0.5 + 1e-4, "{profile:?}");
    assert_eq!(profile_of(PairCase::Ordinary, right).uv_error, None);
}

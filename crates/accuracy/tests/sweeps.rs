//! Sweeps show a subject's faults exactly where it has them.

mod kernels;
mod truth;

use accuracy::{Scalar, Sweep, SweepPoint, sweeps};
use kernels::{kensler_shirley, moller_trumbore, three_volumes, woop};
use scene::{Ray, Triangle};
use truth::right;

/// Rays a point.
const RAYS: u64 = 512;

fn sweep<F>(sweep: Sweep, kernel: F) -> Vec<SweepPoint>
where
    F: Fn(&Ray, &Triangle) -> Option<f32> + Copy + Sync,
{
    sweeps(|| Scalar(kernel), &[sweep], RAYS, 1)
        .remove(0)
        .points
}

fn length([x, y, z]: [f32; 3]) -> f64 {
    let [x, y, z] = [x, y, z].map(f64::from);
    (x * x + y * y + z * z).sqrt()
}

#[test]
fn the_right_answer_is_right_everywhere_and_hits_are_common() {
    for one in Sweep::ALL {
        let points = sweep(one, right);
        assert!(points.is_sorted_by(|a, b| a.at < b.at), "{one:?}");
        assert_eq!(points.len(), one.points().len());
        for point in points {
            assert_eq!(point.wrong.events, 0, "{one:?}: {point:?}");
            let errors = point.relative_error.unwrap();
            assert!(errors.samples > RAYS / 10, "{one:?}: {point:?}");
            // Half an ulp, and the width of a bin.
            assert!(errors.max <= 1.01 * 2_f64.powi(-24), "{one:?}: {point:?}");
        }
    }
}

#[test]
fn a_subject_that_is_blind_beyond_a_scale_misses_beyond_it_and_nowhere_else() {
    let limit = 50_f64.exp2();
    let blind = |ray: &Ray, triangle: &Triangle| {
        right(ray, triangle).filter(|_| length(ray.direction) < limit)
    };
    // Directions are from 0.4 to 24 long at a scale of 1.
    for point in sweep(Sweep::Scale, blind) {
        if point.at * 24.0 < limit {
            assert_eq!(point.wrong.events, 0, "{point:?}");
        }
        if point.at * 0.4 > limit {
            assert_eq!(point.relative_error, None, "{point:?}");
            assert!(point.wrong.share() > 0.1, "{point:?}");
        }
    }
}

#[test]
fn a_subject_whose_t_is_off_far_from_the_origin_is_off_there_and_right_in_its_verdicts() {
    let limit = 2e4;
    let off = |ray: &Ray, triangle: &Triangle| {
        let is_far = length(triangle.p0) > limit;
        right(ray, triangle).map(|t| if is_far { t * 1.001 } else { t })
    };
    for point in sweep(Sweep::Distance, off) {
        assert_eq!(point.wrong.events, 0, "{point:?}");
        let errors = point.relative_error.unwrap();
        match point.at > limit {
            true => assert!((0.99e-3..1.01e-3).contains(&errors.median), "{point:?}"),
            false => assert!(errors.max < 1e-7, "{point:?}"),
        }
    }
}

/// Volumes are products of three coordinates, and the appendix's kernel multiplies two volumes; Woop's shear
/// divides by a coordinate first.
#[test]
fn volumes_leave_the_range_of_f32_long_before_shears_do() {
    let right_scales = |kernel: fn(&Ray, &Triangle) -> Option<f32>| {
        let mut points = sweep(Sweep::Scale, kernel);
        points.retain(|point| point.wrong.share() < 0.05);
        (points[0].at.log2(), points[points.len() - 1].at.log2())
    };
    let (least, most) = right_scales(woop);
    assert!(least < -100.0 && most > 100.0, "{least}..{most}");
    for (kernel, degree) in [
        (moller_trumbore as fn(&Ray, &Triangle) -> Option<f32>, 3.0),
        (three_volumes, 3.0),
        (kensler_shirley, 6.0),
    ] {
        let (least, most) = right_scales(kernel);
        let range = 127.0 / degree - 12.0..127.0 / degree + 12.0;
        assert!(
            range.contains(&most) && range.contains(&-least),
            "{least}..{most}"
        );
    }
}

#[test]
fn the_same_seed_gives_the_same_sweep_on_any_number_of_threads() {
    let on = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build()
            .unwrap()
            .install(|| sweeps(|| Scalar(moller_trumbore), &Sweep::ALL, RAYS, seed))
    };
    assert_eq!(on(1, 3), on(3, 3));
    assert_ne!(on(2, 3), on(2, 4));
}

//! Tests of the oracle: cases with known answers, and the paper's share of hits.

use super::{Ray, Verdict, hit_fraction, judge};
use crate::{Generator, Origin, Triangle};

const TRIANGLE: Triangle = Triangle {
    p0: [0.0, 0.0, 0.0],
    p1: [1.0, 0.0, 0.0],
    p2: [0.0, 1.0, 0.0],
};

/// From `(x, y, -1)` along +z.
fn upward(x: f32, y: f32) -> Ray {
    Ray {
        origin: [x, y, -1.0],
        direction: [0.0, 0.0, 1.0],
        t_min: 0.0,
        t_max: f32::INFINITY,
    }
}

fn is_clear_hit(verdict: Verdict, at: f64) -> bool {
    matches!(verdict, Verdict::Hit { t, tolerance } if t == at && tolerance < 1e-4 * at)
}

fn is_unsure(verdict: Verdict, at: f64) -> bool {
    matches!(verdict, Verdict::Unsure { t, tolerance } if t == at && tolerance < 1e-4)
}

#[test]
fn inside_is_a_hit_and_outside_a_miss_from_both_sides() {
    let turned = Triangle {
        p1: TRIANGLE.p2,
        p2: TRIANGLE.p1,
        ..TRIANGLE
    };
    for triangle in [TRIANGLE, turned] {
        assert!(is_clear_hit(judge(&upward(0.25, 0.25), &triangle), 1.0));
        for (x, y) in [
            (-0.01, 0.5),
            (0.5, -0.01),
            (0.51, 0.5),
            (5.0, 5.0),
            (-5.0, -5.0),
        ] {
            assert_eq!(judge(&upward(x, y), &triangle), Verdict::Miss, "{x} {y}");
        }
    }
}

#[test]
fn edges_and_vertices_are_unsure() {
    for (x, y) in [
        (0.0, 0.5),
        (0.5, 0.0),
        (0.5, 0.5),
        (0.0, 0.0),
        (1.0, 0.0),
        (0.0, 1.0),
    ] {
        assert!(is_unsure(judge(&upward(x, y), &TRIANGLE), 1.0), "{x} {y}");
    }
}

#[test]
fn t_is_unsure_at_both_limits_only() {
    let bounded = |t_max| {
        judge(
            &Ray {
                t_max,
                ..upward(0.25, 0.25)
            },
            &TRIANGLE,
        )
    };
    assert_eq!(bounded(0.99), Verdict::Miss);
    assert!(is_unsure(bounded(1.0), 1.0));
    assert!(is_clear_hit(bounded(1.01), 1.0));

    let from_height = |z| {
        judge(
            &Ray {
                origin: [0.25, 0.25, z],
                ..upward(0.0, 0.0)
            },
            &TRIANGLE,
        )
    };
    assert!(matches!(from_height(-0.01), Verdict::Hit { .. }));
    assert!(is_unsure(from_height(0.0), 0.0));
    assert_eq!(from_height(0.01), Verdict::Miss);
}

#[test]
fn t_is_in_units_of_the_direction() {
    let ray = Ray {
        direction: [0.0, 0.0, 0.125],
        ..upward(0.25, 0.25)
    };
    assert!(is_clear_hit(judge(&ray, &TRIANGLE), 8.0));
}

#[test]
fn scale_does_not_matter() {
    for scale in [1e-9, 1e9] {
        let scaled = |p: [f32; 3]| p.map(|x| x * scale);
        let triangle = Triangle {
            p0: scaled(TRIANGLE.p0),
            p1: scaled(TRIANGLE.p1),
            p2: scaled(TRIANGLE.p2),
        };
        let ray = |x| {
            let ray = upward(x, 0.25);
            Ray {
                origin: scaled(ray.origin),
                direction: scaled(ray.direction),
                ..ray
            }
        };
        assert!(is_clear_hit(judge(&ray(0.25), &triangle), 1.0));
        assert_eq!(judge(&ray(0.76), &triangle), Verdict::Miss);
    }
}

#[test]
fn inactive_rays_miss() {
    for t_max in [0.0, -0.0, -1.0, f32::NEG_INFINITY, f32::NAN] {
        let ray = Ray {
            t_max,
            ..upward(0.25, 0.25)
        };
        assert_eq!(judge(&ray, &TRIANGLE), Verdict::Miss, "{t_max}");
    }
}

#[test]
fn what_is_not_finite_misses() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let ray = upward(0.25, 0.25);
        let origin = Ray {
            origin: [0.25, bad, -1.0],
            ..ray
        };
        let direction = Ray {
            direction: [0.0, 0.0, bad],
            ..ray
        };
        assert_eq!(judge(&origin, &TRIANGLE), Verdict::Miss);
        assert_eq!(judge(&direction, &TRIANGLE), Verdict::Miss);
        for vertex in 0..3 {
            let mut vertices = [TRIANGLE.p0, TRIANGLE.p1, TRIANGLE.p2];
            vertices[vertex][1] = bad;
            let [p0, p1, p2] = vertices;
            assert_eq!(judge(&ray, &Triangle { p0, p1, p2 }), Verdict::Miss);
        }
    }
}

#[test]
fn without_a_volume_only_what_the_ray_goes_past_is_a_clear_miss() {
    let collinear = Triangle {
        p2: [2.0, 0.0, 0.0],
        ..TRIANGLE
    };
    let point = Triangle {
        p1: TRIANGLE.p0,
        p2: TRIANGLE.p0,
        ..TRIANGLE
    };
    let unknown = Verdict::Unsure {
        t: 0.0,
        tolerance: f64::INFINITY,
    };
    assert_eq!(judge(&upward(0.5, 0.0), &collinear), unknown);
    assert_eq!(judge(&upward(0.5, 0.5), &collinear), Verdict::Miss);
    assert_eq!(judge(&upward(0.0, 0.0), &point), unknown);

    let parallel = Ray {
        direction: [1.0, 0.0, 0.0],
        ..upward(-1.0, 0.25)
    };
    assert_eq!(judge(&parallel, &TRIANGLE), Verdict::Miss);
}

/// The paper, section 5: "the intersection probability is approximately 25%". It differs much
/// from packet to packet, so it takes all of the paper's 400 to see it.
#[test]
fn about_a_quarter_of_the_papers_tests_hit() {
    for origin in [Origin::General, Origin::Common] {
        for seed in 0..3 {
            let generator = Generator {
                seed,
                origin,
                triangles: 250,
                ..Generator::default()
            };
            let fraction = hit_fraction(generator.generate().whole());
            assert!((0.22..0.28).contains(&fraction), "seed {seed}: {fraction}");
        }
    }
}

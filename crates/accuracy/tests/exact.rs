//! The exact oracle against fractions of big integers, on ordinary inputs and on the worst there
//! are.

use std::cmp::Ordering;

use accuracy::{Class, Corner, Exact, Side};
use dashu_ratio::RBig;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use scene::{Ray, Triangle};

type Vector = [RBig; 3];

fn fraction(x: f32) -> RBig {
    RBig::try_from(x).expect("finite")
}

fn sub(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|axis| &a[axis] - &b[axis])
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

fn dot(a: &Vector, b: &Vector) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn sign(x: &RBig) -> Ordering {
    x.cmp(&RBig::ZERO)
}

/// The class, from the definitions of `volumes::Volume`, and `Va` and `V`.
fn by_fractions(ray: &Ray, triangle: &Triangle) -> (Class, RBig, RBig) {
    let [a, d, p0, p1, p2] = [
        ray.origin,
        ray.direction,
        triangle.p0,
        triangle.p1,
        triangle.p2,
    ]
    .map(|vector| vector.map(fraction));
    let (edge1, edge2, to_a) = (sub(&p1, &p0), sub(&p2, &p0), sub(&a, &p0));
    let v = dot(&cross(&d, &edge2), &edge1);
    let v1 = dot(&cross(&d, &edge2), &to_a);
    let v2 = dot(&cross(&to_a, &edge1), &d);
    let v0 = &v - &v1 - &v2;
    let va = dot(&cross(&to_a, &edge1), &edge2);
    (class_of(ray.t_max, &[&v, &v0, &v1, &v2, &va]), va, v)
}

fn class_of(t_max: f32, [v, v0, v1, v2, va]: &[&RBig; 5]) -> Class {
    if **v == RBig::ZERO {
        return Class::Parallel;
    }
    let coordinates = [v0, v1, v2].map(|volume| sign(&(*volume / *v)));
    let t = *va / *v;
    let to_end = if t_max == f32::INFINITY {
        Ordering::Less
    } else if t_max > 0.0 {
        t.cmp(&fraction(t_max))
    } else {
        Ordering::Greater
    };
    if coordinates.contains(&Ordering::Less) || sign(&t).is_lt() || to_end.is_gt() {
        return Class::Exterior;
    }
    if sign(&t).is_eq() || to_end.is_eq() {
        return Class::TBoundary;
    }
    match coordinates.map(Ordering::is_eq) {
        [false, false, false] => Class::Interior,
        [true, false, false] => Class::Edge(Side::Opposite0),
        [false, true, false] => Class::Edge(Side::Opposite1),
        [false, false, true] => Class::Edge(Side::Opposite2),
        [false, true, true] => Class::Vertex(Corner::P0),
        [true, false, true] => Class::Vertex(Corner::P1),
        [true, true, false] => Class::Vertex(Corner::P2),
        [true, true, true] => panic!("the coordinates' sum is 1"),
    }
}

/// Asserts that the oracle has the class and `t` of the fractions; returns the class.
fn agrees(ray: &Ray, triangle: &Triangle) -> Class {
    let exact = Exact::new(ray, triangle).expect("finite");
    let (class, va, v) = by_fractions(ray, triangle);
    let context = || {
        let Triangle { p0, p1, p2 } = triangle;
        format!("{ray:?} {p0:?} {p1:?} {p2:?}")
    };
    assert_eq!(exact.class(), class, "{}", context());
    assert_eq!(exact.facing(), sign(&v), "{}", context());
    match exact.t() {
        None => assert_eq!(v, RBig::ZERO, "{}", context()),
        Some(t) => {
            // |t V - Va| <= 2^-40 |Va|
            let residue = RBig::try_from(t).expect("finite") * v - &va;
            let allowed = va / RBig::from(1_u64 << 40);
            let magnitude = |x: RBig| if sign(&x).is_lt() { -x } else { x };
            assert!(magnitude(residue) <= magnitude(allowed), "{}", context());
        }
    }
    class
}

fn vector(mut component: impl FnMut() -> f32) -> [f32; 3] {
    std::array::from_fn(|_| component())
}

fn pair(t_max: f32, mut component: impl FnMut() -> f32) -> (Ray, Triangle) {
    let ray = Ray {
        origin: vector(&mut component),
        direction: vector(&mut component),
        t_min: 0.0,
        t_max,
    };
    let [p0, p1, p2] = std::array::from_fn(|_| vector(&mut component));
    (ray, Triangle { p0, p1, p2 })
}

/// How often each class came up among `count` pairs.
fn tally(count: usize, mut next: impl FnMut() -> (Ray, Triangle)) -> [usize; 6] {
    let mut tally = [0; 6];
    for _ in 0..count {
        let (ray, triangle) = next();
        tally[match agrees(&ray, &triangle) {
            Class::Interior => 0,
            Class::Exterior => 1,
            Class::Edge(_) => 2,
            Class::Vertex(_) => 3,
            Class::Parallel => 4,
            Class::TBoundary => 5,
        }] += 1;
    }
    tally
}

fn any_finite(rng: &mut impl Rng) -> f32 {
    loop {
        let x = f32::from_bits(rng.random());
        if x.is_finite() {
            return x;
        }
    }
}

#[test]
fn ordinary_inputs() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let [interior, exterior, ..] =
        tally(3000, || pair(f32::INFINITY, || rng.random_range(-1.0..1.0)));
    assert!(interior > 100 && exterior > 1000);
}

#[test]
fn small_integers_reach_every_class() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let tally = tally(20_000, || pair(2.0, || rng.random_range(-2_i8..3).into()));
    assert!(tally.iter().all(|&count| count > 20), "{tally:?}");
}

#[test]
fn any_bits_at_all() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    tally(2000, || {
        let t_max = any_finite(&mut rng);
        pair(t_max, || any_finite(&mut rng))
    });
}

#[test]
fn subnormal_and_huge_coordinates() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let tiny = |rng: &mut ChaCha8Rng| {
        f32::from_bits(rng.random_range(0..9) | rng.random::<u32>() & 1 << 31)
    };
    let tally = tally(3000, || pair(f32::INFINITY, || tiny(&mut rng)));
    assert!(tally[..5].iter().all(|&count| count > 0), "{tally:?}");
    for _ in 0..1000 {
        let extremes = [
            f32::MAX,
            -f32::MAX,
            f32::from_bits(1),
            -f32::MIN_POSITIVE,
            1.0,
            0.0,
            -0.0,
        ];
        let (ray, triangle) = pair(f32::MAX, || extremes[rng.random_range(0..extremes.len())]);
        agrees(&ray, &triangle);
    }
}

/// Vertices on a line of the ray, moved by one ulp or not at all: the volumes are zero, or as near
/// to it as they get.
#[test]
fn volumes_within_an_ulp_of_zero() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let tally = tally(5000, || {
        let (ray, mut triangle) = pair(f32::INFINITY, || rng.random_range(-1.0..1.0));
        let [a, d] = [ray.origin, ray.direction];
        let along = rng.random_range(0.1..3.0_f32);
        triangle.p1 = std::array::from_fn(|axis| {
            let x = a[axis] + along * d[axis];
            if rng.random() { x } else { x.next_up() }
        });
        if rng.random_ratio(1, 3) {
            triangle.p2 = std::array::from_fn(|axis| 2.0 * triangle.p1[axis] - triangle.p0[axis]);
        }
        (ray, triangle)
    });
    assert!(tally[0] > 50 && tally[1] > 500, "{tally:?}");
}

#[test]
fn t_at_its_limits() {
    let triangle = Triangle {
        p0: [-1.0, -1.0, 3.0],
        p1: [3.0, -1.0, 3.0],
        p2: [-1.0, 3.0, 3.0],
    };
    let class = |z: f32, t_max| {
        let ray = Ray {
            origin: [0.0, 0.0, z],
            direction: [0.0, 0.0, 1.5],
            t_min: 0.0,
            t_max,
        };
        agrees(&ray, &triangle)
    };
    assert_eq!(class(0.0, 2.0), Class::TBoundary);
    assert_eq!(class(0.0, 2.0_f32.next_up()), Class::Interior);
    assert_eq!(class(0.0, 2.0_f32.next_down()), Class::Exterior);
    assert_eq!(class(3.0, 2.0), Class::TBoundary);
    assert_eq!(class(3.0_f32.next_down(), 2.0), Class::Interior);
    assert_eq!(class(3.0_f32.next_up(), 2.0), Class::Exterior);
    for inactive in [0.0, -0.0, -1.0, f32::NAN] {
        let ray = Ray {
            origin: [0.0; 3],
            direction: [0.0, 0.0, 1.0],
            t_min: 0.0,
            t_max: inactive,
        };
        assert_eq!(
            Exact::new(&ray, &triangle).unwrap().class(),
            Class::Exterior
        );
    }
}

#[test]
fn nothing_is_said_of_what_is_not_finite() {
    let (ray, triangle) = pair(1.0, || 1.0);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let of = |direction, p2| {
            let (ray, triangle) = (Ray { direction, ..ray }, Triangle { p2, ..triangle });
            Exact::new(&ray, &triangle).is_none()
        };
        assert!(of([0.0, bad, 1.0], [1.0; 3]));
        assert!(of([0.0, 1.0, 1.0], [1.0, 1.0, bad]));
    }
}

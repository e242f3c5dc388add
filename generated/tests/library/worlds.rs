//! Rays and triangles to test with: ordinary ones, any whatever, and those that bytes make.

use std::ops::Range;

use proptest::array::uniform3;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use raybreed::{Ray, Triangle};

use crate::kernels::{Calls, RAYS, Rays};

/// Up to a packet of rays, and some triangles.
#[derive(Clone, Debug)]
pub struct World {
    pub rays: Vec<Ray>,
    pub triangles: Vec<Triangle>,
}

impl World {
    /// The rays as a call takes them; what is left over of the packet is inactive.
    pub fn packet(&self, calls: Calls) -> Rays {
        let mut packet = Rays::new();
        for (i, &ray) in self.rays.iter().enumerate() {
            let origin = match calls {
                Calls::CommonOrigin => self.rays[0].origin,
                Calls::Packet | Calls::Ray => ray.origin,
            };
            packet.set(i, Ray { origin, ..ray });
        }
        packet
    }
}

/// Numbers that arithmetic has trouble with.
pub const ODD: [f32; 20] = [
    f32::NAN,
    -f32::NAN,
    f32::from_bits(0x7f80_0001),
    f32::from_bits(0xffbf_ffff),
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    1e30,
    -1e20,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    f32::from_bits(1),
    f32::from_bits(0x8000_0001),
    1e-20,
    -1e-30,
    0.0,
    -0.0,
    f32::EPSILON,
    1.0,
];

/// Any bits, with more of what is odd.
pub fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![any::<u32>().prop_map(f32::from_bits), select(&ODD[..])]
}

/// Numbers in a scene of size 1: anywhere, or on a coarse grid, where much coincides.
fn ordinary_number() -> impl Strategy<Value = f32> {
    prop_oneof![-2.0..2.0_f32, (-2..3_i8).prop_map(f32::from)]
}

/// Points, few of which are odd.
fn any_point() -> impl Strategy<Value = [f32; 3]> {
    prop_oneof![
        12 => uniform3(ordinary_number()),
        1 => uniform3(prop_oneof![ordinary_number(), any_number()]),
        1 => uniform3(any_number()),
    ]
}

fn any_triangle() -> impl Strategy<Value = Triangle> {
    uniform3(any_point()).prop_map(|[p0, p1, p2]| Triangle { p0, p1, p2 })
}

/// Triangles without area: vertices coincide, of any finite numbers, or lie on a line.
pub fn flat_triangle() -> impl Strategy<Value = Triangle> {
    prop_oneof![collapsed_triangle(), triangle_of_a_line()]
}

/// Triangles of which vertices coincide, of any finite numbers.
fn collapsed_triangle() -> impl Strategy<Value = Triangle> {
    let finite = any_number().prop_filter("finite", |x| x.is_finite());
    let number = prop_oneof![20 => ordinary_number(), 1 => finite];
    (uniform3(uniform3(number)), 0..4).prop_map(|([p, q, r], which)| match which {
        0 => Triangle::new(p, p, r),
        1 => Triangle::new(p, q, p),
        2 => Triangle::new(p, q, q),
        _ => Triangle::new(p, p, p),
    })
}

/// Triangles of points on a line, none rounded, in a scene of size 1 or of any.
fn triangle_of_a_line() -> impl Strategy<Value = Triangle> {
    let exponent = prop_oneof![3 => Just(-12), 1 => -140..115];
    (points_on_a_line(), exponent).prop_map(|(points, exponent)| {
        let [p0, p1, p2] =
            points.map(|p| p.map(|x| (f64::from(x) * 2.0_f64.powi(exponent)) as f32));
        Triangle { p0, p1, p2 }
    })
}

/// Points on a line, along an axis too, whose products have more bits than `f32`.
pub fn points_on_a_line() -> impl Strategy<Value = [[i32; 3]; 3]> {
    let step = prop_oneof![4 => -500..501_i32, 1 => Just(0)];
    (
        uniform3(-4000..4001_i32),
        uniform3(step),
        uniform3(-8..9_i32),
    )
        .prop_map(|(origin, step, places)| {
            places.map(|place| [0, 1, 2].map(|axis| origin[axis] + place * step[axis]))
        })
}

/// Triangles with a number that is not finite.
pub fn infinite_triangle() -> impl Strategy<Value = Triangle> {
    let infinite = any_number().prop_filter("not finite", |x| !x.is_finite());
    let points = uniform3(uniform3(ordinary_number()));
    (points, 0..9_usize, infinite).prop_map(|(mut points, place, value)| {
        points[place / 3][place % 3] = value;
        let [p0, p1, p2] = points;
        Triangle { p0, p1, p2 }
    })
}

/// Where a ray is aimed: at a triangle, by its place and barycentric coordinates, corners and sides included.
type Aim = Option<(Index, f32, f32)>;

fn any_ray() -> impl Strategy<Value = (Ray, Aim)> {
    let t_min = prop_oneof![3 => Just(0.0), 2 => 0.0..2.0_f32, 1 => any_number()];
    let t = prop_oneof![6 => Just(f32::INFINITY), 3 => 0.0..4.0_f32, 2 => any_number()];
    let weight = || prop_oneof![0.0..1.0_f32, select(&[0.0, 0.25, 0.5, 0.75, 1.0][..])];
    let aim = prop::option::weighted(0.8, (any::<Index>(), weight(), weight()));
    (any_point(), any_point(), t_min, t, aim).prop_map(|(origin, direction, t_min, t, aim)| {
        (Ray::new(origin, direction).between(t_min, t), aim)
    })
}

/// Rays at triangles, few of both odd.
pub fn any_world() -> impl Strategy<Value = World> {
    world(any_triangle(), 0..20)
}

/// Rays at so many triangles of this kind.
pub fn world(
    triangle: impl Strategy<Value = Triangle>,
    count: Range<usize>,
) -> impl Strategy<Value = World> {
    let parts = (vec(any_ray(), 1..=RAYS), vec(triangle, count));
    parts.prop_map(|(rays, triangles)| {
        let origin = rays[0].0.origin;
        let aimed = |(i, (ray, aim)): (usize, (Ray, Aim))| match aim {
            Some((place, u, v)) if !triangles.is_empty() => {
                // Half of them from one origin: a call may take no other.
                let origin = if i % 2 == 0 { origin } else { ray.origin };
                let target = at(place.get(&triangles), u, v * (1.0 - u));
                Ray {
                    direction: minus(target, origin),
                    ..ray
                }
            }
            _ => ray,
        };
        let rays = rays.into_iter().enumerate().map(aimed).collect();
        World { rays, triangles }
    })
}

/// The point of a triangle with barycentric coordinates.
pub fn at(triangle: &Triangle, u: f32, v: f32) -> [f32; 3] {
    let Triangle { p0, p1, p2 } = triangle;
    [0, 1, 2].map(|axis| (1.0 - u - v) * p0[axis] + u * p1[axis] + v * p2[axis])
}

pub fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

/// Bytes as numbers, over and over.
pub struct Bytes<'a> {
    bytes: &'a [u8],
    next: usize,
}

impl<'a> Bytes<'a> {
    /// None at all are zeros.
    pub fn new(bytes: &'a [u8]) -> Self {
        Bytes { bytes, next: 0 }
    }

    /// A packet's rays, every other aimed at a triangle, from one origin.
    pub fn world(&mut self) -> World {
        let count = self.byte() % 20;
        let triangles: Vec<Triangle> = (0..count).map(|_| self.triangle()).collect();
        let origin = self.point();
        let rays = (0..RAYS).map(|i| {
            let mut ray = Ray::new(origin, self.point());
            if i % 2 == 0 && !triangles.is_empty() {
                let place = usize::from(self.byte()) % triangles.len();
                let [u, v] = [self.byte() % 5, self.byte() % 5].map(|byte| f32::from(byte) / 4.0);
                ray.direction = minus(at(&triangles[place], u, v * (1.0 - u)), origin);
            } else if i % 4 == 1 {
                ray.origin = self.point();
            }
            if self.byte() < 64 {
                ray = ray.between(self.number(), self.number());
            }
            ray
        });
        let rays = rays.collect();
        World { rays, triangles }
    }

    /// A triangle, any or none.
    pub fn triangle(&mut self) -> Triangle {
        Triangle::new(self.point(), self.point(), self.point())
    }

    fn point(&mut self) -> [f32; 3] {
        [(); 3].map(|()| self.number())
    }

    /// An ordinary number, or one of a grid, or now and then any.
    fn number(&mut self) -> f32 {
        match self.byte() {
            0..4 => f32::from_bits(u32::from_le_bytes([(); 4].map(|()| self.byte()))),
            4..8 => ODD[usize::from(self.byte()) % ODD.len()],
            8..128 => f32::from(self.byte() % 5) - 2.0,
            128.. => f32::from(u16::from_le_bytes([(); 2].map(|()| self.byte()))) / 16384.0 - 2.0,
        }
    }

    fn byte(&mut self) -> u8 {
        self.next += 1;
        let bytes = self.bytes;
        bytes
            .get((self.next - 1) % bytes.len().max(1))
            .copied()
            .unwrap_or(0)
    }
}

/// SplitMix64: the same worlds in every run.
pub struct Random(pub u64);

impl Random {
    /// A number in -1..1.
    pub fn number(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    pub fn point(&mut self) -> [f32; 3] {
        [(); 3].map(|()| self.number())
    }

    /// Triangles about 1 across, and rays through their midst from outside; half of them have bounds.
    pub fn world(&mut self) -> World {
        let triangles = (0..8).map(|_| Triangle::new(self.point(), self.point(), self.point()));
        let triangles = triangles.collect();
        let origin = self.point();
        let rays = (0..RAYS).map(|i| {
            // Some near the common origin, so that both calls see much of the same.
            let origin = [0, 1, 2].map(|axis| 3.0 * origin[axis] + 0.1 * self.number());
            let target = self.point();
            let ray = Ray::new(
                origin,
                [0, 1, 2].map(|axis| 0.6 * target[axis] - origin[axis]),
            );
            match i % 2 {
                0 => ray,
                _ => ray.between(0.5 + 0.5 * self.number(), 1.25 + 0.5 * self.number()),
            }
        });
        let rays = rays.collect();
        World { rays, triangles }
    }
}

//! What the methods have in common: a triangle's plane before a precomputation, a ray in lanes, what becomes
//! of a hit, and the loops round a test of records.
//!
//! Nothing here maps vectors with a closure: the function that calls it would not have the instruction set's
//! features, and could not take it in.

use super::lanes::*;
use crate::{Packet, Triangle};

/// A triangle's edges and normal.
pub struct Plane {
    pub a: [f32; 3],
    pub ab: [f32; 3],
    pub ac: [f32; 3],
    pub n: [f32; 3],
}

impl Plane {
    pub fn new(
        &Triangle {
            p0: a,
            p1: b,
            p2: c,
        }: &Triangle,
    ) -> Plane {
        let minus = |x: [f32; 3], y: [f32; 3]| [x[0] - y[0], x[1] - y[1], x[2] - y[2]];
        let (ab, ac) = (minus(b, a), minus(c, a));
        let n = cross3(ab, ac);
        Plane { a, ab, ac, n }
    }
}

pub fn dot3(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross3(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The axes `p`, `q`, `r` of a triangle with this normal: the one of which it has most last.
#[inline]
pub fn axes_of(normal: [f32; 3]) -> [usize; 3] {
    let [x, y, z] = normal.map(f32::abs);
    if y <= x && z <= x {
        [1, 2, 0]
    } else if z <= y {
        [2, 0, 1]
    } else {
        [0, 1, 2]
    }
}

/// A component that is known to be there. A test may not panic, for it is called from outside of Rust; and
/// no compiler sees that a triangle's axes are three.
#[inline]
pub fn component<T: Copy>([x, y, z]: [T; 3], axis: usize) -> T {
    match axis {
        0 => x,
        1 => y,
        _ => z,
    }
}

/// The axes `p`, `q`, `r` of a triangle that is projected along `r`, which is given by its bits. The
/// remainder is what a compiler that looks for bounds does not know.
pub fn axes_after(r: f32) -> [usize; 3] {
    let r = r.to_bits() as usize % 3;
    [(r + 1) % 3, (r + 2) % 3, r]
}

/// Rays in lanes, or one ray in all of them.
#[derive(Clone, Copy)]
pub struct Ray {
    pub origin: [Vector; 3],
    pub direction: [Vector; 3],
}

impl Ray {
    /// A row of a packet.
    #[target_feature(enable = "sse2")]
    #[inline]
    pub fn of_row<const N: usize>(packet: &Packet<N>, row: usize) -> Ray {
        Ray::of_row_along(packet, row, [0, 1, 2])
    }

    /// A row of a packet, its axes in another order.
    #[target_feature(enable = "sse2")]
    #[inline]
    pub fn of_row_along<const N: usize>(packet: &Packet<N>, row: usize, axes: [usize; 3]) -> Ray {
        let origin = [&packet.ox, &packet.oy, &packet.oz];
        let direction = [&packet.dx, &packet.dy, &packet.dz];
        let [x, y, z] = axes;
        Ray {
            origin: [
                load(component(origin, x), row),
                load(component(origin, y), row),
                load(component(origin, z), row),
            ],
            direction: [
                load(component(direction, x), row),
                load(component(direction, y), row),
                load(component(direction, z), row),
            ],
        }
    }

    /// One ray.
    #[target_feature(enable = "sse2")]
    #[inline]
    pub fn of_ray<const N: usize>(packet: &Packet<N>, ray: usize) -> Ray {
        Ray {
            origin: splatted(&[packet.ox[ray], packet.oy[ray], packet.oz[ray]]),
            direction: splatted(&[packet.dx[ray], packet.dy[ray], packet.dz[ray]]),
        }
    }

    /// One ray, its axes in the order of every lane's triangle.
    #[target_feature(enable = "sse2")]
    #[inline]
    pub fn of_ray_along<const N: usize>(
        packet: &Packet<N>,
        ray: usize,
        left_out: &[f32; LANES],
    ) -> Ray {
        let origin = [packet.ox[ray], packet.oy[ray], packet.oz[ray]];
        let direction = [packet.dx[ray], packet.dy[ray], packet.dz[ray]];
        let axes = left_out.map(axes_after);
        let along = |vector: [f32; 3]| {
            [
                axes.map(|[p, _, _]| component(vector, p)),
                axes.map(|[_, q, _]| component(vector, q)),
                axes.map(|[_, _, r]| component(vector, r)),
            ]
        };
        Ray {
            origin: loaded(&along(origin)),
            direction: loaded(&along(direction)),
        }
    }
}

/// Numbers, each in all lanes.
#[target_feature(enable = "sse2")]
#[inline]
pub fn splatted<const NUMBERS: usize>(numbers: &[f32; NUMBERS]) -> [Vector; NUMBERS] {
    let mut lanes = [zeros(); NUMBERS];
    for (lanes, number) in lanes.iter_mut().zip(numbers) {
        *lanes = splat(*number);
    }
    lanes
}

/// Numbers, a lane of each a triangle.
#[target_feature(enable = "sse2")]
#[inline]
pub fn loaded<const NUMBERS: usize>(block: &[[f32; LANES]; NUMBERS]) -> [Vector; NUMBERS] {
    let mut lanes = [zeros(); NUMBERS];
    for (lanes, numbers) in lanes.iter_mut().zip(block) {
        *lanes = load(numbers, 0);
    }
    lanes
}

/// The dot product of two vectors.
#[target_feature(enable = "sse2")]
#[inline]
pub fn dot(a: [Vector; 3], b: [Vector; 3]) -> Vector {
    add(add(mul(a[0], b[0]), mul(a[1], b[1])), mul(a[2], b[2]))
}

/// A point and a multiple of a vector.
#[target_feature(enable = "sse2")]
#[inline]
pub fn along(point: [Vector; 3], factor: Vector, vector: [Vector; 3]) -> [Vector; 3] {
    [
        add(point[0], mul(factor, vector[0])),
        add(point[1], mul(factor, vector[1])),
        add(point[2], mul(factor, vector[2])),
    ]
}

/// The division that was put off. Where a direction is infinite so is `det`, every test before passes, and
/// `t` is zero: that is looked at once more.
#[target_feature(enable = "sse2")]
#[inline]
pub fn divided(mask: Mask, above: Vector, det: Vector) -> Option<(Mask, Vector)> {
    let t = div(above, det);
    Some((both(mask, less(zeros(), t)), t))
}

/// The lanes in which three numbers have one sign; zero has both.
#[target_feature(enable = "sse2")]
#[inline]
pub fn of_one_sign(a: Vector, b: Vector, c: Vector) -> Mask {
    let (least, greatest) = (min(min(a, b), c), max(max(a, b), c));
    either(at_most(zeros(), least), at_most(greatest, zeros()))
}

/// The lanes of `mask` with `t` between its bounds; nothing if there are none.
#[target_feature(enable = "sse2")]
#[inline]
pub fn in_range(mask: Mask, t: Vector, t_max: Vector) -> Option<(Mask, Vector)> {
    let mask = any(both(mask, both(less(zeros(), t), less(t, t_max))))?;
    Some((mask, t))
}

/// Stores hits of a row of a packet.
#[target_feature(enable = "sse2")]
#[inline]
pub fn keep<const N: usize, const FIXED: bool>(
    packet: &mut Packet<N>,
    row: usize,
    mask: Mask,
    t: Vector,
    t_max: Vector,
) {
    if FIXED {
        let hit_t = load(&packet.hit_t, row);
        store(&mut packet.hit_t, row, select(mask, t, hit_t));
    } else {
        store(&mut packet.t, row, select(mask, t, t_max));
    }
}

/// The closest hit of one ray in every lane.
pub struct Closest {
    t_before: Vector,
    pub t_max: Vector,
    hit_t: Vector,
    block_of_hit: Vector,
}

impl Closest {
    #[target_feature(enable = "sse2")]
    #[inline]
    pub fn new<const N: usize>(packet: &Packet<N>, ray: usize) -> Closest {
        let t_before = splat(packet.t[ray]);
        Closest {
            t_before,
            t_max: t_before,
            hit_t: zeros(),
            block_of_hit: zeros(),
        }
    }

    /// Keeps hits in block `place`, counted from 1.
    #[target_feature(enable = "sse2")]
    #[inline]
    pub fn keep<const FIXED: bool>(&mut self, mask: Mask, t: Vector, place: u32) {
        if FIXED {
            self.hit_t = select(mask, t, self.hit_t);
            let number = splat(f32::from_bits(place));
            self.block_of_hit = select(mask, number, self.block_of_hit);
        } else {
            self.t_max = select(mask, t, self.t_max);
        }
    }

    /// Stores what counts of them.
    #[target_feature(enable = "sse2")]
    #[inline]
    pub fn store<const N: usize, const FIXED: bool>(self, packet: &mut Packet<N>, ray: usize) {
        if FIXED {
            let blocks_of_hits = to_array(self.block_of_hit).map(f32::to_bits);
            let lane = last_of_most(blocks_of_hits);
            if blocks_of_hits[lane] > 0 {
                packet.hit_t[ray] = to_array(self.hit_t)[lane];
            }
        } else if !is_empty(less(self.t_max, self.t_before)) {
            packet.t[ray] = least(to_array(self.t_max));
        }
    }
}

/// The lanes of a mask, if there are any.
#[target_feature(enable = "sse2")]
#[inline]
pub fn any(mask: Mask) -> Option<Mask> {
    if is_empty(mask) { None } else { Some(mask) }
}

/// The functions of a method that keeps records, a pair for each of its forms: for packets, and for one ray
/// and blocks of triangles. Both store the closest hit of a ray in `t` or, if `FIXED`, a hit in `hit_t`, `t`
/// staying: the last one in the list's order.
///
/// The method has a `Record`, and `test`, which gives the lanes that are hit, if any are. `axes` says in which order
/// a test wants a ray's: `as_they_are`, or `after N`, where number `N` of a record is the axis that comes last.
/// `apart` is the function that says whether a triangle is of the kind that the method treats apart, or `never`.
macro_rules! forms {
    (
        axes: $axes:ident $($place:literal)?;
        apart: $apart:expr;
        $($(#[$about:meta])* $packet:ident, $single:ident: $form:expr;)+
    ) => {
        forms!(@axes $axes $($place)?);

        $(
        $(#[$about])*
        #[target_feature(enable = "sse2")]
        #[inline]
        pub fn $packet<const N: usize, const FIXED: bool>(
            packet: &mut Packet<N>,
            triangles: &[Record],
        ) {
            align_frame();
            const { assert!(N.is_multiple_of(LANES)) };
            for record in triangles {
                let (axes, apart) = (axes(record), $apart(record));
                let record = splatted(record);
                for row in 0..N / LANES {
                    let ray = Ray::of_row_along(packet, row, axes);
                    let t_max = load(&packet.t, row);
                    if let Some((mask, t)) = test::<{ $form }>(&record, apart, &ray, t_max) {
                        keep::<N, FIXED>(packet, row, mask, t, t_max);
                    }
                }
            }
        }

        $(#[$about])*
        #[target_feature(enable = "sse2")]
        #[inline]
        pub fn $single<const N: usize, const FIXED: bool>(
            packet: &mut Packet<N>,
            ray: usize,
            blocks: &[Record<[f32; LANES]>],
        ) {
            align_frame();
            let mut closest = Closest::new(packet, ray);
            for (place, block) in (1..).zip(blocks) {
                let one = ray_in_block(packet, ray, block);
                let hit = test::<{ $form }>(&loaded(block), false, &one, closest.t_max);
                if let Some((mask, t)) = hit {
                    closest.keep::<FIXED>(mask, t, place);
                }
            }
            closest.store::<N, FIXED>(packet, ray);
        }
        )+
    };
    (@axes as_they_are) => {
        fn axes(_: &Record) -> [usize; 3] {
            [0, 1, 2]
        }

        #[target_feature(enable = "sse2")]
        #[inline]
        fn ray_in_block<const N: usize>(
            packet: &Packet<N>,
            ray: usize,
            _: &Record<[f32; LANES]>,
        ) -> Ray {
            Ray::of_ray(packet, ray)
        }
    };
    (@axes after $place:literal) => {
        fn axes(record: &Record) -> [usize; 3] {
            axes_after(record[$place])
        }

        #[target_feature(enable = "sse2")]
        #[inline]
        fn ray_in_block<const N: usize>(
            packet: &Packet<N>,
            ray: usize,
            block: &Record<[f32; LANES]>,
        ) -> Ray {
            Ray::of_ray_along(packet, ray, &block[$place])
        }
    };
}
pub(crate) use forms;

/// No triangle is treated apart.
pub fn never<Record>(_: &Record) -> bool {
    false
}

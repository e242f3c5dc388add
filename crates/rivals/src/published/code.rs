//! The tests of other people's crates, one ray and one triangle at a time, behind the signatures of every kernel;
//! and the symbols under which a library of them has them.
//!
//! What a crate wants of a ray is made once a ray, what it wants of a triangle beforehand. Its epsilons, its
//! culling and what it calls a hit stay as they are; a hit then counts if `0 < t < t_max`, as everywhere.

use scene::{KernelFn, PACKET_SIZE, PrepareFn, RayHits, RayPacket, Regime, Triangle};

use super::Published;

/// A crate's test as kernels.
#[derive(Clone, Copy, Debug)]
pub struct Code {
    /// What makes its records, if these are not vertices.
    pub prepare: Option<PrepareFn>,
    /// Stores the closest hit of each ray in `t`.
    pub kernel: KernelFn,
    /// Stores the last hit of each ray, in the list's order, in `hit_t`, `t` staying.
    pub fixed_kernel: KernelFn,
}

impl Code {
    /// The kernel for a regime.
    pub fn kernel_for(&self, regime: Regime) -> KernelFn {
        match regime {
            Regime::Shrinking | Regime::Leaf => self.kernel,
            Regime::Fixed => self.fixed_kernel,
        }
    }
}

/// What is called for one of [`all`](super::all).
///
/// # Panics
///
/// If it is none of them.
pub fn of(published: &Published) -> Code {
    match published.name {
        "obvhs" => of_records::<Loose<obvhs::triangle::Triangle>>(published),
        "obvhs-rt" => of_records::<Loose<obvhs::rt_triangle::RtTriangle>>(published),
        "bvh" => of_vertices::<Triangle>(),
        "parry3d" => of_vertices::<parry3d::shape::Triangle>(),
        "rayx" => of_records::<rayx::Triangle>(published),
        name => panic!("no code for {name}"),
    }
}

/// A test of vertices as they are.
fn of_vertices<T: Test>() -> Code {
    const { assert!(size_of::<T>() == size_of::<Triangle>()) };
    unprepared::<T>()
}

/// A test of what it makes of a triangle.
fn of_records<T: Test>(published: &Published) -> Code {
    let numbers = size_of::<T>() / size_of::<f32>();
    assert_eq!(published.numbers, Some(numbers), "{}", published.name);
    Code {
        prepare: Some(prepare::<T>),
        ..unprepared::<T>()
    }
}

fn unprepared<T: Test>() -> Code {
    Code {
        prepare: None,
        kernel: kernel::<T, false>,
        fixed_kernel: kernel::<T, true>,
    }
}

/// Exports tests as a library of kernels does: under even numbers for regimes in which `t` shrinks, under odd
/// ones for the fixed one. The order is that of [`all`](super::all).
macro_rules! export {
    ($($test:ty: $kernel:literal $fixed:literal $($prepare:literal)*;)+) => {$(
        export!(kernel $kernel, $test, false);
        export!(kernel $fixed, $test, true);
        $(export!(prepare $prepare, $test);)*
    )+};
    (kernel $symbol:literal, $test:ty, $fixed:literal) => {
        const _: () = {
            #[unsafe(export_name = $symbol)]
            unsafe extern "C" fn exported(
                packet: *mut RayPacket,
                hits: *mut RayHits,
                records: *const f32,
                count: usize,
            ) {
                // SAFETY: the caller's word.
                unsafe { kernel::<$test, $fixed>(packet, hits, records, count) }
            }
        };
    };
    (prepare $symbol:literal, $test:ty) => {
        const _: () = {
            #[unsafe(export_name = $symbol)]
            unsafe extern "C" fn exported(
                triangles: *const Triangle,
                count: usize,
                records: *mut f32,
            ) {
                // SAFETY: the caller's word.
                unsafe { prepare::<$test>(triangles, count, records) }
            }
        };
    };
}

export! {
    Loose<obvhs::triangle::Triangle>:
        "raybreed_kernel_0" "raybreed_kernel_1" "raybreed_prepare_0" "raybreed_prepare_1";
    Loose<obvhs::rt_triangle::RtTriangle>:
        "raybreed_kernel_2" "raybreed_kernel_3" "raybreed_prepare_2" "raybreed_prepare_3";
    Triangle:
        "raybreed_kernel_4" "raybreed_kernel_5";
    parry3d::shape::Triangle:
        "raybreed_kernel_6" "raybreed_kernel_7";
    rayx::Triangle:
        "raybreed_kernel_8" "raybreed_kernel_9" "raybreed_prepare_8" "raybreed_prepare_9";
}

/// What a crate keeps of a triangle, and its test. It is nothing but `f32`, without padding, and aligned as
/// they are.
trait Test: Sized {
    /// What is made of a ray, once.
    type Ray;

    /// What is kept of a triangle.
    fn of(triangle: &Triangle) -> Self;

    /// The crate's ray.
    fn ray(origin: [f32; 3], direction: [f32; 3]) -> Self::Ray;

    /// `t` of a hit, in units of the ray's direction as it was given. Whatever is not between 0 and `t_max` is
    /// a miss.
    fn hit(&self, ray: &Self::Ray, t_max: f32) -> f32;
}

/// What wants more alignment than numbers have. It is copied before it is looked at, which in an `#[inline]`
/// test becomes a load of its vectors.
#[derive(Clone, Copy)]
#[repr(C, packed(4))]
struct Loose<T>(T);

/// A [`PrepareFn`].
unsafe extern "C" fn prepare<T: Test>(triangles: *const Triangle, count: usize, records: *mut f32) {
    const { assert!(align_of::<T>() == align_of::<f32>()) };
    for place in 0..count {
        // SAFETY: the pointers are valid for as many triangles and records, and these are of the size and
        // alignment of `T`.
        unsafe {
            let record = T::of(&*triangles.add(place));
            records.cast::<T>().add(place).write(record);
        }
    }
}

/// A [`KernelFn`].
unsafe extern "C" fn kernel<T: Test, const FIXED: bool>(
    packet: *mut RayPacket,
    _: *mut RayHits,
    records: *const f32,
    count: usize,
) {
    const { assert!(align_of::<T>() == align_of::<f32>()) };
    // SAFETY: the caller's word: nothing else refers to the packet, and there are `count` records, each of them
    // what `prepare` has written, or vertices where these are the same bytes.
    let (packet, records) = unsafe {
        let records = std::slice::from_raw_parts(records.cast::<T>(), count);
        (&mut *packet, records)
    };
    for ray in 0..PACKET_SIZE {
        let origin = [packet.ox[ray], packet.oy[ray], packet.oz[ray]];
        let direction = [packet.dx[ray], packet.dy[ray], packet.dz[ray]];
        let one = T::ray(origin, direction);
        for record in records {
            let t_max = packet.t[ray];
            let t = record.hit(&one, t_max);
            if 0.0 < t && t < t_max {
                let answers = if FIXED {
                    &mut packet.hit_t
                } else {
                    &mut packet.t
                };
                answers[ray] = t;
            }
        }
    }
}

/// A ray without the inverse of its direction, which only tests of boxes read: users make it once a ray, but a
/// kernel begins anew with every leaf. Nor does it panic, as one from the crate's function would in a debug build,
/// if something is not finite. `t_max` is set before every test.
fn ray_of_obvhs(origin: [f32; 3], direction: [f32; 3]) -> obvhs::ray::Ray {
    obvhs::ray::Ray {
        origin: origin.into(),
        direction: direction.into(),
        inv_direction: [f32::NAN; 3].into(),
        tmin: 0.0,
        tmax: f32::INFINITY,
    }
}

/// Möller and Trumbore with the normal in place of one of the cross products. There is an `intersect_embree`,
/// too, which is no rival: it returns `t` times the size of V.
impl Test for Loose<obvhs::triangle::Triangle> {
    type Ray = obvhs::ray::Ray;

    fn of(&Triangle { p0, p1, p2 }: &Triangle) -> Self {
        Self(obvhs::triangle::Triangle {
            v0: p0.into(),
            v1: p1.into(),
            v2: p2.into(),
        })
    }

    fn ray(origin: [f32; 3], direction: [f32; 3]) -> Self::Ray {
        ray_of_obvhs(origin, direction)
    }

    #[inline]
    fn hit(&self, ray: &Self::Ray, tmax: f32) -> f32 {
        { self.0 }.intersect(&Self::Ray { tmax, ..*ray })
    }
}

/// The same with edges and normal stored, "optimized for CPU ray intersection performance".
impl Test for Loose<obvhs::rt_triangle::RtTriangle> {
    type Ray = obvhs::ray::Ray;

    fn of(&Triangle { p0, p1, p2 }: &Triangle) -> Self {
        Self(obvhs::rt_triangle::RtTriangle::new(
            p0.into(),
            p1.into(),
            p2.into(),
        ))
    }

    fn ray(origin: [f32; 3], direction: [f32; 3]) -> Self::Ray {
        ray_of_obvhs(origin, direction)
    }

    #[inline]
    fn hit(&self, ray: &Self::Ray, tmax: f32) -> f32 {
        { self.0 }.intersect(&Self::Ray { tmax, ..*ray })
    }
}

/// The ray of `bvh`, and how long its direction was.
struct Normalised {
    ray: bvh::ray::Ray<f32, 3>,
    length: f32,
}

/// Möller and Trumbore with culling. The crate has no triangles of its own, it takes vertices. Those that are
/// hit from behind could only be had by a second test, of the vertices in another order.
impl Test for Triangle {
    type Ray = Normalised;

    fn of(triangle: &Triangle) -> Self {
        *triangle
    }

    fn ray(origin: [f32; 3], [x, y, z]: [f32; 3]) -> Normalised {
        Normalised {
            ray: bvh::ray::Ray::new(origin.into(), [x, y, z].into()),
            length: (x * x + y * y + z * z).sqrt(),
        }
    }

    #[inline]
    fn hit(&self, Normalised { ray, length }: &Normalised, _: f32) -> f32 {
        let [a, b, c] = [self.p0, self.p1, self.p2].map(Into::into);
        let distance = ray.intersects_triangle(&a, &b, &c).distance;
        // Most are misses, for which nothing is divided.
        if distance < f32::INFINITY {
            distance / length
        } else {
            f32::INFINITY
        }
    }
}

/// The volumes as in Möller and Trumbore, compared with V before anything is divided.
impl Test for parry3d::shape::Triangle {
    type Ray = parry3d::query::Ray;

    fn of(&Triangle { p0, p1, p2 }: &Triangle) -> Self {
        Self::new(p0.into(), p1.into(), p2.into())
    }

    fn ray(origin: [f32; 3], direction: [f32; 3]) -> Self::Ray {
        Self::Ray::new(origin.into(), direction.into())
    }

    #[inline]
    fn hit(&self, ray: &Self::Ray, t_max: f32) -> f32 {
        use parry3d::query::RayCast;
        // Nothing is inside of a triangle, so whether it is solid is never asked.
        self.cast_local_ray(ray, t_max, false)
            .unwrap_or(f32::INFINITY)
    }
}

/// Baldwin and Weber, with all twelve numbers multiplied, be they zero or one.
impl Test for rayx::Triangle {
    type Ray = rayx::Ray;

    /// The crate refuses triangles without area. Instead of such a one there is one of NaN, which it takes, and
    /// which nothing hits.
    fn of(&Triangle { p0, p1, p2 }: &Triangle) -> Self {
        let nothing = |_| Self::new([f32::NAN; 3], [f32::NAN; 3], [f32::NAN; 3]);
        let triangle = Self::new(p0, p1, p2).or_else(nothing);
        triangle.expect("NaN is not below any area")
    }

    fn ray(origin: [f32; 3], direction: [f32; 3]) -> Self::Ray {
        Self::Ray::new(origin, direction)
    }

    #[inline]
    fn hit(&self, ray: &Self::Ray, t_max: f32) -> f32 {
        self.intersect(*ray, 0.0, t_max)
            .map_or(f32::INFINITY, |hit| hit.t)
    }
}

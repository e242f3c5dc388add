//! Rust crates that others have published: what a project could depend on instead.
//!
//! They come compiled, as Cargo builds any dependency, so they cannot be handed out as text. Each is called
//! as its users call it, one ray and one triangle at a time, behind the signature of every kernel. What a
//! crate wants of a ray is made once a ray, what it wants of a triangle beforehand. Its epsilons, its culling
//! and what it calls a hit stay as they are; a hit then counts if `0 < t < t_max`, as everywhere.
//!
//! A panic must not leave an `extern "C"` function, it would abort. None of the tests panics, whatever it is given.

use scene::{Culling, KernelFn, PACKET_SIZE, PrepareFn, RayHits, RayPacket, Regime, Triangle};

/// A crate's ray-triangle test.
#[derive(Clone, Copy, Debug)]
pub struct Published {
    /// Its name in tables and on the command line, `[a-z0-9-]`. No two share one.
    pub name: &'static str,
    /// The crate.
    pub package: &'static str,
    /// Which version of it.
    pub version: &'static str,
    /// The function that is called.
    pub reference: &'static str,
    /// What it does that kernels here do not, and answers may differ for.
    pub differs: &'static str,
    /// Which side of a triangle it does not see.
    pub culling: Culling,
    /// How many numbers it keeps of a triangle, and what makes them, if they are not its vertices.
    pub prepare: Option<(usize, PrepareFn)>,
    /// Stores the closest hit of each ray in `t`.
    pub kernel: KernelFn,
    /// Stores the last hit of each ray, in the list's order, in `hit_t`, `t` staying.
    pub fixed_kernel: KernelFn,
}

impl Published {
    /// The kernel for a regime.
    pub fn kernel_for(&self, regime: Regime) -> KernelFn {
        match regime {
            Regime::Shrinking | Regime::Leaf => self.kernel,
            Regime::Fixed => self.fixed_kernel,
        }
    }
}

/// All of them, in the order in which tables print them.
pub fn all() -> &'static [Published] {
    &PUBLISHED
}

/// The one of this name, if there is one.
///
/// ```
/// assert_eq!(rivals::published::find("bvh").unwrap().package, "bvh");
/// assert!(rivals::published::find("embree").is_none());
/// ```
pub fn find(name: &str) -> Option<&'static Published> {
    all().iter().find(|published| published.name == name)
}

static PUBLISHED: [Published; 5] = [
    Published {
        name: "obvhs",
        package: "obvhs",
        version: "0.4.0",
        reference: "obvhs::triangle::Triangle::intersect",
        differs: "from behind, two of the edges are outside (they are -0); gives no u and v",
        ..of_records::<Loose<obvhs::triangle::Triangle>>()
    },
    Published {
        name: "obvhs-rt",
        package: "obvhs",
        version: "0.4.0",
        reference: "obvhs::rt_triangle::RtTriangle::intersect",
        differs: "as obvhs; edges and normal are stored",
        ..of_records::<Loose<obvhs::rt_triangle::RtTriangle>>()
    },
    Published {
        name: "bvh",
        package: "bvh",
        version: "0.13.0",
        reference: "bvh::ray::Ray::intersects_triangle",
        differs: "fronts alone; directions are normalised, and with that V is at least 2^-23 and the distance above it, \
                  or there is no hit",
        culling: Culling::Back,
        ..of_vertices::<Triangle>()
    },
    Published {
        name: "parry3d",
        package: "parry3d",
        version: "0.31.1",
        reference: "parry3d::query::RayCast::cast_local_ray of parry3d::shape::Triangle",
        differs: "nothing in its answers; makes a unit normal for every hit before it looks at t_max, in a \
                  call that is not inlined",
        ..of_vertices::<parry3d::shape::Triangle>()
    },
    Published {
        name: "rayx",
        package: "rayx",
        version: "0.2.0",
        reference: "rayx::Triangle::intersect",
        differs: "no hit if V over the normal's greatest component is below 2^-23, nor if the normal's square is \
                  below 1e-20",
        ..of_records::<rayx::Triangle>()
    },
];

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

/// A test of vertices as they are.
const fn of_vertices<T: Test>() -> Published {
    assert!(size_of::<T>() == size_of::<Triangle>());
    unnamed::<T>(None)
}

/// A test of what it makes of a triangle.
const fn of_records<T: Test>() -> Published {
    unnamed::<T>(Some((size_of::<T>() / size_of::<f32>(), prepare::<T>)))
}

const fn unnamed<T: Test>(prepare: Option<(usize, PrepareFn)>) -> Published {
    Published {
        name: "",
        package: "",
        version: "",
        reference: "",
        differs: "",
        culling: Culling::None,
        prepare,
        kernel: kernel::<T, false>,
        fixed_kernel: kernel::<T, true>,
    }
}

/// A [`PrepareFn`].
unsafe extern "C" fn prepare<T: Test>(triangle: &Triangle, record: *mut f32) {
    const { assert!(align_of::<T>() == align_of::<f32>()) };
    // SAFETY: the pointer is valid for as many numbers as `of_records` says, which is the size of a record, and
    // aligned for them.
    unsafe { record.cast::<T>().write(T::of(triangle)) }
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

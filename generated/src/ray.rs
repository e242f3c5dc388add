//! What is tested: a ray, or a packet of them; and what is reported of hits.

/// A ray: the points `origin + t * direction` with `t_min < t < t`.
///
/// Directions need not be of unit length, and are never normalised: `t` is in units of the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Where it goes.
    pub direction: [f32; 3],
    /// Lower bound of the ray parameter, which scenes with [`T_MIN`](crate::Scene::T_MIN) read. A negative one counts
    /// as zero; with NaN there is no hit.
    pub t_min: f32,
    /// Upper bound of the ray parameter going in, closest hit so far coming out. A ray with zero, a negative number
    /// or NaN here has no hit.
    pub t: f32,
}

impl Ray {
    /// The ray without an end.
    pub fn new(origin: impl Into<[f32; 3]>, direction: impl Into<[f32; 3]>) -> Ray {
        Ray {
            origin: origin.into(),
            direction: direction.into(),
            t_min: 0.0,
            t: f32::INFINITY,
        }
    }

    /// The ray between two parameters.
    #[must_use]
    pub fn between(self, t_min: f32, t: f32) -> Ray {
        Ray { t_min, t, ..self }
    }
}

/// A packet of `N` rays, one array a component.
///
/// Ray `i` is the points `o[i] + t * d[i]` with `t_min[i] < t < self.t[i]`. Directions need not be of unit length,
/// and are never normalised: `t` is in units of the direction. With any `N` all rays are tested; where `N` is a
/// multiple of 16, by the widest vectors that there are.
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Packet<const N: usize> {
    /// Origins, x.
    pub ox: [f32; N],
    /// Origins, y.
    pub oy: [f32; N],
    /// Origins, z.
    pub oz: [f32; N],
    /// Directions, x.
    pub dx: [f32; N],
    /// Directions, y.
    pub dy: [f32; N],
    /// Directions, z.
    pub dz: [f32; N],
    /// Upper bounds of the ray parameter going in, closest hits so far coming out. A ray with zero, a negative
    /// number or NaN here is inactive and stays as it is.
    pub t: [f32; N],
    /// Lower bounds of the ray parameter, which scenes with [`T_MIN`](crate::Scene::T_MIN) read. A negative one
    /// counts as zero; with NaN there is no hit.
    pub t_min: [f32; N],
}

impl<const N: usize> Packet<N> {
    /// A packet of inactive rays.
    pub const fn new() -> Self {
        let zero = [0.0; N];
        Packet {
            ox: zero,
            oy: zero,
            oz: zero,
            dx: zero,
            dy: zero,
            dz: zero,
            t: zero,
            t_min: zero,
        }
    }

    /// The packet of these rays.
    pub fn of(rays: &[Ray; N]) -> Self {
        let mut packet = Packet::new();
        for (i, &ray) in rays.iter().enumerate() {
            packet.set(i, ray);
        }
        packet
    }

    /// Makes ray `i` this one.
    ///
    /// # Panics
    ///
    /// If `i` is not below `N`.
    #[inline]
    pub fn set(&mut self, i: usize, ray: Ray) {
        [self.ox[i], self.oy[i], self.oz[i]] = ray.origin;
        [self.dx[i], self.dy[i], self.dz[i]] = ray.direction;
        self.t_min[i] = ray.t_min;
        self.t[i] = ray.t;
    }

    /// Ray `i`.
    ///
    /// # Panics
    ///
    /// If `i` is not below `N`.
    #[inline]
    pub fn ray(&self, i: usize) -> Ray {
        Ray {
            origin: [self.ox[i], self.oy[i], self.oz[i]],
            direction: [self.dx[i], self.dy[i], self.dz[i]],
            t_min: self.t_min[i],
            t: self.t[i],
        }
    }
}

impl<const N: usize> Default for Packet<N> {
    fn default() -> Self {
        Packet::new()
    }
}

/// What is reported of the hits of a packet of `N` rays, beside `t`. Written is what the scene asks for, of rays whose
/// `t` is written, and nothing else.
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Hits<const N: usize> {
    /// Barycentric coordinates of `p1`.
    pub u: [f32; N],
    /// Barycentric coordinates of `p2`.
    pub v: [f32; N],
    /// The triangles' places in the slice, counted from [`first`](Hits::first); in blocks, lane `i` of block `b` is
    /// `b * W + i`.
    pub triangle: [u32; N],
    /// `(p1-p0) × (p2-p0)`, of any length, one array an axis.
    pub normal: [[f32; N]; 3],
    /// `p0 + u (p1-p0) + v (p2-p0)`, one array an axis.
    pub point: [[f32; N]; 3],
    /// The number of the slice's first triangle: 0, but for whoever tests one leaf of many after the other.
    pub first: u32,
}

impl<const N: usize> Hits<N> {
    /// All zero.
    pub const fn new() -> Self {
        Hits {
            u: [0.0; N],
            v: [0.0; N],
            triangle: [0; N],
            normal: [[0.0; N]; 3],
            point: [[0.0; N]; 3],
            first: 0,
        }
    }

    /// What is reported of ray `i`, whose closest hit is at `t`.
    ///
    /// # Panics
    ///
    /// If `i` is not below `N`.
    #[inline]
    pub fn hit(&self, i: usize, t: f32) -> Hit {
        Hit {
            t,
            u: self.u[i],
            v: self.v[i],
            triangle: self.triangle[i],
            normal: [self.normal[0][i], self.normal[1][i], self.normal[2][i]],
            point: [self.point[0][i], self.point[1][i], self.point[2][i]],
        }
    }
}

impl<const N: usize> Default for Hits<N> {
    fn default() -> Self {
        Hits::new()
    }
}

/// The closest hit of one ray. What the scene does not ask for is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The ray parameter.
    pub t: f32,
    /// Barycentric coordinate of `p1`.
    pub u: f32,
    /// Barycentric coordinate of `p2`.
    pub v: f32,
    /// The triangle's place: lane `i` of block `b` is `b * W + i`.
    pub triangle: u32,
    /// `(p1-p0) × (p2-p0)`, of any length.
    pub normal: [f32; 3],
    /// `p0 + u (p1-p0) + v (p2-p0)`.
    pub point: [f32; 3],
}

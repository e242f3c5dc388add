//! What kernels take: rays in packets, triangles in slices.

/// A triangle by its vertices, 36 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Triangle {
    /// First vertex.
    pub p0: [f32; 3],
    /// Second vertex.
    pub p1: [f32; 3],
    /// Third vertex.
    pub p2: [f32; 3],
}

/// A packet of `N` rays, one array a component.
///
/// Ray `i` is the points `o[i] + t * d[i]` with `0 < t < self.t[i]`. Directions need not be of
/// unit length, and are never normalised: `t` is in units of the direction.
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
    /// Upper bound of the ray parameter going in, closest hit so far coming out. A ray with zero,
    /// a negative number or NaN here is inactive and stays as it is.
    pub t: [f32; N],
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
        }
    }

    /// Makes ray `i` the points `origin + t * direction` with `0 < t < t_max`.
    ///
    /// # Panics
    ///
    /// If `i` is not below `N`.
    pub fn set_ray(&mut self, i: usize, origin: [f32; 3], direction: [f32; 3], t_max: f32) {
        [self.ox[i], self.oy[i], self.oz[i]] = origin;
        [self.dx[i], self.dy[i], self.dz[i]] = direction;
        self.t[i] = t_max;
    }
}

impl<const N: usize> Default for Packet<N> {
    fn default() -> Self {
        Packet::new()
    }
}

//! What a kernel takes: rays in packets, triangles in slices; and what it may report of a hit.
//!
//! This text is compiled into the timed libraries and, as `scene::abi`, into the process that
//! times them, so both sides agree on every byte.

/// A triangle by its vertices, 36 bytes. With arrays for numbers, `Triangle<[f32; N]>`, a block of
/// `N` triangles, one array a component.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Triangle<T = f32> {
    /// First vertex.
    pub p0: [T; 3],
    /// Second vertex.
    pub p1: [T; 3],
    /// Third vertex.
    pub p2: [T; 3],
}

/// A triangle by its vertices and its normal, 48 bytes.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TriangleWithNormal<T = f32> {
    /// First vertex.
    pub p0: [T; 3],
    /// Second vertex.
    pub p1: [T; 3],
    /// Third vertex.
    pub p2: [T; 3],
    /// `(p1-p0) × (p2-p0)`, in `f32`.
    pub normal: [T; 3],
}

/// A triangle by a vertex and two edges, 36 bytes.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Edges<T = f32> {
    /// First vertex.
    pub p0: [T; 3],
    /// `p1-p0`, in `f32`.
    pub edge1: [T; 3],
    /// `p2-p0`, in `f32`.
    pub edge2: [T; 3],
}

/// A triangle by a vertex, two edges and its normal, 48 bytes.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct EdgesWithNormal<T = f32> {
    /// First vertex.
    pub p0: [T; 3],
    /// `p1-p0`, in `f32`.
    pub edge1: [T; 3],
    /// `p2-p0`, in `f32`.
    pub edge2: [T; 3],
    /// `edge1 × edge2`, in `f32`.
    pub normal: [T; 3],
}

/// A packet of `N` rays, one array a component.
///
/// A kernel reports a hit of ray `i` when `t_min < t < self.t[i]`, both strictly; `t_min` is
/// `self.t_min[i]` for kernels of the range `t_min..t_max`, which count a negative one as 0, and 0
/// for all others. The closest hit then lowers `self.t[i]` to it; a query for any hit makes it
/// negative infinity. A ray with `t <= 0` or a NaN there is inactive. Directions need not be of
/// unit length: `t` is in units of the direction. Kernels for a common origin read the origin of
/// ray 0 only.
#[derive(Clone)]
#[repr(C, align(64))]
pub struct Packet<const N: usize> {
    /// Origins, x.
    pub ox: [f32; N],
    /// Origins, y.
    pub oy: [f32; N],
    /// Origins, z.
    pub oz: [f32; N],
    /// Directions, x; for kernels of segments the other ends, of which `t` is 1.
    pub dx: [f32; N],
    /// Directions, y.
    pub dy: [f32; N],
    /// Directions, z.
    pub dz: [f32; N],
    /// Upper bound of the ray parameter going in, closest hit so far coming out.
    pub t: [f32; N],
    /// Where kernels built for the fixed regime store the parameter of a hit; they leave `t`
    /// alone. Other kernels never touch it.
    pub hit_t: [f32; N],
    /// Lower bound of the ray parameter, read by kernels of the range `t_min..t_max` alone.
    pub t_min: [f32; N],
}

/// What is reported of the hits of a packet of `N` rays, beside `t`. A kernel writes what its
/// scene asks for, where `t` is written too, and touches nothing else.
#[derive(Clone)]
#[repr(C, align(64))]
pub struct Hits<const N: usize> {
    /// Barycentric coordinate of `p1`.
    pub u: [f32; N],
    /// Barycentric coordinate of `p2`.
    pub v: [f32; N],
    /// The triangle's place in the slice; in a block, lane `i` of block `b` is `b * lanes + i`.
    pub triangle: [u32; N],
    /// `(p1-p0) × (p2-p0)`, of any length, one array an axis.
    pub normal: [[f32; N]; 3],
    /// `p0 + u (p1-p0) + v (p2-p0)`, one array an axis.
    pub point: [[f32; N]; 3],
}

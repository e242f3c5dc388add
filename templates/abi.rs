//! What a kernel takes: rays in packets, triangles in slices.
//!
//! This text is compiled into the timed libraries and, as `scene::abi`, into the process that
//! times them, so both sides agree on every byte.

/// A triangle by its vertices, 36 bytes.
#[derive(Clone, Copy)]
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
/// A kernel reports a hit of ray `i` when `0 < t < self.t[i]`, and then lowers `self.t[i]` to it.
/// A ray with `t <= 0` or a NaN there is inactive. Directions need not be of unit length: `t` is
/// in units of the direction. Kernels for a common origin read the origin of ray 0 only.
#[derive(Clone)]
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
    /// Upper bound of the ray parameter going in, closest hit so far coming out.
    pub t: [f32; N],
    /// Where kernels built for the fixed regime store the parameter of a hit; they leave `t`
    /// alone. Other kernels never touch it.
    pub hit_t: [f32; N],
}

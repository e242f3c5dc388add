//! Lanes of the scalar kernels: one ray, in the words that kernels are written in.

/// A number of one ray.
pub type Vector = f32;

/// Whether a ray is still in question.
pub type Mask = bool;

/// Rays in a vector.
pub const LANES: usize = 1;

/// Has the compiler align the frame of the kernel that this is called in to whole vectors, so that every vector which
/// is kept on the stack lies in one line of the cache. Here a vector is a number.
#[inline]
pub fn align_frame() {}

/// Element `row` of `lanes`.
#[inline]
pub fn load<const N: usize>(lanes: &[f32; N], row: usize) -> Vector {
    lanes[row]
}

/// Overwrites element `row` of `lanes`.
#[inline]
pub fn store<const N: usize>(lanes: &mut [f32; N], row: usize, value: Vector) {
    lanes[row] = value;
}

/// The bits in element `row` of `lanes`, as a number.
#[inline]
pub fn load_bits<const N: usize>(lanes: &[u32; N], row: usize) -> Vector {
    f32::from_bits(lanes[row])
}

/// Overwrites element `row` of `lanes` with the bits of a number.
#[inline]
pub fn store_bits<const N: usize>(lanes: &mut [u32; N], row: usize, value: Vector) {
    lanes[row] = value.to_bits();
}

/// The number as an array.
#[inline]
pub fn to_array(a: Vector) -> [f32; LANES] {
    [a]
}

/// The number.
#[inline]
pub fn splat(number: f32) -> Vector {
    number
}

/// Zero.
#[inline]
pub fn zeros() -> Vector {
    0.0
}

/// The sum.
#[inline]
pub fn add(a: Vector, b: Vector) -> Vector {
    a + b
}

/// The difference.
#[inline]
pub fn sub(a: Vector, b: Vector) -> Vector {
    a - b
}

/// The product.
#[inline]
pub fn mul(a: Vector, b: Vector) -> Vector {
    a * b
}

/// The quotient.
#[inline]
pub fn div(a: Vector, b: Vector) -> Vector {
    a / b
}

/// `a * b + c`. Here both operations round; where they are one instruction that rounds once, so
/// kernels that have this word may answer otherwise there, and portable ones have none.
#[inline]
pub fn mul_add(a: Vector, b: Vector, c: Vector) -> Vector {
    a * b + c
}

/// `a * b - c`, as [`mul_add`].
#[inline]
pub fn mul_sub(a: Vector, b: Vector, c: Vector) -> Vector {
    a * b - c
}

/// `c - a * b`, as [`mul_add`].
#[inline]
pub fn neg_mul_add(a: Vector, b: Vector, c: Vector) -> Vector {
    c - a * b
}

/// `a * b - c * d` in twice the precision, in which products are exact: the sign is right.
#[inline]
pub fn exact_difference(a: Vector, b: Vector, c: Vector, d: Vector) -> Vector {
    let [a, b, c, d] = [a, b, c, d].map(f64::from);
    (a * b - c * d) as f32
}

/// The lesser; the second if either is NaN.
#[inline]
pub fn min(a: Vector, b: Vector) -> Vector {
    if a < b { a } else { b }
}

/// The greater; the second if either is NaN.
#[inline]
pub fn max(a: Vector, b: Vector) -> Vector {
    if a > b { a } else { b }
}

/// The reciprocal: a processor without vectors has no estimate of it.
#[inline]
pub fn estimate_reciprocal(a: Vector) -> Vector {
    1.0 / a
}

/// Or of the bits.
#[inline]
pub fn bit_or(a: Vector, b: Vector) -> Vector {
    f32::from_bits(a.to_bits() | b.to_bits())
}

/// Exclusive or of the bits.
#[inline]
pub fn bit_xor(a: Vector, b: Vector) -> Vector {
    f32::from_bits(a.to_bits() ^ b.to_bits())
}

/// `a`, its sign changed if the sign bit of `b` is set.
#[inline]
pub fn flip_sign(a: Vector, b: Vector) -> Vector {
    f32::from_bits(a.to_bits() ^ (b.to_bits() & 1 << 31))
}

/// Whether `a < b`, which no NaN is.
#[inline]
pub fn less(a: Vector, b: Vector) -> Mask {
    a < b
}

/// Whether `a <= b`, which no NaN is.
#[inline]
pub fn at_most(a: Vector, b: Vector) -> Mask {
    a <= b
}

/// Whether the sign bit is clear.
#[inline]
pub fn sign_is_clear(a: Vector) -> Mask {
    a.is_sign_positive()
}

/// True.
#[inline]
pub fn all_true() -> Mask {
    true
}

/// Whether both are true.
#[inline]
pub fn both(a: Mask, b: Mask) -> Mask {
    a & b
}

/// Whether one is true.
#[inline]
pub fn either(a: Mask, b: Mask) -> Mask {
    a | b
}

/// `a` if `mask` is true, or else `b`.
#[inline]
pub fn select(mask: Mask, a: Vector, b: Vector) -> Vector {
    if mask { a } else { b }
}

/// Whether `mask` is false.
#[inline]
pub fn is_empty(mask: Mask) -> bool {
    !mask
}

/// The lanes in which `mask` is true, lane 0 in the lowest bit.
#[inline]
pub fn bits(mask: Mask) -> u32 {
    mask as u32
}

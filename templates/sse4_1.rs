//! Lanes of the SSE4.1 kernels: what every instruction set offers, in the words that kernels are
//! written in.

#[allow(unused_imports, reason = "some kernels take others than the rest")]
pub use core::arch::x86_64::{
    __m128 as Vector, __m128 as Mask, _mm_add_ps as add, _mm_and_ps as both,
    _mm_cmple_ps as at_most, _mm_cmplt_ps as less, _mm_div_ps as div, _mm_max_ps as max,
    _mm_min_ps as min, _mm_mul_ps as mul, _mm_or_ps as bit_or, _mm_or_ps as either,
    _mm_rcp_ps as estimate_reciprocal, _mm_set1_ps as splat, _mm_setzero_ps as zeros,
    _mm_sub_ps as sub, _mm_xor_ps as bit_xor,
};
use core::arch::x86_64::{
    __m128d, _mm_blendv_ps, _mm_castps_si128, _mm_castsi128_ps, _mm_cmpgt_epi32, _mm_cvtpd_ps,
    _mm_cvtps_pd, _mm_loadu_ps, _mm_movehl_ps, _mm_movelh_ps, _mm_movemask_ps, _mm_mul_pd,
    _mm_set1_epi32, _mm_storeu_ps, _mm_sub_pd,
};

/// Rays in a vector.
pub const LANES: usize = 4;

/// Has the compiler align the frame of the kernel that this is called in to whole vectors, so that every vector which
/// is kept on the stack lies in one line of the cache. Here the ABI does: frames are aligned to 16 bytes.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn align_frame() {}

/// Row `row` of `lanes`: its elements `4 * row .. 4 * row + 4`.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn load<const N: usize>(lanes: &[f32; N], row: usize) -> Vector {
    let row = &lanes.as_chunks::<LANES>().0[row];
    // SAFETY: `row` is a reference to four floats; the load needs no alignment.
    unsafe { _mm_loadu_ps(row.as_ptr()) }
}

/// Overwrites row `row` of `lanes`.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn store<const N: usize>(lanes: &mut [f32; N], row: usize, value: Vector) {
    let row = &mut lanes.as_chunks_mut::<LANES>().0[row];
    // SAFETY: `row` is a reference to four floats; the store needs no alignment.
    unsafe { _mm_storeu_ps(row.as_mut_ptr(), value) }
}

/// Row `row` of `lanes`, the bits as they are.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn load_bits<const N: usize>(lanes: &[u32; N], row: usize) -> Vector {
    let row = &lanes.as_chunks::<LANES>().0[row];
    // SAFETY: `row` is a reference to four numbers of 32 bits; the load needs no alignment.
    unsafe { _mm_loadu_ps(row.as_ptr().cast()) }
}

/// Overwrites row `row` of `lanes` with bits.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn store_bits<const N: usize>(lanes: &mut [u32; N], row: usize, value: Vector) {
    let row = &mut lanes.as_chunks_mut::<LANES>().0[row];
    // SAFETY: `row` is a reference to four numbers of 32 bits; the store needs no alignment.
    unsafe { _mm_storeu_ps(row.as_mut_ptr().cast(), value) }
}

/// The lanes as an array.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn to_array(a: Vector) -> [f32; LANES] {
    let mut lanes = [0.0; LANES];
    store(&mut lanes, 0, a);
    lanes
}

/// `a * b + c`. Here both operations round; where they are one instruction that rounds once, so
/// kernels that have this word may answer otherwise there, and portable ones have none.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn mul_add(a: Vector, b: Vector, c: Vector) -> Vector {
    add(mul(a, b), c)
}

/// `a * b - c`, as [`mul_add`].
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn mul_sub(a: Vector, b: Vector, c: Vector) -> Vector {
    sub(mul(a, b), c)
}

/// `c - a * b`, as [`mul_add`].
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn neg_mul_add(a: Vector, b: Vector, c: Vector) -> Vector {
    sub(c, mul(a, b))
}

/// A mask that is true in every lane.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn all_true() -> Mask {
    _mm_castsi128_ps(_mm_set1_epi32(-1))
}

/// `a`, its sign changed where the sign bit of `b` is set.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn flip_sign(a: Vector, b: Vector) -> Vector {
    bit_xor(a, both(b, splat(-0.0)))
}

/// True in the lanes whose sign bit is clear.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn sign_is_clear(a: Vector) -> Mask {
    _mm_castsi128_ps(_mm_cmpgt_epi32(_mm_castps_si128(a), _mm_set1_epi32(-1)))
}

/// `a` where `mask` is true, `b` elsewhere.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn select(mask: Mask, a: Vector, b: Vector) -> Vector {
    _mm_blendv_ps(b, a, mask)
}

/// Whether `mask` is false in every lane.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn is_empty(mask: Mask) -> bool {
    _mm_movemask_ps(mask) == 0
}

/// The lanes in which `mask` is true, lane 0 in the lowest bit.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn bits(mask: Mask) -> u32 {
    _mm_movemask_ps(mask) as u32
}

/// The same packet, of which nothing is known: what has been loaded of it is loaded again.
///
/// Without this a compiler keeps in registers what is used after an exit as well as before it,
/// though hardly any row goes on after an exit. An instruction that overwrites one of its operands
/// makes that dear.
#[inline]
pub fn afresh<P>(packet: &mut P) -> &mut P {
    core::hint::black_box(packet)
}

/// `a * b - c * d` in twice the precision, in which products are exact: the sign is right.
#[target_feature(enable = "sse4.1")]
#[inline]
pub fn exact_difference(a: Vector, b: Vector, c: Vector, d: Vector) -> Vector {
    let low = wide_difference(low(a), low(b), low(c), low(d));
    let high = wide_difference(high(a), high(b), high(c), high(d));
    _mm_movelh_ps(low, high)
}

/// The lower half of the lanes, widened.
#[target_feature(enable = "sse4.1")]
#[inline]
fn low(a: Vector) -> __m128d {
    _mm_cvtps_pd(a)
}

/// The upper half of the lanes, widened.
#[target_feature(enable = "sse4.1")]
#[inline]
fn high(a: Vector) -> __m128d {
    _mm_cvtps_pd(_mm_movehl_ps(a, a))
}

/// `a * b - c * d`, narrowed again.
#[target_feature(enable = "sse4.1")]
#[inline]
fn wide_difference(a: __m128d, b: __m128d, c: __m128d, d: __m128d) -> Vector {
    _mm_cvtpd_ps(_mm_sub_pd(_mm_mul_pd(a, b), _mm_mul_pd(c, d)))
}

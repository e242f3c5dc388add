//! Lanes of the AVX-512 kernels: what every instruction set offers, in the words that kernels are
//! written in.
//!
//! `mul_add(a, b, c)` is `a * b + c`, `mul_sub(a, b, c)` is `a * b - c` and `neg_mul_add(a, b, c)`
//! is `c - a * b`, rounded once. Sets without these instructions round the product as well, so
//! kernels that have such words may answer otherwise there, and portable ones have none.

use core::arch::asm;
use core::arch::x86_64::{
    __m256, __m512d, _CMP_LE_OQ, _CMP_LT_OQ, _mm512_castps_si512, _mm512_castps256_ps512,
    _mm512_and_ps, _mm512_castps512_ps256, _mm512_cmp_ps_mask, _mm512_cvtpd_ps, _mm512_cvtps_pd,
    _mm512_extractf32x8_ps, _mm512_insertf32x8, _mm512_loadu_ps, _mm512_mask_blend_ps,
    _mm512_movepi32_mask, _mm512_mul_pd, _mm512_storeu_ps, _mm512_sub_pd,
};
#[allow(unused_imports, reason = "some kernels take others than the rest")]
pub use core::arch::x86_64::{
    __m512 as Vector, __mmask16 as Mask, _mm512_add_ps as add, _mm512_div_ps as div,
    _mm512_fmadd_ps as mul_add, _mm512_fmsub_ps as mul_sub, _mm512_fnmadd_ps as neg_mul_add,
    _mm512_max_ps as max, _mm512_min_ps as min, _mm512_mul_ps as mul, _mm512_or_ps as bit_or,
    _mm512_rcp14_ps as estimate_reciprocal, _mm512_set1_ps as splat, _mm512_setzero_ps as zeros,
    _mm512_sub_ps as sub, _mm512_xor_ps as bit_xor,
};
use core::mem::MaybeUninit;

/// Rays in a vector.
pub const LANES: usize = 16;

/// Has the compiler align the frame of the kernel that this is called in to whole vectors, so that every vector which
/// is kept on the stack lies in one line of the cache.
///
/// The ABI aligns frames to 16 bytes. A compiler aligns one further for a variable that needs it, not for registers
/// that it later has to spill: many of those would straddle lines and, at some depths of the stack, a page.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn align_frame() {
    let place = MaybeUninit::<Vector>::uninit();
    // SAFETY: there is no instruction in it; it only gives the place an address.
    unsafe { asm!("/* {0} */", in(reg) (&raw const place).addr(), options(nomem, nostack, preserves_flags)) }
}

/// Row `row` of `lanes`: its elements `16 * row .. 16 * row + 16`.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn load<const N: usize>(lanes: &[f32; N], row: usize) -> Vector {
    let row = &lanes.as_chunks::<LANES>().0[row];
    // SAFETY: `row` is a reference to 16 floats; the load needs no alignment.
    unsafe { _mm512_loadu_ps(row.as_ptr()) }
}

/// Overwrites row `row` of `lanes`.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn store<const N: usize>(lanes: &mut [f32; N], row: usize, value: Vector) {
    let row = &mut lanes.as_chunks_mut::<LANES>().0[row];
    // SAFETY: `row` is a reference to 16 floats; the store needs no alignment.
    unsafe { _mm512_storeu_ps(row.as_mut_ptr(), value) }
}

/// Row `row` of `lanes`, the bits as they are.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn load_bits<const N: usize>(lanes: &[u32; N], row: usize) -> Vector {
    let row = &lanes.as_chunks::<LANES>().0[row];
    // SAFETY: `row` is a reference to 16 numbers of 32 bits; the load needs no alignment.
    unsafe { _mm512_loadu_ps(row.as_ptr().cast()) }
}

/// Overwrites row `row` of `lanes` with bits.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn store_bits<const N: usize>(lanes: &mut [u32; N], row: usize, value: Vector) {
    let row = &mut lanes.as_chunks_mut::<LANES>().0[row];
    // SAFETY: `row` is a reference to 16 numbers of 32 bits; the store needs no alignment.
    unsafe { _mm512_storeu_ps(row.as_mut_ptr().cast(), value) }
}

/// The lanes as an array.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn to_array(a: Vector) -> [f32; LANES] {
    let mut lanes = [0.0; LANES];
    store(&mut lanes, 0, a);
    lanes
}

/// A mask that is true in every lane.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn all_true() -> Mask {
    !0
}

/// `a`, its sign changed where the sign bit of `b` is set.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn flip_sign(a: Vector, b: Vector) -> Vector {
    bit_xor(a, _mm512_and_ps(b, splat(-0.0)))
}

/// True in the lanes with `a < b`, which no NaN is.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn less(a: Vector, b: Vector) -> Mask {
    _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b)
}

/// True in the lanes with `a <= b`, which no NaN is.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn at_most(a: Vector, b: Vector) -> Mask {
    _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b)
}

/// True where both masks are.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn both(a: Mask, b: Mask) -> Mask {
    a & b
}

/// True where one of the masks is.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn either(a: Mask, b: Mask) -> Mask {
    a | b
}

/// True in the lanes whose sign bit is clear.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn sign_is_clear(a: Vector) -> Mask {
    !_mm512_movepi32_mask(_mm512_castps_si512(a))
}

/// `a` where `mask` is true, `b` elsewhere.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn select(mask: Mask, a: Vector, b: Vector) -> Vector {
    _mm512_mask_blend_ps(mask, b, a)
}

/// Whether `mask` is false in every lane.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn is_empty(mask: Mask) -> bool {
    mask == 0
}

/// The lanes in which `mask` is true, lane 0 in the lowest bit.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn bits(mask: Mask) -> u32 {
    u32::from(mask)
}

/// `a * b - c * d` in twice the precision, in which products are exact: the sign is right.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
pub fn exact_difference(a: Vector, b: Vector, c: Vector, d: Vector) -> Vector {
    let low = wide_difference(low(a), low(b), low(c), low(d));
    let high = wide_difference(high(a), high(b), high(c), high(d));
    _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high)
}

/// The lower half of the lanes, widened.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
fn low(a: Vector) -> __m512d {
    _mm512_cvtps_pd(_mm512_castps512_ps256(a))
}

/// The upper half of the lanes, widened.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
fn high(a: Vector) -> __m512d {
    _mm512_cvtps_pd(_mm512_extractf32x8_ps::<1>(a))
}

/// `a * b - c * d`, narrowed again.
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
#[inline]
fn wide_difference(a: __m512d, b: __m512d, c: __m512d, d: __m512d) -> __m256 {
    _mm512_cvtpd_ps(_mm512_sub_pd(_mm512_mul_pd(a, b), _mm512_mul_pd(c, d)))
}

//! Lanes of the AVX2 kernels: what every instruction set offers, in the words that kernels are
//! written in.
//!
//! `mul_add(a, b, c)` is `a * b + c`, `mul_sub(a, b, c)` is `a * b - c` and `neg_mul_add(a, b, c)`
//! is `c - a * b`, rounded once. Sets without these instructions round the product as well, so
//! kernels that have such words may answer otherwise there, and portable ones have none.

use core::arch::asm;
use core::arch::x86_64::{
    __m128, __m256d, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_blendv_ps, _mm256_castps_si256,
    _mm256_castps256_ps128, _mm256_castsi256_ps, _mm256_cmp_ps, _mm256_cmpgt_epi32,
    _mm256_cvtpd_ps, _mm256_cvtps_pd, _mm256_extractf128_ps, _mm256_loadu_ps, _mm256_movemask_ps,
    _mm256_mul_pd, _mm256_set_m128, _mm256_set1_epi32, _mm256_storeu_ps, _mm256_sub_pd,
};
#[allow(unused_imports, reason = "some kernels take others than the rest")]
pub use core::arch::x86_64::{
    __m256 as Vector, __m256 as Mask, _mm256_add_ps as add, _mm256_and_ps as both,
    _mm256_div_ps as div, _mm256_fmadd_ps as mul_add, _mm256_fmsub_ps as mul_sub,
    _mm256_fnmadd_ps as neg_mul_add, _mm256_max_ps as max, _mm256_min_ps as min,
    _mm256_mul_ps as mul, _mm256_or_ps as bit_or, _mm256_or_ps as either,
    _mm256_rcp_ps as estimate_reciprocal, _mm256_set1_ps as splat, _mm256_setzero_ps as zeros,
    _mm256_sub_ps as sub, _mm256_xor_ps as bit_xor,
};
use core::mem::MaybeUninit;

/// Rays in a vector.
pub const LANES: usize = 8;

/// Has the compiler align the frame of the kernel that this is called in to whole vectors, so that every vector which
/// is kept on the stack lies in one line of the cache.
///
/// The ABI aligns frames to 16 bytes. A compiler aligns one further for a variable that needs it, not for registers
/// that it later has to spill: many of those would straddle lines and, at some depths of the stack, a page.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn align_frame() {
    let place = MaybeUninit::<Vector>::uninit();
    // SAFETY: there is no instruction in it; it only gives the place an address.
    unsafe { asm!("/* {0} */", in(reg) (&raw const place).addr(), options(nomem, nostack, preserves_flags)) }
}

/// Row `row` of `lanes`: its elements `8 * row .. 8 * row + 8`.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn load<const N: usize>(lanes: &[f32; N], row: usize) -> Vector {
    let row = &lanes.as_chunks::<LANES>().0[row];
    // SAFETY: `row` is a reference to eight floats; the load needs no alignment.
    unsafe { _mm256_loadu_ps(row.as_ptr()) }
}

/// Overwrites row `row` of `lanes`.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn store<const N: usize>(lanes: &mut [f32; N], row: usize, value: Vector) {
    let row = &mut lanes.as_chunks_mut::<LANES>().0[row];
    // SAFETY: `row` is a reference to eight floats; the store needs no alignment.
    unsafe { _mm256_storeu_ps(row.as_mut_ptr(), value) }
}

/// Row `row` of `lanes`, the bits as they are.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn load_bits<const N: usize>(lanes: &[u32; N], row: usize) -> Vector {
    let row = &lanes.as_chunks::<LANES>().0[row];
    // SAFETY: `row` is a reference to eight numbers of 32 bits; the load needs no alignment.
    unsafe { _mm256_loadu_ps(row.as_ptr().cast()) }
}

/// Overwrites row `row` of `lanes` with bits.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn store_bits<const N: usize>(lanes: &mut [u32; N], row: usize, value: Vector) {
    let row = &mut lanes.as_chunks_mut::<LANES>().0[row];
    // SAFETY: `row` is a reference to eight numbers of 32 bits; the store needs no alignment.
    unsafe { _mm256_storeu_ps(row.as_mut_ptr().cast(), value) }
}

/// The lanes as an array.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn to_array(a: Vector) -> [f32; LANES] {
    let mut lanes = [0.0; LANES];
    store(&mut lanes, 0, a);
    lanes
}

/// A mask that is true in every lane.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn all_true() -> Mask {
    _mm256_castsi256_ps(_mm256_set1_epi32(-1))
}

/// `a`, its sign changed where the sign bit of `b` is set.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn flip_sign(a: Vector, b: Vector) -> Vector {
    bit_xor(a, both(b, splat(-0.0)))
}

/// True in the lanes with `a < b`, which no NaN is.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn less(a: Vector, b: Vector) -> Mask {
    _mm256_cmp_ps::<_CMP_LT_OQ>(a, b)
}

/// True in the lanes with `a <= b`, which no NaN is.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn at_most(a: Vector, b: Vector) -> Mask {
    _mm256_cmp_ps::<_CMP_LE_OQ>(a, b)
}

/// True in the lanes whose sign bit is clear.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn sign_is_clear(a: Vector) -> Mask {
    _mm256_castsi256_ps(_mm256_cmpgt_epi32(
        _mm256_castps_si256(a),
        _mm256_set1_epi32(-1),
    ))
}

/// `a` where `mask` is true, `b` elsewhere.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn select(mask: Mask, a: Vector, b: Vector) -> Vector {
    _mm256_blendv_ps(b, a, mask)
}

/// Whether `mask` is false in every lane.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn is_empty(mask: Mask) -> bool {
    _mm256_movemask_ps(mask) == 0
}

/// The lanes in which `mask` is true, lane 0 in the lowest bit.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn bits(mask: Mask) -> u32 {
    _mm256_movemask_ps(mask) as u32
}

/// `a * b - c * d` in twice the precision, in which products are exact: the sign is right.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub fn exact_difference(a: Vector, b: Vector, c: Vector, d: Vector) -> Vector {
    let low = wide_difference(low(a), low(b), low(c), low(d));
    let high = wide_difference(high(a), high(b), high(c), high(d));
    _mm256_set_m128(high, low)
}

/// The lower half of the lanes, widened.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn low(a: Vector) -> __m256d {
    _mm256_cvtps_pd(_mm256_castps256_ps128(a))
}

/// The upper half of the lanes, widened.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn high(a: Vector) -> __m256d {
    _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(a))
}

/// `a * b - c * d`, narrowed again.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn wide_difference(a: __m256d, b: __m256d, c: __m256d, d: __m256d) -> __m128 {
    _mm256_cvtpd_ps(_mm256_sub_pd(_mm256_mul_pd(a, b), _mm256_mul_pd(c, d)))
}

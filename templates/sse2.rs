//! Lanes of the SSE2 kernels: what a single intrinsic does not say.

#[allow(unused_imports, reason = "some kernels take others than the rest")]
pub use core::arch::x86_64::{
    __m128, _mm_add_ps, _mm_and_ps, _mm_andnot_ps, _mm_castps_si128, _mm_castsi128_ps,
    _mm_cmpge_ps, _mm_cmpgt_epi32, _mm_cmpgt_ps, _mm_cmple_ps, _mm_cmplt_ps, _mm_div_ps,
    _mm_loadu_ps, _mm_max_ps, _mm_min_ps, _mm_movemask_ps, _mm_mul_ps, _mm_or_ps, _mm_rcp_ps,
    _mm_set1_epi32, _mm_set1_ps, _mm_setzero_ps, _mm_storeu_ps, _mm_sub_ps, _mm_xor_ps,
};

/// Rays in a vector.
pub const LANES: usize = 4;

/// Row `row` of `lanes`: its elements `4 * row .. 4 * row + 4`.
#[target_feature(enable = "sse2")]
#[inline]
pub fn load<const N: usize>(lanes: &[f32; N], row: usize) -> __m128 {
    let row = &lanes.as_chunks::<LANES>().0[row];
    // SAFETY: `row` is a reference to four floats; the load needs no alignment.
    unsafe { _mm_loadu_ps(row.as_ptr()) }
}

/// Overwrites row `row` of `lanes`.
#[target_feature(enable = "sse2")]
#[inline]
pub fn store<const N: usize>(lanes: &mut [f32; N], row: usize, value: __m128) {
    let row = &mut lanes.as_chunks_mut::<LANES>().0[row];
    // SAFETY: `row` is a reference to four floats; the store needs no alignment.
    unsafe { _mm_storeu_ps(row.as_mut_ptr(), value) }
}

/// A mask that is true in every lane.
#[target_feature(enable = "sse2")]
#[inline]
pub fn all_true() -> __m128 {
    _mm_castsi128_ps(_mm_set1_epi32(-1))
}

/// True in the lanes whose sign bit is clear.
#[target_feature(enable = "sse2")]
#[inline]
pub fn sign_is_clear(a: __m128) -> __m128 {
    _mm_castsi128_ps(_mm_cmpgt_epi32(_mm_castps_si128(a), _mm_set1_epi32(-1)))
}

/// `a` where `mask` is true, `b` elsewhere.
#[target_feature(enable = "sse2")]
#[inline]
pub fn select(mask: __m128, a: __m128, b: __m128) -> __m128 {
    _mm_or_ps(_mm_and_ps(mask, a), _mm_andnot_ps(mask, b))
}

/// Whether `mask` is false in every lane.
#[target_feature(enable = "sse2")]
#[inline]
pub fn is_empty(mask: __m128) -> bool {
    _mm_movemask_ps(mask) == 0
}

/// The same packet, of which nothing is known: what has been loaded of it is loaded again.
///
/// Without this a compiler keeps in registers what is used after an exit as well as before it,
/// though hardly any row goes on after an exit.
#[inline]
pub fn afresh<P>(packet: &mut P) -> &mut P {
    core::hint::black_box(packet)
}

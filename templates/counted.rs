//! Words of lanes that count how often they are used, around the words that an instruction set spells: the
//! ones that are arithmetic. A kernel compiled with these answers as it does without, and takes as many.

pub use super::spelled::*;
use super::spelled;

/// How often each word was used, in the order of the list below.
pub static mut COUNTS: [u64; 20] = [0; 20];

/// Defines words that count themselves.
macro_rules! counted {
    ($($place:literal $word:ident($($operand:ident: $type:ty),*) -> $result:ty;)+) => {$(
        #[target_feature(enable = "counted")]
        #[inline]
        pub fn $word($($operand: $type),*) -> $result {
            // SAFETY: kernels with these words run on one thread, and whoever reads the counts waits.
            unsafe { COUNTS[$place] += 1 }
            spelled::$word($($operand),*)
        }
    )+};
}

counted! {
    0 add(a: Vector, b: Vector) -> Vector;
    1 sub(a: Vector, b: Vector) -> Vector;
    2 mul(a: Vector, b: Vector) -> Vector;
    3 mul_add(a: Vector, b: Vector, c: Vector) -> Vector;
    4 mul_sub(a: Vector, b: Vector, c: Vector) -> Vector;
    5 neg_mul_add(a: Vector, b: Vector, c: Vector) -> Vector;
    6 div(a: Vector, b: Vector) -> Vector;
    7 estimate_reciprocal(a: Vector) -> Vector;
    8 min(a: Vector, b: Vector) -> Vector;
    9 max(a: Vector, b: Vector) -> Vector;
    10 less(a: Vector, b: Vector) -> Mask;
    11 at_most(a: Vector, b: Vector) -> Mask;
    12 both(a: Mask, b: Mask) -> Mask;
    13 either(a: Mask, b: Mask) -> Mask;
    14 select(mask: Mask, a: Vector, b: Vector) -> Vector;
    15 flip_sign(a: Vector, b: Vector) -> Vector;
    16 sign_is_clear(a: Vector) -> Mask;
    17 bit_or(a: Vector, b: Vector) -> Vector;
    18 bit_xor(a: Vector, b: Vector) -> Vector;
    19 exact_difference(a: Vector, b: Vector, c: Vector, d: Vector) -> Vector;
}

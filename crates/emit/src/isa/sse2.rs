//! SSE2, four lanes.

use program::{Binary, Unary};

use super::Spelling;

pub(super) static SPELLING: Spelling = Spelling {
    name: "sse2",
    features: "sse2",
    lanes: include_str!("../../../../templates/sse2.rs"),
    splat: |number| format!("_mm_set1_ps({number})"),
    zero: "_mm_setzero_ps()",
    both: |a, b| format!("_mm_and_ps({a}, {b})"),
    unary,
    binary,
};

fn unary(op: Unary, a: &str) -> String {
    let function = match op {
        Unary::Estimate => "_mm_rcp_ps",
        Unary::SignIsClear => "sign_is_clear",
    };
    format!("{function}({a})")
}

fn binary(op: Binary, a: &str, b: &str) -> String {
    let function = match op {
        Binary::Add => "_mm_add_ps",
        Binary::Sub => "_mm_sub_ps",
        Binary::Mul => "_mm_mul_ps",
        Binary::Div => "_mm_div_ps",
        Binary::Min => "_mm_min_ps",
        Binary::Max => "_mm_max_ps",
        Binary::Less => "_mm_cmplt_ps",
        Binary::AtMost => "_mm_cmple_ps",
        Binary::Either | Binary::BitOr => "_mm_or_ps",
        Binary::BitXor => "_mm_xor_ps",
    };
    format!("{function}({a}, {b})")
}

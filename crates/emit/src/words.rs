//! What operations and values are called in printed code.

use program::{Binary, Op, Quantity, Ternary, Unary};
use volumes::Vector;

/// The word for an operation of one number.
pub(crate) fn unary(op: Unary) -> &'static str {
    match op {
        Unary::Estimate => "estimate_reciprocal",
        Unary::SignIsClear => "sign_is_clear",
    }
}

/// The word for an operation of two.
pub(crate) fn binary(op: Binary) -> &'static str {
    match op {
        Binary::Add => "add",
        Binary::Sub => "sub",
        Binary::Mul => "mul",
        Binary::Div => "div",
        Binary::Min => "min",
        Binary::Max => "max",
        Binary::Less => "less",
        Binary::AtMost => "at_most",
        Binary::Either => "either",
        Binary::Both => "both",
        Binary::BitOr => "bit_or",
        Binary::BitXor => "bit_xor",
        Binary::FlipSign => "flip_sign",
    }
}

/// The word for an operation of three.
pub(crate) fn ternary(op: Ternary) -> &'static str {
    match op {
        Ternary::MulAdd => "mul_add",
        Ternary::MulSub => "mul_sub",
        Ternary::NegMulAdd => "neg_mul_add",
    }
}

/// Axes, as components are called.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// The intermediate value of an operation that has one: an estimate of a reciprocal, or a product of
/// a difference.
pub(crate) fn intermediate(op: Op) -> &'static str {
    match op {
        Op::Reciprocal(_) => "estimate",
        _ => "product",
    }
}

/// The variable that holds a quantity; vectors have a component's letter behind it.
pub(crate) fn variable(quantity: Quantity) -> String {
    let vector = |vector: Vector| match vector {
        Vector::Edge(edge) => format!("{}_{}", edge.to, edge.from),
        Vector::Direction => "d".into(),
    };
    match quantity {
        Quantity::Point(point) => point.to_string(),
        Quantity::Vector(Vector::Direction) => "d".into(),
        Quantity::Vector(edge) => format!("edge_{}", vector(edge)),
        Quantity::Cross(cross) => {
            format!("cross_{}_by_{}", vector(cross.left), vector(cross.right))
        }
        Quantity::Volume(volume) => format!("volume_{}", volume.name()),
        Quantity::PairSum(side) => {
            let [j, k] = side.others().map(|other| other.volume().name());
            format!("volumes_{j}_{k}")
        }
        Quantity::SquareOfV => "v_squared".into(),
        Quantity::ProductVaV => "va_times_v".into(),
        Quantity::ReciprocalOfV => "reciprocal".into(),
        Quantity::T => "t".into(),
        Quantity::Barycentric(side) => side.barycentric().into(),
        Quantity::TMax => "t_max".into(),
        Quantity::Zero => "zero".into(),
        Quantity::One => "one".into(),
        Quantity::Magnitudes => "magnitude".into(),
        Quantity::Along(axis) => format!("along_{axis}"),
        Quantity::Longest => "longest".into(),
        Quantity::Row(axis) => format!("row_{axis}"),
        Quantity::Sheared(point, axis) => format!("sheared_{point}_{axis}"),
        Quantity::Rounded(side) => format!("rounded_{}", side.volume().name()),
        Quantity::Mask | Quantity::Tested(_) => "mask".into(),
        Quantity::Stored => unreachable!("nothing reads a store"),
    }
}

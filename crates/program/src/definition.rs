//! The arithmetic of every operation, given once: the interpreter evaluates it, every
//! instruction set spells it.

use crate::op::{On, Op, Reciprocal, SameSign, SideTest, Summation};

/// An operation of two numbers, two masks or the bits of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// Sum.
    Add,
    /// Difference.
    Sub,
    /// Product.
    Mul,
    /// Quotient, rounded once.
    Div,
    /// The lesser; the second if either is NaN.
    Min,
    /// The greater; the second if either is NaN.
    Max,
    /// Mask: `a < b`, false for NaN.
    Less,
    /// Mask: `a <= b`, false for NaN.
    AtMost,
    /// Either of two masks.
    Either,
    /// Both of two masks.
    Both,
    /// Bitwise or of two numbers.
    BitOr,
    /// Bitwise exclusive or of two numbers.
    BitXor,
    /// The first, its sign changed if the second's sign bit is set.
    FlipSign,
}

/// An operation of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// The processor's estimate of the reciprocal, good to 12 bits or more.
    Estimate,
    /// Mask: the sign bit is clear.
    SignIsClear,
}

/// An operation of three numbers: a multiplication and an addition rounded once, as by the
/// processor's fused instructions. On instruction sets that have none both are rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ternary {
    /// `a · b + c`.
    MulAdd,
    /// `a · b - c`.
    MulSub,
    /// `c - a · b`.
    NegMulAdd,
}

/// An expression over the operands of one statement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expr {
    /// An operand with a single component, by its index.
    Operand(usize),
    /// One axis (0, 1, 2) of a three-component operand.
    Component(usize, usize),
    /// The definition's intermediate value.
    Intermediate,
    /// One number in.
    Unary(Unary, Box<Expr>),
    /// Two in.
    Binary(Binary, Box<Expr>, Box<Expr>),
    /// Three in.
    Ternary(Ternary, Box<[Expr; 3]>),
    /// The second where the first, a mask, is true, the third elsewhere.
    Select(Box<[Expr; 3]>),
    /// `a · b - c · d` in twice the precision, then rounded.
    ExactDifference(Box<[Expr; 4]>),
}

/// What an operation computes of its operands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Definition {
    /// Reads its value from outside: a point, a direction, a bound.
    Input,
    /// A constant number.
    Constant(u8),
    /// The mask, true in every lane.
    AllTrue,
    /// Three components, one expression an axis.
    Vector([Expr; 3]),
    /// One number, or one mask that is a value like others.
    Scalar(Expr),
    /// One number by way of an intermediate one, computed first.
    ScalarVia {
        /// The intermediate value.
        intermediate: Expr,
        /// The value.
        result: Expr,
    },
    /// Keeps the rays for which this mask is true.
    Keep(Expr),
    /// Leaves if no ray is in question.
    Exit,
    /// Stores operand 0 as the new `t_max` where the mask is true, operand 1 elsewhere.
    Store,
    /// No code.
    Nothing,
}

impl Op {
    /// The operation's arithmetic; operands are numbered as in [`Op::quantity`].
    pub fn definition(self) -> Definition {
        use Binary::{Add, AtMost, BitOr, BitXor, Div, Either, FlipSign, Less, Max, Min, Mul, Sub};
        use Ternary::{MulAdd, MulSub, NegMulAdd};
        let [o0, o1, o2, o3] = [0, 1, 2, 3].map(Expr::Operand);
        match self {
            Op::Load(_) | Op::LoadEdge(_) | Op::LoadDirection | Op::LoadTMax => Definition::Input,
            Op::Zero => Definition::Constant(0),
            Op::One => Definition::Constant(1),
            Op::Mask => Definition::AllTrue,
            Op::Edge => Definition::Vector([0, 1, 2].map(|axis| {
                let component = |operand| Expr::Component(operand, axis);
                binary(Sub, component(0), component(1))
            })),
            Op::Cross | Op::FusedCross => Definition::Vector([0, 1, 2].map(|axis| {
                let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
                let [left, right] =
                    [(j, k), (k, j)].map(|(j, k)| [Expr::Component(0, j), Expr::Component(1, k)]);
                match self {
                    Op::FusedCross => ternary(MulSub, left, product(right)),
                    _ => binary(Sub, product(left), product(right)),
                }
            })),
            Op::Volume(_, summation) => {
                let factors = [0, 1, 2].map(|axis| [0, 1].map(|one| Expr::Component(one, axis)));
                Definition::Scalar(dot(factors, summation))
            }
            Op::SumOfSides => Definition::Scalar(binary(Add, binary(Add, o0, o1), o2)),
            Op::Rest(_) | Op::BarycentricRest(_) => {
                Definition::Scalar(binary(Sub, binary(Sub, o0, o1), o2))
            }
            Op::DifferenceOfEnds => Definition::Scalar(binary(Sub, o0, o1)),
            Op::PairSum(_) => Definition::Scalar(binary(Add, o0, o1)),
            Op::Square => Definition::Scalar(binary(Mul, o0.clone(), o0)),
            Op::Product | Op::TMultiply | Op::BarycentricMultiply(_) => {
                Definition::Scalar(binary(Mul, o0, o1))
            }
            Op::Reciprocal(Reciprocal::Exact) | Op::TDivide => {
                Definition::Scalar(binary(Div, o0, o1))
            }
            Op::Reciprocal(Reciprocal::Newton) => {
                // r' = 2r - r²V, as the appendix of Kensler-Shirley writes it.
                let r = Expr::Intermediate;
                let twice = binary(Add, r.clone(), r.clone());
                let square = binary(Mul, r.clone(), r);
                Definition::ScalarVia {
                    intermediate: unary(Unary::Estimate, o0.clone()),
                    result: binary(Sub, twice, binary(Mul, square, o0)),
                }
            }
            Op::Reciprocal(Reciprocal::FusedNewton) => {
                let r = Expr::Intermediate;
                let remainder = ternary(NegMulAdd, [r.clone(), o1.clone()], o0);
                Definition::ScalarVia {
                    intermediate: unary(Unary::Estimate, o1),
                    result: ternary(MulAdd, [r.clone(), remainder], r),
                }
            }
            Op::Near(On::Quotient | On::Product) => Definition::Keep(binary(Less, o1, o2)),
            Op::Near(On::Signs) => Definition::Keep(binary(Less, o1, binary(FlipSign, o2, o3))),
            Op::Side(_, SideTest::Signs) => Definition::Keep(same_sign_bit(binary(BitXor, o1, o2))),
            Op::Ends => Definition::Keep(binary(AtMost, binary(FlipSign, o2, o3), o1)),
            Op::Far(On::Quotient) => Definition::Keep(binary(Less, o1, o2)),
            Op::Far(_) => Definition::Keep(binary(Less, o1, binary(Mul, o2, o3))),
            Op::Side(_, SideTest::Quotient) => Definition::Keep(binary(AtMost, o2, o1)),
            Op::Side(_, SideTest::Product) => {
                Definition::Keep(binary(AtMost, o3, binary(Mul, o1, o2)))
            }
            Op::Side(_, SideTest::Sum) => Definition::Keep(binary(AtMost, binary(Mul, o1, o2), o3)),
            Op::SameSign(SameSign::Bits) => {
                let differ = binary(
                    BitOr,
                    binary(BitXor, o1.clone(), o2),
                    binary(BitXor, o1, o3),
                );
                Definition::Keep(same_sign_bit(differ))
            }
            Op::SameSign(SameSign::Ordered | SameSign::Rounded) => {
                let zero = Expr::Operand(4);
                let least = binary(Min, binary(Min, o1.clone(), o2.clone()), o3.clone());
                let greatest = binary(Max, binary(Max, o1, o2), o3);
                let positive = binary(AtMost, zero.clone(), least);
                let negative = binary(AtMost, greatest, zero);
                Definition::Keep(binary(Either, positive, negative))
            }
            Op::Shear(shear) => shear.definition(),
            Op::Exit => Definition::Exit,
            Op::Store => Definition::Store,
            Op::All | Op::Choice => Definition::Nothing,
        }
    }
}

fn unary(op: Unary, a: Expr) -> Expr {
    Expr::Unary(op, Box::new(a))
}

pub(crate) fn binary(op: Binary, a: Expr, b: Expr) -> Expr {
    Expr::Binary(op, Box::new(a), Box::new(b))
}

/// A fused operation of two factors and what their product is added to or subtracted from.
pub(crate) fn ternary(op: Ternary, [a, b]: [Expr; 2], c: Expr) -> Expr {
    Expr::Ternary(op, Box::new([a, b, c]))
}

pub(crate) fn product([a, b]: [Expr; 2]) -> Expr {
    binary(Binary::Mul, a, b)
}

/// The sum of three products.
fn dot([x, y, z]: [[Expr; 2]; 3], summation: Summation) -> Expr {
    use Binary::Add;
    use Ternary::MulAdd;
    match summation {
        Summation::XyZ => binary(Add, binary(Add, product(x), product(y)), product(z)),
        Summation::XYz => binary(Add, product(x), binary(Add, product(y), product(z))),
        Summation::FusedXyZ => ternary(MulAdd, z, ternary(MulAdd, y, product(x))),
        Summation::FusedXYz => ternary(MulAdd, x, ternary(MulAdd, y, product(z))),
    }
}

fn same_sign_bit(differing_bits: Expr) -> Expr {
    unary(Unary::SignIsClear, differing_bits)
}

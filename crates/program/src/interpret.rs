//! An interpreter: what a program answers for one ray and one triangle, in `f32` or `f64`.
//!
//! It is the meaning of a program without any instruction set, and evaluates the same
//! [`Definition`]s that are printed. In `f32` it rounds as the kernels do, but for the reciprocal
//! estimate: here that is the true reciprocal cut to 12 bits in `f32`, and the true one in `f64`.

use std::ops::{Add, Div, Mul, Sub};

use volumes::Point;

use crate::definition::{Binary, Definition, Expr, Unary};
use crate::op::Op;
use crate::statements::Program;

/// A number that programs can be run on.
pub trait Real:
    Copy
    + PartialOrd
    + From<u8>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// An estimate of the reciprocal, as a processor might give.
    fn estimate_reciprocal(self) -> Self;
    /// Whether the sign bit is clear.
    fn sign_is_clear(self) -> bool;
    /// Exclusive or of the bits.
    fn bit_xor(self, other: Self) -> Self;
    /// Or of the bits.
    fn bit_or(self, other: Self) -> Self;
}

impl Real for f32 {
    fn estimate_reciprocal(self) -> f32 {
        let kept_bits = !((1 << 12) - 1);
        f32::from_bits((1.0 / self).to_bits() & kept_bits)
    }

    fn sign_is_clear(self) -> bool {
        self.is_sign_positive()
    }

    fn bit_xor(self, other: f32) -> f32 {
        f32::from_bits(self.to_bits() ^ other.to_bits())
    }

    fn bit_or(self, other: f32) -> f32 {
        f32::from_bits(self.to_bits() | other.to_bits())
    }
}

impl Real for f64 {
    fn estimate_reciprocal(self) -> f64 {
        1.0 / self
    }

    fn sign_is_clear(self) -> bool {
        self.is_sign_positive()
    }

    fn bit_xor(self, other: f64) -> f64 {
        f64::from_bits(self.to_bits() ^ other.to_bits())
    }

    fn bit_or(self, other: f64) -> f64 {
        f64::from_bits(self.to_bits() | other.to_bits())
    }
}

/// A ray: `a + t·d` for `0 < t < t_max`.
#[derive(Clone, Copy, Debug)]
pub struct Ray<F> {
    /// Origin.
    pub a: [F; 3],
    /// Direction, of any length.
    pub d: [F; 3],
    /// Upper bound of `t`.
    pub t_max: F,
}

/// A triangle by its vertices.
#[derive(Clone, Copy, Debug)]
pub struct Triangle<F> {
    /// First vertex.
    pub p0: [F; 3],
    /// Second vertex.
    pub p1: [F; 3],
    /// Third vertex.
    pub p2: [F; 3],
}

/// The value of a statement.
#[derive(Clone, Copy)]
enum Value<F> {
    Vector([F; 3]),
    Scalar(F),
    /// Tests narrow one mask, which is kept apart.
    None,
}

/// The value of an expression.
enum Evaluated<F> {
    Number(F),
    Mask(bool),
}

impl<F> Evaluated<F> {
    fn number(self) -> F {
        match self {
            Evaluated::Number(number) => number,
            Evaluated::Mask(_) => unreachable!("definitions do not compute with masks"),
        }
    }

    fn mask(self) -> bool {
        match self {
            Evaluated::Mask(mask) => mask,
            Evaluated::Number(_) => unreachable!("definitions do not test numbers"),
        }
    }
}

impl Program {
    /// The `t` that the program stores, or `None` if the ray misses the triangle.
    pub fn run<F: Real>(&self, ray: &Ray<F>, triangle: &Triangle<F>) -> Option<F> {
        let mut values: Vec<Value<F>> = Vec::with_capacity(self.statements().len());
        let mut mask = true;
        for (index, statement) in self.statements().iter().enumerate() {
            let scope = Scope {
                program: self,
                index,
                values: &values,
            };
            let value = match statement.op.definition() {
                Definition::Input => input(statement.op, ray, triangle),
                Definition::Constant(constant) => Value::Scalar(F::from(constant)),
                Definition::AllTrue => {
                    mask = true;
                    Value::None
                }
                Definition::Vector(components) => {
                    Value::Vector(components.map(|expr| scope.evaluate(&expr, None).number()))
                }
                Definition::Scalar(expr) => Value::Scalar(scope.evaluate(&expr, None).number()),
                Definition::ScalarVia {
                    intermediate,
                    result,
                } => {
                    let intermediate = scope.evaluate(&intermediate, None).number();
                    Value::Scalar(scope.evaluate(&result, Some(intermediate)).number())
                }
                Definition::Keep(expr) => {
                    mask &= scope.evaluate(&expr, None).mask();
                    Value::None
                }
                Definition::Exit => {
                    if !mask {
                        return None;
                    }
                    Value::None
                }
                Definition::Store => return mask.then(|| scope.scalar(0)),
                Definition::Nothing => unreachable!("a program has only statements"),
            };
            values.push(value);
        }
        unreachable!("a program ends with a store")
    }
}

fn input<F: Real>(op: Op, ray: &Ray<F>, triangle: &Triangle<F>) -> Value<F> {
    match op {
        Op::Load(Point::A) => Value::Vector(ray.a),
        Op::Load(Point::P0) => Value::Vector(triangle.p0),
        Op::Load(Point::P1) => Value::Vector(triangle.p1),
        Op::Load(Point::P2) => Value::Vector(triangle.p2),
        Op::LoadDirection => Value::Vector(ray.d),
        Op::LoadTMax => Value::Scalar(ray.t_max),
        _ => unreachable!("{op} is no input"),
    }
}

/// The operands of one statement.
struct Scope<'a, F> {
    program: &'a Program,
    index: usize,
    values: &'a [Value<F>],
}

impl<F: Real> Scope<'_, F> {
    fn scalar(&self, operand: usize) -> F {
        match self.values[self.program.operand(self.index, operand)] {
            Value::Scalar(scalar) => scalar,
            _ => unreachable!("checked programs have fitting operands"),
        }
    }

    fn component(&self, operand: usize, axis: usize) -> F {
        match self.values[self.program.operand(self.index, operand)] {
            Value::Vector(vector) => vector[axis],
            _ => unreachable!("checked programs have fitting operands"),
        }
    }

    fn evaluate(&self, expr: &Expr, intermediate: Option<F>) -> Evaluated<F> {
        use Evaluated::{Mask, Number};
        match expr {
            Expr::Operand(operand) => Number(self.scalar(*operand)),
            Expr::Component(operand, axis) => Number(self.component(*operand, *axis)),
            Expr::Intermediate => Number(intermediate.expect("computed before its use")),
            Expr::Unary(op, a) => {
                let a = self.evaluate(a, intermediate).number();
                match op {
                    Unary::Estimate => Number(a.estimate_reciprocal()),
                    Unary::SignIsClear => Mask(a.sign_is_clear()),
                }
            }
            Expr::Binary(Binary::Either, a, b) => {
                let a = self.evaluate(a, intermediate).mask();
                Mask(self.evaluate(b, intermediate).mask() || a)
            }
            Expr::Binary(op, a, b) => {
                let a = self.evaluate(a, intermediate).number();
                let b = self.evaluate(b, intermediate).number();
                match op {
                    Binary::Add => Number(a + b),
                    Binary::Sub => Number(a - b),
                    Binary::Mul => Number(a * b),
                    Binary::Div => Number(a / b),
                    Binary::Min => Number(if a < b { a } else { b }),
                    Binary::Max => Number(if a > b { a } else { b }),
                    Binary::Less => Mask(a < b),
                    Binary::AtMost => Mask(a <= b),
                    Binary::BitOr => Number(a.bit_or(b)),
                    Binary::BitXor => Number(a.bit_xor(b)),
                    Binary::Either => unreachable!("matched above"),
                }
            }
        }
    }
}

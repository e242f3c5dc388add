//! An interpreter: what a program answers for one ray and one triangle, in `f32` or `f64`.
//!
//! It is the meaning of a program without any instruction set, and evaluates the same
//! [`Definition`]s that are printed. In `f32` it rounds as the kernels do, fused operations once,
//! but for the reciprocal estimate: here that is the true reciprocal cut to 12 bits in `f32`, and
//! the true one in `f64`.

use std::ops::{Add, Div, Mul, Neg, Sub};

use volumes::{Point, Volume};

use crate::definition::{Binary, Definition, Expr, Ternary, Unary};
use crate::op::{Op, StoredEdge};
use crate::quantity::Quantity;
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
    + Neg<Output = Self>
{
    /// `self · factor + addend`, rounded once.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// An estimate of the reciprocal, as a processor might give.
    fn estimate_reciprocal(self) -> Self;
    /// Whether the sign bit is clear.
    fn sign_is_clear(self) -> bool;
    /// Exclusive or of the bits.
    fn bit_xor(self, other: Self) -> Self;
    /// Or of the bits.
    fn bit_or(self, other: Self) -> Self;
    /// `self · b - c · d`, with the sign of the exact difference.
    fn exact_difference(self, b: Self, c: Self, d: Self) -> Self;
}

impl Real for f32 {
    fn mul_add(self, factor: f32, addend: f32) -> f32 {
        f32::mul_add(self, factor, addend)
    }

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

    fn exact_difference(self, b: f32, c: f32, d: f32) -> f32 {
        let [a, b, c, d] = [self, b, c, d].map(f64::from);
        (a * b - c * d) as f32
    }
}

impl Real for f64 {
    fn mul_add(self, factor: f64, addend: f64) -> f64 {
        f64::mul_add(self, factor, addend)
    }

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

    fn exact_difference(self, b: f64, c: f64, d: f64) -> f64 {
        let rounded = c * d;
        f64::mul_add(self, b, -rounded) + f64::mul_add(-c, d, rounded)
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
    Mask(bool),
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
        let mut run = Run::new(self, ray, triangle);
        for (index, statement) in self.statements().iter().enumerate() {
            if statement.op == Op::Exit && !run.mask {
                return None;
            }
            run.step(index);
        }
        let store = self.statements().len() - 1;
        run.mask.then(|| run.scope(store).operand(0).number())
    }

    /// The value that the program computes for a volume of a ray and a triangle, whether the ray
    /// leaves before or not; `None` if the program does not have that volume.
    pub fn volume<F: Real>(
        &self,
        volume: Volume,
        ray: &Ray<F>,
        triangle: &Triangle<F>,
    ) -> Option<F> {
        let mut quantities = self.quantities().iter();
        let place = quantities.position(|&quantity| quantity == Quantity::Volume(volume))?;
        let mut run = Run::new(self, ray, triangle);
        for index in 0..=place {
            run.step(index);
        }
        match run.values[place] {
            Value::Scalar(value) => Some(value),
            _ => unreachable!("a volume is a number"),
        }
    }
}

/// A program while it runs.
struct Run<'a, F> {
    program: &'a Program,
    ray: &'a Ray<F>,
    triangle: &'a Triangle<F>,
    /// Of the statements that have run.
    values: Vec<Value<F>>,
    /// Whether the ray is still in question.
    mask: bool,
}

impl<'a, F: Real> Run<'a, F> {
    fn new(program: &'a Program, ray: &'a Ray<F>, triangle: &'a Triangle<F>) -> Self {
        Run {
            program,
            ray,
            triangle,
            values: Vec::with_capacity(program.statements().len()),
            mask: true,
        }
    }

    fn scope(&self, index: usize) -> Scope<'_, F> {
        Scope {
            program: self.program,
            index,
            values: &self.values,
        }
    }

    /// Runs the statement `index`, after all before it.
    fn step(&mut self, index: usize) {
        let op = self.program.statements()[index].op;
        let scope = self.scope(index);
        let number = |expr: &Expr, via: Option<F>| scope.evaluate(expr, via).number();
        let value = match op.definition() {
            Definition::Input => input(op, self.ray, self.triangle),
            Definition::Constant(constant) => Value::Scalar(F::from(constant)),
            Definition::Vector(components) => {
                Value::Vector(components.map(|expr| number(&expr, None)))
            }
            Definition::Scalar(expr) => match scope.evaluate(&expr, None) {
                Evaluated::Number(number) => Value::Scalar(number),
                Evaluated::Mask(mask) => Value::Mask(mask),
            },
            Definition::ScalarVia {
                intermediate,
                result,
            } => {
                let via = number(&intermediate, None);
                Value::Scalar(number(&result, Some(via)))
            }
            Definition::Keep(expr) => {
                self.mask &= scope.evaluate(&expr, None).mask();
                Value::None
            }
            // The mask is true before the first test, and nothing else makes it true.
            Definition::AllTrue | Definition::Exit | Definition::Store => Value::None,
            Definition::Nothing => unreachable!("a program has only statements"),
        };
        self.values.push(value);
    }
}

fn input<F: Real>(op: Op, ray: &Ray<F>, triangle: &Triangle<F>) -> Value<F> {
    match op {
        Op::Load(Point::A) => Value::Vector(ray.a),
        Op::Load(Point::B) => Value::Vector([0, 1, 2].map(|axis| ray.a[axis] + ray.d[axis])),
        Op::Load(Point::P0) => Value::Vector(triangle.p0),
        Op::Load(Point::P1) => Value::Vector(triangle.p1),
        Op::Load(Point::P2) => Value::Vector(triangle.p2),
        Op::LoadEdge(stored) => {
            let to = match stored {
                StoredEdge::P1P0 => triangle.p1,
                StoredEdge::P2P0 => triangle.p2,
            };
            Value::Vector([0, 1, 2].map(|axis| to[axis] - triangle.p0[axis]))
        }
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
    fn operand(&self, operand: usize) -> Evaluated<F> {
        match self.values[self.program.operand(self.index, operand)] {
            Value::Scalar(number) => Evaluated::Number(number),
            Value::Mask(mask) => Evaluated::Mask(mask),
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
            Expr::Operand(operand) => self.operand(*operand),
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
            Expr::Binary(Binary::Both, a, b) => {
                let a = self.evaluate(a, intermediate).mask();
                Mask(self.evaluate(b, intermediate).mask() && a)
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
                    Binary::FlipSign => Number(if b.sign_is_clear() { a } else { -a }),
                    Binary::Either | Binary::Both => unreachable!("matched above"),
                }
            }
            Expr::Select(operands) => {
                let [mask, one, other] = &**operands;
                match self.evaluate(mask, intermediate).mask() {
                    true => self.evaluate(one, intermediate),
                    false => self.evaluate(other, intermediate),
                }
            }
            Expr::ExactDifference(operands) => {
                let number = |expr| self.evaluate(expr, intermediate).number();
                let [a, b, c, d] = operands.each_ref().map(number);
                Number(a.exact_difference(b, c, d))
            }
            Expr::Ternary(op, operands) => {
                let number = |expr| self.evaluate(expr, intermediate).number();
                let [a, b, c] = operands.each_ref().map(number);
                Number(match op {
                    Ternary::MulAdd => a.mul_add(b, c),
                    Ternary::MulSub => a.mul_add(b, -c),
                    Ternary::NegMulAdd => (-a).mul_add(b, c),
                })
            }
        }
    }
}

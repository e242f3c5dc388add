//! Dimensional analysis: how every number that a program computes grows with the scene, and whether
//! it depends on where the world's origin is.
//!
//! The [`Definition`] of an operation is evaluated as it is on numbers, but on [`Dimension`]s. What
//! is read from outside has a known one, and arithmetic does the rest, so no operation has to be
//! told what its dimension is.

use std::collections::BTreeSet;

use volumes::Point;

use crate::definition::{Binary, Definition, Expr, Ternary, Unary};
use crate::op::Op;
use crate::statements::Program;

/// With which powers of the scene's lengths a number grows: a volume that is twice linear in
/// positions and once in directions has the degrees 2 and 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Degree {
    /// In vertices and origins.
    pub positions: i32,
    /// In directions.
    pub directions: i32,
}

impl Degree {
    /// The weights of a scene of which positions and directions are multiplied alike; `t` stays.
    pub const EVERYTHING: Degree = Degree::new(1, 1);

    /// Of one whose vertices and origins are; `t` is multiplied as well.
    pub const POSITIONS: Degree = Degree::new(1, 0);

    /// Of one whose directions are; `t` is divided.
    pub const DIRECTIONS: Degree = Degree::new(0, 1);

    const fn new(positions: i32, directions: i32) -> Degree {
        Degree {
            positions,
            directions,
        }
    }

    /// Of a product.
    fn times(self, other: Degree) -> Degree {
        let Degree {
            positions,
            directions,
        } = other;
        Degree::new(self.positions + positions, self.directions + directions)
    }

    /// Of a reciprocal.
    fn inverse(self) -> Degree {
        Degree::new(-self.positions, -self.directions)
    }
}

/// What is known of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Dimension {
    /// The number zero, which has every degree.
    Zero,
    /// Another number.
    Number {
        degree: Degree,
        /// Whether it is moved as much as the world is: a coordinate, and no difference of two.
        is_place: bool,
    },
    /// A mask, or bits of which only the sign is looked at.
    Bits,
}

/// A number that no place is.
fn difference(degree: Degree) -> Dimension {
    let is_place = false;
    Dimension::Number { degree, is_place }
}

/// What came up in a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Dimensions {
    /// The degrees of all numbers that are read or computed.
    pub degrees: BTreeSet<Degree>,
    /// Those of what a rounded product leaves of the exact one.
    pub remainders: BTreeSet<Degree>,
    /// Whether numbers of different degrees are added or compared, so that a scale is no matter of
    /// units alone.
    pub are_mixed: bool,
    /// Whether something else is done with a coordinate than to take its difference to another.
    pub use_places: bool,
}

impl Dimensions {
    /// Of all statements of a program.
    pub fn of(program: &Program) -> Dimensions {
        let mut found = Dimensions::default();
        let has_end = |one: &crate::Statement| one.op == Op::Load(Point::B);
        let is_of_segments = program.statements().iter().any(has_end);
        let mut values: Vec<[Dimension; 3]> = Vec::new();
        for (index, statement) in program.statements().iter().enumerate() {
            let operand = |number, axis| values[program.operand(index, number)][axis];
            let value = match statement.op.definition() {
                Definition::Input => [found.read(statement.op, is_of_segments); 3],
                Definition::Constant(0) => [Dimension::Zero; 3],
                Definition::Constant(_) => [difference(Degree::default()); 3],
                Definition::Vector(components) => {
                    components.map(|expr| found.evaluate(&expr, &operand, None))
                }
                Definition::Scalar(expr) | Definition::Keep(expr) => {
                    [found.evaluate(&expr, &operand, None); 3]
                }
                Definition::ScalarVia {
                    intermediate,
                    result,
                } => {
                    let via = found.evaluate(&intermediate, &operand, None);
                    [found.evaluate(&result, &operand, Some(via)); 3]
                }
                Definition::AllTrue
                | Definition::Exit
                | Definition::Store
                | Definition::Nothing => [Dimension::Bits; 3],
            };
            values.push(value);
        }
        found
    }

    /// What an input is. The direction of a segment is a difference of positions.
    fn read(&mut self, op: Op, is_of_segments: bool) -> Dimension {
        let (degree, is_place) = match op {
            Op::Load(_) => (Degree::new(1, 0), true),
            Op::LoadEdge(_) => (Degree::new(1, 0), false),
            Op::LoadDirection if is_of_segments => (Degree::new(1, 0), false),
            Op::LoadDirection => (Degree::new(0, 1), false),
            Op::LoadTMax if is_of_segments => (Degree::default(), false),
            Op::LoadTMax => (Degree::new(1, -1), false),
            _ => unreachable!("{op} is no input"),
        };
        self.degrees.insert(degree);
        Dimension::Number { degree, is_place }
    }

    /// Of an expression, given those of operands by their number and axis, and of the intermediate value.
    fn evaluate(
        &mut self,
        expr: &Expr,
        operand: &dyn Fn(usize, usize) -> Dimension,
        via: Option<Dimension>,
    ) -> Dimension {
        let mut of = |expr: &Expr| self.evaluate(expr, operand, via);
        match expr {
            Expr::Operand(number) => operand(*number, 0),
            Expr::Component(number, axis) => operand(*number, *axis),
            Expr::Intermediate => via.expect("computed before its use"),
            Expr::Unary(op, a) => {
                let a = of(a);
                match op {
                    Unary::Estimate => self.quotient(difference(Degree::default()), a),
                    Unary::SignIsClear => Dimension::Bits,
                }
            }
            Expr::Binary(op, a, b) => {
                let (a, b) = (of(a), of(b));
                match op {
                    Binary::Add => self.sum(a, b),
                    Binary::Sub => self.sub(a, b),
                    Binary::Min | Binary::Max => self.either(a, b),
                    Binary::Mul => self.product(a, b),
                    Binary::Div => self.quotient(a, b),
                    Binary::Less | Binary::AtMost => {
                        self.either(a, b);
                        Dimension::Bits
                    }
                    Binary::Either | Binary::Both | Binary::BitOr | Binary::BitXor => {
                        Dimension::Bits
                    }
                    Binary::FlipSign => a,
                }
            }
            Expr::Ternary(op, factors) => {
                let [a, b, c] = factors.each_ref().map(of);
                let product = self.product(a, b);
                let result = self.either(product, c);
                if let (Ternary::NegMulAdd, Dimension::Number { degree, .. }) = (op, result) {
                    self.remainders.insert(degree);
                }
                result
            }
            Expr::Select(options) => {
                let [_, one, other] = options.each_ref().map(of);
                self.either(one, other)
            }
            Expr::ExactDifference(factors) => {
                let [a, b, c, d] = factors.each_ref().map(of);
                let (left, right) = (self.product(a, b), self.product(c, d));
                self.either(left, right)
            }
        }
    }

    /// A number that is computed.
    fn number(&mut self, degree: Degree, is_place: bool) -> Dimension {
        self.degrees.insert(degree);
        Dimension::Number { degree, is_place }
    }

    /// What two numbers are that are added, compared or chosen from: of one degree.
    fn either(&mut self, a: Dimension, b: Dimension) -> Dimension {
        use Dimension::{Bits, Number, Zero};
        match (a, b) {
            (Bits, _) | (_, Bits) => Bits,
            (Zero, other) | (other, Zero) => other,
            (
                Number { degree, is_place },
                Number {
                    degree: other,
                    is_place: is_other_place,
                },
            ) => {
                self.are_mixed |= degree != other;
                self.use_places |= is_place || is_other_place;
                difference(degree)
            }
        }
    }

    fn sum(&mut self, a: Dimension, b: Dimension) -> Dimension {
        self.either(a, b)
    }

    /// A difference of two places is none.
    fn sub(&mut self, a: Dimension, b: Dimension) -> Dimension {
        use Dimension::Number;
        match (a, b) {
            (
                Number {
                    degree,
                    is_place: true,
                },
                Number { is_place: true, .. },
            ) => self.number(degree, false),
            _ => self.sum(a, b),
        }
    }

    fn product(&mut self, a: Dimension, b: Dimension) -> Dimension {
        self.scaled(a, b, |degree| degree)
    }

    fn quotient(&mut self, a: Dimension, b: Dimension) -> Dimension {
        self.scaled(a, b, Degree::inverse)
    }

    /// `a` times a power of `b`, whose degree that power changes as `power` says.
    fn scaled(&mut self, a: Dimension, b: Dimension, power: fn(Degree) -> Degree) -> Dimension {
        use Dimension::{Bits, Number, Zero};
        match (a, b) {
            (Bits, _) | (_, Bits) => Bits,
            (Zero, _) | (_, Zero) => Zero,
            (
                Number { degree, is_place },
                Number {
                    degree: other,
                    is_place: is_other_place,
                },
            ) => {
                self.use_places |= is_place || is_other_place;
                self.number(degree.times(power(other)), false)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Degree, Dimension, Dimensions, difference};
    use crate::definition::{Binary, Expr, binary, product};

    const PLACE: Dimension = Dimension::Number {
        degree: Degree::new(1, 0),
        is_place: true,
    };

    fn dimensions(expr: &Expr, operands: &[Dimension]) -> Dimensions {
        let mut found = Dimensions::default();
        found.evaluate(expr, &|number, _| operands[number], None);
        found
    }

    /// No operation of today does it: a plane's constant at the world's origin, as Wald and Havel and
    /// Herout store it.
    #[test]
    fn a_plane_by_its_distance_from_the_worlds_origin_uses_places() {
        let normal = difference(Degree::new(2, 0));
        let [n, p0, a] = [0, 1, 2].map(Expr::Operand);
        let distances = [p0.clone(), a.clone()].map(|point| product([n.clone(), point]));
        let [of_plane, of_ray] = distances;
        let apart = binary(Binary::Sub, of_plane, of_ray);
        assert!(dimensions(&apart, &[normal, PLACE, PLACE]).use_places);
        let together = product([n, binary(Binary::Sub, p0, a)]);
        let found = dimensions(&together, &[normal, PLACE, PLACE]);
        assert!(!found.use_places);
        assert!(found.degrees.contains(&Degree::new(3, 0)));
    }

    #[test]
    fn an_absolute_epsilon_mixes_degrees() {
        let volume = difference(Degree::new(2, 1));
        let epsilon = difference(Degree::default());
        let [o0, o1] = [0, 1].map(Expr::Operand);
        let test = binary(Binary::Less, o0, o1);
        assert!(dimensions(&test, &[volume, epsilon]).are_mixed);
        assert!(!dimensions(&test, &[volume, Dimension::Zero]).are_mixed);
    }
}

//! Programs as text that a person reads: a statement a line.

use std::fmt;

use volumes::{TripleProduct, Volume};

use crate::op::{On, Op, Reciprocal, SameSign, Side, SideTest};
use crate::quantity::Quantity;
use crate::statements::Program;

/// How a program has a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formula {
    /// As a triple product.
    Product(TripleProduct),
    /// `V` as the sum of the sides' volumes.
    SumOfSides,
    /// `V` as the difference of `Va` and `Vb`.
    DifferenceOfEnds,
    /// A side's volume as what `V` leaves of the two others'.
    Rest(Side),
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Formula::Product(product) => product.fmt(f),
            Formula::SumOfSides => f.write_str("V0 + V1 + V2"),
            Formula::DifferenceOfEnds => f.write_str("Va - Vb"),
            Formula::Rest(side) => {
                let [j, k] = side.others().map(Side::volume);
                write!(f, "V - {j} - {k}")
            }
        }
    }
}

impl Program {
    /// Every volume that the program has, with its formula, in the order of the program.
    pub fn formulas(&self) -> Vec<(Volume, Formula)> {
        let formulas = (0..self.statements().len()).filter_map(|index| {
            let Quantity::Volume(volume) = self.quantities()[index] else {
                return None;
            };
            Some((volume, self.formula(index)?))
        });
        formulas.collect()
    }

    /// The formula of a statement, if it computes a volume.
    fn formula(&self, index: usize) -> Option<Formula> {
        match self.statements()[index].op {
            Op::Volume(..) => {
                let operand = |number| self.quantities()[self.operand(index, number)];
                match (operand(0), operand(1)) {
                    (Quantity::Cross(cross), Quantity::Vector(dot)) => {
                        Some(Formula::Product(TripleProduct { cross, dot }))
                    }
                    _ => unreachable!("checked programs have fitting operands"),
                }
            }
            Op::SumOfSides => Some(Formula::SumOfSides),
            Op::DifferenceOfEnds => Some(Formula::DifferenceOfEnds),
            Op::Rest(side) => Some(Formula::Rest(side)),
            _ => None,
        }
    }

    /// A line for every statement: what it computes, or does.
    pub fn listing(&self) -> Vec<String> {
        (0..self.statements().len())
            .map(|index| self.line(index))
            .collect()
    }

    fn line(&self, index: usize) -> String {
        let quantity = self.quantities()[index];
        if let (Some(formula), Quantity::Volume(volume)) = (self.formula(index), quantity) {
            let fused = match self.statements()[index].op.is_fused() {
                true => ", fused",
                false => "",
            };
            return format!("{volume} = {formula}{fused}");
        }
        let coordinate = |side: Side| side.barycentric();
        match self.statements()[index].op {
            Op::Load(point) => format!("load {point}"),
            Op::LoadEdge(stored) => format!("load {}", stored.edge()),
            Op::LoadDirection => "load d".into(),
            Op::LoadTMax => "load t_max".into(),
            Op::Zero => "0".into(),
            Op::One => "1".into(),
            Op::Mask => "mask = true in every lane".into(),
            Op::Square => "V · V".into(),
            Op::Reciprocal(Reciprocal::Exact) => "1 / V by division".into(),
            Op::Reciprocal(Reciprocal::Newton) => "1 / V by an estimate and a Newton step".into(),
            Op::Reciprocal(Reciprocal::FusedNewton) => {
                "1 / V by an estimate and a fused Newton step".into()
            }
            Op::TMultiply => "t = Va · (1 / V)".into(),
            Op::TDivide => "t = Va / V".into(),
            Op::BarycentricMultiply(side) => {
                format!("{} = {} · (1 / V)", coordinate(side), side.volume())
            }
            Op::BarycentricRest(side) => {
                let [j, k] = side.others().map(coordinate);
                format!("{} = 1 - {j} - {k}", coordinate(side))
            }
            Op::Shear(shear) if shear.is_fused() => format!("{quantity}, fused"),
            Op::FusedCross => format!("{quantity}, fused"),
            Op::Exit => format!("exit after {}", self.quantity_of_operand(index)),
            Op::Store => "store t".into(),
            op if op.is_test() => self.test(index, op),
            _ => match quantity {
                Quantity::Vector(vector) => vector.to_string(),
                Quantity::Cross(cross) => cross.to_string(),
                other => other.to_string(),
            },
        }
    }

    fn test(&self, index: usize, op: Op) -> String {
        let kept = match op {
            Op::Near(On::Quotient) => "t > 0".into(),
            Op::Near(On::Product) => "Va · V > 0".into(),
            Op::Near(On::Signs) => "Va with the sign of V > 0".into(),
            Op::Far(On::Quotient) => "t < t_max".into(),
            Op::Far(_) => "Va · V < t_max · V · V".into(),
            Op::Ends => "Va with the sign of Vb <= 0".into(),
            Op::Side(side, SideTest::Quotient) => format!("{} >= 0", side.barycentric()),
            Op::Side(side, SideTest::Product) => format!("{} · V >= 0", side.volume()),
            Op::Side(side, SideTest::Signs) => format!("{} and V of one sign", side.volume()),
            Op::Side(side, SideTest::Sum) => {
                let [j, k] = side.others().map(Side::volume);
                format!("({j} + {k}) · V <= V · V")
            }
            Op::SameSign(SameSign::Bits) => "V0, V1, V2 of one sign bit".into(),
            Op::SameSign(SameSign::Ordered) => "V0, V1, V2 of one sign".into(),
            Op::SameSign(SameSign::Rounded) => "V0, V1, V2, rounded, of one sign".into(),
            _ => unreachable!("{op} is no test"),
        };
        match self.begins_mask(index) {
            true => format!("mask = {kept}"),
            false => format!("mask = mask and {kept}"),
        }
    }

    fn quantity_of_operand(&self, index: usize) -> Quantity {
        self.quantities()[self.statements()[index].operands[0] as usize]
    }
}

//! How many operations a program takes: not only its volumes, but its divisions and tests too.

use volumes::{Case, Cost, Kind, Model, Operations, Rate};

use crate::definition::{Binary, Definition, Expr, Unary};
use crate::op::Op;
use crate::quantity::Quantity;
use crate::statements::Program;

impl Op {
    /// What the operation takes, once its operands are there. If `fused`, a multiplication and the
    /// addition behind it are one operation; if not, they are two even where the program fuses
    /// them.
    ///
    /// A test also joins the mask, an exit looks at it and a store selects by it: one operation
    /// each.
    pub fn operations(self, fused: bool) -> Operations {
        let count = |expr: &Expr| count(expr, fused);
        let one_test = Operations::of(Kind::Test, 1);
        match self.definition() {
            Definition::Input | Definition::Constant(_) | Definition::AllTrue => {
                Operations::default()
            }
            Definition::Nothing => Operations::default(),
            Definition::Vector(components) => components
                .iter()
                .map(count)
                .fold(Operations::default(), |all, one| all + one),
            Definition::Scalar(expr) => count(&expr),
            Definition::ScalarVia {
                intermediate,
                result,
            } => count(&intermediate) + count(&result),
            Definition::Keep(expr) => count(&expr) + one_test,
            Definition::Exit | Definition::Store => one_test,
        }
    }
}

impl Program {
    /// What the program takes at each rate, in the order of [`Rate::ALL`].
    pub fn operations(&self, case: Case, fused: bool) -> [Operations; Rate::ALL.len()] {
        let mut operations = [Operations::default(); Rate::ALL.len()];
        let rates = self.rates(case.rates);
        for (index, (statement, rate)) in self.statements().iter().zip(rates).enumerate() {
            let mut own = statement.op.operations(fused);
            if self.begins_mask(index) {
                // There is no mask to join.
                own.counts[Kind::Test as usize] -= 1;
            }
            operations[rate as usize] += own;
        }
        operations
    }

    /// What the whole program costs per ray and triangle, if no ray leaves early.
    pub fn cost(&self, case: Case, model: &Model) -> Cost {
        let operations = self.operations(case, model.fused).into_iter();
        weighted_cost(case, model, operations.zip(Rate::ALL))
    }

    /// The part of that which the volumes cost, direct or derived, with their edges and crosses.
    pub fn cost_of_volumes(&self, case: Case, model: &Model) -> Cost {
        let rates = self.rates(case.rates).into_iter();
        let statements = self.statements().iter().zip(self.quantities()).zip(rates);
        let of_volumes = statements.filter(|((_, quantity), _)| {
            quantity.is_vector() || matches!(quantity, Quantity::Volume(_))
        });
        let operations =
            of_volumes.map(|((statement, _), rate)| (statement.op.operations(model.fused), rate));
        weighted_cost(case, model, operations)
    }
}

fn weighted_cost(
    case: Case,
    model: &Model,
    operations: impl Iterator<Item = (Operations, Rate)>,
) -> Cost {
    let weighted = operations.map(|(operations, rate)| operations * case.weight(rate));
    let weighted = weighted.fold(Operations::default(), |all, one| all + one);
    case.cost(model, weighted)
}

fn count(expr: &Expr, fused: bool) -> Operations {
    let count = |expr: &Expr| count(expr, fused);
    match expr {
        Expr::Operand(_) | Expr::Component(..) | Expr::Intermediate => Operations::default(),
        Expr::Unary(op, a) => {
            let kind = match op {
                Unary::Estimate => Kind::Divide,
                Unary::SignIsClear => Kind::Test,
            };
            count(a) + Operations::of(kind, 1)
        }
        Expr::Binary(op, a, b) => {
            let kind = match op {
                Binary::Add | Binary::Sub => Kind::Add,
                Binary::Mul => Kind::Multiply,
                Binary::Div => Kind::Divide,
                _ => Kind::Test,
            };
            let factors = [b, a].into_iter().find_map(|side| match side.as_ref() {
                Expr::Binary(Binary::Mul, ..) => Some(count(side)),
                _ => None,
            });
            match factors {
                Some(_) if fused && kind == Kind::Add => {
                    let mut both = count(a) + count(b);
                    both.counts[Kind::Multiply as usize] -= 1;
                    both + Operations::of(Kind::Fused, 1)
                }
                _ => count(a) + count(b) + Operations::of(kind, 1),
            }
        }
        Expr::Select(operands) => {
            let operands = operands.iter().map(count);
            operands.fold(Operations::of(Kind::Test, 1), |all, one| all + one)
        }
        // In twice the precision: every operand is widened, the difference narrowed.
        Expr::ExactDifference(operands) => {
            let operands = operands.iter().map(count);
            let own = Operations::of(Kind::Multiply, 4) + Operations::of(Kind::Add, 2);
            operands.fold(own, |all, one| all + one)
        }
        Expr::Ternary(_, operands) => {
            let operands = operands.iter().map(count);
            let own = match fused {
                true => Operations::of(Kind::Fused, 1),
                false => Operations::of(Kind::Multiply, 1) + Operations::of(Kind::Add, 1),
            };
            operands.fold(own, |all, one| all + one)
        }
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU16;

    use super::*;
    use crate::{appendix, kensler_shirley, moller_trumbore_volumes};

    #[test]
    fn vectors_and_volumes_take_what_the_cost_models_say() {
        for model in [Model::paper(), Model::fma()] {
            assert_eq!(Op::Edge.operations(model.fused), model.edge);
            for cross in [Op::Cross, Op::FusedCross] {
                assert_eq!(cross.operations(model.fused), model.cross);
            }
            for summation in crate::Summation::ALL {
                let volume = Op::Volume(volumes::Volume::V, summation);
                assert_eq!(volume.operations(model.fused), model.dot);
            }
        }
    }

    #[test]
    fn the_papers_two_programs_take_what_the_paper_says() {
        let graph = kensler_shirley();
        let packet = Case::packet(NonZeroU16::new(64).unwrap());
        let appendix = graph.program(&appendix(&graph)).unwrap();
        let cost =
            |program: &Program, case| program.cost_of_volumes(case, &Model::paper()).to_string();
        assert_eq!(cost(&appendix, packet), "32 + 15/64");
        let equations_2 = graph.program(&moller_trumbore_volumes(&graph)).unwrap();
        assert_eq!(cost(&equations_2, Case::SINGLE), "47");
    }

    #[test]
    fn the_appendix_has_its_divisions_and_tests_counted() {
        let graph = kensler_shirley();
        let case = Case::packet(NonZeroU16::new(64).unwrap());
        let program = graph.program(&appendix(&graph)).unwrap();
        let operations = program.operations(case, false);
        let of_ray = operations[Rate::RayTriangle as usize];
        // The estimate; 5 tests joined to the mask with 5 comparisons, 3 exits, the store.
        assert_eq!(of_ray.count(Kind::Divide), 1);
        assert_eq!(of_ray.count(Kind::Test), 5 + 5 + 3 + 1);
        // Of 32, 18 are multiplications; 3 for the Newton step, t, two barycentrics, V², and V
        // times the sum.
        assert_eq!(of_ray.count(Kind::Multiply), 18 + 2 + 1 + 2 + 1 + 1);
    }
}

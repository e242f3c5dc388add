//! Programs: straight-line statements with early exits, checked like a graph.

use serde::{Deserialize, Serialize};
use volumes::{Rate, Rates};

use crate::op::Op;
use crate::quantity::{Condition, Misfit, Quantity};

/// One statement: an operation and the statements before it that it works on.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statement {
    /// What it does.
    pub op: Op,
    /// The places of its operands in the program, all before its own.
    pub operands: Vec<u32>,
}

/// A checked program: the statements in the order in which they run. The last one stores.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Statement>", into = "Vec<Statement>")]
pub struct Program {
    statements: Vec<Statement>,
    quantities: Vec<Quantity>,
}

/// What is wrong with a program.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum ProgramError {
    /// An operand that is not before its statement.
    #[error("statement {0} works on one that does not come before it")]
    Order(usize),
    /// A choice or a group, which are structure of the graph.
    #[error("statement {0} is a {1}, which only a graph has")]
    Structure(usize, Op),
    /// Operands that do not fit.
    #[error("statement {statement}: {misfit}")]
    Misfit {
        /// The statement.
        statement: usize,
        /// What does not fit.
        misfit: Misfit,
    },
    /// A value that an earlier statement has.
    #[error("statement {0} computes again what an earlier one has computed")]
    Duplicate(usize),
    /// A second mask.
    #[error("statement {0} begins the mask of rays in question, which an earlier one has begun")]
    Mask(usize),
    /// No store, one that is not last, or several.
    #[error("a program stores once, at its end")]
    Store,
}

impl Program {
    /// Checks `statements` and makes them a program.
    ///
    /// # Errors
    ///
    /// [`ProgramError`] names the first statement that is wrong, and what is wrong with it.
    pub fn new(statements: Vec<Statement>) -> Result<Program, ProgramError> {
        let mut quantities: Vec<Quantity> = Vec::with_capacity(statements.len());
        for (index, statement) in statements.iter().enumerate() {
            let op = statement.op;
            if !op.is_statement() {
                return Err(ProgramError::Structure(index, op));
            }
            let operands: Option<Vec<(Op, Quantity)>> = statement
                .operands
                .iter()
                .map(|&operand| {
                    let quantity = *quantities.get(operand as usize)?;
                    Some((statements[operand as usize].op, quantity))
                })
                .collect();
            let operands = operands.ok_or(ProgramError::Order(index))?;
            let begun = quantities.iter().any(|quantity| quantity.is_mask());
            let quantity = match quantity(op, operands) {
                Ok((quantity, true)) if begun && !quantities.contains(&quantity) => {
                    return Err(ProgramError::Mask(index));
                }
                Ok((quantity, _)) => quantity,
                Err(misfit) => {
                    let statement = index;
                    return Err(ProgramError::Misfit { statement, misfit });
                }
            };
            if op != Op::Exit && quantities.contains(&quantity) {
                return Err(ProgramError::Duplicate(index));
            }
            quantities.push(quantity);
        }
        let stores = quantities
            .iter()
            .filter(|&&q| q == Quantity::Stored)
            .count();
        if stores != 1 || quantities.last() != Some(&Quantity::Stored) {
            return Err(ProgramError::Store);
        }
        Ok(Program {
            statements,
            quantities,
        })
    }

    /// The statements, in order.
    pub fn statements(&self) -> &[Statement] {
        &self.statements
    }

    /// What each statement computes.
    pub fn quantities(&self) -> &[Quantity] {
        &self.quantities
    }

    /// Whether a statement is the test that begins the mask: the others narrow what it, or a
    /// [mask](Op::Mask) that is true in every lane, has begun.
    pub fn begins_mask(&self, index: usize) -> bool {
        let Statement { op, operands } = &self.statements[index];
        let is_mask = |&operand: &u32| self.quantities[operand as usize].is_mask();
        op.is_test() && !operands.first().is_some_and(is_mask)
    }

    /// The statement that is the operand of this number in the [definition](Op::definition) of
    /// another. The definition of a test has the mask before it as operand 0, whether there is one
    /// or not.
    ///
    /// # Panics
    ///
    /// If there is no such operand.
    pub fn operand(&self, index: usize, number: usize) -> usize {
        let shift = usize::from(self.begins_mask(index));
        self.statements[index].operands[number - shift] as usize
    }

    /// How often each statement's value changes, given how often the inputs do.
    ///
    /// Tests, exits and the store are of the ray and the triangle whatever they work on: the mask
    /// begins anew for every pair.
    pub fn rates(&self, inputs: Rates) -> Vec<Rate> {
        let mut rates: Vec<Rate> = Vec::with_capacity(self.statements.len());
        for (statement, quantity) in self.statements.iter().zip(&self.quantities) {
            let operands = statement.operands.iter().map(|&o| rates[o as usize]);
            rates.push(match statement.op {
                Op::Load(point) => inputs.of_point(point),
                Op::LoadEdge(_) => inputs.vertices,
                Op::LoadDirection => inputs.direction,
                Op::LoadTMax => Rate::Ray,
                _ if quantity.is_mask() || *quantity == Quantity::Stored => Rate::RayTriangle,
                _ => operands.fold(Rate::Constant, Rate::join),
            });
        }
        rates
    }

    /// The conditions that are tested, each with whether an exit follows from it, in order.
    pub fn tests(&self) -> Vec<(Condition, Op, bool)> {
        let exits: Vec<u32> = self
            .statements
            .iter()
            .filter(|statement| statement.op == Op::Exit)
            .map(|statement| statement.operands[0])
            .collect();
        let tests = self.statements.iter().zip(&self.quantities).enumerate();
        tests
            .filter_map(|(index, (statement, quantity))| match quantity {
                Quantity::Tested(condition) if statement.op.is_test() => {
                    let exits = exits.contains(&(index as u32));
                    Some((*condition, statement.op, exits))
                }
                _ => None,
            })
            .collect()
    }
}

/// What an operation makes of its operands, and whether it begins a mask. A test may be the
/// beginning, and then has no mask before it; or it narrows the mask that another test has begun.
fn quantity(op: Op, mut operands: Vec<(Op, Quantity)>) -> Result<(Quantity, bool), Misfit> {
    let untested = (Op::Mask, Quantity::Mask);
    if op.is_test()
        && let Some(first) = operands.first_mut()
        && first.0.is_test()
    {
        *first = untested;
    }
    let has_mask = operands.first().is_some_and(|first| first.1.is_mask());
    match op.quantity(&operands) {
        Err(Misfit::Arity { takes, given, .. })
            if op.is_test() && !has_mask && given + 1 == takes =>
        {
            operands.insert(0, untested);
            Ok((op.quantity(&operands)?, true))
        }
        quantity => Ok((quantity?, op == Op::Mask)),
    }
}

impl TryFrom<Vec<Statement>> for Program {
    type Error = ProgramError;

    fn try_from(statements: Vec<Statement>) -> Result<Program, ProgramError> {
        Program::new(statements)
    }
}

impl From<Program> for Vec<Statement> {
    fn from(program: Program) -> Vec<Statement> {
        program.statements
    }
}

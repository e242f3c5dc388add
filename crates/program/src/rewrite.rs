//! Programs made of programs: other formulations, what is dead removed, the mask begun by the first
//! test, estimates made exact.
//!
//! This is what Kensler and Shirley did by hand with the best programs of their search (end of
//! section 5): "trying to change the code and especially the basic structure as little as possible".

use std::collections::HashMap;

use volumes::{Cross, Edge, Formulation, Point, TripleProduct, Vector, Volume};

use crate::op::{Op, Reciprocal, Side, Summation};
use crate::quantity::Quantity;
use crate::statements::{Program, Statement};

impl Program {
    /// The same program with the formulation's triple products. Volumes that it does not compute
    /// are derived from those that it does; every other statement stays, in its place, even if it
    /// is of no use any more.
    ///
    /// # Panics
    ///
    /// If the formulation's products are not its volumes, or it lacks `Va` or two volumes of the
    /// other four.
    #[must_use]
    pub fn with_formulation(&self, formulation: &Formulation) -> Program {
        let mut rewriter = Rewriter {
            old: self,
            formulation,
            statements: Vec::new(),
            known: HashMap::new(),
        };
        let mut places = Vec::with_capacity(self.statements().len());
        for (statement, &quantity) in self.statements().iter().zip(self.quantities()) {
            let operands = statement.operands.iter();
            let operands = operands.map(|&old| places[old as usize]).collect();
            places.push(match quantity {
                Quantity::Volume(volume) => rewriter.volume(volume),
                _ => rewriter.copy(statement.op, operands, quantity),
            });
        }
        checked(rewriter.statements)
    }

    /// Whether its volumes are those of a sheared ray, which no formulation has.
    pub fn is_sheared(&self) -> bool {
        let mut ops = self.statements().iter().map(|statement| statement.op);
        ops.any(|op| matches!(op, Op::Shear(_)))
    }

    /// The same program without statements of whose value nothing comes.
    #[must_use]
    pub fn without_dead(&self) -> Program {
        let count = self.statements().len();
        let mut live = vec![false; count];
        live[count - 1] = true;
        for index in (0..count).rev() {
            if live[index] {
                for &operand in &self.statements()[index].operands {
                    live[operand as usize] = true;
                }
            }
        }
        self.filtered(&live)
    }

    /// The same program with the mask begun by the first test, and not true in every lane before.
    #[must_use]
    pub fn beginning_with_first_test(&self) -> Program {
        let first = self.statements().iter().position(|one| one.op.is_test());
        let first = first.expect("a program has tests");
        if self.begins_mask(first) {
            return self.clone();
        }
        let mut statements = self.statements().to_vec();
        let before = statements[first].operands.remove(0);
        for statement in &mut statements[first + 1..] {
            for operand in &mut statement.operands {
                if *operand == before {
                    *operand = first as u32;
                }
            }
        }
        let live: Vec<bool> = (0..statements.len())
            .map(|index| index != before as usize)
            .collect();
        filtered(&statements, &live)
    }

    /// The same program with exact divisions in place of estimates.
    #[must_use]
    pub fn without_estimates(&self) -> Program {
        if !self.statements().iter().any(|one| one.op.is_estimate()) {
            return self.clone();
        }
        let mut statements: Vec<Statement> = Vec::new();
        let mut places: Vec<u32> = Vec::with_capacity(self.statements().len());
        let mut one = None;
        for Statement { op, operands } in self.statements() {
            let mut operands: Vec<u32> = operands.iter().map(|&old| places[old as usize]).collect();
            let mut op = *op;
            if op.is_estimate() || op == Op::One {
                let place = *one.get_or_insert_with(|| {
                    let operands = Vec::new();
                    statements.push(Statement {
                        op: Op::One,
                        operands,
                    });
                    statements.len() as u32 - 1
                });
                if op == Op::One {
                    places.push(place);
                    continue;
                }
                if op == Op::Reciprocal(Reciprocal::Newton) {
                    operands.insert(0, place);
                }
                op = Op::Reciprocal(Reciprocal::Exact);
            }
            statements.push(Statement { op, operands });
            places.push(statements.len() as u32 - 1);
        }
        checked(statements)
    }

    /// Whether the program has the same answers on every instruction set.
    pub fn is_portable(&self) -> bool {
        self.statements()
            .iter()
            .all(|one| !one.op.is_estimate() && !one.op.is_fused())
    }

    /// How many statements one program has that the other has not, by what they compute of what.
    pub fn changes(&self, other: &Program) -> usize {
        let mut lines: HashMap<String, i32> = HashMap::new();
        for (program, sign) in [(self, 1), (other, -1)] {
            for line in program.listing() {
                *lines.entry(line).or_default() += sign;
            }
        }
        lines
            .values()
            .map(|count| count.unsigned_abs() as usize)
            .sum()
    }

    fn filtered(&self, live: &[bool]) -> Program {
        filtered(self.statements(), live)
    }
}

/// The statements that are live.
fn filtered(statements: &[Statement], live: &[bool]) -> Program {
    let mut place = 0;
    let places: Vec<u32> = live
        .iter()
        .map(|&live| {
            place += u32::from(live);
            place.saturating_sub(1)
        })
        .collect();
    let kept = statements.iter().zip(live).filter(|(_, live)| **live);
    let statements = kept.map(|(statement, _)| Statement {
        op: statement.op,
        operands: (statement.operands.iter())
            .map(|&operand| places[operand as usize])
            .collect(),
    });
    checked(statements.collect())
}

fn checked(statements: Vec<Statement>) -> Program {
    Program::new(statements).expect("rewriting keeps a program sound")
}

struct Rewriter<'a> {
    old: &'a Program,
    formulation: &'a Formulation,
    statements: Vec<Statement>,
    /// The place of every value.
    known: HashMap<Quantity, u32>,
}

impl Rewriter<'_> {
    fn push(&mut self, op: Op, operands: Vec<u32>) -> u32 {
        self.statements.push(Statement { op, operands });
        self.statements.len() as u32 - 1
    }

    /// A statement as it was, unless its value is there already. Exits have none of their own.
    fn copy(&mut self, op: Op, operands: Vec<u32>, quantity: Quantity) -> u32 {
        if op == Op::Exit {
            return self.push(op, operands);
        }
        self.value(quantity, op, |_| operands)
    }

    /// The place of a value, which is computed if it is not there.
    fn value(
        &mut self,
        quantity: Quantity,
        op: Op,
        operands: impl FnOnce(&mut Self) -> Vec<u32>,
    ) -> u32 {
        if let Some(&place) = self.known.get(&quantity) {
            return place;
        }
        let operands = operands(self);
        let place = self.push(op, operands);
        self.known.insert(quantity, place);
        place
    }

    fn volume(&mut self, volume: Volume) -> u32 {
        let quantity = Quantity::Volume(volume);
        let formulation = self.formulation;
        if let Some(TripleProduct { cross, dot }) = formulation.product(volume) {
            let op = Op::Volume(volume, self.summation(volume));
            return self.value(quantity, op, |this| {
                vec![this.cross(cross), this.vector(dot)]
            });
        }
        let side = Side::ALL.into_iter().find(|side| side.volume() == volume);
        match side {
            Some(side) => {
                let [j, k] = side.others().map(Side::volume);
                self.value(quantity, Op::Rest(side), |this| {
                    [Volume::V, j, k].map(|one| this.volume(one)).to_vec()
                })
            }
            None => {
                assert_eq!(volume, Volume::V, "Va cannot be derived");
                self.value(quantity, Op::SumOfSides, |this| {
                    Side::ALL.map(|side| this.volume(side.volume())).to_vec()
                })
            }
        }
    }

    /// The order of summation that the volume had.
    fn summation(&self, volume: Volume) -> Summation {
        let of_volume = |statement: &Statement| match statement.op {
            Op::Volume(other, summation) if other == volume => Some(summation),
            _ => None,
        };
        let summation = self.old.statements().iter().find_map(of_volume);
        summation.unwrap_or(Summation::XyZ)
    }

    fn cross(&mut self, cross: Cross) -> u32 {
        let Cross { left, right } = cross;
        let quantity = Quantity::Cross(cross);
        let mut old = self.old.statements().iter().zip(self.old.quantities());
        let is_fused = old.any(|(one, &old)| old == quantity && one.op.is_fused());
        let op = match is_fused {
            true => Op::FusedCross,
            false => Op::Cross,
        };
        self.value(quantity, op, |this| {
            vec![this.vector(left), this.vector(right)]
        })
    }

    fn vector(&mut self, vector: Vector) -> u32 {
        let quantity = Quantity::Vector(vector);
        match vector {
            Vector::Direction => self.value(quantity, Op::LoadDirection, |_| Vec::new()),
            Vector::Edge(Edge { to, from }) => self.value(quantity, Op::Edge, |this| {
                vec![this.point(to), this.point(from)]
            }),
        }
    }

    fn point(&mut self, point: Point) -> u32 {
        self.value(Quantity::Point(point), Op::Load(point), |_| Vec::new())
    }
}

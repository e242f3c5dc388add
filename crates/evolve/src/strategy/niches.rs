//! The best of every structure, so that a way to test that was found late, or was unlucky at first, is tuned like the
//! others before it is given up.

use program::{Op, Program};

use crate::individual::Individual;

/// What a program tests, divides and leaves by, in its order: what no single move changes without harm.
type Structure = Vec<Op>;

/// The best of every structure that was seen.
#[derive(Default)]
pub struct Niches {
    /// The fittest first.
    best: Vec<(Structure, Individual)>,
}

impl Niches {
    /// Takes these into account.
    pub fn see<'a>(&mut self, individuals: impl IntoIterator<Item = &'a Individual>) {
        for individual in individuals {
            if individual.evaluation.fitness.is_none() {
                continue;
            }
            let structure = structure(&individual.candidate.program);
            let known = self.best.iter_mut().find(|(known, _)| *known == structure);
            match known {
                None => self.best.push((structure, individual.clone())),
                Some((_, known)) => {
                    let is_same = known.candidate.source == individual.candidate.source;
                    if is_same || individual.weight() > known.weight() {
                        *known = individual.clone();
                    }
                }
            }
        }
        self.best
            .sort_by(|(_, a), (_, b)| b.weight().total_cmp(&a.weight()));
    }

    /// How many structures were seen.
    pub fn len(&self) -> usize {
        self.best.len()
    }

    /// Whether nobody was seen who could be a parent.
    pub fn is_empty(&self) -> bool {
        self.best.is_empty()
    }

    /// The best of a structure, by the structure's place.
    ///
    /// # Panics
    ///
    /// If there are not so many.
    pub fn best(&self, place: usize) -> &Individual {
        &self.best[place].1
    }
}

fn structure(program: &Program) -> Structure {
    let ops = program.statements().iter().map(|statement| statement.op);
    let of_structure = ops.filter(|op| {
        let divides = matches!(op, Op::TMultiply | Op::TDivide | Op::Reciprocal(_));
        op.is_test() || divides || *op == Op::Exit
    });
    of_structure.collect()
}

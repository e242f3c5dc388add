//! Where the statements of a program are printed: in the loop of their rate and, in the loop over
//! rays, in the part between two exits that uses them first.
//!
//! Most vectors of rays leave at the first exit, so what is not needed before it stands after it,
//! and what a ray brings along is loaded again in every part that uses it. Kept for later, it
//! would take a register of each of its components; used once, it is the memory operand of the
//! instruction that uses it. On instruction sets that overwrite an operand this saves a copy for
//! every component before the exit, 2 to 10% of the time of a kernel.

use program::{Op, Program, Quantity};
use volumes::{Rate, Rates, Vector};

/// Statements by their numbers, in the order in which they are printed.
pub(crate) struct Schedule {
    /// Before the loop over triangles.
    pub once: Vec<usize>,
    /// In it, before the loop over rays.
    pub each_triangle: Vec<usize>,
    /// In the loop over rays: all that stands before the first exit, between it and the second,
    /// and so on. Every part but the last ends with its exit, the last one with the store.
    pub parts: Vec<Vec<usize>>,
}

impl Schedule {
    /// Arranges `program` for a scene whose inputs change at these rates.
    pub fn new(program: &Program, rates: Rates) -> Schedule {
        let mut schedule = Schedule {
            once: Vec::new(),
            each_triangle: Vec::new(),
            parts: Vec::new(),
        };
        let rates = program.rates(rates);
        for (index, rate) in rates.iter().enumerate() {
            match rate {
                Rate::Constant | Rate::Packet => schedule.once.push(index),
                Rate::Triangle | Rate::PacketTriangle => schedule.each_triangle.push(index),
                Rate::Ray | Rate::RayTriangle => {}
            }
        }
        let mut parts = Parts {
            program,
            // What stands before the loop is there.
            printed: rates.iter().map(|&rate| !is_of_ray(rate)).collect(),
            part: Vec::new(),
        };
        for (index, statement) in program.statements().iter().enumerate() {
            // Values wait for whoever needs them.
            if parts.is_effect(index) {
                parts.print(index);
            }
            if matches!(statement.op, Op::Exit | Op::Store) {
                schedule.parts.push(parts.finish());
            }
        }
        schedule
    }
}

fn is_of_ray(rate: Rate) -> bool {
    matches!(rate, Rate::Ray | Rate::RayTriangle)
}

struct Parts<'a> {
    program: &'a Program,
    /// Whether a statement need not be printed where its value is used now.
    printed: Vec<bool>,
    part: Vec<usize>,
}

impl Parts<'_> {
    /// Whether a statement belongs where it stands in the program: the mask and all that is done
    /// with it.
    fn is_effect(&self, index: usize) -> bool {
        let quantity = self.program.quantities()[index];
        quantity.is_mask() || quantity == Quantity::Stored
    }

    /// Prints a statement in this part, after what it works on.
    fn print(&mut self, index: usize) {
        if std::mem::replace(&mut self.printed[index], true) {
            return;
        }
        for &operand in &self.program.statements()[index].operands {
            self.print(operand as usize);
        }
        self.part.push(index);
    }

    /// The part, its values in the program's order. What a ray brings along, and its edges, are
    /// worth no register in the next.
    fn finish(&mut self) -> Vec<usize> {
        let mut part = std::mem::take(&mut self.part);
        part.sort_unstable();
        for &index in &part {
            let edge = matches!(
                self.program.quantities()[index],
                Quantity::Vector(Vector::Edge(_))
            );
            if edge || self.program.statements()[index].op.is_input() {
                self.printed[index] = false;
            }
        }
        part
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use program::{Genome, kensler_shirley};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Schedules of random programs in the general scene.
    fn with_schedules(mut check: impl FnMut(&Program, &Schedule)) {
        let graph = kensler_shirley();
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        for _ in 0..1000 {
            let genome = Genome::random(graph.nodes().len(), &mut rng);
            let program = graph.program(&genome).unwrap();
            check(&program, &Schedule::new(&program, Rates::GENERAL));
        }
    }

    #[test]
    fn every_statement_stands_after_all_that_it_works_on() {
        with_schedules(|program, schedule| {
            let mut printed = HashSet::new();
            let before = schedule.once.iter().chain(&schedule.each_triangle);
            for &index in before.chain(schedule.parts.iter().flatten()) {
                let operands = &program.statements()[index].operands;
                assert!(operands.iter().all(|&o| printed.contains(&(o as usize))));
                printed.insert(index);
            }
            assert_eq!(printed.len(), program.statements().len());
        });
    }

    #[test]
    fn a_part_loads_and_computes_only_what_somebody_uses_in_it_or_later() {
        with_schedules(|program, schedule| {
            for (number, part) in schedule.parts.iter().enumerate() {
                let used: HashSet<usize> = part
                    .iter()
                    .flat_map(|&index| &program.statements()[index].operands)
                    .map(|&operand| operand as usize)
                    .collect();
                let ends = |op| matches!(op, Op::Exit | Op::Store);
                let (last, rest) = part.split_last().unwrap();
                assert!(ends(program.statements()[*last].op));
                for &index in rest {
                    let op = program.statements()[index].op;
                    assert!(!ends(op), "part {number} goes on after its end");
                    let mask = program.quantities()[index].is_mask();
                    assert!(mask || used.contains(&index), "part {number}: {op}");
                }
            }
        });
    }

    #[test]
    fn the_mask_and_what_is_no_input_or_edge_is_printed_once() {
        with_schedules(|program, schedule| {
            let mut printed = HashSet::new();
            for &index in schedule.parts.iter().flatten() {
                let quantity = program.quantities()[index];
                let again = program.statements()[index].op.is_input()
                    || matches!(quantity, Quantity::Vector(_));
                assert!(printed.insert(index) || again, "{quantity:?}");
            }
        });
    }
}

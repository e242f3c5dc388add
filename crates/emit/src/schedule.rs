//! Where the statements of a program are printed: in the loop of their rate and, in the inner loop,
//! in the part between two exits that uses them first.
//!
//! Most vectors leave at the first exit, so what is not needed before it stands after it, and what
//! a ray brings along is loaded again in every part that uses it. Kept for later, it would take a
//! register of each of its components; used once, it is the memory operand of the instruction that
//! uses it. On instruction sets that overwrite an operand this saves a copy for every component
//! before the exit, 2 to 10% of the time of a kernel. One ray's components are read once a call or, where an instruction
//! set [says so](crate::Isa::rereads), once a block.

use program::{Op, Quantity};
use scene::Grouping;
use volumes::{Rate, Vector};

use crate::in_scene::InScene;

/// Statements by their numbers, in the order in which they are printed. What nothing needs is
/// nowhere.
pub(crate) struct Schedule {
    /// Before all loops.
    pub once: Vec<usize>,
    /// In a loop over the packet's rays before the loop over triangles: what depends on the ray
    /// alone and is computed.
    pub each_ray: Vec<usize>,
    /// Those of them that are kept for the inner loop.
    pub kept: Vec<usize>,
    /// In the loop over triangles, before the loop over rays.
    pub each_triangle: Vec<usize>,
    /// In the inner loop: all that stands before the first exit, between it and the second, and so
    /// on. Every part but the last ends with its exit, the last one with the store.
    pub parts: Vec<Vec<usize>>,
}

/// The loop that a value is computed in.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Loop {
    None,
    Rays,
    Triangles,
    Inner,
}

impl Schedule {
    /// Arranges a program for its scene. `rereads` says whether one ray's components are read for every block, if it
    /// is not decided at run time which axis they belong to.
    pub fn new(view: InScene<'_>, rereads: bool) -> Schedule {
        let rereads = rereads && !view.renames_axes();
        let rates = view.program.rates(view.scene.rates());
        let loops: Vec<Loop> = (0..rates.len())
            .map(|index| loop_of(view, index, rates[index], rereads))
            .collect();
        let needed = needed(view);
        let of = |which| {
            let statements = needed.iter().copied();
            in_order(view, statements.filter(|&index| loops[index] == which))
        };
        let each_ray: Vec<usize> = of(Loop::Rays);
        let kept = each_ray.iter().copied().filter(|ray| {
            let mut inner = needed.iter().filter(|&&index| loops[index] == Loop::Inner);
            inner.any(|&index| view.operands(index).contains(ray))
        });
        let kept = kept.collect();
        let mut parts = Parts {
            view,
            // What stands before the inner loop is there.
            printed: loops
                .iter()
                .map(|&of| matches!(of, Loop::None | Loop::Triangles))
                .collect(),
            loops: &loops,
            part: Vec::new(),
        };
        let mut schedule = Schedule {
            once: of(Loop::None),
            each_triangle: of(Loop::Triangles),
            each_ray,
            kept,
            parts: Vec::new(),
        };
        for (index, statement) in view.program.statements().iter().enumerate() {
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

/// The statements that the tests, the exits and the store need, in the program's order.
fn needed(view: InScene<'_>) -> Vec<usize> {
    let mut is_needed: Vec<bool> = (view.program.quantities().iter())
        .map(|&quantity| quantity.is_mask() || quantity == Quantity::Stored)
        .collect();
    // Operands stand before those that need them, but for what a scene adds to a test.
    let mut waiting: Vec<usize> = (0..is_needed.len())
        .filter(|&index| is_needed[index])
        .collect();
    while let Some(index) = waiting.pop() {
        for operand in view.operands(index) {
            if !std::mem::replace(&mut is_needed[operand], true) {
                waiting.push(operand);
            }
        }
    }
    (0..is_needed.len())
        .filter(|&index| is_needed[index])
        .collect()
}

fn loop_of(view: InScene<'_>, index: usize, rate: Rate, rereads: bool) -> Loop {
    let computed = !view.program.statements()[index].op.is_input();
    match (view.scene.grouping, rate) {
        (Grouping::Single | Grouping::Scalar, Rate::Packet) if rereads && !computed => Loop::Inner,
        (_, Rate::Constant | Rate::Packet) => Loop::None,
        (Grouping::Packet, Rate::Triangle | Rate::PacketTriangle) => Loop::Triangles,
        (Grouping::Packet, Rate::Ray) if computed => Loop::Rays,
        _ => Loop::Inner,
    }
}

struct Parts<'a> {
    view: InScene<'a>,
    /// Whether a statement need not be printed where its value is used now.
    printed: Vec<bool>,
    loops: &'a [Loop],
    part: Vec<usize>,
}

impl Parts<'_> {
    /// Whether a statement belongs where it stands in the program: the mask and all that is done
    /// with it.
    fn is_effect(&self, index: usize) -> bool {
        let quantity = self.view.program.quantities()[index];
        quantity.is_mask() || quantity == Quantity::Stored
    }

    /// Prints a statement in this part, after what it works on.
    fn print(&mut self, index: usize) {
        if std::mem::replace(&mut self.printed[index], true) {
            return;
        }
        if self.loops[index] == Loop::Inner {
            for operand in self.view.operands(index) {
                self.print(operand);
            }
        }
        self.part.push(index);
    }

    /// The part, its values in the program's order, but for those that a scene wants earlier. What
    /// a ray brings along, and its edges, are worth no register in the next.
    fn finish(&mut self) -> Vec<usize> {
        let part = in_order(self.view, std::mem::take(&mut self.part).into_iter());
        for &index in &part {
            let edge = matches!(
                self.view.program.quantities()[index],
                Quantity::Vector(Vector::Edge(_))
            );
            let op = self.view.program.statements()[index].op;
            if edge || op.is_input() || self.loops[index] == Loop::Rays {
                self.printed[index] = false;
            }
        }
        part
    }
}

/// Statements in the program's order, except that what a statement works on stands before it.
pub(crate) fn in_order(view: InScene<'_>, part: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut part: Vec<usize> = part.collect();
    part.sort_unstable();
    part.dedup();
    let mut ordered = Vec::with_capacity(part.len());
    let mut placed = vec![false; view.program.statements().len()];
    for &index in &part {
        put(view, &part, index, &mut placed, &mut ordered);
    }
    ordered
}

/// Puts a statement of a part in its place, after those of its operands that are of the part.
fn put(
    view: InScene<'_>,
    part: &[usize],
    index: usize,
    placed: &mut [bool],
    ordered: &mut Vec<usize>,
) {
    if std::mem::replace(&mut placed[index], true) {
        return;
    }
    for operand in view.operands(index) {
        if part.binary_search(&operand).is_ok() {
            put(view, part, operand, placed, ordered);
        }
    }
    ordered.push(index);
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use program::{Genome, Program, kensler_shirley};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use scene::SceneModel;

    use super::*;

    /// Schedules of random programs in the general scene.
    fn with_schedules(mut check: impl FnMut(&Program, &Schedule)) {
        let graph = kensler_shirley();
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        for _ in 0..1000 {
            let genome = Genome::random(graph.nodes().len(), &mut rng);
            let program = graph.program(&genome).unwrap();
            let scene = SceneModel::preset("packet").unwrap();
            let view = InScene {
                program: &program,
                scene: &scene,
                is_open: false,
            };
            check(&program, &Schedule::new(view, false));
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

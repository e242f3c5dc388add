//! Operators that know the graph, and move what is live.

use program::{Genome, Graph, NodeId, Program};
use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};

/// Another option of one choice: of a random live choice that has several, the one that satisfies it and a random
/// other one exchange priorities. None if the program has no choice.
///
/// The program stays the same where the option is live for another's sake, or gives way to a twin of its own.
pub fn flip(graph: &Graph, parent: &Genome, rng: &mut impl Rng) -> Option<Genome> {
    let mut choices = graph.choices(parent);
    choices.retain(|decided| graph.node(decided.choice).optional.len() > 1);
    let decided = choices.choose(rng)?;
    let options = graph.node(decided.choice).optional.iter().copied();
    let others: Vec<NodeId> = options.filter(|&id| id != decided.option).collect();
    let other = others.choose(rng)?;
    let mut genome = parent.clone();
    genome.swap(decided.option.index(), other.index());
    Some(genome)
}

/// The same statements in another order: a random one is moved to a random other place of its legal window, behind
/// what it works on and before what works on it. `program` is what the parent picks. None if that one cannot move.
pub fn slide(
    graph: &Graph,
    parent: &Genome,
    program: &Program,
    rng: &mut impl Rng,
) -> Option<Genome> {
    let statements = program.statements();
    let from = rng.random_range(0..statements.len());
    let operands = statements[from].operands.iter();
    let first = operands.map(|&operand| operand as usize + 1).max();
    let is_user = |place: &usize| statements[*place].operands.contains(&(from as u32));
    let end = (from + 1..statements.len()).find(is_user);
    let window = first.unwrap_or(0)..end.unwrap_or(from + 1);
    let others: Vec<usize> = window.filter(|&place| place != from).collect();
    let &to = others.choose(rng)?;
    let mut order = graph.statements(parent);
    let moved = order.remove(from);
    order.insert(to, moved);
    // Live ones above all others have the order of their priorities; and the choices that were made, unless one
    // has two live options and the other one came first.
    let genome = parent.preferring(&order);
    (graph.statements(&genome) == order).then_some(genome)
}

/// A part of another's program in place of one's own: of a random live choice of `other`, its option and all that is
/// live below it are preferred, in their order.
pub fn graft(graph: &Graph, parent: &Genome, other: &Genome, rng: &mut impl Rng) -> Option<Genome> {
    let choices = graph.choices(other);
    let decided = choices.choose(rng)?;
    let mut scion = graph.live_below(other, decided.choice);
    scion.sort_by_key(|id| std::cmp::Reverse(other.priorities()[id.index()]));
    Some(parent.preferring(&scion))
}

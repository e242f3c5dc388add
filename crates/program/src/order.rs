//! The modified topological sort: from a genome to a program (section 5 of Kensler-Shirley).
//!
//! First a depth-first walk from the goal marks the live nodes. A node's required dependencies
//! are all marked; of a choice's options, one that is live already satisfies it (if there are
//! several, the one of highest priority), and if none is, the one of highest priority is marked.
//!
//! No value is computed twice because two volumes write it differently. A cross is satisfied by a
//! live one that is the same vector by other edges. A triple product gives way to one of the same
//! edges walked the other way, which is the same number but for how a fused cross rounds, if that needs fewer vectors that are not
//! live. For that, what leaves least to choose is marked first: V has the normal with one sign
//! only, and Va, which has it with both, follows.
//!
//! Then the live statements are put in topological order, ties broken by priority. Choices and
//! groups are structure: they print nothing, and nothing waits for them, only for what they
//! stand for.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

use crate::genome::Genome;
use crate::graph::{Graph, MAX_DEPTH, NodeId};
use crate::op::Op;
use crate::statements::{Program, ProgramError, Statement};

impl Graph {
    /// The program that `genome` picks.
    ///
    /// # Errors
    ///
    /// [`ProgramError::Duplicate`] if the graph lets a genome pick two ways to one value. Ours
    /// does not; whether any does is not seen from the graph alone.
    ///
    /// # Panics
    ///
    /// If the genome is not of this graph's length.
    pub fn program(&self, genome: &Genome) -> Result<Program, ProgramError> {
        let order = self.order(genome);
        let mut place = vec![None; self.nodes().len()];
        for (index, id) in order.ids.iter().enumerate() {
            place[id.index()] = Some(index as u32);
        }
        let statements = order.ids.iter().map(|&id| Statement {
            op: self.node(id).op,
            operands: (order.live.operands(self, id).into_iter())
                .map(|operand| place[operand.index()].expect("an operand is live"))
                .collect(),
        });
        Program::new(statements.collect())
    }

    /// The live statements that `genome` picks, in the order of its program.
    ///
    /// # Panics
    ///
    /// If the genome is not of this graph's length.
    pub fn statements(&self, genome: &Genome) -> Vec<NodeId> {
        self.order(genome).ids
    }

    /// Every live node that `genome` picks, choices and groups included.
    ///
    /// # Panics
    ///
    /// If the genome is not of this graph's length.
    pub fn live(&self, genome: &Genome) -> Vec<NodeId> {
        let live = Live::mark(self, genome);
        let ids = (0..self.nodes().len()).map(NodeId::from_index);
        ids.filter(|&id| live.is_itself(id) || live.is_live(id) && self.node(id).op == Op::Choice)
            .collect()
    }

    /// Every live choice with the option that satisfies it, in order of the choices' numbers.
    ///
    /// # Panics
    ///
    /// If the genome is not of this graph's length.
    pub fn choices(&self, genome: &Genome) -> Vec<Decided> {
        let live = Live::mark(self, genome);
        let ids = (0..self.nodes().len()).map(NodeId::from_index);
        let choices = ids.filter(|&id| self.node(id).op == Op::Choice);
        let decided = choices.filter_map(|choice| {
            let option = live.stands_for[choice.index()]?;
            Some(Decided { choice, option })
        });
        decided.collect()
    }

    /// The live nodes that a node stands on, itself first if it is live; nothing if it is not.
    ///
    /// # Panics
    ///
    /// If the genome is not of this graph's length, or the node not of this graph.
    pub fn live_below(&self, genome: &Genome, id: NodeId) -> Vec<NodeId> {
        let live = Live::mark(self, genome);
        let mut below = Vec::new();
        let mut seen = vec![false; self.nodes().len()];
        let mut open = vec![id];
        while let Some(id) = open.pop() {
            let Some(stand_in) = live.stands_for[id.index()] else {
                continue;
            };
            if std::mem::replace(&mut seen[id.index()], true) {
                continue;
            }
            below.push(id);
            // What satisfies a choice, or the cross that is the same vector.
            if stand_in != id {
                open.push(stand_in);
            } else {
                open.extend(&self.node(id).required);
            }
        }
        below
    }

    fn order(&self, genome: &Genome) -> Order {
        let live = Live::mark(self, genome);
        let statements = (0..self.nodes().len())
            .map(NodeId::from_index)
            .filter(|&id| live.is_itself(id) && self.node(id).op.is_statement());
        let mut waits_for = vec![0; self.nodes().len()];
        let mut needed_by: Vec<Vec<NodeId>> = vec![Vec::new(); self.nodes().len()];
        let mut ready = BinaryHeap::new();
        let priority = |id: NodeId| (genome.priorities()[id.index()], id);
        for id in statements {
            let operands = live.operands(self, id);
            if operands.is_empty() {
                ready.push(priority(id));
            }
            waits_for[id.index()] = operands.len();
            for operand in operands {
                needed_by[operand.index()].push(id);
            }
        }
        let mut ids = Vec::new();
        while let Some((_, id)) = ready.pop() {
            ids.push(id);
            for &user in &needed_by[id.index()] {
                waits_for[user.index()] -= 1;
                if waits_for[user.index()] == 0 {
                    ready.push(priority(user));
                }
            }
        }
        Order { live, ids }
    }
}

/// A live choice and what satisfies it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decided {
    /// The choice.
    pub choice: NodeId,
    /// One of its options.
    pub option: NodeId,
}

struct Order {
    live: Live,
    ids: Vec<NodeId>,
}

/// The marks of the depth-first walk.
struct Live {
    /// For every live node itself, or what satisfies it: the option of a choice, or the live
    /// cross that is the same vector.
    stands_for: Vec<Option<NodeId>>,
    /// The live cross for the first node of its vector.
    vectors: HashMap<NodeId, NodeId>,
}

impl Live {
    fn mark(graph: &Graph, genome: &Genome) -> Live {
        assert_eq!(
            genome.len(),
            graph.nodes().len(),
            "a genome of another graph"
        );
        let stands_for = vec![None; graph.nodes().len()];
        let vectors = HashMap::new();
        let mut live = Live {
            stands_for,
            vectors,
        };
        live.visit(graph, genome, graph.goal(), 0);
        live
    }

    /// The recursion is as deep as the graph, which [`MAX_DEPTH`] bounds.
    fn visit(&mut self, graph: &Graph, genome: &Genome, id: NodeId, depth: usize) {
        debug_assert!(depth <= MAX_DEPTH);
        if self.is_live(id) {
            return;
        }
        if let Some(vector) = graph.same().vector(id) {
            let live = *self.vectors.entry(vector).or_insert(id);
            if live != id {
                self.stands_for[id.index()] = Some(live);
                return;
            }
        }
        self.stands_for[id.index()] = Some(id);
        let node = graph.node(id);
        let mut required = node.required.clone();
        required.sort_by_key(|&id| graph.node(id).optional.len());
        for required in required {
            self.visit(graph, genome, required, depth + 1);
        }
        let preferred = |option: &&NodeId| {
            let priority = genome.priorities()[option.index()];
            (self.is_live(**option), priority)
        };
        if let Some(&option) = node.optional.iter().max_by_key(preferred) {
            let option = self.cheapest_twin(graph, genome, &node.optional, option);
            self.stands_for[id.index()] = Some(option);
            self.visit(graph, genome, option, depth + 1);
        }
    }

    /// Of the options that write the same number as `option`, the one that adds least to what is
    /// live; of several, the one of highest priority.
    fn cheapest_twin(
        &self,
        graph: &Graph,
        genome: &Genome,
        options: &[NodeId],
        option: NodeId,
    ) -> NodeId {
        if self.is_live(option) {
            return option;
        }
        let twins = graph.same().twins(option).iter().copied();
        twins
            .filter(|twin| options.contains(twin))
            .min_by_key(|&twin| {
                let priority = genome.priorities()[twin.index()];
                (self.operations_to_add(graph, twin), Reverse(priority))
            })
            .unwrap_or(option)
    }

    /// Operations of the vectors that would become live with a node.
    fn operations_to_add(&self, graph: &Graph, id: NodeId) -> u32 {
        let vector = graph.same().vector(id);
        if self.is_live(id) || vector.is_some_and(|vector| self.vectors.contains_key(&vector)) {
            return 0;
        }
        let node = graph.node(id);
        let own = match node.op {
            Op::Edge => 3,
            // Were the fused one cheaper, a plain one would always give way.
            Op::Cross | Op::FusedCross => 9,
            _ => 0,
        };
        let options = node.optional.iter();
        let option = options.map(|&option| self.operations_to_add(graph, option));
        let needed = node.required.iter();
        let needed = needed.map(|&required| self.operations_to_add(graph, required));
        own + needed.sum::<u32>() + option.min().unwrap_or(0)
    }

    fn is_live(&self, id: NodeId) -> bool {
        self.stands_for[id.index()].is_some()
    }

    /// Whether a node is live and nothing else stands in for it.
    fn is_itself(&self, id: NodeId) -> bool {
        self.stands_for[id.index()] == Some(id)
    }

    /// The statements that a statement works on.
    fn operands(&self, graph: &Graph, id: NodeId) -> Vec<NodeId> {
        let required = &graph.node(id).required;
        let mut operands = Vec::with_capacity(required.len());
        for &required in required {
            self.resolve(graph, required, &mut operands);
        }
        if graph.node(id).op == Op::Store {
            // A test may have to be passed on several counts.
            let mut seen = HashSet::new();
            operands.retain(|&operand| seen.insert(operand));
        }
        operands
    }

    /// Follows choices and groups to the statements that they stand for.
    fn resolve(&self, graph: &Graph, id: NodeId, found: &mut Vec<NodeId>) {
        let node = graph.node(id);
        match node.op {
            Op::Choice => self.resolve(graph, self.stand_in(id), found),
            Op::All => {
                for &member in &node.required {
                    self.resolve(graph, member, found);
                }
            }
            _ => found.push(self.stand_in(id)),
        }
    }

    fn stand_in(&self, id: NodeId) -> NodeId {
        self.stands_for[id.index()].expect("what a live node needs is live")
    }
}

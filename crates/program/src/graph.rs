//! The dependency graph: nodes with required and optional dependencies, as data.
//!
//! A graph comes from a file, so nothing in it is trusted: sizes, indices, cycles, names and the
//! meaning of every node are checked before it is used.

use serde::{Deserialize, Serialize};

use crate::op::Op;
use crate::quantity::{Misfit, Quantity};
use crate::same::Same;

/// The most nodes that a graph may have.
pub const MAX_NODES: usize = 1 << 16;

/// The longest chain of dependencies that a graph may have.
pub const MAX_DEPTH: usize = 256;

/// The number of a node in its graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct NodeId(u32);

impl NodeId {
    /// The node at `index`.
    ///
    /// # Panics
    ///
    /// If the index is beyond 32 bits.
    pub fn from_index(index: usize) -> NodeId {
        NodeId(u32::try_from(index).expect("a node number of 32 bits"))
    }

    /// The node's place in [`Graph::nodes`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// One statement of the graph.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Node {
    /// The node's number, which is its place in the list.
    pub id: NodeId,
    /// A name for people, of `[a-z0-9._-]`.
    pub name: String,
    /// What it does.
    pub op: Op,
    /// All of these are needed: the operands, in order.
    pub required: Vec<NodeId>,
    /// At least one of these is needed. Only a choice has any.
    pub optional: Vec<NodeId>,
}

/// A checked graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Graph {
    goal: NodeId,
    nodes: Vec<Node>,
    quantities: Vec<Quantity>,
    same: Same,
}

/// The graph as it stands in a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File<N> {
    goal: NodeId,
    nodes: N,
}

/// What is wrong with a graph.
#[derive(Debug, thiserror::Error)]
pub enum GraphError {
    /// Not the JSON of a graph.
    #[error("not a graph: {}", .0.to_string().replace(char::is_control, " "))]
    Json(#[from] serde_json::Error),
    /// Too large to be one of ours.
    #[error("{0} nodes, more than the {MAX_NODES} that a graph may have")]
    TooManyNodes(usize),
    /// A chain of dependencies that is too long.
    #[error("node {0} has a chain of more than {MAX_DEPTH} dependencies")]
    TooDeep(usize),
    /// A node out of its place.
    #[error("node {0} stands in another's place: ids must count from 0")]
    Misplaced(usize),
    /// A name that is no name.
    #[error("node {0} has a name that is not of [a-z0-9._-], or has '..' in it, or is taken")]
    Name(usize),
    /// A dependency on a node that there is not.
    #[error("node {0} depends on node {1}, which does not exist")]
    Dangling(usize, usize),
    /// Optional dependencies where they mean nothing, or required ones of a choice.
    #[error(
        "node {0} mixes up its dependencies: a choice has optional ones only, others required ones only"
    )]
    Dependencies(usize),
    /// Nodes that need each other.
    #[error("node {0} depends on itself in a cycle")]
    Cycle(usize),
    /// A node whose operands do not fit.
    #[error("node {node}: {misfit}")]
    Misfit {
        /// The node.
        node: usize,
        /// What does not fit.
        misfit: Misfit,
    },
    /// A group where one mask is needed: in a program it is several.
    #[error("node {0} works on a group of tests, which can only be stored, or an option")]
    Group(usize),
    /// The goal is no store.
    #[error("the goal must be a node that stores the hit")]
    Goal,
}

impl Graph {
    /// Checks `nodes` and makes them a graph.
    ///
    /// # Errors
    ///
    /// [`GraphError`] names the first node that is wrong, and what is wrong with it.
    pub fn new(goal: NodeId, nodes: Vec<Node>) -> Result<Graph, GraphError> {
        if nodes.len() > MAX_NODES {
            return Err(GraphError::TooManyNodes(nodes.len()));
        }
        check_names(&nodes)?;
        check_dependencies(&nodes)?;
        let mut quantities: Vec<Option<Quantity>> = vec![None; nodes.len()];
        let mut may_be_group = vec![false; nodes.len()];
        for index in dependencies_first(&nodes)? {
            let node = &nodes[index];
            let of_group = dependencies(node).any(|id| may_be_group[id.index()]);
            may_be_group[index] = node.op == Op::All || of_group;
            if of_group && !matches!(node.op, Op::Choice | Op::Store) {
                return Err(GraphError::Group(index));
            }
            let operands: Vec<(Op, Quantity)> = dependencies(node)
                .map(|id| {
                    let quantity = quantities[id.index()].expect("dependencies come first");
                    (nodes[id.index()].op, quantity)
                })
                .collect();
            let quantity = node.op.quantity(&operands);
            let misfit = |misfit| GraphError::Misfit {
                node: index,
                misfit,
            };
            quantities[index] = Some(quantity.map_err(misfit)?);
        }
        let quantities: Vec<Quantity> = quantities.into_iter().flatten().collect();
        if quantities.get(goal.index()) != Some(&Quantity::Stored) {
            return Err(GraphError::Goal);
        }
        let ops: Vec<Op> = nodes.iter().map(|node| node.op).collect();
        let same = Same::new(&ops, &quantities, |index| &nodes[index].required);
        Ok(Graph {
            goal,
            nodes,
            quantities,
            same,
        })
    }

    /// Reads and checks a graph.
    ///
    /// # Errors
    ///
    /// [`GraphError`], as for [`Graph::new`], or if the text is not the JSON of a graph.
    pub fn from_json(text: &str) -> Result<Graph, GraphError> {
        let file: File<Vec<Node>> = serde_json::from_str(text)?;
        Graph::new(file.goal, file.nodes)
    }

    /// The graph as JSON, one node a line.
    pub fn to_json(&self) -> String {
        let lines: Vec<String> = self
            .nodes
            .iter()
            .map(|node| serde_json::to_string(node).expect("a node has only numbers and names"))
            .collect();
        let goal = self.goal.index();
        format!(
            "{{\"goal\":{goal},\"nodes\":[\n{}\n]}}\n",
            lines.join(",\n")
        )
    }

    /// The node that every program ends with.
    pub fn goal(&self) -> NodeId {
        self.goal
    }

    /// The nodes, in order of their numbers.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// One node.
    ///
    /// # Panics
    ///
    /// If the number is of another graph.
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.index()]
    }

    /// What a node computes.
    ///
    /// # Panics
    ///
    /// If the number is of another graph.
    pub fn quantity(&self, id: NodeId) -> Quantity {
        self.quantities[id.index()]
    }

    /// The same graph with other dependencies: nodes whose quantities they leave as they are.
    pub(crate) fn with_nodes(&self, nodes: Vec<Node>) -> Graph {
        Graph {
            nodes,
            ..self.clone()
        }
    }

    /// Which nodes are other ways to write the same value.
    pub(crate) fn same(&self) -> &Same {
        &self.same
    }

    /// The node of that name.
    pub fn find(&self, name: &str) -> Option<NodeId> {
        let node = self.nodes.iter().find(|node| node.name == name)?;
        Some(node.id)
    }
}

/// A node's dependencies: the required ones, or a choice's options.
fn dependencies(node: &Node) -> impl Iterator<Item = &NodeId> {
    node.required.iter().chain(&node.optional)
}

fn check_names(nodes: &[Node]) -> Result<(), GraphError> {
    let mut names = std::collections::HashSet::new();
    let allowed = |c: u8| c.is_ascii_lowercase() || c.is_ascii_digit() || b"._-".contains(&c);
    for (index, node) in nodes.iter().enumerate() {
        if node.id.index() != index {
            return Err(GraphError::Misplaced(index));
        }
        let harmless = !node.name.is_empty()
            && node.name.len() <= 100
            && node.name.bytes().all(allowed)
            && !node.name.contains("..");
        if !harmless || !names.insert(&node.name) {
            return Err(GraphError::Name(index));
        }
    }
    Ok(())
}

fn check_dependencies(nodes: &[Node]) -> Result<(), GraphError> {
    for (index, node) in nodes.iter().enumerate() {
        if let Some(id) = dependencies(node).find(|id| id.index() >= nodes.len()) {
            return Err(GraphError::Dangling(index, id.index()));
        }
        let of_the_other_kind = match node.op {
            Op::Choice => &node.required,
            _ => &node.optional,
        };
        if !of_the_other_kind.is_empty() {
            return Err(GraphError::Dependencies(index));
        }
    }
    Ok(())
}

/// The nodes in an order in which every node comes after its dependencies.
pub(crate) fn dependencies_first(nodes: &[Node]) -> Result<Vec<usize>, GraphError> {
    let mut waits_for: Vec<usize> = nodes
        .iter()
        .map(|node| dependencies(node).count())
        .collect();
    let mut needed_by: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        for id in dependencies(node) {
            needed_by[id.index()].push(index);
        }
    }
    let mut depth = vec![0; nodes.len()];
    let mut order: Vec<usize> = (0..nodes.len()).filter(|&i| waits_for[i] == 0).collect();
    let mut next = 0;
    while let Some(&index) = order.get(next) {
        next += 1;
        for &user in &needed_by[index] {
            depth[user] = depth[user].max(depth[index] + 1);
            if depth[user] > MAX_DEPTH {
                return Err(GraphError::TooDeep(user));
            }
            waits_for[user] -= 1;
            if waits_for[user] == 0 {
                order.push(user);
            }
        }
    }
    match waits_for.iter().position(|&count| count > 0) {
        None => Ok(order),
        Some(index) => Err(GraphError::Cycle(index)),
    }
}

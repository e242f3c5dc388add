//! Rules: what a scene leaves of a graph.
//!
//! A rule speaks of one statement, so the same rules restrict a graph, whose genomes then pick
//! only programs that keep to them, and judge a program that comes from a file.

use volumes::{Cross, Edge, Point, TripleProduct, Vector, Volume};

use crate::graph::{Graph, Node, dependencies_first};
use crate::op::{On, Op, SameSign, Side, StoredEdge};
use crate::quantity::{Condition, Quantity};
use crate::shear::{Rounding, Shear};
use crate::statements::Program;

/// What a scene allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rules {
    /// Whether a reciprocal may begin with the processor's estimate.
    pub estimates: bool,
    /// Whether the range of `t` may be tested before the division. There `Va·V < t_max·V²` compares
    /// with a `t_max` that was rounded otherwise, so of two hits of nearly one `t` each may be nearer
    /// than the other, and which of them stays depends on the order of the triangles.
    pub early_range: bool,
    /// Whether a multiplication may be fused with an addition.
    pub fused: bool,
    /// Whether every volume is known to be finite. Only then may a near test that is made before the
    /// division go with a far test that is made after it: an infinite `V` has `t = 0`, which such a
    /// pair would take for a hit.
    pub finite: bool,
    /// Whether volumes may be multiplied by each other, or their reciprocals squared. The product is
    /// zero or infinite where volumes are very small or very large, and a test of it is wrong.
    pub squares: bool,
    /// Whether rays are segments, whose other end is to be had.
    pub ends: bool,
    /// Which rays must not slip between triangles.
    pub watertight: Watertight,
    /// What is stored of a triangle.
    pub vertices: Vertices,
}

/// Which rays must not slip between the triangles of a closed surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Watertight {
    /// Any may.
    No,
    /// None through an edge that two triangles share. What tells a side depends on that edge and
    /// the ray alone and changes its sign, and nothing else, if the edge is walked the other way,
    /// as the neighbour does. So:
    ///
    /// - a side's volume is `(x × y) · d`, where `x` and `y` are the edges between the ray's
    ///   origin and the two ends of the side, each in either direction, nothing of it fused. Its three
    ///   products may be summed in any order: rounding is monotonic, so a sum that is rounded once before its
    ///   last addition never has the sign opposite to the exact one of the three, and the neighbour's, summed
    ///   otherwise, is of the other sign or one of the two is zero;
    /// - no other cross product stands for `x × y`, not in `Va` either: it would be the same
    ///   vector, rounded otherwise, or its opposite, which no program needs beside it;
    /// - `V` is the sum of the three, or a triple product of its own, of which rounding can turn the sign only
    ///   where the ray lies in the triangle's plane but for 2^-20 and passes both of two sides at once, as at a
    ///   vertex; but not what the ends of a segment have between them;
    /// - none of the three is what `V` leaves of the others;
    /// - the inside test is the ordered one of the three signs, for which a zero is inside on
    ///   both sides of the edge;
    /// - or the volumes are those of sheared vertices, all of whose coordinates are rounded in the one
    ///   way: what they tell apart is two points of a plane.
    ///
    /// Where many triangles meet in one vertex, rays may still slip through that.
    Edges,
    /// None at all. Every vertex is mapped to one point of a plane by the ray alone, every time
    /// with the same operations, and on which side of an edge the ray goes by is told by a volume
    /// whose sign is right. So:
    ///
    /// - volumes are those of sheared vertices, exact in sign;
    /// - all coordinates are rounded in the one way, fused if products may be and else not;
    /// - `V` is the sum of the three, and `Va` that of the vertices' depths;
    /// - the inside test is as above; one of rounded volumes may come before it, since none that it
    ///   loses would pass.
    Full,
}

/// What is stored of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Vertices {
    /// Its three vertices.
    Points,
    /// Its first vertex and the edges from there to the two others, which themselves are not to
    /// be had: to add an edge to the first vertex does not give them back exactly.
    Edges,
}

impl Rules {
    /// All that a graph has is allowed; triangles are stored by their vertices.
    ///
    /// Kernels of scenes without bounds must not have all of it: see [`Rules::ORDINARY`].
    pub const ALL: Rules = Rules {
        estimates: true,
        early_range: true,
        fused: true,
        finite: true,
        squares: true,
        ends: true,
        watertight: Watertight::No,
        vertices: Vertices::Points,
    };

    /// All but what takes bounds to be sure of.
    pub const ORDINARY: Rules = Rules {
        finite: false,
        ..Rules::ALL
    };

    /// Only what every processor rounds alike.
    pub const PORTABLE: Rules = Rules {
        estimates: false,
        fused: false,
        ..Rules::ORDINARY
    };

    /// Whether a statement of this operation and these operands is allowed.
    pub fn allows(&self, op: Op, operands: &[Quantity]) -> bool {
        (self.estimates || !op.is_estimate())
            && (self.early_range || !matches!(op, Op::Near(On::Product) | Op::Far(On::Product)))
            && (self.finite || !splits_range(op, operands))
            && (self.squares || !op.squares_volumes())
            && (self.fused || !op.is_fused())
            && (self.ends || op != Op::Load(Point::B))
            && self.vertices.allow(op)
            && self.watertight.allows(op, operands)
            && (self.watertight == Watertight::No || self.maps_alike(op))
    }

    /// Whether an operation, if it maps vertices, is the one that all programs map them by.
    fn maps_alike(&self, op: Op) -> bool {
        match op {
            Op::Shear(Shear::Coordinate(_, rounding)) => {
                (rounding == Rounding::Fused) == self.fused
            }
            _ => true,
        }
    }
}

impl Watertight {
    /// Whether a statement is one of those that programs of this class have. How coordinates are rounded
    /// is a matter of all of them together.
    pub(crate) fn allows(self, op: Op, operands: &[Quantity]) -> bool {
        match self {
            Watertight::No => true,
            Watertight::Edges => keeps_edges_tight(op, operands),
            Watertight::Full => keeps_vertices_tight(op),
        }
    }
}

/// Whether an operation is of those that let nothing through.
fn keeps_vertices_tight(op: Op) -> bool {
    match op {
        Op::Shear(Shear::Volume(_, difference)) => difference.has_exact_sign(),
        Op::Volume(..)
        | Op::DifferenceOfEnds
        | Op::Rest(_)
        | Op::Side(..)
        | Op::SameSign(SameSign::Bits) => false,
        _ => true,
    }
}

/// Whether an operation that needs tests of `t` has the near one before the division and the far one
/// after it.
fn splits_range(op: Op, operands: &[Quantity]) -> bool {
    let tests = |condition| operands.contains(&Quantity::Tested(condition));
    matches!(op, Op::Store | Op::All)
        && tests(Condition::Far(On::Quotient))
        && ![
            Condition::Near(On::Quotient),
            Condition::Far(On::Product),
            Condition::Range,
        ]
        .into_iter()
        .any(tests)
}

impl Vertices {
    /// Whether they can be loaded as `op` does.
    fn allow(self, op: Op) -> bool {
        match self {
            Vertices::Points => !matches!(op, Op::LoadEdge(_)),
            Vertices::Edges => !matches!(op, Op::Load(Point::P1 | Point::P2)),
        }
    }
}

fn keeps_edges_tight(op: Op, operands: &[Quantity]) -> bool {
    match op {
        Op::Cross | Op::FusedCross => match operands {
            &[Quantity::Vector(left), Quantity::Vector(right)] => {
                let cross = Cross { left, right };
                !is_of_face_with_origin(cross) || op == Op::Cross && is_of_side(cross)
            }
            _ => true,
        },
        Op::Volume(Volume::V | Volume::Va | Volume::Vb, _) => true,
        Op::Volume(_, summation) => match operands {
            [Quantity::Cross(cross), Quantity::Vector(Vector::Direction)] => {
                !summation.is_fused() && is_of_side(*cross)
            }
            _ => false,
        },
        Op::DifferenceOfEnds | Op::Rest(_) | Op::Side(..) | Op::SameSign(SameSign::Bits) => false,
        _ => true,
    }
}

/// Whether a cross is of two edges that both begin or end in the ray's origin, and its product
/// with the direction is the volume of a side.
fn is_of_side(cross: Cross) -> bool {
    let joins_origin = |vector: Vector| {
        let edge = vector.edge();
        edge.is_some_and(|edge: Edge| edge.joins(Point::A))
    };
    let dot = Vector::Direction;
    let is = |side: Side| side.volume().is(TripleProduct { cross, dot });
    joins_origin(cross.left) && joins_origin(cross.right) && Side::ALL.into_iter().any(is)
}

/// Whether a cross is of two edges of one triangle that the ray's origin is a corner of.
fn is_of_face_with_origin(Cross { left, right }: Cross) -> bool {
    let (Some(left), Some(right)) = (left.edge(), right.edge()) else {
        return false;
    };
    let corners = [left.to, left.from, right.to, right.from];
    let count = Point::ALL.iter().filter(|point| corners.contains(point));
    corners.contains(&Point::A) && count.count() == 3
}

/// No program of a graph keeps to the rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no program of the graph keeps to these rules")]
pub struct Unsatisfiable;

impl Graph {
    /// The same nodes, of which programs have only those that the rules allow.
    ///
    /// A node is possible if it is allowed and all that it requires is possible, a choice if one
    /// of its options is. Choices keep their possible options, one at least; nothing leads to what
    /// is impossible, which stays as it was. Numbers and names stay, so genomes fit both graphs.
    ///
    /// Where edges are stored, the differences of points that they are become loads of them.
    ///
    /// # Errors
    ///
    /// [`Unsatisfiable`] if the goal is impossible.
    pub fn restricted(&self, rules: &Rules) -> Result<Graph, Unsatisfiable> {
        let mut nodes = self.nodes().to_vec();
        if rules.vertices == Vertices::Edges {
            for node in &mut nodes {
                if let Some(stored) = stored_edge(node.op, self.quantity(node.id)) {
                    node.op = Op::LoadEdge(stored);
                    node.required.clear();
                }
            }
        }
        let order = dependencies_first(&nodes).expect("a part of a graph has no cycle");
        let mut possible = vec![false; nodes.len()];
        for index in order {
            possible[index] = match nodes[index].op {
                Op::Choice => keep_possible(&mut nodes[index], &possible),
                _ => self.is_possible(&nodes[index], rules, &possible),
            };
        }
        if possible[self.goal().index()] {
            Ok(self.with_nodes(nodes))
        } else {
            Err(Unsatisfiable)
        }
    }

    /// Whether a node that is no choice is allowed and has all that it needs.
    fn is_possible(&self, node: &Node, rules: &Rules, possible: &[bool]) -> bool {
        let operands = node.required.iter().map(|&id| self.quantity(id));
        let operands: Vec<Quantity> = operands.collect();
        rules.allows(node.op, &operands) && node.required.iter().all(|id| possible[id.index()])
    }
}

/// Leaves a choice its possible options. False if there are none, and then it is as it was.
fn keep_possible(choice: &mut Node, possible: &[bool]) -> bool {
    let options = choice.optional.iter().copied();
    let options: Vec<_> = options.filter(|id| possible[id.index()]).collect();
    let any = !options.is_empty();
    if any {
        choice.optional = options;
    }
    any
}

/// The stored edge that a statement need not compute.
fn stored_edge(op: Op, quantity: Quantity) -> Option<StoredEdge> {
    let is = |stored: &StoredEdge| quantity == Quantity::Vector(stored.edge().into());
    let mut stored = StoredEdge::ALL.into_iter();
    (op == Op::Edge).then(|| stored.find(is)).flatten()
}

/// The first statement of a program that its rules do not allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("statement {statement}, {op}, is not allowed here")]
pub struct Breach {
    /// Its place in the program.
    pub statement: usize,
    /// What it does.
    pub op: Op,
}

impl Program {
    /// The first statement that the rules do not allow, if any.
    pub fn breaks(&self, rules: &Rules) -> Option<Breach> {
        let mut statements = self.ops_with_operands().enumerate();
        let breach = statements.find(|(_, (op, operands))| !rules.allows(*op, operands))?;
        let (statement, (op, _)) = breach;
        Some(Breach { statement, op })
    }

    /// Every statement's operation and what it works on.
    pub(crate) fn ops_with_operands(&self) -> impl Iterator<Item = (Op, Vec<Quantity>)> {
        self.statements().iter().map(|statement| {
            let operands = statement.operands.iter();
            let operands = operands.map(|&operand| self.quantities()[operand as usize]);
            (statement.op, operands.collect())
        })
    }
}

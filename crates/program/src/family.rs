//! The table of families: how the nodes of a graph are made up.

use volumes::{Point, Vector, Volume};

use crate::graph::{Graph, NodeId};
use crate::op::{Op, Reciprocal};
use crate::quantity::Quantity;
use crate::shear::Shear;

/// A family of nodes, in the order of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Family {
    /// Loads of points, direction and bound; constants; the mask.
    Input,
    /// The load of a segment's other end.
    InputOfEnd,
    /// Directed edges.
    Edge,
    /// Directed edges from or to a segment's other end.
    EdgeOfEnd,
    /// The direction's longest component, and the rows of the shear.
    Shear,
    /// Sheared vertices.
    ShearedVertex,
    /// How a coordinate of a sheared vertex is rounded.
    ChoiceOfRounding,
    /// Volumes as edge functions of sheared vertices.
    EdgeFunction,
    /// How a volume gets its sign right.
    ChoiceOfEdgeFunction,
    /// Cross products.
    Cross,
    /// Cross products with fused operations.
    FusedCross,
    /// Whether a cross product is fused.
    ChoiceOfCross,
    /// Triple products of `V` or of one side's volume.
    TripleProduct,
    /// The same with fused operations.
    FusedTripleProduct,
    /// Triple products of `Va`.
    TripleProductOfVa,
    /// The same with fused operations.
    FusedTripleProductOfVa,
    /// Triple products of `Vb`.
    TripleProductOfVb,
    /// The same with fused operations.
    FusedTripleProductOfVb,
    /// Which triple product a volume is.
    ChoiceOfTripleProduct,
    /// Volumes derived from others, and sums of two.
    DerivedVolume,
    /// `V` derived from `Va` and `Vb`.
    DifferenceOfEnds,
    /// Whether a volume is direct or derived.
    ChoiceOfVolume,
    /// Reciprocals, `t` and barycentric coordinates.
    Quotient,
    /// Reciprocals with fused operations.
    FusedQuotient,
    /// Which way a quotient is taken.
    ChoiceOfQuotient,
    /// Products with `V`.
    Product,
    /// Near, far, side and same-sign tests.
    Test,
    /// The test of a segment's ends.
    TestOfEnds,
    /// Which test is made, and which strategy.
    ChoiceOfTest,
    /// Early exits.
    Exit,
    /// Whether to exit after a test.
    ChoiceOfExit,
    /// Tests that only together are a strategy.
    Together,
    /// The store, which is the goal.
    Store,
}

impl Family {
    /// What the table says of it.
    pub fn description(self) -> &'static str {
        match self {
            Family::Input => "loads of p0, p1, p2, a, d and t_max; 0 and 1; the mask",
            Family::InputOfEnd => "load of b, the other end of a segment",
            Family::EdgeOfEnd => "directed edges between b and p0, p1, p2",
            Family::Edge => "directed edges between a, p0, p1, p2",
            Family::Shear => {
                "|d|, along which axis it is greatest, and the three rows of the shear"
            }
            Family::ShearedVertex => "coordinates of sheared vertices: 9, rounded in two ways",
            Family::ChoiceOfRounding => "choices: how a coordinate is rounded",
            Family::EdgeFunction => {
                "edge functions: V0, V1, V2 rounded for a first test; in three ways; Va of depths in two"
            }
            Family::ChoiceOfEdgeFunction => "choices: V0, V1, V2, Va in which way",
            Family::Cross => "crosses: 120 of two edges, 24 of an edge and d",
            Family::FusedCross => "the same crosses, fused",
            Family::ChoiceOfCross => "choices: which of the two a cross is",
            Family::TripleProduct => {
                "triple products of V, V0, V1, V2: 36 each, summed in two orders"
            }
            Family::TripleProductOfVa => "triple products of Va: 384, summed in two orders",
            Family::FusedTripleProduct => "triple products of V, V0, V1, V2, fused, in two orders",
            Family::FusedTripleProductOfVa => "triple products of Va, fused, in two orders",
            Family::TripleProductOfVb => "triple products of Vb: 72, summed in two orders",
            Family::FusedTripleProductOfVb => "triple products of Vb, fused, in two orders",
            Family::ChoiceOfTripleProduct => "choices: which triple product a volume is",
            Family::DerivedVolume => {
                "V = V0 + V1 + V2; V0, V1, V2 as what V leaves of the others; V1 + V2"
            }
            Family::DifferenceOfEnds => "V = Va - Vb",
            Family::ChoiceOfVolume => "choices: V, V0, V1, V2 direct or derived",
            Family::Quotient => {
                "1/V exact, and by estimate and Newton step; t and α, β, γ each in two ways"
            }
            Family::FusedQuotient => "1/V by estimate and fused Newton step",
            Family::ChoiceOfQuotient => "choices: which way to 1/V, t, α, β, γ",
            Family::Product => "V² and Va·V, for tests before the division",
            Family::Test => "tests: 3 near, 2 far; 4, 3 and 3 for the sides; 2 of same signs",
            Family::TestOfEnds => "test: a and b not on one side of the triangle's plane",
            Family::ChoiceOfTest => {
                "choices: which near, far, side and same-sign test; which strategy"
            }
            Family::Exit => "early exits: after near, far, each side, same signs",
            Family::ChoiceOfExit => "choices: exit or not",
            Family::Together => {
                "tests that go together: near and far on t, before the division; the three sides"
            }
            Family::Store => "the store, which is the goal",
        }
    }

    /// The family of one node.
    pub fn of(graph: &Graph, id: NodeId) -> Family {
        let node = graph.node(id);
        match node.op {
            Op::Load(Point::B) => Family::InputOfEnd,
            Op::Load(_) | Op::LoadEdge(_) | Op::LoadDirection | Op::LoadTMax => Family::Input,
            Op::Zero | Op::One | Op::Mask => Family::Input,
            Op::Edge => match graph.quantity(id) {
                Quantity::Vector(Vector::Edge(edge)) if edge.joins(Point::B) => Family::EdgeOfEnd,
                _ => Family::Edge,
            },
            Op::Shear(Shear::Coordinate(..)) => Family::ShearedVertex,
            Op::Shear(Shear::Rounded(_) | Shear::Volume(..) | Shear::Depths(_)) => {
                Family::EdgeFunction
            }
            Op::Shear(_) => Family::Shear,
            Op::Cross => Family::Cross,
            Op::FusedCross => Family::FusedCross,
            Op::Volume(Volume::Va, summation) if summation.is_fused() => {
                Family::FusedTripleProductOfVa
            }
            Op::Volume(Volume::Va, _) => Family::TripleProductOfVa,
            Op::Volume(Volume::Vb, summation) if summation.is_fused() => {
                Family::FusedTripleProductOfVb
            }
            Op::Volume(Volume::Vb, _) => Family::TripleProductOfVb,
            Op::Volume(_, summation) if summation.is_fused() => Family::FusedTripleProduct,
            Op::Volume(..) => Family::TripleProduct,
            Op::DifferenceOfEnds => Family::DifferenceOfEnds,
            Op::SumOfSides | Op::Rest(_) | Op::PairSum(_) => Family::DerivedVolume,
            Op::Square | Op::Product => Family::Product,
            Op::Reciprocal(Reciprocal::FusedNewton) => Family::FusedQuotient,
            Op::Reciprocal(_)
            | Op::TMultiply
            | Op::TDivide
            | Op::BarycentricMultiply(_)
            | Op::BarycentricRest(_) => Family::Quotient,
            Op::Ends => Family::TestOfEnds,
            Op::Near(_) | Op::Far(_) | Op::Side(..) | Op::SameSign(_) => Family::Test,
            Op::Exit => Family::Exit,
            Op::Store => Family::Store,
            Op::All => Family::Together,
            Op::Choice => {
                let has = |is: fn(Op) -> bool| {
                    node.optional
                        .iter()
                        .any(|&option| is(graph.node(option).op))
                };
                match graph.quantity(id) {
                    Quantity::Cross(_) => Family::ChoiceOfCross,
                    Quantity::Sheared(..) => Family::ChoiceOfRounding,
                    Quantity::Volume(_) if has(|op| matches!(op, Op::Shear(_))) => {
                        Family::ChoiceOfEdgeFunction
                    }
                    Quantity::Volume(_) if has(|op| matches!(op, Op::Volume(..))) => {
                        Family::ChoiceOfTripleProduct
                    }
                    Quantity::Volume(_) => Family::ChoiceOfVolume,
                    Quantity::Tested(_) if has(|op| op == Op::Exit) => Family::ChoiceOfExit,
                    Quantity::Tested(_) => Family::ChoiceOfTest,
                    _ => Family::ChoiceOfQuotient,
                }
            }
        }
    }
}

/// The table of a graph's families as Markdown, with the total in its last row.
pub fn family_table(graph: &Graph) -> String {
    let mut counts = std::collections::BTreeMap::<Family, usize>::new();
    for node in graph.nodes() {
        *counts.entry(Family::of(graph, node.id)).or_default() += 1;
    }
    let rows = counts
        .iter()
        .map(|(family, count)| (family.description(), *count));
    let rows: Vec<(&str, usize)> = rows.chain([("all nodes", graph.nodes().len())]).collect();
    let width = rows
        .iter()
        .map(|(text, _)| text.chars().count())
        .max()
        .unwrap_or(0);
    let mut table = format!(
        "| {:width$} | nodes |\n|-{:-<width$}-|------:|\n",
        "family", ""
    );
    for (text, count) in rows {
        table += &format!("| {text:width$} | {count:5} |\n");
    }
    table
}

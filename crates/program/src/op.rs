//! The closed set of operations: everything that a node of the graph, or a statement of a
//! program, can be.
//!
//! An operation is data. Files spell it by the names below and by nothing else, so no text of a
//! file ever reaches emitted code.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use volumes::{Edge, Point, Volume};

use crate::shear::Shear;

/// A side of the triangle, numbered as the vertex opposite to it: side `i` goes with the volume
/// `V_i` and with the barycentric coordinate of vertex `i`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// Opposite `p0`: `V0`, α.
    S0,
    /// Opposite `p1`: `V1`, β.
    S1,
    /// Opposite `p2`: `V2`, γ.
    S2,
}

impl Side {
    /// All three, in order.
    pub const ALL: [Side; 3] = [Side::S0, Side::S1, Side::S2];

    /// The volume whose sign tells this side.
    pub fn volume(self) -> Volume {
        [Volume::V0, Volume::V1, Volume::V2][self as usize]
    }

    /// The two others, in order.
    pub fn others(self) -> [Side; 2] {
        match self {
            Side::S0 => [Side::S1, Side::S2],
            Side::S1 => [Side::S0, Side::S2],
            Side::S2 => [Side::S0, Side::S1],
        }
    }

    /// The barycentric coordinate's name in the paper.
    pub fn barycentric(self) -> &'static str {
        ["alpha", "beta", "gamma"][self as usize]
    }
}

/// The order in which a dot product is summed, and whether its multiplications are fused with its
/// additions. Compilers may neither re-associate floating-point addition nor round once what is
/// written to be rounded twice, so only the search can choose it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Summation {
    /// `(x + y) + z`.
    XyZ,
    /// `x + (y + z)`.
    XYz,
    /// `(x + y) + z`, where only the product of `x` is rounded by itself.
    FusedXyZ,
    /// `x + (y + z)`, where only the product of `z` is rounded by itself.
    FusedXYz,
}

impl Summation {
    /// Those that round every product by itself.
    pub const PLAIN: [Summation; 2] = [Summation::XyZ, Summation::XYz];

    /// All.
    pub const ALL: [Summation; 4] = [
        Summation::XyZ,
        Summation::XYz,
        Summation::FusedXyZ,
        Summation::FusedXYz,
    ];

    /// Whether multiplications are fused with additions.
    pub fn is_fused(self) -> bool {
        matches!(self, Summation::FusedXyZ | Summation::FusedXYz)
    }

    /// The same order, every product rounded by itself.
    fn unfused(self) -> Summation {
        match self {
            Summation::XyZ | Summation::FusedXyZ => Summation::XyZ,
            Summation::XYz | Summation::FusedXYz => Summation::XYz,
        }
    }
}

impl fmt::Display for Summation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Summation::XyZ => "xy_z",
            Summation::XYz => "x_yz",
            Summation::FusedXyZ => "xy_z.fused",
            Summation::FusedXYz => "x_yz.fused",
        })
    }
}

/// How `1 / V` is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Reciprocal {
    /// By division.
    Exact,
    /// By the processor's estimate `r` and one Newton step, `2r - r²V` as in the appendix of
    /// Kensler-Shirley.
    Newton,
    /// By the estimate and the step `r(1 - rV) + r` of two fused operations, the remainder's
    /// rounded once.
    FusedNewton,
}

/// What the test of a ray parameter is made on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum On {
    /// On `t` itself.
    Quotient,
    /// On products with `V`, before any division.
    Product,
    /// On `Va` with the sign that `V` gives it.
    Signs,
}

/// What the test of one side is made on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SideTest {
    /// The barycentric coordinate is at least zero.
    Quotient,
    /// `V_i · V` is at least zero.
    Product,
    /// The sign bits of `V_i` and `V` agree.
    Signs,
    /// `(V_j + V_k) · V` is at most `V²`, for the two other sides.
    Sum,
}

/// How three volumes are seen to have the same sign (section 3 of Kensler-Shirley, first
/// strategy).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SameSign {
    /// By their sign bits; a zero counts as its sign bit says.
    Bits,
    /// By ordered comparisons of their least and greatest with zero; a zero is inside.
    Ordered,
    /// In the same way, of volumes that were only rounded: none is outside whose exact volumes are
    /// inside, so it may come before the other.
    Rounded,
}

/// An edge that a scene may store with a triangle, beside its first vertex and instead of the
/// two others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StoredEdge {
    /// `p1-p0`.
    P1P0,
    /// `p2-p0`.
    P2P0,
}

impl StoredEdge {
    /// Both, in order.
    pub const ALL: [StoredEdge; 2] = [StoredEdge::P1P0, StoredEdge::P2P0];

    /// The edge.
    pub fn edge(self) -> Edge {
        let to = [Point::P1, Point::P2][self as usize];
        Edge {
            to,
            from: Point::P0,
        }
    }
}

/// An operation: what a node of the graph or a statement of a program does with its operands.
///
/// The operands that each takes are given by [`Op::quantity`], the arithmetic by
/// [`Op::definition`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Op {
    /// Loads a vertex or, for [`Point::A`] and [`Point::B`], an end of the ray.
    Load(Point),
    /// Loads an edge that is stored with the triangle. No graph has it: it takes the place of the
    /// difference of points where a scene stores edges ([`Graph::restricted`](crate::Graph::restricted)).
    LoadEdge(StoredEdge),
    /// Loads the ray's direction.
    LoadDirection,
    /// Loads the upper bound of the ray parameter.
    LoadTMax,
    /// The constant 0.
    Zero,
    /// The constant 1.
    One,
    /// The mask of rays still in question, true in every lane.
    Mask,
    /// The difference of two points, `first - second`.
    Edge,
    /// The cross product of two vectors.
    Cross,
    /// The same, of whose two products a component only the second is rounded by itself. Unlike
    /// the plain one it is not exactly the opposite if the vectors change places.
    FusedCross,
    /// A volume as a triple product: the dot product of a cross and a vector.
    Volume(Volume, Summation),
    /// `V` as the sum of `V0`, `V1` and `V2`.
    SumOfSides,
    /// `V` as what the two ends of a segment have between them, `Va - Vb`.
    DifferenceOfEnds,
    /// One side's volume as what `V` leaves of the two others'.
    Rest(Side),
    /// The sum of the volumes of the two *other* sides.
    PairSum(Side),
    /// `V²`.
    Square,
    /// `Va · V`.
    Product,
    /// `1 / V`.
    Reciprocal(Reciprocal),
    /// `t` as `Va` times the reciprocal of `V`.
    TMultiply,
    /// `t` as `Va / V`.
    TDivide,
    /// A barycentric coordinate as its volume times the reciprocal of `V`.
    BarycentricMultiply(Side),
    /// A barycentric coordinate as one minus the two others.
    BarycentricRest(Side),
    /// An operation of the sheared test.
    Shear(Shear),
    /// Keeps the rays with `t > 0`.
    Near(On),
    /// Keeps the rays with `t < t_max`.
    Far(On),
    /// Keeps the segments whose ends are not both on one side of the triangle's plane. Whether `t` is
    /// in its range must be tested beside it.
    Ends,
    /// Keeps the rays on the inner side of one side.
    Side(Side, SideTest),
    /// Keeps the rays for which the three sides' volumes have the same sign.
    SameSign(SameSign),
    /// Leaves the triangle if no ray of the vector is still in question.
    Exit,
    /// Lowers `t_max` to `t` for the rays still in question.
    Store,
    /// Nothing by itself: all of its operands are needed.
    All,
    /// Nothing by itself: one of its options is needed.
    Choice,
}

impl Op {
    /// Every operation, in a fixed order.
    pub fn all() -> impl Iterator<Item = Op> {
        let volumes = Volume::ALL
            .into_iter()
            .chain([Volume::Vb])
            .flat_map(|volume| Summation::ALL.map(|order| Op::Volume(volume, order)));
        let sides = Side::ALL.into_iter().flat_map(|side| {
            use SideTest::{Product, Quotient, Signs, Sum};
            let tests = [Quotient, Product, Signs, Sum].map(|test| Op::Side(side, test));
            [
                Op::Rest(side),
                Op::PairSum(side),
                Op::BarycentricMultiply(side),
                Op::BarycentricRest(side),
            ]
            .into_iter()
            .chain(tests)
        });
        [
            Op::Load(Point::P0),
            Op::Load(Point::P1),
            Op::Load(Point::P2),
            Op::Load(Point::A),
            Op::Load(Point::B),
            Op::LoadEdge(StoredEdge::P1P0),
            Op::LoadEdge(StoredEdge::P2P0),
            Op::LoadDirection,
            Op::LoadTMax,
            Op::Zero,
            Op::One,
            Op::Mask,
            Op::Edge,
            Op::Cross,
            Op::FusedCross,
            Op::SumOfSides,
            Op::DifferenceOfEnds,
            Op::Square,
            Op::Product,
            Op::Reciprocal(Reciprocal::Exact),
            Op::Reciprocal(Reciprocal::Newton),
            Op::Reciprocal(Reciprocal::FusedNewton),
            Op::TMultiply,
            Op::TDivide,
            Op::Near(On::Quotient),
            Op::Near(On::Product),
            Op::Near(On::Signs),
            Op::Far(On::Quotient),
            Op::Far(On::Product),
            Op::Ends,
            Op::SameSign(SameSign::Bits),
            Op::SameSign(SameSign::Ordered),
            Op::SameSign(SameSign::Rounded),
            Op::Exit,
            Op::Store,
            Op::All,
            Op::Choice,
        ]
        .into_iter()
        .chain(volumes)
        .chain(sides)
        .chain(Shear::all().map(Op::Shear))
    }

    /// Whether the operation narrows the mask of rays in question.
    pub fn is_test(self) -> bool {
        matches!(
            self,
            Op::Near(_) | Op::Far(_) | Op::Ends | Op::Side(..) | Op::SameSign(_)
        )
    }

    /// Whether the operation reads what the caller brings.
    pub fn is_input(self) -> bool {
        matches!(
            self,
            Op::Load(_) | Op::LoadEdge(_) | Op::LoadDirection | Op::LoadTMax
        )
    }

    /// Whether the operation begins with the processor's estimate of a reciprocal, which differs
    /// between instruction sets and between makers of processors.
    pub fn is_estimate(self) -> bool {
        use Reciprocal::{FusedNewton, Newton};
        matches!(self, Op::Reciprocal(Newton | FusedNewton))
    }

    /// Whether a multiplication is fused with an addition and rounded with it. Where a processor
    /// has no such instruction both are rounded, so answers differ between instruction sets.
    pub fn is_fused(self) -> bool {
        match self {
            Op::Volume(_, summation) => summation.is_fused(),
            Op::Shear(shear) => shear.is_fused(),
            _ => matches!(
                self,
                Op::FusedCross | Op::Reciprocal(Reciprocal::FusedNewton)
            ),
        }
    }

    /// What the operation amounts to where no product is fused with a sum, as on instruction sets without
    /// such instructions: there both are rounded.
    pub fn unfused(self) -> Op {
        match self {
            Op::FusedCross => Op::Cross,
            Op::Volume(volume, summation) => Op::Volume(volume, summation.unfused()),
            Op::Shear(shear) => Op::Shear(shear.unfused()),
            _ => self,
        }
    }

    /// Whether the operation multiplies two volumes, or squares the reciprocal of one.
    pub fn squares_volumes(self) -> bool {
        matches!(
            self,
            Op::Square
                | Op::Product
                | Op::Side(_, SideTest::Product | SideTest::Sum)
                | Op::Reciprocal(Reciprocal::Newton)
        )
    }

    /// Whether the operation is a statement, and not only structure of the graph.
    pub fn is_statement(self) -> bool {
        !matches!(self, Op::All | Op::Choice)
    }
}

impl fmt::Display for Op {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Op::Load(point) => write!(f, "load.{point}"),
            Op::LoadEdge(stored) => write!(f, "load.{}", stored.edge()),
            Op::LoadDirection => write!(f, "load.d"),
            Op::LoadTMax => write!(f, "load.t_max"),
            Op::Zero => write!(f, "zero"),
            Op::One => write!(f, "one"),
            Op::Mask => write!(f, "mask"),
            Op::Edge => write!(f, "edge"),
            Op::Cross => write!(f, "cross"),
            Op::FusedCross => write!(f, "cross.fused"),
            Op::Volume(volume, order) => write!(f, "volume.{}.{order}", volume.name()),
            Op::SumOfSides => write!(f, "sum.v"),
            Op::DifferenceOfEnds => write!(f, "difference.v"),
            Op::Rest(side) => write!(f, "rest.{}", side.volume().name()),
            Op::PairSum(side) => {
                let [j, k] = side.others().map(|other| other.volume().name());
                write!(f, "pair.{j}_{k}")
            }
            Op::Square => write!(f, "square.v"),
            Op::Product => write!(f, "product.va_v"),
            Op::Reciprocal(Reciprocal::Exact) => write!(f, "reciprocal.exact"),
            Op::Reciprocal(Reciprocal::Newton) => write!(f, "reciprocal.newton"),
            Op::Reciprocal(Reciprocal::FusedNewton) => write!(f, "reciprocal.newton.fused"),
            Op::TMultiply => write!(f, "t.multiply"),
            Op::TDivide => write!(f, "t.divide"),
            Op::BarycentricMultiply(side) => write!(f, "{}.multiply", side.barycentric()),
            Op::BarycentricRest(side) => write!(f, "{}.rest", side.barycentric()),
            Op::Near(on) => write!(f, "near.{on}"),
            Op::Far(on) => write!(f, "far.{on}"),
            Op::Ends => write!(f, "ends"),
            Op::Side(side, test) => {
                let test = match test {
                    SideTest::Quotient => "quotient",
                    SideTest::Product => "product",
                    SideTest::Signs => "signs",
                    SideTest::Sum => "sum",
                };
                write!(f, "side{}.{test}", side as usize)
            }
            Op::SameSign(SameSign::Bits) => write!(f, "same_sign.bits"),
            Op::SameSign(SameSign::Ordered) => write!(f, "same_sign.ordered"),
            Op::SameSign(SameSign::Rounded) => write!(f, "same_sign.rounded"),
            Op::Shear(shear) => shear.fmt(f),
            Op::Exit => write!(f, "exit"),
            Op::Store => write!(f, "store"),
            Op::All => write!(f, "all"),
            Op::Choice => write!(f, "choice"),
        }
    }
}

impl fmt::Display for On {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            On::Quotient => "quotient",
            On::Product => "product",
            On::Signs => "signs",
        })
    }
}

/// A file names an operation that there is not.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[error("unknown operation {0:?}")]
pub struct UnknownOp(String);

impl FromStr for Op {
    type Err = UnknownOp;

    fn from_str(text: &str) -> Result<Op, UnknownOp> {
        Op::all()
            .find(|op| op.to_string() == text)
            .ok_or_else(|| UnknownOp(text.chars().take(40).collect()))
    }
}

impl TryFrom<String> for Op {
    type Error = UnknownOp;

    fn try_from(text: String) -> Result<Op, UnknownOp> {
        text.parse()
    }
}

impl From<Op> for String {
    fn from(op: Op) -> String {
        op.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_operation_is_read_back_from_its_name() {
        for op in Op::all() {
            assert_eq!(op.to_string().parse(), Ok(op));
        }
    }

    #[test]
    fn nothing_is_fused_where_nothing_can_be() {
        let estimate = Op::Reciprocal(Reciprocal::FusedNewton);
        for op in Op::all().filter(|&op| op != estimate) {
            assert!(!op.unfused().is_fused(), "{op}");
            assert_eq!(op.unfused() == op, !op.is_fused(), "{op}");
        }
    }

    #[test]
    fn names_are_distinct_and_harmless() {
        let names: BTreeSet<String> = Op::all().map(|op| op.to_string()).collect();
        assert_eq!(names.len(), Op::all().count());
        let harmless = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "._-".contains(c);
        assert!(names.iter().all(|name| name.chars().all(harmless)));
    }
}

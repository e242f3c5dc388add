//! What a statement computes: the type of its value, and the check that its operands fit.
//!
//! The check is semantic: `volume.v1.xy_z` of a cross and a vector is accepted only if their
//! triple product *is* `V1`, and a store only if the rays it keeps have passed a near test, a far
//! test and an inside test. A graph or recipe that passes computes what it says.
//!
//! A zero, infinite or NaN `V` is a miss. On such a `V` the far test on products is false by itself,
//! and the two tests on `t` are not both true; but any other near test beside a far test on `t` may
//! be, where `V` is infinite and `t` is zero. [`Rules`](crate::Rules) allow such a pair only to scenes
//! whose volumes are finite.

use std::fmt;

use volumes::{Cross, Edge, Point, TripleProduct, Vector, Volume};

use crate::op::{On, Op, SameSign, Side, SideTest};
use crate::shear::{Axis, Shear};

/// What the rays left in a mask have been tested for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Condition {
    /// `t > 0`.
    Near(On),
    /// `t < t_max`.
    Far(On),
    /// Both.
    Range,
    /// A segment's ends, that they are not both on one side of the triangle's plane.
    Ends,
    /// The inner side of one side.
    Side(Side),
    /// All three sides, but for what rounding may have moved.
    NearlyInside,
    /// All three sides.
    Inside,
}

/// The value of a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    /// A vertex or an end of the ray: three components.
    Point(Point),
    /// An edge or the ray's direction: three components.
    Vector(Vector),
    /// A cross product: three components.
    Cross(Cross),
    /// A volume.
    Volume(Volume),
    /// The sum of the volumes of the two sides other than this one.
    PairSum(Side),
    /// `V²`.
    SquareOfV,
    /// `Va · V`.
    ProductVaV,
    /// `1 / V`.
    ReciprocalOfV,
    /// The ray parameter of the hit.
    T,
    /// The barycentric coordinate of the vertex opposite a side.
    Barycentric(Side),
    /// The upper bound of the ray parameter.
    TMax,
    /// The constant 0.
    Zero,
    /// The constant 1.
    One,
    /// The magnitudes of the direction's components: three components.
    Magnitudes,
    /// Whether the direction is longest along this axis.
    Along(Axis),
    /// The direction's longest component.
    Longest,
    /// A row of the shear: three components.
    Row(Axis),
    /// A coordinate of a vertex in the sheared frame.
    Sheared(Point, Axis),
    /// A side's volume, but for what rounding has made of it.
    Rounded(Side),
    /// The mask before any test.
    Mask,
    /// The mask after a test.
    Tested(Condition),
    /// Nothing: the hit is stored.
    Stored,
}

impl Quantity {
    /// Whether the value has three components.
    pub fn is_vector(self) -> bool {
        matches!(
            self,
            Quantity::Point(_)
                | Quantity::Vector(_)
                | Quantity::Cross(_)
                | Quantity::Magnitudes
                | Quantity::Row(_)
        )
    }

    /// What either of two values is known to be: the same, or of two near tests or two far tests
    /// the one that promises less.
    fn in_common(self, other: Quantity) -> Option<Quantity> {
        use Condition::{Far, Near};
        use Quantity::Tested;
        match (self, other) {
            (Tested(Near(a)), Tested(Near(b))) if a != b => Some(Tested(Near(On::Signs))),
            (Tested(Far(a)), Tested(Far(b))) if a != b => Some(Tested(Far(On::Quotient))),
            _ => (self == other).then_some(self),
        }
    }

    /// Whether the value is the mask, before or after tests.
    pub fn is_mask(self) -> bool {
        matches!(self, Quantity::Mask | Quantity::Tested(_))
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Quantity::Point(point) => write!(f, "the point {point}"),
            Quantity::Vector(vector) => write!(f, "the vector {vector}"),
            Quantity::Cross(cross) => write!(f, "the cross {cross}"),
            Quantity::Volume(volume) => write!(f, "the volume {volume}"),
            Quantity::PairSum(side) => {
                let [j, k] = side.others().map(Side::volume);
                write!(f, "{j} + {k}")
            }
            Quantity::SquareOfV => write!(f, "V²"),
            Quantity::ProductVaV => write!(f, "Va · V"),
            Quantity::ReciprocalOfV => write!(f, "1 / V"),
            Quantity::T => write!(f, "t"),
            Quantity::Barycentric(side) => write!(f, "{}", side.barycentric()),
            Quantity::TMax => write!(f, "t_max"),
            Quantity::Zero => write!(f, "zero"),
            Quantity::One => write!(f, "one"),
            Quantity::Magnitudes => write!(f, "the magnitudes of d"),
            Quantity::Along(axis) => write!(f, "whether d is longest along {axis}"),
            Quantity::Longest => write!(f, "the longest component of d"),
            Quantity::Row(axis) => write!(f, "the row {axis} of the shear"),
            Quantity::Sheared(point, axis) => write!(f, "the sheared {axis} of {point}"),
            Quantity::Rounded(side) => write!(f, "{}, rounded", side.volume()),
            Quantity::Mask => write!(f, "the untested mask"),
            Quantity::Tested(Condition::Near(_)) => write!(f, "the near test"),
            Quantity::Tested(Condition::Far(_)) => write!(f, "the far test"),
            Quantity::Tested(Condition::Range) => write!(f, "the test of t"),
            Quantity::Tested(Condition::Ends) => write!(f, "the test of the ends"),
            Quantity::Tested(Condition::Side(side)) => {
                write!(f, "the test of side {}", *side as usize)
            }
            Quantity::Tested(Condition::NearlyInside) => write!(f, "the rounded inside test"),
            Quantity::Tested(Condition::Inside) => write!(f, "the inside test"),
            Quantity::Stored => write!(f, "the store"),
        }
    }
}

/// Operands that do not fit their operation.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
pub enum Misfit {
    /// The wrong number of operands.
    #[error("{op} takes {takes} operands, not {given}")]
    Arity {
        /// The operation.
        op: Op,
        /// How many it takes.
        takes: usize,
        /// How many it was given.
        given: usize,
    },
    /// An operand of the wrong quantity.
    #[error("operand {index} of {op} is {given}, which does not fit")]
    Operand {
        /// The operation.
        op: Op,
        /// Which operand, from 0.
        index: usize,
        /// What that operand is.
        given: String,
    },
    /// The operands fit one by one but do not make the quantity together.
    #[error("{op} of these operands is not what it says: {why}")]
    Meaning {
        /// The operation.
        op: Op,
        /// What is wrong.
        why: &'static str,
    },
}

impl Op {
    /// The quantity that the operation makes of its operands, given each operand's own operation
    /// and quantity.
    ///
    /// [`Op::All`] is the inside test made of the three sides' tests, or the test of `t` made of a
    /// near and a far test. The options of an
    /// [`Op::Choice`] must be of one quantity, which is the choice's.
    ///
    /// # Errors
    ///
    /// [`Misfit`] says which operand does not fit, or why they do not fit together.
    pub fn quantity(self, operands: &[(Op, Quantity)]) -> Result<Quantity, Misfit> {
        match self {
            Op::Edge => self.edge(operands),
            Op::Cross | Op::FusedCross => self.cross(operands),
            Op::Volume(volume, _) => self.triple_product(volume, operands),
            Op::Shear(Shear::Coordinate(axis, _)) => self.sheared(axis, operands),
            Op::Exit => self.exit(operands),
            Op::Store => self.store(operands),
            Op::All => self.together(operands),
            Op::Choice => self.choice(operands),
            _ => {
                let (takes, makes) = self.signature();
                self.expect(operands, &takes)?;
                Ok(makes)
            }
        }
    }

    /// Operands and result of the operations that have the same ones every time.
    fn signature(self) -> (Vec<Quantity>, Quantity) {
        use Quantity as Q;
        let v = Q::Volume(Volume::V);
        let va = Q::Volume(Volume::Va);
        let side_volume = |side: Side| Q::Volume(side.volume());
        match self {
            Op::Load(point) => (vec![], Q::Point(point)),
            Op::LoadEdge(stored) => (vec![], Q::Vector(stored.edge().into())),
            Op::LoadDirection => (vec![], Q::Vector(Vector::Direction)),
            Op::LoadTMax => (vec![], Q::TMax),
            Op::Zero => (vec![], Q::Zero),
            Op::One => (vec![], Q::One),
            Op::Mask => (vec![], Q::Mask),
            Op::SumOfSides => (Side::ALL.map(side_volume).to_vec(), v),
            Op::DifferenceOfEnds => (vec![va, Q::Volume(Volume::Vb)], v),
            Op::Rest(side) => {
                let [j, k] = side.others().map(side_volume);
                (vec![v, j, k], side_volume(side))
            }
            Op::PairSum(side) => (side.others().map(side_volume).to_vec(), Q::PairSum(side)),
            Op::Square => (vec![v], Q::SquareOfV),
            Op::Product => (vec![va, v], Q::ProductVaV),
            Op::Reciprocal(crate::Reciprocal::Newton) => (vec![v], Q::ReciprocalOfV),
            Op::Reciprocal(_) => (vec![Q::One, v], Q::ReciprocalOfV),
            Op::TMultiply => (vec![va, Q::ReciprocalOfV], Q::T),
            Op::TDivide => (vec![va, v], Q::T),
            Op::BarycentricMultiply(side) => {
                let takes = vec![side_volume(side), Q::ReciprocalOfV];
                (takes, Q::Barycentric(side))
            }
            Op::BarycentricRest(side) => {
                let [j, k] = side.others().map(Q::Barycentric);
                (vec![Q::One, j, k], Q::Barycentric(side))
            }
            Op::Near(on) => {
                let takes = match on {
                    On::Quotient => vec![Q::Mask, Q::Zero, Q::T],
                    On::Product => vec![Q::Mask, Q::Zero, Q::ProductVaV],
                    On::Signs => vec![Q::Mask, Q::Zero, va, v],
                };
                (takes, Q::Tested(Condition::Near(on)))
            }
            Op::Far(on) => {
                let takes = match on {
                    On::Quotient => vec![Q::Mask, Q::T, Q::TMax],
                    _ => vec![Q::Mask, Q::ProductVaV, Q::TMax, Q::SquareOfV],
                };
                (takes, Q::Tested(Condition::Far(on)))
            }
            Op::Ends => {
                let takes = vec![Q::Mask, Q::Zero, va, Q::Volume(Volume::Vb)];
                (takes, Q::Tested(Condition::Ends))
            }
            Op::Side(side, test) => {
                let takes = match test {
                    SideTest::Quotient => vec![Q::Mask, Q::Barycentric(side), Q::Zero],
                    SideTest::Product => vec![Q::Mask, side_volume(side), v, Q::Zero],
                    SideTest::Signs => vec![Q::Mask, side_volume(side), v],
                    SideTest::Sum => vec![Q::Mask, Q::PairSum(side), v, Q::SquareOfV],
                };
                (takes, Q::Tested(Condition::Side(side)))
            }
            Op::SameSign(how) => {
                let mut takes = vec![Q::Mask];
                let of_sides = match how {
                    SameSign::Bits | SameSign::Ordered => Side::ALL.map(side_volume),
                    SameSign::Rounded => Side::ALL.map(Q::Rounded),
                };
                takes.extend(of_sides);
                if how != SameSign::Bits {
                    takes.push(Q::Zero);
                }
                let condition = match how {
                    SameSign::Bits | SameSign::Ordered => Condition::Inside,
                    SameSign::Rounded => Condition::NearlyInside,
                };
                (takes, Q::Tested(condition))
            }
            Op::Shear(shear) => shear_signature(shear),
            Op::Edge | Op::Cross | Op::FusedCross | Op::Volume(..) => {
                unreachable!("their quantity depends on their operands")
            }
            Op::Exit | Op::Store | Op::All | Op::Choice => {
                unreachable!("their quantity depends on their operands")
            }
        }
    }

    fn expect(self, operands: &[(Op, Quantity)], takes: &[Quantity]) -> Result<(), Misfit> {
        self.arity(operands, takes.len())?;
        match (0..takes.len()).find(|&index| operands[index].1 != takes[index]) {
            None => Ok(()),
            Some(index) => Err(self.misfit(operands, index)),
        }
    }

    fn arity(self, operands: &[(Op, Quantity)], takes: usize) -> Result<(), Misfit> {
        let given = operands.len();
        if given == takes {
            Ok(())
        } else {
            Err(Misfit::Arity {
                op: self,
                takes,
                given,
            })
        }
    }

    fn misfit(self, operands: &[(Op, Quantity)], index: usize) -> Misfit {
        Misfit::Operand {
            op: self,
            index,
            given: operands[index].1.to_string(),
        }
    }

    fn edge(self, operands: &[(Op, Quantity)]) -> Result<Quantity, Misfit> {
        self.arity(operands, 2)?;
        let point = |index: usize| match operands[index].1 {
            Quantity::Point(point) => Ok(point),
            _ => Err(self.misfit(operands, index)),
        };
        let (to, from) = (point(0)?, point(1)?);
        if to == from {
            let why = "an edge joins two different points";
            return Err(Misfit::Meaning { op: self, why });
        }
        Ok(Quantity::Vector(Vector::Edge(Edge { to, from })))
    }

    fn vector(self, operands: &[(Op, Quantity)], index: usize) -> Result<Vector, Misfit> {
        match operands[index].1 {
            Quantity::Vector(vector) => Ok(vector),
            _ => Err(self.misfit(operands, index)),
        }
    }

    fn cross(self, operands: &[(Op, Quantity)]) -> Result<Quantity, Misfit> {
        self.arity(operands, 2)?;
        let left = self.vector(operands, 0)?;
        let right = self.vector(operands, 1)?;
        Ok(Quantity::Cross(Cross { left, right }))
    }

    fn triple_product(
        self,
        volume: Volume,
        operands: &[(Op, Quantity)],
    ) -> Result<Quantity, Misfit> {
        self.arity(operands, 2)?;
        let Quantity::Cross(cross) = operands[0].1 else {
            return Err(self.misfit(operands, 0));
        };
        let dot = self.vector(operands, 1)?;
        if volume.is(TripleProduct { cross, dot }) {
            Ok(Quantity::Volume(volume))
        } else {
            let why = "their triple product is another volume, or its negative";
            Err(Misfit::Meaning { op: self, why })
        }
    }

    /// A row of the shear, and an edge from the ray's origin to a vertex.
    fn sheared(self, axis: Axis, operands: &[(Op, Quantity)]) -> Result<Quantity, Misfit> {
        self.arity(operands, 2)?;
        if operands[0].1 != Quantity::Row(axis) {
            return Err(self.misfit(operands, 0));
        }
        match operands[1].1 {
            Quantity::Vector(Vector::Edge(Edge { to, from: Point::A })) => {
                Ok(Quantity::Sheared(to, axis))
            }
            _ => Err(self.misfit(operands, 1)),
        }
    }

    fn exit(self, operands: &[(Op, Quantity)]) -> Result<Quantity, Misfit> {
        self.arity(operands, 1)?;
        match operands[0].1 {
            tested @ Quantity::Tested(_) => Ok(tested),
            _ => Err(self.misfit(operands, 0)),
        }
    }

    /// `t`, `t_max`, then any number of tested masks that cover the range of `t` and the inside.
    fn store(self, operands: &[(Op, Quantity)]) -> Result<Quantity, Misfit> {
        let takes = [Quantity::T, Quantity::TMax];
        let Some((values, tests)) = operands.split_at_checked(takes.len()) else {
            let (takes, given) = (takes.len(), operands.len());
            return Err(Misfit::Arity {
                op: self,
                takes,
                given,
            });
        };
        self.expect(values, &takes)?;
        let passed = self.conditions(operands, tests.len())?;
        if tests_range(&passed) && tests_inside(&passed) {
            Ok(Quantity::Stored)
        } else {
            let why = "a hit needs a near test, a far test and an inside test";
            Err(Misfit::Meaning { op: self, why })
        }
    }

    fn together(self, operands: &[(Op, Quantity)]) -> Result<Quantity, Misfit> {
        let passed = self.conditions(operands, operands.len())?;
        match (tests_range(&passed), tests_inside(&passed)) {
            (true, false) => Ok(Quantity::Tested(Condition::Range)),
            (false, true) => Ok(Quantity::Tested(Condition::Inside)),
            _ => {
                let why = "they are neither all tests of t nor all tests of the sides";
                Err(Misfit::Meaning { op: self, why })
            }
        }
    }

    /// What the last `count` operands have been tested for.
    fn conditions(
        self,
        operands: &[(Op, Quantity)],
        count: usize,
    ) -> Result<Vec<Condition>, Misfit> {
        let condition = |index: usize| match operands[index].1 {
            Quantity::Tested(condition) => Ok(condition),
            _ => Err(self.misfit(operands, index)),
        };
        (operands.len() - count..operands.len())
            .map(condition)
            .collect()
    }

    fn choice(self, operands: &[(Op, Quantity)]) -> Result<Quantity, Misfit> {
        if operands.len() < 2 {
            let why = "a choice has at least two options";
            return Err(Misfit::Meaning { op: self, why });
        }
        let mut common = operands[0].1;
        for (index, &(_, option)) in operands.iter().enumerate() {
            let both = common.in_common(option);
            common = both.ok_or_else(|| self.misfit(operands, index))?;
        }
        Ok(common)
    }
}

/// Operands and results of the operations of the sheared test that have the same ones every time.
fn shear_signature(shear: Shear) -> (Vec<Quantity>, Quantity) {
    use Quantity as Q;
    let direction = Q::Vector(Vector::Direction);
    let along = Axis::ALL.map(Q::Along);
    match shear {
        Shear::Magnitudes => (vec![direction, Q::Zero], Q::Magnitudes),
        Shear::Along(axis) => (vec![Q::Magnitudes], Q::Along(axis)),
        Shear::Longest => (vec![along[0], along[1], direction], Q::Longest),
        Shear::Row(axis) => {
            let mut takes = along.to_vec();
            takes.extend([direction, Q::Longest, Q::Zero]);
            takes.extend((axis == Axis::Z).then_some(Q::One));
            (takes, Q::Row(axis))
        }
        Shear::Rounded(side) => (corners(side), Q::Rounded(side)),
        Shear::Volume(side, _) => (corners(side), Q::Volume(side.volume())),
        Shear::Depths(_) => {
            let takes = Side::ALL.map(|side| {
                let depth = Q::Sheared(Point::VERTICES[side as usize], Axis::Z);
                [Q::Volume(side.volume()), depth]
            });
            (takes.concat(), Q::Volume(Volume::Va))
        }
        Shear::Coordinate(..) => unreachable!("its quantity depends on its operands"),
    }
}

/// The coordinates of a side's two ends, the factors of its volume: `x_k`, `y_j`, `x_j`, `y_k` if
/// the vertices are `i`, `j`, `k` in turn.
fn corners(side: Side) -> Vec<Quantity> {
    let vertex = |steps: usize| Point::VERTICES[(side as usize + steps) % 3];
    let (j, k) = (vertex(1), vertex(2));
    let factors = [(k, Axis::X), (j, Axis::Y), (j, Axis::X), (k, Axis::Y)];
    let factors = factors.map(|(vertex, axis)| Quantity::Sheared(vertex, axis));
    factors.to_vec()
}

/// Whether a near and a far test are among the conditions.
fn tests_range(passed: &[Condition]) -> bool {
    let has = |condition| passed.contains(&condition);
    let near = [On::Quotient, On::Product, On::Signs].map(Condition::Near);
    let far = [On::Quotient, On::Product].map(Condition::Far);
    has(Condition::Range) || near.into_iter().any(has) && far.into_iter().any(has)
}

/// Whether all sides are among the conditions.
fn tests_inside(passed: &[Condition]) -> bool {
    let sides = Side::ALL.map(Condition::Side);
    passed.contains(&Condition::Inside) || sides.iter().all(|side| passed.contains(side))
}

//! What a scene model makes of a program: which statements it needs, what it has from elsewhere, and
//! what it adds.
//!
//! A program decides whether and where a ray hits. A scene may rule out some ways to do so, it may
//! have stored what a statement computes, and it says what is done with a hit. The program stays
//! as it is bred: kernels of scenes that differ in these things share its volumes, its tests and its
//! `t`.

use std::num::NonZeroU16;

use program::{CheckedIn, Graph, Op, Program, Quantity, Rules, Shear, Side, Vertices};
use scene::{Grouping, Numeric, Output, Range, Regime, SceneModel, Stored, Watertight};
use volumes::{Case, Cross, Edge, Model, Point, Sample, Vector, Volume};

use crate::isa::Isa;
use crate::when::When;

/// Operations of a ray and a triangle by the paper's count, if no ray leaves early: tests and divisions included,
/// and work that a packet's rays share, or a ray's triangles, divided among them.
pub fn operations(program: &Program, scene: &SceneModel) -> f64 {
    const SHARERS: NonZeroU16 = NonZeroU16::new(scene::PACKET_SIZE as u16).expect("some rays");
    let case = Case {
        rates: scene.rates(),
        ..Case::packet(SHARERS)
    };
    program.cost(case, &Model::paper()).operations()
}

/// What a scene leaves of a graph on these instruction sets.
pub fn rules(scene: &SceneModel, isas: &[Isa]) -> Rules {
    let volumes = scene.volume_bounds();
    Rules {
        finite: volumes.are_finite,
        // V is a length cubed: its square, or that of its reciprocal, leaves the range where a scene is
        // a millionth as large as usual. That is a miss, and so a leak.
        squares: volumes
            .have_squares
            .unwrap_or(scene.watertight != Watertight::Edges),
        estimates: match scene.numeric {
            Numeric::Portable => false,
            Numeric::Fast => true,
        },
        fused: scene.numeric == Numeric::Fast
            && match scene.watertight {
                Watertight::None => true,
                // A product that is fused with one of its terms is not the opposite of its mirror
                // image.
                Watertight::Edges => false,
                // Signs are right only where a fused operation is one.
                Watertight::Full => isas.iter().all(|isa| isa.fuses()),
            },
        // One ray's triangles are in another order, lane by lane, on every instruction set.
        early_range: scene.numeric == Numeric::Fast || scene.grouping == Grouping::Packet,
        ends: scene.range == Range::Segment,
        vertices: match scene.stored {
            Stored::Vertices | Stored::VerticesAndNormal => Vertices::Points,
            Stored::Edges | Stored::EdgesAndNormal => Vertices::Edges,
        },
        watertight: match scene.watertight {
            Watertight::None => program::Watertight::No,
            Watertight::Edges => program::Watertight::Edges,
            Watertight::Full => program::Watertight::Full,
        },
    }
}

/// The checked-in graph to search for a scene's kernels: the sheared one if nothing may leak; for
/// segments the one that has their other end; where products can be fused with sums and may be, or
/// bounds prove that volumes are finite, the one that has the choice.
///
/// For one ray, where nearly every triangle is behind what has been hit, the sheared one is the best
/// even if leaks are allowed: the ray is sheared once, and what is left to do for a triangle is less.
pub fn checked_in(scene: &SceneModel, isas: &[Isa]) -> CheckedIn {
    let fuses = isas.iter().any(|isa| isa.fuses());
    let rules = rules(scene, isas);
    let may_leak = rules.watertight == program::Watertight::No;
    let shears_well = scene.grouping != Grouping::Packet
        && scene.regime == Regime::Shrinking
        && scene.stored == Stored::Vertices;
    match shears_well && may_leak && !rules.ends {
        true => CheckedIn::Watertight,
        false => CheckedIn::of(&rules, fuses),
    }
}

/// What the scene leaves of that graph.
pub fn graph(scene: &SceneModel, isas: &[Isa]) -> Graph {
    let graph = checked_in(scene, isas).graph();
    let left = graph.restricted(&rules(scene, isas));
    left.expect("checked scenes leave programs of their graphs")
}

/// A program in a scene.
#[derive(Clone, Copy)]
pub(crate) struct InScene<'a> {
    pub program: &'a Program,
    pub scene: &'a SceneModel,
    /// Whether the scene only says what is tested together, and from where: what is asked, culled, reported,
    /// bounded below and stored is left to whoever calls the kernel.
    pub is_open: bool,
}

/// A vector that is stored with the triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StoredAs {
    /// `p1-p0`.
    Edge1,
    /// `p2-p0`.
    Edge2,
    /// `(p1-p0) × (p2-p0)`.
    Normal,
    /// The negative of that.
    OppositeNormal,
}

impl StoredAs {
    /// The condition on which it is there.
    pub fn when(self) -> When {
        match self {
            StoredAs::Edge1 | StoredAs::Edge2 => When::StoredEdges,
            StoredAs::Normal | StoredAs::OppositeNormal => When::StoredNormal,
        }
    }
}

impl InScene<'_> {
    /// Where a statement's value is stored, if it may be.
    pub fn stored_as(self, index: usize) -> Option<StoredAs> {
        let edge = |to| {
            Vector::Edge(Edge {
                to,
                from: Point::P0,
            })
        };
        let as_what = match self.program.quantities()[index] {
            Quantity::Vector(vector) if vector == edge(Point::P1) => StoredAs::Edge1,
            Quantity::Vector(vector) if vector == edge(Point::P2) => StoredAs::Edge2,
            // Most crosses are none, which takes a while to find out.
            Quantity::Cross(cross) if self.may(When::StoredNormal) => normal_of(cross)?,
            _ => return None,
        };
        self.may(as_what.when()).then_some(as_what)
    }

    /// Whether a statement's value is stored in any case.
    fn is_stored(self, index: usize) -> bool {
        let as_what = self.stored_as(index);
        as_what.is_some_and(|as_what| self.decides(as_what.when()) == Some(true))
    }

    /// The statements that a statement works on in this scene.
    pub fn operands(self, index: usize) -> Vec<usize> {
        if self.is_stored(index) {
            return Vec::new();
        }
        let statement = &self.program.statements()[index];
        let mut operands: Vec<usize> = match statement.op {
            Op::Store => self.of_hit(),
            Op::Shear(Shear::Row(_)) if self.renames_axes() => {
                let direction = Quantity::Vector(Vector::Direction);
                self.find(direction).into_iter().collect()
            }
            Op::LoadDirection if self.scene.range == Range::Segment => {
                self.find(Quantity::Point(Point::A)).into_iter().collect()
            }
            op => statement
                .operands
                .iter()
                .map(|&operand| operand as usize)
                .filter(|&operand| !(self.needs_no_zero(op) && self.is_zero(operand)))
                .collect(),
        };
        if self.bounds_below(statement.op) {
            operands.extend(self.early_range(statement.op));
            // The two bounds are read together.
            operands.extend(self.find(Quantity::TMax));
        }
        operands
    }

    /// Whether the axes are renamed so that the ray's direction is longest along the last: then a
    /// shear takes two multiplications a vertex and not six. Only for one ray there is one such
    /// order.
    pub fn renames_axes(self) -> bool {
        let mut statements = self.program.statements().iter();
        self.scene.grouping != Grouping::Packet
            && statements.any(|statement| matches!(statement.op, Op::Shear(_)))
    }

    /// Whether `t` never rejects, and hits are kept elsewhere.
    pub fn is_fixed(self) -> bool {
        self.scene.regime == Regime::Fixed && !self.is_open
    }

    /// What the store needs, beside the mask.
    fn of_hit(self) -> Vec<usize> {
        let mut needed = vec![Quantity::TMax];
        if self.decides(When::AnyHit) != Some(true) {
            needed.push(Quantity::T);
        }
        let mut found: Vec<usize> = needed
            .into_iter()
            .filter_map(|one| self.find(one))
            .collect();
        if self.reports_coordinates() {
            for side in [Side::S1, Side::S2] {
                found.extend(self.barycentric(side).statements());
            }
        }
        if self.may(When::Reports(Output::Normal)) {
            found.extend(self.normal().map(|(index, _)| index));
        }
        found
    }

    /// Whether barycentric coordinates may be needed.
    pub fn reports_coordinates(self) -> bool {
        let mut outputs = [Output::Uv, Output::Point].into_iter();
        outputs.any(|output| self.may(When::Reports(output)))
    }

    /// How a barycentric coordinate is had from what the program computes anyway.
    pub fn barycentric(self, side: Side) -> Coordinate {
        if let Some(there) = self.find(Quantity::Barycentric(side)) {
            return Coordinate::There(there);
        }
        let volume = |volume| {
            let found = self.find(Quantity::Volume(volume));
            found.expect("a program has V, and a side's coordinate or volume")
        };
        let of_side = volume(side.volume());
        match self.find(Quantity::ReciprocalOfV) {
            Some(reciprocal) => Coordinate::Product(of_side, reciprocal),
            None => Coordinate::Quotient(of_side, volume(Volume::V)),
        }
    }

    /// The program's own normal, if it has one, and whether it is the opposite one.
    pub fn normal(self) -> Option<(usize, bool)> {
        let quantities = self.program.quantities().iter().enumerate();
        let mut normals = quantities.filter_map(|(index, quantity)| match quantity {
            Quantity::Cross(cross) => Some((index, normal_of(*cross)? == StoredAs::OppositeNormal)),
            _ => None,
        });
        normals.next()
    }

    /// The first test that depends on V: before it rays are culled, which go by the sign of V.
    pub fn first_test_of_v(self) -> usize {
        let v = self.find(Quantity::Volume(Volume::V));
        let v = v.expect("a program has V");
        let mut depends = vec![false; self.program.statements().len()];
        depends[v] = true;
        let mut statements = self.program.statements().iter().enumerate();
        let first = statements.find(|(index, statement)| {
            let mut operands = statement.operands.iter();
            depends[*index] |= operands.any(|&operand| depends[operand as usize]);
            depends[*index] && statement.op.is_test()
        });
        let (index, _) = first.expect("tests of t depend on V");
        index
    }

    /// Whether an operation compares with the lower bound of `t`, and there may be one.
    pub fn bounds_below(self, op: Op) -> bool {
        self.may(When::LowerBound) && matches!(op, Op::Near(_))
    }

    /// Whether what the operation compares with is no zero of the program: a quotient is compared with the lower
    /// bound, which is zero where there is none.
    fn needs_no_zero(self, op: Op) -> bool {
        let is_there = self.decides(When::LowerBound) == Some(true);
        self.bounds_below(op) && (is_there || op == Op::Near(program::On::Quotient))
    }

    /// The statement that computes a quantity, if there is one.
    pub fn find(self, quantity: Quantity) -> Option<usize> {
        let mut quantities = self.program.quantities().iter();
        quantities.position(|&other| other == quantity)
    }

    /// `Va · V` and `V²`, if a test of the lower bound is made before the division. The far test
    /// that goes with it has both.
    fn early_range(self, op: Op) -> Vec<usize> {
        match op {
            Op::Near(program::On::Quotient) => Vec::new(),
            _ => [Quantity::ProductVaV, Quantity::SquareOfV]
                .into_iter()
                .filter_map(|quantity| self.find(quantity))
                .collect(),
        }
    }

    fn is_zero(self, index: usize) -> bool {
        self.program.quantities()[index] == Quantity::Zero
    }
}

/// How a barycentric coordinate is had.
pub(crate) enum Coordinate {
    /// It is there.
    There(usize),
    /// As a product of these.
    Product(usize, usize),
    /// As their quotient.
    Quotient(usize, usize),
}

impl Coordinate {
    fn statements(&self) -> Vec<usize> {
        match *self {
            Coordinate::There(there) => vec![there],
            Coordinate::Product(a, b) | Coordinate::Quotient(a, b) => vec![a, b],
        }
    }
}

/// Whether a cross is the triangle's normal, by whatever edges, or the opposite.
fn normal_of(cross: Cross) -> Option<StoredAs> {
    let edge = |to| {
        Vector::Edge(Edge {
            to,
            from: Point::P0,
        })
    };
    let normal = Cross {
        left: edge(Point::P1),
        right: edge(Point::P2),
    };
    let opposite = Cross {
        left: normal.right,
        right: normal.left,
    };
    let samples = [1, 2].map(Sample::random);
    let is = |other: Cross| {
        samples
            .iter()
            .all(|one| one.cross(cross) == one.cross(other))
    };
    match (is(normal), is(opposite)) {
        (true, _) => Some(StoredAs::Normal),
        (_, true) => Some(StoredAs::OppositeNormal),
        _ => None,
    }
}

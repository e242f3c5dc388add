//! The graph of the sheared test. Of its programs, those that [`Watertight::Full`](crate::Watertight)
//! leaves let no ray through a closed surface.
//!
//! ```text
//! d ─► rows of the shear ──┐
//! p0, p1, p2, a ─► edges ──┴─► sheared vertices ─► sides' volumes ─► V, Va ─► t, tests, store
//!                                      └─► the same, rounded ─► a first test
//! ```
//!
//! What there is to choose: whether the sides' volumes are looked at in single precision first, which
//! loses none that is a hit, and whether a vector without any leaves then; whether, and how, a volume
//! gets the right sign; and, as in the other graphs, division, the tests of `t`, exits, and the order. Volumes
//! here are those of the paper divided by the magnitude of the direction's longest component, which
//! no ratio of them shows.

use volumes::{Edge, Point, Vector};

use crate::builder::{Arithmetic, Builder, Inputs, Volumes, vector_name};
use crate::graph::{Graph, NodeId};
use crate::op::{Op, SameSign, Side};
use crate::shear::{Axis, ProductDifference, Rounding, Shear};

/// Builds the graph.
pub fn watertight() -> Graph {
    Builder::new(Arithmetic::Fused).sheared_to_hit()
}

/// The sheared vertices: a row for each axis, a choice of rounding for each vertex.
type Coordinates = [[NodeId; 3]; 3];

impl Builder {
    /// The whole way from points to a hit by way of the shear.
    fn sheared_to_hit(mut self) -> Graph {
        let inputs = self.inputs();
        let rows = self.shear(&inputs);
        let coordinates = self.sheared_vertices(&rows);
        let rounded = Side::ALL.map(|side| self.of_corners(Shear::Rounded(side), &coordinates));
        let volumes = self.sheared_volumes(&coordinates);
        let quotients = self.quotients(&inputs, &volumes);
        let range = self.range_tests(&inputs, &volumes, &quotients, None);
        let inside = self.watertight_tests(&inputs, rounded, volumes.sides);
        self.store(&inputs, &quotients, range, inside)
    }

    /// An operation of the sheared test under its own name.
    fn sheared(&mut self, shear: Shear, operands: &[NodeId]) -> NodeId {
        self.add(&shear.to_string(), Op::Shear(shear), operands)
    }

    /// The rows of the shear.
    fn shear(&mut self, inputs: &Inputs) -> [NodeId; 3] {
        let Inputs { zero, one, .. } = *inputs;
        let d = self.find("d");
        let magnitudes = self.sheared(Shear::Magnitudes, &[d, zero]);
        let [x, y, z] = Axis::ALL.map(|axis| self.sheared(Shear::Along(axis), &[magnitudes]));
        let longest = self.sheared(Shear::Longest, &[x, y, d]);
        Axis::ALL.map(|axis| {
            let mut operands = vec![x, y, z, d, longest, zero];
            operands.extend((axis == Axis::Z).then_some(one));
            self.sheared(Shear::Row(axis), &operands)
        })
    }

    fn sheared_vertices(&mut self, rows: &[NodeId; 3]) -> Coordinates {
        let edges = Point::VERTICES.map(|to| {
            let from = Point::A;
            let points = [to, from].map(|point| self.find(&point.to_string()));
            let edge = vector_name(Vector::Edge(Edge { to, from }));
            self.add(&edge, Op::Edge, &points)
        });
        Axis::ALL.map(|axis| {
            [0, 1, 2].map(|vertex| {
                let operands = [rows[axis as usize], edges[vertex]];
                let ways = Rounding::ALL.map(|rounding| {
                    let coordinate = Shear::Coordinate(axis, rounding);
                    let name = format!("p{vertex}.{coordinate}");
                    self.add(&name, Op::Shear(coordinate), &operands)
                });
                self.choice(&format!("p{vertex}.{axis}"), &ways)
            })
        })
    }

    /// What is made of the two ends of a side.
    fn of_corners(&mut self, shear: Shear, [x, y, _]: &Coordinates) -> NodeId {
        let (Shear::Rounded(side) | Shear::Volume(side, _)) = shear else {
            unreachable!("{shear} is of no side");
        };
        let vertex = |steps: usize| (side as usize + steps) % 3;
        let (j, k) = (vertex(1), vertex(2));
        self.sheared(shear, &[x[k], y[j], x[j], y[k]])
    }

    fn sheared_volumes(&mut self, coordinates: &Coordinates) -> Volumes {
        let sides = Side::ALL.map(|side| {
            let ways = ProductDifference::ALL
                .map(|difference| self.of_corners(Shear::Volume(side, difference), coordinates));
            self.choice(side.volume().name(), &ways)
        });
        let v = self.add("v", Op::SumOfSides, &sides);
        let [_, _, depths] = coordinates;
        let operands = [0, 1, 2].map(|side| [sides[side], depths[side]]).concat();
        let ways = Rounding::ALL.map(|rounding| self.sheared(Shear::Depths(rounding), &operands));
        let va = self.choice("va", &ways);
        Volumes { v, sides, va }
    }

    /// The inside test on volumes whose signs are right, alone or after one on rounded volumes.
    fn watertight_tests(
        &mut self,
        inputs: &Inputs,
        rounded: [NodeId; 3],
        sides: [NodeId; 3],
    ) -> NodeId {
        let Inputs { zero, mask, .. } = *inputs;
        let mut test = |how: SameSign, [v0, v1, v2]: [NodeId; 3]| {
            let op = Op::SameSign(how);
            let test = self.add(&op.to_string(), op, &[mask, v0, v1, v2, zero]);
            self.exit_or_not(&op.to_string(), test)
        };
        let first = test(SameSign::Rounded, rounded);
        let exact = test(SameSign::Ordered, sides);
        let twice = self.add("inside.twice", Op::All, &[first, exact]);
        self.choice("inside", &[exact, twice])
    }
}

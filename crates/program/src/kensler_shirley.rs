//! The graph of 1294 nodes, built from the algebra of Kensler and Shirley (2006).
//!
//! The paper gives the number and the kinds of choices (section 5), not the list. Ours holds
//! every triple product of the five volumes, each with two orders of summation, and around them
//! the ways to go on from volumes to a hit: `dag/README.md` has the table of families.

use volumes::{Cross, Edge, Point, TripleProduct, Vector, Volume};

use crate::genome::Genome;
use crate::graph::{Graph, Node, NodeId};
use crate::op::{On, Op, Reciprocal, SameSign, Side, SideTest, Summation};

/// The number of nodes, as the paper gives it.
pub const COUNT: usize = 1294;

/// Builds the graph.
pub fn kensler_shirley() -> Graph {
    let mut builder = Builder::default();
    let inputs = builder.inputs();
    let direct = builder.triple_products();
    let volumes = builder.volumes(&direct);
    let quotients = builder.quotients(&inputs, &volumes);
    let [range, near, far] = builder.range_tests(&inputs, &volumes, &quotients);
    let inside = builder.inside_tests(&inputs, &volumes, &quotients);
    let goal = builder.add(
        "store",
        Op::Store,
        &[quotients.t, inputs.t_max, range, near, far, inside],
    );
    Graph::new(goal, builder.nodes).expect("the builder makes sound graphs")
}

/// The genome that picks the general packet kernel of the paper's appendix (GA+), in the order
/// in which it is printed there.
///
/// # Panics
///
/// If `graph` is not [`kensler_shirley`]'s.
pub fn appendix(graph: &Graph) -> Genome {
    preferring(
        graph,
        &[
            "p1",
            "p0",
            "edge.p1-p0",
            "p2",
            "edge.p0-p2",
            "cross.p1-p0.p0-p2",
            "zero",
            "a",
            "t_max",
            "d",
            "v.direct",
            "v.p1-p0.p0-p2.d.xy_z",
            "reciprocal.newton",
            "edge.p0-a",
            "va.p1-p0.p0-p2.p0-a.xy_z",
            "t.multiply",
            "mask",
            "range.late",
            "far",
            "far.quotient",
            "near.quotient",
            "near.exit",
            "cross.p0-a.d",
            "v1.direct",
            "v1.p0-a.d.p0-p2.xy_z",
            "beta.multiply",
            "side1.quotient",
            "side1.exit",
            "v2.direct",
            "v2.p0-a.d.p1-p0.xy_z",
            "pair.v1_v2",
            "square.v",
            "side0.sum",
            "side0",
            "gamma.multiply",
            "side2.quotient",
            "side2.exit",
            "inside.sides",
        ],
    )
}

/// The genome that picks equations 2, the volumes of Möller and Trumbore, with divisions and
/// tests in their order.
///
/// # Panics
///
/// If `graph` is not [`kensler_shirley`]'s.
pub fn moller_trumbore_volumes(graph: &Graph) -> Genome {
    preferring(
        graph,
        &[
            "p0",
            "p1",
            "p2",
            "edge.p1-p0",
            "edge.p2-p0",
            "zero",
            "one",
            "d",
            "cross.d.p2-p0",
            "v.direct",
            "v.d.p2-p0.p1-p0.xy_z",
            "reciprocal.exact",
            "a",
            "edge.a-p0",
            "v1.direct",
            "v1.d.p2-p0.a-p0.xy_z",
            "beta.multiply",
            "mask",
            "side1.quotient",
            "side1.exit",
            "cross.a-p0.p1-p0",
            "v2.direct",
            "v2.a-p0.p1-p0.d.xy_z",
            "gamma.multiply",
            "side2.quotient",
            "side2",
            "alpha.rest",
            "side0.quotient",
            "side0.exit",
            "va.a-p0.p1-p0.p2-p0.xy_z",
            "t.multiply",
            "t_max",
            "range.late",
            "near",
            "near.quotient",
            "far.quotient",
            "far.exit",
            "inside.sides",
        ],
    )
}

fn preferring(graph: &Graph, names: &[&str]) -> Genome {
    let node = |name: &&str| {
        let found = graph.find(name);
        found.unwrap_or_else(|| panic!("the graph has no node {name:?}"))
    };
    let nodes: Vec<NodeId> = names.iter().map(node).collect();
    Genome::identity(graph.nodes().len()).preferring(&nodes)
}

/// Nodes in the making; every method adds a family and gives what later ones need of it.
#[derive(Default)]
struct Builder {
    nodes: Vec<Node>,
}

struct Inputs {
    t_max: NodeId,
    zero: NodeId,
    one: NodeId,
    mask: NodeId,
}

/// One node for each volume: a choice of triple product, or of a way to have the volume.
#[derive(Clone, Copy)]
struct Volumes {
    v: NodeId,
    sides: [NodeId; 3],
    va: NodeId,
}

impl Volumes {
    fn side(&self, side: Side) -> NodeId {
        self.sides[side as usize]
    }

    fn others(&self, side: Side) -> [NodeId; 2] {
        side.others().map(|other| self.side(other))
    }
}

struct Quotients {
    t: NodeId,
    barycentric: [NodeId; 3],
    square: NodeId,
    product: NodeId,
}

impl Builder {
    fn add(&mut self, name: &str, op: Op, required: &[NodeId]) -> NodeId {
        self.push(name, op, required, &[])
    }

    fn choice(&mut self, name: &str, options: &[NodeId]) -> NodeId {
        self.push(name, Op::Choice, &[], options)
    }

    fn push(&mut self, name: &str, op: Op, required: &[NodeId], optional: &[NodeId]) -> NodeId {
        let id = NodeId::from_index(self.nodes.len());
        self.nodes.push(Node {
            id,
            name: name.to_owned(),
            op,
            required: required.to_vec(),
            optional: optional.to_vec(),
        });
        id
    }

    fn find(&self, name: &str) -> NodeId {
        let node = self.nodes.iter().find(|node| node.name == name);
        node.expect("families are added before they are used").id
    }

    fn inputs(&mut self) -> Inputs {
        for point in [Point::P0, Point::P1, Point::P2, Point::A] {
            self.add(&point.to_string(), Op::Load(point), &[]);
        }
        self.add("d", Op::LoadDirection, &[]);
        Inputs {
            t_max: self.add("t_max", Op::LoadTMax, &[]),
            zero: self.add("zero", Op::Zero, &[]),
            one: self.add("one", Op::One, &[]),
            mask: self.add("mask", Op::Mask, &[]),
        }
    }

    /// Edges, crosses and every triple product of every volume with both orders of summation.
    /// Gives the choice of triple product for each volume.
    fn triple_products(&mut self) -> Volumes {
        for edge in Edge::all() {
            let points = [edge.to, edge.from].map(|point| self.find(&point.to_string()));
            self.add(&vector_name(Vector::Edge(edge)), Op::Edge, &points);
        }
        for cross in volumes::crosses() {
            let operands = [cross.left, cross.right].map(|v| self.find(&vector_name(v)));
            self.add(&cross_name(cross), Op::Cross, &operands);
        }
        let [v, v0, v1, v2, va] = Volume::ALL.map(|volume| {
            let mut options = Vec::new();
            for product in volume.triple_products() {
                let operands = [cross_name(product.cross), vector_name(product.dot)];
                let operands = operands.map(|name| self.find(&name));
                for summation in [Summation::XyZ, Summation::XYz] {
                    let name = product_name(volume, product, summation);
                    options.push(self.add(&name, Op::Volume(volume, summation), &operands));
                }
            }
            let name = match volume {
                Volume::Va => "va".to_owned(),
                _ => format!("{}.direct", volume.name()),
            };
            self.choice(&name, &options)
        });
        let sides = [v0, v1, v2];
        Volumes { v, sides, va }
    }

    /// Volumes taken directly or derived from the others. What is derived is derived from direct
    /// volumes only, so the graph stays acyclic and no program has a volume twice.
    fn volumes(&mut self, direct: &Volumes) -> Volumes {
        let sum = self.add("v.sum", Op::SumOfSides, &direct.sides);
        let v = self.choice("v", &[direct.v, sum]);
        let sides = Side::ALL.map(|side| {
            let name = side.volume().name();
            let [j, k] = direct.others(side);
            let rest = self.add(&format!("{name}.rest"), Op::Rest(side), &[direct.v, j, k]);
            self.choice(name, &[direct.side(side), rest])
        });
        let va = direct.va;
        Volumes { v, sides, va }
    }

    /// Division: `t` and the barycentric coordinates, each by the reciprocal of `V` or another
    /// way, and the products that let a test do without.
    fn quotients(&mut self, inputs: &Inputs, volumes: &Volumes) -> Quotients {
        let (one, v) = (inputs.one, volumes.v);
        let exact = Op::Reciprocal(Reciprocal::Exact);
        let exact = self.add("reciprocal.exact", exact, &[one, v]);
        let newton = self.add(
            "reciprocal.newton",
            Op::Reciprocal(Reciprocal::Newton),
            &[v],
        );
        let reciprocal = self.choice("reciprocal", &[exact, newton]);

        let multiply = self.add("t.multiply", Op::TMultiply, &[volumes.va, reciprocal]);
        let divide = self.add("t.divide", Op::TDivide, &[volumes.va, v]);
        let t = self.choice("t", &[multiply, divide]);

        let multiplied = Side::ALL.map(|side| {
            let operands = [volumes.side(side), reciprocal];
            let name = format!("{}.multiply", side.barycentric());
            self.add(&name, Op::BarycentricMultiply(side), &operands)
        });
        let barycentric = Side::ALL.map(|side| {
            let [j, k] = side.others().map(|other| multiplied[other as usize]);
            let name = side.barycentric();
            let rest = Op::BarycentricRest(side);
            let rest = self.add(&format!("{name}.rest"), rest, &[one, j, k]);
            self.choice(name, &[multiplied[side as usize], rest])
        });
        Quotients {
            t,
            barycentric,
            square: self.add("square.v", Op::Square, &[v]),
            product: self.add("product.va_v", Op::Product, &[volumes.va, v]),
        }
    }

    /// The near test and the far test: both on `t`, or both before the division. Gives the masks
    /// that a hit must have passed.
    ///
    /// Where `V` is zero, infinite or NaN neither pair is true, so no program finds a hit there;
    /// see [`Op::quantity`] for the pairs that there are not.
    fn range_tests(&mut self, inputs: &Inputs, volumes: &Volumes, q: &Quotients) -> [NodeId; 3] {
        let Inputs {
            t_max, zero, mask, ..
        } = *inputs;
        let mut test = |op: Op, operands: &[NodeId]| self.add(&op.to_string(), op, operands);
        let near_quotient = test(Op::Near(On::Quotient), &[mask, zero, q.t]);
        let near_product = test(Op::Near(On::Product), &[mask, zero, q.product]);
        let near_signs = test(Op::Near(On::Signs), &[mask, volumes.va, volumes.v]);
        let far_quotient = test(Op::Far(On::Quotient), &[mask, q.t, t_max]);
        let far_product = test(Op::Far(On::Product), &[mask, q.product, t_max, q.square]);

        let near_early = self.choice("near.early", &[near_product, near_signs]);
        let late = self.add("range.late", Op::All, &[near_quotient, far_quotient]);
        let early = self.add("range.early", Op::All, &[near_early, far_product]);
        // The store asks for the range first: then one near and one far test are live, and the
        // choices below are settled.
        let range = self.choice("range", &[late, early]);
        let near = self.choice("near", &[near_quotient, near_product, near_signs]);
        let far = self.choice("far", &[far_quotient, far_product]);
        [
            range,
            self.exit_or_not("near", near),
            self.exit_or_not("far", far),
        ]
    }

    /// The three strategies of the paper's section 3: same signs, or side by side with one or
    /// none of the barycentric coordinates as the rest of the others.
    fn inside_tests(&mut self, inputs: &Inputs, volumes: &Volumes, q: &Quotients) -> NodeId {
        let Inputs { zero, mask, .. } = *inputs;
        let Volumes { v, sides, .. } = *volumes;
        let side_by_side = Side::ALL.map(|side| {
            let index = side as usize;
            let mut tests = vec![
                (SideTest::Quotient, vec![mask, q.barycentric[index], zero]),
                (SideTest::Product, vec![mask, sides[index], v, zero]),
                (SideTest::Signs, vec![mask, sides[index], v]),
            ];
            // Any program with such a sum for another side is one with this, its vertices
            // renamed in turn.
            if side == Side::S0 {
                let pair = Op::PairSum(side);
                let pair = self.add(&pair.to_string(), pair, &volumes.others(side));
                tests.push((SideTest::Sum, vec![mask, pair, v, q.square]));
            }
            let tests: Vec<NodeId> = tests
                .into_iter()
                .map(|(test, operands)| {
                    let op = Op::Side(side, test);
                    self.add(&op.to_string(), op, &operands)
                })
                .collect();
            let name = format!("side{index}");
            let test = self.choice(&name, &tests);
            self.exit_or_not(&name, test)
        });
        let [v0, v1, v2] = sides;
        let bits = Op::SameSign(SameSign::Bits);
        let ordered = Op::SameSign(SameSign::Ordered);
        let same_sign = [
            self.add(&bits.to_string(), bits, &[mask, v0, v1, v2]),
            self.add(&ordered.to_string(), ordered, &[mask, v0, v1, v2, zero]),
        ];
        let same_sign = self.choice("same_sign", &same_sign);
        let same_sign = self.exit_or_not("same_sign", same_sign);
        let side_by_side = self.add("inside.sides", Op::All, &side_by_side);
        self.choice("inside", &[same_sign, side_by_side])
    }

    /// The choice of an early exit after a test.
    fn exit_or_not(&mut self, name: &str, test: NodeId) -> NodeId {
        let exit = self.add(&format!("{name}.exit"), Op::Exit, &[test]);
        self.choice(&format!("{name}.done"), &[test, exit])
    }
}

fn vector_name(vector: Vector) -> String {
    match vector {
        Vector::Edge(edge) => format!("edge.{edge}"),
        Vector::Direction => "d".to_owned(),
    }
}

fn cross_name(Cross { left, right }: Cross) -> String {
    format!("cross.{left}.{right}")
}

fn product_name(volume: Volume, product: TripleProduct, summation: Summation) -> String {
    let TripleProduct { cross, dot } = product;
    let summation = match summation {
        Summation::XyZ => "xy_z",
        Summation::XYz => "x_yz",
    };
    format!(
        "{}.{}.{}.{dot}.{summation}",
        volume.name(),
        cross.left,
        cross.right
    )
}

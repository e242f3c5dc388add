//! What the graphs have in common: inputs, triple products, volumes, and the ways to go on from
//! volumes to a hit. How the sheared graph has its volumes is in [`watertight`](crate::watertight()).

use volumes::{Cross, Edge, Point, TripleProduct, Vector, Volume};

use crate::graph::{Graph, Node, NodeId};
use crate::op::{On, Op, Reciprocal, SameSign, Side, SideTest, Summation};

/// Whether a graph has fused operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Arithmetic {
    /// It has none.
    Plain,
    /// They are choices beside the plain ones.
    Fused,
}

/// Nodes in the making; every method adds a family and gives what later ones need of it.
pub(crate) struct Builder {
    arithmetic: Arithmetic,
    segments: bool,
    nodes: Vec<Node>,
}

pub(crate) struct Inputs {
    pub t_max: NodeId,
    pub zero: NodeId,
    pub one: NodeId,
    pub mask: NodeId,
}

/// One node for each volume: a choice of triple product, or of a way to have the volume.
#[derive(Clone, Copy)]
pub(crate) struct Volumes {
    pub v: NodeId,
    pub sides: [NodeId; 3],
    pub va: NodeId,
}

impl Volumes {
    fn side(&self, side: Side) -> NodeId {
        self.sides[side as usize]
    }

    fn others(&self, side: Side) -> [NodeId; 2] {
        side.others().map(|other| self.side(other))
    }
}

/// `t`, and what lets a test do without it.
pub(crate) struct Quotients {
    reciprocal: NodeId,
    t: NodeId,
    square: NodeId,
    product: NodeId,
}

impl Builder {
    pub fn new(arithmetic: Arithmetic) -> Builder {
        Builder {
            arithmetic,
            segments: false,
            nodes: Vec::new(),
        }
    }

    /// Rays are segments, whose other end is known.
    pub fn of_segments(self) -> Builder {
        Builder {
            segments: true,
            ..self
        }
    }

    /// The whole way from points to a hit by way of triple products.
    pub fn volumes_to_hit(mut self) -> Graph {
        let inputs = self.inputs();
        let mut direct = self.triple_products();
        let vb = self.segments.then(|| self.other_end());
        if let Some(vb) = vb {
            let ends = self.add("v.ends", Op::DifferenceOfEnds, &[direct.va, vb]);
            direct.v = self.choice("v.once", &[direct.v, ends]);
        }
        let volumes = self.volumes(&direct);
        let quotients = self.quotients(&inputs, &volumes);
        let ends = vb.map(|vb| self.test_of_ends(&inputs, &volumes, vb));
        let range = self.range_tests(&inputs, &volumes, &quotients, ends);
        let coordinates = self.barycentric(&inputs, &volumes, &quotients);
        let inside = self.inside_tests(&inputs, &volumes, &quotients, &coordinates);
        self.store(&inputs, &quotients, range, inside)
    }

    fn is_fused(&self) -> bool {
        self.arithmetic == Arithmetic::Fused
    }

    pub(crate) fn add(&mut self, name: &str, op: Op, required: &[NodeId]) -> NodeId {
        self.push(name, op, required, &[])
    }

    pub(crate) fn choice(&mut self, name: &str, options: &[NodeId]) -> NodeId {
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

    /// The ways to sum three products.
    fn summations(&self) -> &'static [Summation] {
        match self.arithmetic {
            Arithmetic::Plain => &Summation::PLAIN,
            Arithmetic::Fused => &Summation::ALL,
        }
    }

    pub(crate) fn find(&self, name: &str) -> NodeId {
        let node = self.nodes.iter().find(|node| node.name == name);
        node.expect("families are added before they are used").id
    }

    pub(crate) fn inputs(&mut self) -> Inputs {
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

    /// Edges, crosses and every triple product of every volume with every order of summation.
    /// Gives the choice of triple product for each volume.
    fn triple_products(&mut self) -> Volumes {
        for edge in Edge::all() {
            let points = [edge.to, edge.from].map(|point| self.find(&point.to_string()));
            self.add(&vector_name(Vector::Edge(edge)), Op::Edge, &points);
        }
        for cross in volumes::crosses() {
            let operands = [cross.left, cross.right].map(|v| self.find(&vector_name(v)));
            let name = cross_name(cross);
            if self.is_fused() {
                let plain = self.add(&format!("{name}.plain"), Op::Cross, &operands);
                let fused = self.add(&format!("{name}.fused"), Op::FusedCross, &operands);
                self.choice(&name, &[plain, fused]);
            } else {
                self.add(&name, Op::Cross, &operands);
            }
        }
        let [v, v0, v1, v2, va] = Volume::ALL.map(|volume| {
            let options = self.direct(volume);
            let name = match volume {
                Volume::Va => "va".to_owned(),
                _ => format!("{}.direct", volume.name()),
            };
            self.choice(&name, &options)
        });
        let sides = [v0, v1, v2];
        Volumes { v, sides, va }
    }

    /// Every triple product of a volume, in every order of summation.
    fn direct(&mut self, volume: Volume) -> Vec<NodeId> {
        let mut options = Vec::new();
        for product in volume.triple_products() {
            let operands = [cross_name(product.cross), vector_name(product.dot)];
            let operands = operands.map(|name| self.find(&name));
            for &summation in self.summations() {
                let name = product_name(volume, product, summation);
                options.push(self.add(&name, Op::Volume(volume, summation), &operands));
            }
        }
        options
    }

    /// A segment's other end: its edges, and the choice of triple product for `Vb`.
    fn other_end(&mut self) -> NodeId {
        let b = Point::B;
        self.add(&b.to_string(), Op::Load(b), &[]);
        for vertex in Point::VERTICES {
            for (to, from) in [(vertex, b), (b, vertex)] {
                let points = [to, from].map(|point| self.find(&point.to_string()));
                self.add(&vector_name(Edge { to, from }.into()), Op::Edge, &points);
            }
        }
        let options = self.direct(Volume::Vb);
        self.choice(Volume::Vb.name(), &options)
    }

    /// The test of a segment's ends, with or without an exit.
    fn test_of_ends(&mut self, inputs: &Inputs, volumes: &Volumes, vb: NodeId) -> NodeId {
        let operands = [inputs.mask, inputs.zero, volumes.va, vb];
        let test = self.add(&Op::Ends.to_string(), Op::Ends, &operands);
        self.exit_or_not("ends", test)
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

    /// Division: `t` by the reciprocal of `V` or by itself, and the products that let a test do
    /// without.
    pub(crate) fn quotients(&mut self, inputs: &Inputs, volumes: &Volumes) -> Quotients {
        let (one, v) = (inputs.one, volumes.v);
        let exact = Op::Reciprocal(Reciprocal::Exact);
        let exact = self.add("reciprocal.exact", exact, &[one, v]);
        let newton = self.add(
            "reciprocal.newton",
            Op::Reciprocal(Reciprocal::Newton),
            &[v],
        );
        let mut options = vec![exact, newton];
        if self.is_fused() {
            let newton = Op::Reciprocal(Reciprocal::FusedNewton);
            options.push(self.add("reciprocal.newton.fused", newton, &[one, v]));
        }
        let reciprocal = self.choice("reciprocal", &options);

        let multiply = self.add("t.multiply", Op::TMultiply, &[volumes.va, reciprocal]);
        let divide = self.add("t.divide", Op::TDivide, &[volumes.va, v]);
        let t = self.choice("t", &[multiply, divide]);

        Quotients {
            reciprocal,
            t,
            square: self.add("square.v", Op::Square, &[v]),
            product: self.add("product.va_v", Op::Product, &[volumes.va, v]),
        }
    }

    /// The barycentric coordinates, each by the reciprocal of `V` or as the rest of the others.
    fn barycentric(&mut self, inputs: &Inputs, volumes: &Volumes, q: &Quotients) -> [NodeId; 3] {
        let multiplied = Side::ALL.map(|side| {
            let operands = [volumes.side(side), q.reciprocal];
            let name = format!("{}.multiply", side.barycentric());
            self.add(&name, Op::BarycentricMultiply(side), &operands)
        });
        Side::ALL.map(|side| {
            let [j, k] = side.others().map(|other| multiplied[other as usize]);
            let name = side.barycentric();
            let rest = Op::BarycentricRest(side);
            let rest = self.add(&format!("{name}.rest"), rest, &[inputs.one, j, k]);
            self.choice(name, &[multiplied[side as usize], rest])
        })
    }

    /// The near test and the far test: both on `t`, or both before the division, or between. Gives the masks
    /// that a hit must have passed.
    ///
    /// Where `V` is zero, infinite or NaN neither pair is true, so no program finds a hit there. A
    /// third pair, where there are fused operations too, is for scenes whose volumes are finite: near
    /// before the division and far after it.
    ///
    /// Where there is a test of the ends, either pair may have it before it.
    pub(crate) fn range_tests(
        &mut self,
        inputs: &Inputs,
        volumes: &Volumes,
        q: &Quotients,
        ends: Option<NodeId>,
    ) -> [NodeId; 3] {
        let Inputs {
            t_max, zero, mask, ..
        } = *inputs;
        let mut test = |op: Op, operands: &[NodeId]| self.add(&op.to_string(), op, operands);
        let near_quotient = test(Op::Near(On::Quotient), &[mask, zero, q.t]);
        let near_product = test(Op::Near(On::Product), &[mask, zero, q.product]);
        let near_signs = test(Op::Near(On::Signs), &[mask, zero, volumes.va, volumes.v]);
        let far_quotient = test(Op::Far(On::Quotient), &[mask, q.t, t_max]);
        let far_product = test(Op::Far(On::Product), &[mask, q.product, t_max, q.square]);

        let near_early = self.choice("near.early", &[near_product, near_signs]);
        let late = self.pair("range.late", ends, [near_quotient, far_quotient]);
        let mut early = self.pair("range.early", ends, [near_early, far_product]);
        if self.is_fused() {
            let split = self.pair("range.split", ends, [near_early, far_quotient]);
            early = self.choice("range.near_first", &[early, split]);
        }
        // The store asks for the range first, which has as few options as what it asks for later: then
        // one near and one far test are live, and the choices below are settled.
        let range = self.choice("range", &[late, early]);
        let near = self.choice("near", &[near_quotient, near_product, near_signs]);
        let far = self.choice("far", &[far_quotient, far_product]);
        [
            range,
            self.exit_or_not("near", near),
            self.exit_or_not("far", far),
        ]
    }

    /// A near and a far test that go together, with or without the test of the ends before them if there
    /// is one.
    fn pair(&mut self, name: &str, ends: Option<NodeId>, [near, far]: [NodeId; 2]) -> NodeId {
        let alone = self.add(name, Op::All, &[near, far]);
        let Some(ends) = ends else {
            return alone;
        };
        let after_ends = self.add(&format!("{name}.ends"), Op::All, &[ends, near, far]);
        self.choice(&format!("{name}.way"), &[alone, after_ends])
    }

    /// The three strategies of the paper's section 3: same signs, or side by side with one or
    /// none of the barycentric coordinates as the rest of the others.
    fn inside_tests(
        &mut self,
        inputs: &Inputs,
        volumes: &Volumes,
        q: &Quotients,
        barycentric: &[NodeId; 3],
    ) -> NodeId {
        let Inputs { zero, mask, .. } = *inputs;
        let Volumes { v, sides, .. } = *volumes;
        let side_by_side = Side::ALL.map(|side| {
            let index = side as usize;
            let mut tests = vec![
                (SideTest::Quotient, vec![mask, barycentric[index], zero]),
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

    /// The store of a hit that has passed the tests, which is the goal.
    pub(crate) fn store(
        mut self,
        inputs: &Inputs,
        quotients: &Quotients,
        [range, near, far]: [NodeId; 3],
        inside: NodeId,
    ) -> Graph {
        let needed = [quotients.t, inputs.t_max, range, near, far, inside];
        let goal = self.add("store", Op::Store, &needed);
        Graph::new(goal, self.nodes).expect("the builder makes sound graphs")
    }

    /// The choice of an early exit after a test.
    pub(crate) fn exit_or_not(&mut self, name: &str, test: NodeId) -> NodeId {
        let exit = self.add(&format!("{name}.exit"), Op::Exit, &[test]);
        self.choice(&format!("{name}.done"), &[test, exit])
    }
}

pub(crate) fn vector_name(vector: Vector) -> String {
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
    format!(
        "{}.{}.{}.{dot}.{summation}",
        volume.name(),
        cross.left,
        cross.right
    )
}

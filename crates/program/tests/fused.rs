//! Fused operations: what they round, and that they are choices beside the plain ones.

use program::{
    Genome, Op, Program, Ray, Reciprocal, Rules, Statement, Summation, Triangle, extended,
    kensler_shirley,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use volumes::{Case, Kind, Rate, Volume};

mod common;

/// A program of the extended graph that prefers these nodes.
fn preferring(names: &[&str]) -> Program {
    let graph = extended();
    let nodes = names.iter().map(|name| graph.find(name).expect(name));
    let nodes: Vec<_> = nodes.collect();
    let genome = Genome::identity(graph.nodes().len()).preferring(&nodes);
    graph.program(&genome).unwrap()
}

fn has(program: &Program, op: Op) -> bool {
    program.statements().iter().any(|one| one.op == op)
}

#[test]
fn every_node_of_the_first_graph_is_in_the_extended_one() {
    let extended = extended();
    for node in kensler_shirley().nodes() {
        let name = match node.op {
            Op::Cross => format!("{}.plain", node.name),
            _ => node.name.clone(),
        };
        let found = extended.find(&name).unwrap_or_else(|| panic!("{name}"));
        assert_eq!(extended.node(found).op, node.op);
    }
}

#[test]
fn one_product_of_a_fused_sum_is_rounded_by_itself_and_no_other() {
    let (ray, triangle) = common::random_pair(&mut ChaCha8Rng::seed_from_u64(3));
    let ray = common::narrow_ray(&ray);
    let triangle = common::narrow_triangle(&triangle);
    let [e, f] = [(triangle.p1, triangle.p0), (triangle.p0, triangle.p2)]
        .map(|(to, from)| [0, 1, 2].map(|axis| to[axis] - from[axis]));
    let cross = |fused: bool| {
        [(1, 2), (2, 0), (0, 1)].map(|(j, k)| match fused {
            true => e[j].mul_add(f[k], -(e[k] * f[j])),
            false => e[j] * f[k] - e[k] * f[j],
        })
    };
    let d = ray.d;
    for (name, is_fused) in [("plain", false), ("fused", true)] {
        let n: [f32; 3] = cross(is_fused);
        let sums = [
            ("xy_z", n[0] * d[0] + n[1] * d[1] + n[2] * d[2]),
            ("x_yz", n[0] * d[0] + (n[1] * d[1] + n[2] * d[2])),
            (
                "xy_z.fused",
                n[2].mul_add(d[2], n[1].mul_add(d[1], n[0] * d[0])),
            ),
            (
                "x_yz.fused",
                n[0].mul_add(d[0], n[1].mul_add(d[1], n[2] * d[2])),
            ),
        ];
        for (sum, expected) in sums {
            let product = format!("v.p1-p0.p0-p2.d.{sum}");
            let cross = format!("cross.p1-p0.p0-p2.{name}");
            let program = preferring(&["v.direct", &product, &cross]);
            let volume = program.volume(Volume::V, &ray, &triangle);
            assert_eq!(volume, Some(expected), "{name} {sum}");
        }
    }
}

#[test]
fn a_fused_newton_step_is_at_least_as_good_as_the_plain_one() {
    let error = |name: &str| {
        let program = preferring(&["t.multiply", name, "inside.sides", "side0.signs"]);
        let (ray, triangle) = common::a_hit();
        let wide = Ray {
            a: ray.a.map(f64::from),
            d: ray.d.map(f64::from),
            t_max: 1e6,
        };
        let exact = Triangle {
            p0: triangle.p0.map(f64::from),
            p1: triangle.p1.map(f64::from),
            p2: triangle.p2.map(f64::from),
        };
        let exact = program.run(&wide, &exact).unwrap();
        (f64::from(program.run(&ray, &triangle).unwrap()) / exact - 1.0).abs()
    };
    let [plain, fused] = ["reciprocal.newton", "reciprocal.newton.fused"].map(error);
    assert!(plain < 1e-6 && fused < 1e-6, "{plain} {fused}");
}

#[test]
fn a_program_may_fuse_one_product_and_not_another() {
    let program = preferring(&[
        "v.direct",
        "v.p1-p0.p0-p2.d.xy_z.fused",
        "cross.p1-p0.p0-p2.plain",
        "va.p1-p0.p0-p2.p0-a.x_yz",
        "t.multiply",
        "reciprocal.newton.fused",
    ]);
    assert!(has(&program, Op::Volume(Volume::V, Summation::FusedXyZ)));
    assert!(has(&program, Op::Volume(Volume::Va, Summation::XYz)));
    assert!(has(&program, Op::Cross) && has(&program, Op::Reciprocal(Reciprocal::FusedNewton)));
    let breach = program.breaks(&Rules {
        fused: false,
        ..Rules::ALL
    });
    assert!(breach.unwrap().op.is_fused());
}

#[test]
fn what_is_fused_counts_once_where_the_model_fuses_and_twice_where_not() {
    let of = |program: &Program, fused, kind| -> u32 {
        let operations = program.operations(Case::SINGLE, fused);
        Rate::ALL
            .iter()
            .map(|&rate| operations[rate as usize].count(kind))
            .sum()
    };
    let graph = extended();
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for _ in 0..200 {
        let genome = Genome::random(graph.nodes().len(), &mut rng);
        let program = graph.program(&genome).unwrap();
        assert_eq!(of(&program, false, Kind::Fused), 0);
        let fused = of(&program, true, Kind::Fused);
        assert!(fused > 0);
        let multiplications = of(&program, false, Kind::Multiply);
        assert_eq!(of(&program, true, Kind::Multiply) + fused, multiplications);
    }
}

#[test]
fn a_program_without_estimates_may_still_be_fused() {
    let program = preferring(&["t.multiply", "reciprocal.newton.fused"]);
    let exact = program.without_estimates();
    assert!(has(&exact, Op::Reciprocal(Reciprocal::Exact)));
    let ones = |one: &&Statement| one.op == Op::One;
    assert_eq!(exact.statements().iter().filter(ones).count(), 1);
    assert!(exact.statements().iter().all(|one| !one.op.is_estimate()));
}

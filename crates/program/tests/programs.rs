//! Programs that genomes pick: their order, their values, their answers.

use std::collections::BTreeSet;

use program::{
    Condition, Genome, On, Op, Program, Quantity, Ray, Rules, Triangle, appendix, kensler_shirley,
    moller_trumbore_volumes,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use volumes::{Cross, Edge, Point, Rate, Rates, Vector};

mod common;

const GENOMES: usize = 4000;

#[test]
fn operands_come_before_their_statements_and_every_value_is_used() {
    for_random_programs(|program| {
        let mut used = BTreeSet::<u32>::new();
        for (index, statement) in program.statements().iter().enumerate() {
            assert!(statement.operands.iter().all(|&o| (o as usize) < index));
            used.extend(&statement.operands);
        }
        assert_eq!(
            used.len(),
            program.statements().len() - 1,
            "only the store is for itself"
        );
    });
}

#[test]
fn no_value_is_computed_twice() {
    for_random_programs(|program| {
        let mut seen = BTreeSet::new();
        for (statement, quantity) in program.statements().iter().zip(program.quantities()) {
            assert!(
                statement.op == Op::Exit || seen.insert(*quantity),
                "{quantity} twice"
            );
        }
    });
}

#[test]
fn no_vector_is_computed_twice_by_different_edges() {
    let sample = volumes::Sample::random(9);
    for_random_programs(|program| {
        let mut seen = BTreeSet::new();
        for quantity in program.quantities() {
            if let Quantity::Cross(cross) = quantity {
                assert!(seen.insert(sample.cross(*cross)), "{cross} again");
            }
        }
    });
}

#[test]
fn no_program_has_both_the_normal_and_its_opposite() {
    let sample = volumes::Sample::random(9);
    let of_triangle = |cross: &Cross| {
        let edges = [cross.left, cross.right].map(Vector::edge);
        edges
            .iter()
            .all(|edge| edge.is_some_and(|edge| edge.to != Point::A && edge.from != Point::A))
    };
    for_random_programs(|program| {
        let normals: BTreeSet<_> = program
            .quantities()
            .iter()
            .filter_map(|quantity| match quantity {
                Quantity::Cross(cross) if of_triangle(cross) => Some(sample.cross(*cross)),
                _ => None,
            })
            .collect();
        assert!(normals.len() <= 1, "{}", listing(program));
    });
}

#[test]
fn edges_walked_the_other_way_give_the_same_number_and_the_least_vectors() {
    let graph = kensler_shirley();
    let nodes = |names: &[&str]| -> Vec<_> {
        let find = |name: &&str| graph.find(name).expect(name);
        names.iter().map(find).collect()
    };
    // V1 and V2 with opposite crosses, as two independent choices would have them.
    let preferred = nodes(&[
        "v.direct",
        "v.p1-p0.p0-p2.d.xy_z",
        "va.p1-p0.p0-p2.p0-a.xy_z",
        "v1.direct",
        "v1.p0-a.d.p0-p2.xy_z",
        "v2.direct",
        "v2.d.p0-a.p0-p1.xy_z",
        "inside.sides",
        "side1.signs",
        "side2.signs",
    ]);
    let genome = Genome::identity(graph.nodes().len()).preferring(&preferred);
    let program = graph.program(&genome).unwrap();
    let crosses_of_d = |quantity: &&Quantity| match quantity {
        Quantity::Cross(cross) => [cross.left, cross.right].contains(&Vector::Direction),
        _ => false,
    };
    let crosses = program.quantities().iter().filter(crosses_of_d);
    assert_eq!(crosses.count(), 1, "{}", listing(&program));
    assert!(listing(&program).contains("v1") && listing(&program).contains("v2"));
}

#[test]
fn among_the_ready_statements_the_one_of_highest_priority_comes_first() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for (_, graph) in common::graphs() {
        for _ in 0..GENOMES {
            let genome = Genome::random(graph.nodes().len(), &mut rng);
            let program = graph.program(&genome).unwrap();
            let ids = graph.statements(&genome);
            let priority = |place: usize| genome.priorities()[ids[place].index()];
            for (place, statement) in program.statements().iter().enumerate().skip(1) {
                // A statement that could have stood one place earlier has the lower priority.
                if !statement.operands.contains(&(place as u32 - 1)) {
                    assert!(priority(place) < priority(place - 1));
                }
            }
        }
    }
}

#[test]
fn every_program_compares_something_that_is_false_for_nan_and_for_zero_volume() {
    let (ray, triangle) = common::a_hit();
    let inputs = |at: usize, value: f32| {
        let (mut ray, mut triangle) = (ray, triangle);
        let points = [
            &mut ray.a,
            &mut ray.d,
            &mut triangle.p0,
            &mut triangle.p1,
            &mut triangle.p2,
        ];
        let components: Vec<&mut f32> = points.into_iter().flatten().collect();
        *components.into_iter().nth(at).unwrap() = value;
        (ray, triangle)
    };
    for_random_programs(|program| {
        assert!(program.run(&ray, &triangle).is_some());
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for at in 0..15 {
                let (ray, triangle) = inputs(at, value);
                let hit = program.run(&ray, &triangle);
                assert_eq!(hit, None, "component {at} is {value}: {program:?}");
            }
        }
        let t_max = f32::NAN;
        assert_eq!(program.run(&Ray { t_max, ..ray }, &triangle), None);
        let parallel = Ray {
            d: [1.0, -2.0, 0.0],
            ..ray
        };
        assert_eq!(program.run(&parallel, &triangle), None);
        let collinear = Triangle {
            p2: triangle.p1,
            ..triangle
        };
        assert_eq!(program.run(&ray, &collinear), None);
    });
}

#[test]
fn every_program_agrees_with_moller_trumbore_away_from_edges() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let mut hits = 0;
    for_random_programs(|program| {
        hits += common::agrees_away_from_edges(program, 8, &mut rng);
    });
    assert!(hits > 8 * GENOMES / 25, "{hits} hits");
}

/// The lower bound is open: a hit at `t = 0` is none, on either side of the triangle and whichever way
/// the near test is made.
#[test]
fn a_ray_that_starts_on_a_triangle_misses_it() {
    let [a, d] = [[1.0, 2.0, 0.0], [1.0, -2.0, 4.0]];
    let [p0, p1, p2] = [[-3.0, -2.0, 0.0], [6.0, 1.0, 0.0], [0.0, 7.0, 0.0]];
    for_random_programs(|program| {
        for d in [d, d.map(|component: f32| -component)] {
            let ray = Ray { a, d, t_max: 1.0 };
            for triangle in [Triangle { p0, p1, p2 }, Triangle { p0, p1: p2, p2: p1 }] {
                assert_eq!(program.run(&ray, &triangle), None, "{}", listing(program));
                let before = Ray {
                    a: [0, 1, 2].map(|axis| a[axis] - d[axis] / 2.0),
                    ..ray
                };
                assert!(program.run(&before, &triangle).is_some());
            }
        }
    });
}

#[test]
fn the_appendix_kernel_is_a_program_of_the_graph() {
    let graph = kensler_shirley();
    let program = graph.program(&appendix(&graph)).unwrap();
    expect_test::expect![[r#"
         0 load.p1           [] the point p1
         1 load.p0           [] the point p0
         2 edge              [0, 1] the vector p1-p0
         3 load.p2           [] the point p2
         4 edge              [1, 3] the vector p0-p2
         5 cross             [2, 4] the cross (p1-p0) × (p0-p2)
         6 zero              [] zero
         7 load.a            [] the point a
         8 load.t_max        [] t_max
         9 load.d            [] the vector d
        10 volume.v.xy_z     [5, 9] the volume V
        11 reciprocal.newton [10] 1 / V
        12 edge              [1, 7] the vector p0-a
        13 volume.va.xy_z    [5, 12] the volume Va
        14 t.multiply        [13, 11] t
        15 mask              [] the untested mask
        16 far.quotient      [15, 14, 8] the far test
        17 near.quotient     [15, 6, 14] the near test
        18 exit              [17] the near test
        19 cross             [12, 9] the cross (p0-a) × d
        20 volume.v1.xy_z    [19, 4] the volume V1
        21 beta.multiply     [20, 11] beta
        22 side1.quotient    [15, 21, 6] the test of side 1
        23 exit              [22] the test of side 1
        24 volume.v2.xy_z    [19, 2] the volume V2
        25 pair.v1_v2        [20, 24] V1 + V2
        26 square.v          [10] V²
        27 side0.sum         [15, 25, 10, 26] the test of side 0
        28 gamma.multiply    [24, 11] gamma
        29 side2.quotient    [15, 28, 6] the test of side 2
        30 exit              [29] the test of side 2
        31 store             [14, 8, 17, 16, 18, 27, 23, 30] the store
    "#]]
    .assert_eq(&listing(&program));
}

#[test]
fn equations_2_are_a_program_of_the_graph() {
    let graph = kensler_shirley();
    let program = graph.program(&moller_trumbore_volumes(&graph)).unwrap();
    expect_test::expect![[r#"
         0 load.p0           [] the point p0
         1 load.p1           [] the point p1
         2 load.p2           [] the point p2
         3 edge              [1, 0] the vector p1-p0
         4 edge              [2, 0] the vector p2-p0
         5 zero              [] zero
         6 one               [] one
         7 load.d            [] the vector d
         8 cross             [7, 4] the cross d × (p2-p0)
         9 volume.v.xy_z     [8, 3] the volume V
        10 reciprocal.exact  [6, 9] 1 / V
        11 load.a            [] the point a
        12 edge              [11, 0] the vector a-p0
        13 volume.v1.xy_z    [8, 12] the volume V1
        14 beta.multiply     [13, 10] beta
        15 mask              [] the untested mask
        16 side1.quotient    [15, 14, 5] the test of side 1
        17 exit              [16] the test of side 1
        18 cross             [12, 3] the cross (a-p0) × (p1-p0)
        19 volume.v2.xy_z    [18, 7] the volume V2
        20 gamma.multiply    [19, 10] gamma
        21 side2.quotient    [15, 20, 5] the test of side 2
        22 alpha.rest        [6, 14, 20] alpha
        23 side0.quotient    [15, 22, 5] the test of side 0
        24 exit              [23] the test of side 0
        25 volume.va.xy_z    [18, 4] the volume Va
        26 t.multiply        [25, 10] t
        27 load.t_max        [] t_max
        28 near.quotient     [15, 5, 26] the near test
        29 far.quotient      [15, 26, 27] the far test
        30 exit              [29] the far test
        31 store             [26, 27, 28, 29, 30, 24, 17, 21] the store
    "#]]
    .assert_eq(&listing(&program));
}

#[test]
fn a_value_changes_as_often_as_what_it_is_made_of() {
    let graph = kensler_shirley();
    let program = graph.program(&appendix(&graph)).unwrap();
    let edge = |to, from| Vector::Edge(Edge { to, from });
    let [e0, e1, from_eye] = [
        edge(Point::P1, Point::P0),
        edge(Point::P0, Point::P2),
        edge(Point::P0, Point::A),
    ];
    let rate = |inputs: Rates, quantity: Quantity| {
        let place = program.quantities().iter().position(|&q| q == quantity);
        program.rates(inputs)[place.unwrap()]
    };
    let normal = Quantity::Cross(Cross {
        left: e0,
        right: e1,
    });
    assert_eq!(rate(Rates::GENERAL, normal), Rate::Triangle);
    assert_eq!(
        rate(Rates::GENERAL, Quantity::Vector(from_eye)),
        Rate::RayTriangle
    );
    assert_eq!(
        rate(Rates::COMMON_ORIGIN, Quantity::Vector(from_eye)),
        Rate::PacketTriangle
    );
    assert_eq!(
        rate(Rates::COMMON_ORIGIN, Quantity::Point(Point::A)),
        Rate::Packet
    );
    assert_eq!(rate(Rates::GENERAL, Quantity::Zero), Rate::Constant);
    assert_eq!(rate(Rates::GENERAL, Quantity::TMax), Rate::Ray);
    assert_eq!(
        rate(
            Rates::COMMON_ORIGIN,
            Quantity::Tested(Condition::Near(On::Quotient))
        ),
        Rate::RayTriangle
    );
}

/// Calls `check` with programs of random genomes of every graph, as scenes without bounds have them.
fn for_random_programs(mut check: impl FnMut(&Program)) {
    for (_, graph) in common::graphs() {
        let graph = graph.restricted(&Rules::ORDINARY).unwrap();
        common::for_random_programs(&graph, GENOMES, &mut check);
    }
}

fn listing(program: &Program) -> String {
    let lines = program.statements().iter().zip(program.quantities());
    lines
        .enumerate()
        .map(|(index, (statement, quantity))| {
            let (op, operands) = (statement.op.to_string(), &statement.operands);
            format!("{index:2} {op:17} {operands:?} {quantity}\n")
        })
        .collect()
}

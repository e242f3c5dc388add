//! What rules leave of a graph: programs that keep to them, and all that may be had of those.

use program::{
    Condition, Genome, Graph, On, Op, Program, Quantity, Ray, Rules, Side, Triangle, Unsatisfiable,
    Vertices, Watertight, appendix, extended, kensler_shirley, segment, watertight,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use volumes::{Point, Vector, Volume};

mod common;

const GENOMES: usize = 1000;

const STORED_EDGES: Rules = Rules {
    vertices: Vertices::Edges,
    ..Rules::ALL
};

const EDGE_WATERTIGHT: Rules = Rules {
    watertight: Watertight::Edges,
    ..Rules::ALL
};

/// Each rule alone, and some together, with what they leave of the graphs of triple products.
fn cases() -> Vec<(Rules, Graph)> {
    let rules = [
        Rules::PORTABLE,
        STORED_EDGES,
        EDGE_WATERTIGHT,
        Rules {
            vertices: Vertices::Edges,
            ..Rules::PORTABLE
        },
        Rules {
            watertight: Watertight::Edges,
            ..Rules::PORTABLE
        },
    ];
    let graphs = [kensler_shirley(), extended(), segment()];
    let cases = graphs.iter().flat_map(|graph| {
        rules.map(|rules| (rules, graph.restricted(&rules).expect("there are programs")))
    });
    cases.collect()
}

#[test]
fn without_rules_a_graph_stays_as_it_is() {
    for (_, graph) in common::graphs() {
        assert_eq!(graph.restricted(&Rules::ALL).as_ref(), Ok(&graph));
    }
}

#[test]
fn every_program_of_a_restricted_graph_keeps_to_the_rules() {
    for (rules, graph) in cases() {
        common::for_random_programs(&graph, GENOMES, |program| {
            assert_eq!(program.breaks(&rules), None, "{program:?}");
        });
    }
}

#[test]
fn all_that_the_goal_leads_to_is_live_for_some_genome() {
    for (rules, graph) in cases() {
        for id in common::reachable(&graph) {
            let live =
                common::genomes_towards(&graph, id).any(|genome| graph.live(&genome).contains(&id));
            assert!(live, "{} is never live: {rules:?}", graph.node(id).name);
        }
    }
}

#[test]
fn restricted_graphs_keep_numbers_and_names_and_lose_options() {
    for (rules, restricted) in cases() {
        let graphs = [kensler_shirley(), extended(), segment()];
        let is_whole = |graph: &Graph| graph.nodes().len() == restricted.nodes().len();
        let graph = graphs.into_iter().find(is_whole).unwrap();
        assert_ne!(rules, Rules::ALL);
        assert_eq!(restricted.goal(), graph.goal());
        assert!(common::reachable(&restricted).len() < graph.nodes().len());
        for (left, node) in restricted.nodes().iter().zip(graph.nodes()) {
            assert_eq!((left.id, &left.name), (node.id, &node.name));
            assert!(left.optional.iter().all(|id| node.optional.contains(id)));
        }
    }
}

#[test]
fn restricted_programs_find_what_others_find() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for (_, graph) in cases() {
        let mut hits = 0;
        common::for_random_programs(&graph, GENOMES, |program| {
            hits += common::agrees_away_from_edges(program, 8, &mut rng);
        });
        assert!(hits > GENOMES / 20, "{hits}");
    }
}

#[test]
fn a_portable_program_has_no_estimate_and_nothing_fused() {
    for (_, graph) in common::graphs() {
        let graph = graph.restricted(&Rules::PORTABLE).unwrap();
        common::for_random_programs(&graph, GENOMES, |program| {
            assert!(program.is_portable());
            for statement in program.statements() {
                assert!(!statement.op.is_estimate() && !statement.op.is_fused());
                let name = statement.op.to_string();
                assert!(
                    !name.contains("newton") && !name.contains("fused"),
                    "{name}"
                );
            }
        });
    }
}

#[test]
fn with_stored_edges_no_other_vertex_than_the_first_is_ever_needed() {
    let graph = extended().restricted(&STORED_EDGES).unwrap();
    common::for_random_programs(&graph, GENOMES, |program| {
        let mut loads = 0;
        for (statement, quantity) in program.statements().iter().zip(program.quantities()) {
            loads += usize::from(matches!(statement.op, Op::LoadEdge(_)));
            if let Quantity::Point(point) = quantity {
                assert!([Point::A, Point::P0].contains(point), "{program:?}");
            }
        }
        assert_eq!(loads, 2, "{program:?}");
    });
}

#[test]
fn what_rules_leave_of_the_triple_products() {
    let count = |graph: &Graph, volume| {
        let is_of = |id| matches!(graph.node(id).op, Op::Volume(other, _) if other == volume);
        let reachable = common::reachable(graph);
        reachable.into_iter().filter(|&id| is_of(id)).count()
    };
    let counts = |rules| {
        let graph = kensler_shirley().restricted(&rules).unwrap();
        Volume::ALL.map(|volume| count(&graph, volume))
    };
    // Two orders of summation each.
    assert_eq!(counts(Rules::ALL), [72, 72, 72, 72, 768]);
    assert_eq!(counts(STORED_EDGES), [6, 0, 12, 12, 12]);
    // Four directions of the two edges, whose order the sign decides. Of Va, 36 have one of these twelve
    // crosses, the rest the normal or two edges without a corner in common.
    assert_eq!(counts(EDGE_WATERTIGHT), [72, 8, 8, 8, 2 * (36 + 72 + 96)]);
}

#[test]
fn from_a_stored_edge_to_its_other_end_no_difference_of_points_leads() {
    let rules = Rules {
        watertight: Watertight::Edges,
        ..STORED_EDGES
    };
    let error = kensler_shirley().restricted(&rules).unwrap_err();
    assert_eq!(error, Unsatisfiable);
    assert_eq!(
        error.to_string(),
        "no program of the graph keeps to these rules"
    );
}

const SPLIT: [Condition; 2] = [Condition::Near(On::Signs), Condition::Far(On::Quotient)];

#[test]
fn where_volumes_may_be_infinite_tests_of_t_are_both_before_the_division_or_both_after_it() {
    let splits = |rules: &Rules| {
        let graph = extended().restricted(rules).unwrap();
        let mut splits = 0;
        common::for_random_programs(&graph, GENOMES, |program| {
            let tests: Vec<Condition> = program.tests().into_iter().map(|test| test.0).collect();
            splits += usize::from(SPLIT.iter().all(|test| tests.contains(test)));
        });
        splits
    };
    assert_eq!(splits(&Rules::ORDINARY), 0);
    assert!(splits(&Rules::ALL) > GENOMES / 20);
}

/// Such as scenes have whose bounds do not keep them from squares that are zero or infinite.
#[test]
fn without_squares_a_program_is_right_where_squares_of_volumes_are_infinite_or_zero() {
    let rules = Rules {
        squares: false,
        ..Rules::ORDINARY
    };
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for (name, graph) in [("extended", extended()), ("segment", segment())] {
        let without = graph.restricted(&rules).unwrap();
        let ordinary = graph.restricted(&Rules::ORDINARY).unwrap();
        for scale in [2f32.powi(-24), 2f32.powi(28)] {
            let mut differs = |graph: &Graph| {
                let mut differs = 0;
                common::for_random_programs(graph, GENOMES, |program| {
                    let (ray, triangle) = common::random_pair(&mut rng);
                    let Some(expected) = common::reference(&ray, &triangle) else {
                        return;
                    };
                    let found = scaled(program, &ray, &triangle, scale);
                    differs += usize::from(found.is_some() != expected.is_some());
                });
                differs
            };
            assert_eq!(differs(&without), 0, "{name}, {scale:e}");
            assert!(
                differs(&ordinary) > 0,
                "{name}, {scale:e}: the test is empty"
            );
        }
    }
}

/// Runs a program on what is larger by a factor, the direction too.
fn scaled(program: &Program, ray: &Ray<f64>, triangle: &Triangle<f64>, scale: f32) -> Option<f32> {
    let (ray, triangle) = (common::narrow_ray(ray), common::narrow_triangle(triangle));
    let scaled = |v: [f32; 3]| v.map(|x| x * scale);
    let ray = Ray {
        a: scaled(ray.a),
        d: scaled(ray.d),
        t_max: ray.t_max,
    };
    let triangle = Triangle {
        p0: scaled(triangle.p0),
        p1: scaled(triangle.p1),
        p2: scaled(triangle.p2),
    };
    program.run(&ray, &triangle)
}

#[test]
fn only_a_segment_has_another_end() {
    let rays = Rules {
        ends: false,
        ..Rules::ALL
    };
    let has_end = |program: &Program| {
        let mut ops = program.statements().iter().map(|statement| statement.op);
        ops.any(|op| op == Op::Load(Point::B))
    };
    let mut with_end = 0;
    common::for_random_programs(&segment(), GENOMES, |program| {
        assert_eq!(has_end(program), program.breaks(&rays).is_some());
        with_end += usize::from(has_end(program));
    });
    assert!((GENOMES / 10..GENOMES).contains(&with_end), "{with_end}");
    common::for_random_programs(&segment().restricted(&rays).unwrap(), GENOMES, |program| {
        assert!(!has_end(program), "{program:?}");
    });
}

/// A hit is hardly short of a segment's end: that is seen by the volume of the end, and hidden from `t`,
/// which is rounded as the whole segment is long.
#[test]
fn at_its_end_a_segment_is_told_by_the_volume_of_the_end() {
    let graph = segment();
    let genome = |ends: &str| {
        let prefer = ["range.late", ends, "v.once", "v.ends"].map(|name| graph.find(name).unwrap());
        Genome::identity(graph.nodes().len()).preferring(&prefer)
    };
    let program = graph.program(&genome("range.late.ends")).unwrap();
    assert!(program.statements().iter().any(|one| one.op == Op::Ends));
    let [p0, p1, p2] = [[-1.0, -1.0, 0.0], [2.0, -1.0, 0.0], [-1.0, 2.0, 0.0]];
    let triangle = Triangle { p0, p1, p2 };
    let a = [0.0, 0.0, 1000.0];
    // b is a hair above the triangle, and then a hair below.
    for (z, is_hit) in [(1e-6, false), (-1e-3, true)] {
        let d = [0.0, 0.0, z - a[2]];
        let ray = Ray { a, d, t_max: 1.0 };
        assert_eq!(program.run(&ray, &triangle).is_some(), is_hit, "{z}");
    }
}

#[test]
fn a_program_that_breaks_a_rule_says_where() {
    let graph = kensler_shirley();
    let program = graph.program(&appendix(&graph)).unwrap();
    let breach = |rules| program.breaks(&rules).map(|breach| breach.to_string());
    assert_eq!(breach(Rules::ALL), None);
    let expected = [
        (
            Rules::PORTABLE,
            "statement 11, reciprocal.newton, is not allowed here",
        ),
        (STORED_EDGES, "statement 0, load.p1, is not allowed here"),
        (
            EDGE_WATERTIGHT,
            "statement 20, volume.v1.xy_z, is not allowed here",
        ),
    ];
    for (rules, sentence) in expected {
        assert_eq!(breach(rules).as_deref(), Some(sentence));
    }
    let stored = graph.restricted(&STORED_EDGES).unwrap();
    let program = stored.program(&appendix(&graph)).unwrap();
    let breach = program.breaks(&Rules::ALL).unwrap();
    assert!(matches!(breach.op, Op::LoadEdge(_)));
}

/// Whatever the order in which the two triangles sum the three products: either of the two may be zero.
#[test]
fn an_edge_walked_the_other_way_never_has_the_same_sign() {
    let graph = extended().restricted(&EDGE_WATERTIGHT).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let mut differences = 0;
    common::for_random_programs(&graph, GENOMES, |program| {
        for _ in 0..40 {
            let [a, d, p, q, r, s] = [(); 6].map(|()| [(); 3].map(|()| coordinate(&mut rng)));
            let ray = match rng.random() {
                true => Ray { a, d, t_max: 1.0 },
                false => at_edge(&mut rng, a, p, q),
            };
            let values = [[p, q, r], [q, p, s]].map(|corners| {
                // The edge from p to q is another side of the triangle, seen from each vertex.
                [0, 1, 2].map(|turn| {
                    let [p0, p1, p2] = [0, 1, 2].map(|i| corners[(i + turn) % 3]);
                    let opposite = Side::ALL[(5 - turn) % 3];
                    let triangle = Triangle { p0, p1, p2 };
                    let volume = program.volume(opposite.volume(), &ray, &triangle);
                    volume.expect("a watertight program has all sides")
                })
            });
            let [ours, theirs] = values;
            for (ours, theirs) in ours
                .into_iter()
                .flat_map(|one| theirs.map(|other| (one, other)))
            {
                let same = ours > 0.0 && theirs > 0.0 || ours < 0.0 && theirs < 0.0;
                assert!(!same, "{ours:e}, {theirs:e}: {program:?}");
                differences += usize::from(ours != -theirs);
            }
        }
    });
    assert!(differences > GENOMES, "{differences}");
}

/// A ray at a point of an edge, but for rounding.
fn at_edge(rng: &mut ChaCha8Rng, a: [f32; 3], p: [f32; 3], q: [f32; 3]) -> Ray<f32> {
    let along: f32 = rng.random();
    let d = [0, 1, 2].map(|axis| p[axis] + along * (q[axis] - p[axis]) - a[axis]);
    Ray { a, d, t_max: 1.0 }
}

/// A number of any size, often one that others have too.
fn coordinate(rng: &mut ChaCha8Rng) -> f32 {
    match rng.random_range(0..4) {
        0 => rng.random_range(-2..=2) as f32,
        1 => rng.random_range(-1e3..1e3),
        _ => rng.random_range(-1.0..1.0),
    }
}

#[test]
fn without_the_rule_an_edge_walked_the_other_way_may_have_the_same_sign() {
    let graph = kensler_shirley();
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let mut same = 0;
    common::for_random_programs(&graph, GENOMES, |program| {
        let [a, p, q, r, s] = [(); 5].map(|()| [(); 3].map(|()| coordinate(&mut rng)));
        let ray = at_edge(&mut rng, a, p, q);
        let values = [[p, q, r], [q, p, s]]
            .map(|[p0, p1, p2]| program.volume(Volume::V2, &ray, &Triangle { p0, p1, p2 }));
        let both = |is: fn(f32) -> bool| values.iter().all(|value| value.is_some_and(is));
        same += usize::from(both(|value| value > 0.0) || both(|value| value < 0.0));
    });
    assert!(same > GENOMES / 20, "{same}");
}

#[test]
fn only_crosses_at_the_origin_are_left_of_the_faces_that_meet_there() {
    let graph = extended().restricted(&EDGE_WATERTIGHT).unwrap();
    let at_origin = |vector: Vector| {
        let edge = vector.edge();
        edge.is_some_and(|edge| edge.to == Point::A || edge.from == Point::A)
    };
    let sample = volumes::Sample::random(3);
    common::for_random_programs(&graph, GENOMES, |program| {
        let crosses = program.quantities().iter().filter_map(|one| match one {
            Quantity::Cross(cross) => Some(*cross),
            _ => None,
        });
        let (sides, others): (Vec<_>, Vec<_>) =
            crosses.partition(|cross| at_origin(cross.left) && at_origin(cross.right));
        assert_eq!(sides.len(), 3, "{program:?}");
        for cross in others {
            assert!(
                sides
                    .iter()
                    .all(|side| sample.cross(*side) != sample.cross(cross))
            );
        }
    });
}

#[test]
fn a_fully_watertight_program_maps_all_vertices_alike_and_takes_signs_from_exact_differences() {
    for fused in [false, true] {
        let rules = Rules {
            watertight: Watertight::Full,
            fused,
            ..Rules::ALL
        };
        let graph = watertight().restricted(&rules).unwrap();
        common::for_random_programs(&graph, GENOMES, |program| {
            assert_eq!(program.breaks(&rules), None);
            for statement in program.statements() {
                let name = statement.op.to_string();
                let mapped = name.starts_with("sheared.") && name.ends_with(".fused") != fused;
                assert!(!mapped && !name.starts_with("side"), "{name}");
                assert!(!(name.starts_with("difference.") && name.ends_with(".rounded")));
            }
        });
        for graph in [kensler_shirley(), extended()] {
            assert_eq!(graph.restricted(&rules), Err(Unsatisfiable));
        }
    }
}

/// Whatever triangle asks: the edge between two vertices has them on the two sides that they are on.
#[test]
fn what_is_said_of_an_edge_is_said_the_other_way_round_by_the_neighbour() {
    let rules = Rules {
        watertight: Watertight::Full,
        ..Rules::ALL
    };
    let graph = watertight().restricted(&rules).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(13);
    common::for_random_programs(&graph, GENOMES, |program| {
        let [a, d, p, q, r, s] = [(); 6].map(|()| [(); 3].map(|()| coordinate(&mut rng)));
        let ray = Ray { a, d, t_max: 1.0 };
        let [ours, theirs] = [[p, q, r], [q, p, s]].map(|[p0, p1, p2]| {
            let volume = program.volume(Volume::V2, &ray, &Triangle { p0, p1, p2 });
            volume.expect("a watertight program has all sides")
        });
        let sign = |value: f32| value.partial_cmp(&0.0);
        assert_eq!(sign(ours), sign(-theirs), "{ours} {theirs} {program:?}");
    });
}

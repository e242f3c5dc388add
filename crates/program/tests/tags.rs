//! Tags keep their promises to the interpreter, and agree with the rules and with what programs are.

use program::{
    CheckedIn, Degree, Genome, Op, ProductDifference, Program, Ray, Rules, Shear, Side, Statement,
    Tags, Triangle, Watertight,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use volumes::Point;

mod common;

const GENOMES: usize = 100;

/// Multiplies positions, directions or both.
const WEIGHTS: [Degree; 3] = [Degree::EVERYTHING, Degree::POSITIONS, Degree::DIRECTIONS];

const fn degree(positions: i32, directions: i32) -> Degree {
    Degree {
        positions,
        directions,
    }
}

fn is_of_segments(program: &Program) -> bool {
    let mut statements = program.statements().iter();
    statements.any(|statement| statement.op == Op::Load(Point::B))
}

/// The answer to a ray and a triangle times a power of two each, taken back, in bits.
fn scaled(
    program: &Program,
    ray: &Ray<f32>,
    triangle: &Triangle<f32>,
    exponents: Degree,
) -> Option<u32> {
    let power = |exponent: i32| 2f64.powi(exponent);
    let times = |number: f32, exponent: i32| (f64::from(number) * power(exponent)) as f32;
    let position = |point: [f32; 3]| point.map(|x| times(x, exponents.positions));
    let of_t = exponents.positions - exponents.directions;
    let ray = Ray {
        a: position(ray.a),
        d: ray.d.map(|x| times(x, exponents.directions)),
        t_max: times(ray.t_max, of_t),
    };
    let triangle = Triangle {
        p0: position(triangle.p0),
        p1: position(triangle.p1),
        p2: position(triangle.p2),
    };
    let t = program.run(&ray, &triangle)?;
    Some(times(t, -of_t).to_bits())
}

#[test]
fn at_either_end_of_the_safe_scales_answers_are_the_same_to_the_last_bit() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut hits = 0;
    for (name, graph) in common::graphs() {
        common::for_random_programs(&graph, GENOMES, |program| {
            let tags = program.tags(true);
            for weights in WEIGHTS {
                if is_of_segments(program) && weights != Degree::EVERYTHING {
                    continue;
                }
                let safe = tags.safe_scales(weights);
                for _ in 0..20 {
                    let (ray, triangle) = common::random_pair(&mut rng);
                    if common::reference(&ray, &triangle).is_none() {
                        continue;
                    }
                    let (ray, triangle) =
                        (common::narrow_ray(&ray), common::narrow_triangle(&triangle));
                    let at = |exponent: i32| {
                        let Degree {
                            positions,
                            directions,
                        } = weights;
                        let exponents = degree(exponent * positions, exponent * directions);
                        scaled(program, &ray, &triangle, exponents)
                    };
                    let expected = at(0);
                    for end in [*safe.start(), *safe.end()] {
                        assert_eq!(at(end), expected, "{name}, {weights:?}, {end}: {ray:?}");
                    }
                    hits += usize::from(expected.is_some());
                }
            }
        });
    }
    assert!(hits > 1000, "{hits}");
}

/// What there is to be promised of a formulation is in the degree of what it compares.
#[test]
fn sixth_powers_of_the_scale_go_half_as_far_as_third_ones() {
    let graph = CheckedIn::KenslerShirley.graph();
    let safe = |genome: Genome| {
        let tags = graph.program(&genome).unwrap().tags(false);
        tags.safe_scales(Degree::EVERYTHING)
    };
    assert_eq!(safe(program::appendix(&graph)), -16..=16);
    assert_eq!(safe(program::moller_trumbore_volumes(&graph)), -37..=37);
}

#[test]
fn what_the_rules_leave_of_a_graph_has_its_class() {
    for graph in CheckedIn::ALL {
        for watertight in [Watertight::Edges, Watertight::Full] {
            for fused in [false, true] {
                let rules = Rules {
                    watertight,
                    fused,
                    ..Rules::ORDINARY
                };
                let Ok(left) = graph.graph().restricted(&rules) else {
                    continue;
                };
                common::for_random_programs(&left, GENOMES, |program| {
                    let class = program.tags(true).watertight;
                    assert!(class >= watertight, "{}: {class:?}", graph.name());
                });
            }
        }
    }
}

#[test]
fn every_program_of_every_graph_is_translation_safe() {
    for (name, graph) in common::graphs() {
        common::for_random_programs(&graph, GENOMES, |program| {
            assert!(program.tags(true).translation_safe, "{name}: {program:?}");
        });
    }
}

/// Fused operations are what they are only where there are any.
#[test]
fn a_class_may_depend_on_what_the_instruction_set_fuses() {
    let rules = Rules {
        watertight: Watertight::Full,
        ..Rules::ORDINARY
    };
    let graph = CheckedIn::Watertight.graph().restricted(&rules).unwrap();
    let (mut kahan, mut wide) = (0, 0);
    common::for_random_programs(&graph, GENOMES, |program| {
        let uses_kahan = program.statements().iter().any(|statement| {
            matches!(
                statement.op,
                Op::Shear(Shear::Volume(_, ProductDifference::Kahan))
            )
        });
        let classes = [false, true].map(|fuses| program.tags(fuses).watertight);
        if uses_kahan {
            kahan += 1;
            assert_eq!(classes, [Watertight::Edges, Watertight::Full]);
        } else {
            wide += 1;
            assert_eq!(classes, [Watertight::Full; 2]);
        }
    });
    assert!(kahan > 0 && wide > 0);
}

/// Sound statement by statement, and nonsense: one side's volume is the paper's, those of the others are divided
/// by the direction's longest component.
#[test]
fn a_program_that_adds_volumes_of_two_kinds_has_no_safe_scale() {
    let rules = Rules {
        watertight: Watertight::Full,
        ..Rules::PORTABLE
    };
    let graph = CheckedIn::Watertight.graph().restricted(&rules).unwrap();
    let genome = Genome::identity(graph.nodes().len());
    let sheared = graph.program(&genome).unwrap();
    let tags = |statements: Vec<Statement>| Program::new(statements).unwrap().tags(false);
    let Tags { watertight, .. } = tags(sheared.statements().to_vec());
    assert_eq!(watertight, Watertight::Full);
    let mixed = tags(with_direct_v0(sheared.statements()));
    assert_eq!(mixed.watertight, Watertight::No);
    assert_eq!(mixed.safe_scales(Degree::EVERYTHING), 0..=0);
}

/// The statements with the first side's volume as a triple product.
fn with_direct_v0(statements: &[Statement]) -> Vec<Statement> {
    let volume = Side::S0.volume();
    let is_v0 = |one: &Statement| matches!(one.op, Op::Shear(Shear::Volume(Side::S0, _)));
    let place = statements.iter().position(is_v0).unwrap();
    let find = |name: &str| {
        let is = |one: &Statement| one.op.to_string() == name;
        statements.iter().position(is).unwrap() as u32
    };
    let edges: Vec<u32> = (0..statements.len() as u32)
        .filter(|&index| {
            let Statement { op, operands } = &statements[index as usize];
            *op == Op::Edge && operands[0] != find("load.p0")
        })
        .collect();
    for ends in [[edges[0], edges[1]], [edges[1], edges[0]]] {
        let mut mixed = statements.to_vec();
        let cross = Statement {
            op: Op::Cross,
            operands: ends.to_vec(),
        };
        mixed[place] = Statement {
            op: Op::Volume(volume, program::Summation::XyZ),
            operands: vec![place as u32, find("load.d")],
        };
        // The cross comes before it, and all that follows is one farther on.
        for statement in &mut mixed[place + 1..] {
            for operand in &mut statement.operands {
                *operand += u32::from(*operand >= place as u32);
            }
        }
        mixed.insert(place, cross);
        if Program::new(mixed.clone()).is_ok() {
            return mixed;
        }
    }
    panic!("one of the two is V0");
}

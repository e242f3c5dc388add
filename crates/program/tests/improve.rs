//! The step from GA to GA+, on the paper's programs and on random ones.

use std::num::NonZeroU16;

use program::{
    Difference, Genome, Graph, Op, Optimum, Program, Rules, Watertight, appendix, extended,
    kensler_shirley, moller_trumbore_volumes, watertight,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use volumes::{Case, Formulation, Model, cheapest};

const RAYS: NonZeroU16 = NonZeroU16::new(64).unwrap();

fn packet() -> Case {
    Case::packet(RAYS)
}

fn random_programs(graph: &Graph, count: usize) -> impl Iterator<Item = Program> {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    (0..count).map(move |_| {
        let genome = Genome::random(graph.nodes().len(), &mut rng);
        graph.program(&genome).unwrap()
    })
}

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(3)
}

#[test]
fn the_papers_ga_plus_is_recognised_as_optimal() {
    let graph = kensler_shirley();
    let program = graph.program(&appendix(&graph)).unwrap();
    let improvement = Optimum::new(packet(), Model::paper()).improve(&program, &Rules::ALL);
    assert_eq!(improvement.formulation, None);
    assert_eq!(improvement.clean, program);
}

#[test]
fn moller_and_trumbores_volumes_are_optimal_for_single_rays_and_not_for_packets() {
    let graph = kensler_shirley();
    let program = graph.program(&moller_trumbore_volumes(&graph)).unwrap();
    let improve = |case| Optimum::new(case, Model::paper()).improve(&program, &Rules::ALL);
    assert_eq!(improve(Case::SINGLE).formulation, None);
    let packet = improve(packet());
    let cheapest = cheapest(self::packet(), &Model::paper(), Formulation::WITH_V);
    assert!(cheapest.formulations.contains(&packet.formulation.unwrap()));
    // 41 + 6/64 for the four volumes become 32 + 15/64; and the first test joins no mask.
    let saved = packet.before.units - packet.after.units;
    assert_eq!(saved, 41 * 64 + 6 - (32 * 64 + 15) + 64);
}

#[test]
fn improved_programs_do_the_same_for_less() {
    let graph = kensler_shirley();
    for case in [packet(), Case::common_origin(RAYS), Case::SINGLE] {
        let optimum = Optimum::new(case, Model::paper());
        let mut rng = rng();
        for program in random_programs(&graph, 60) {
            let improvement = optimum.improve(&program, &Rules::ALL);
            assert!(improvement.after.units < improvement.before.units);
            for step in [
                &improvement.rewritten,
                &improvement.clean,
                &improvement.finished,
            ] {
                assert_eq!(program.equals(step, 40, &mut rng), Ok(()));
            }
            // There is nothing left to do.
            let again = optimum.improve(&improvement.finished, &Rules::ALL);
            assert_eq!(again.formulation, None);
            assert_eq!(again.finished, improvement.finished);
        }
    }
}

#[test]
fn what_is_watertight_stays_so_and_does_the_same_for_no_more() {
    let of_class = |watertight| Rules {
        watertight,
        squares: false,
        ..Rules::ALL
    };
    let classes = [
        (kensler_shirley(), of_class(Watertight::Edges)),
        (extended(), of_class(Watertight::Edges)),
        (watertight(), of_class(Watertight::Full)),
    ];
    let mut improved = 0;
    for (graph, rules) in classes {
        let graph = graph.restricted(&rules).unwrap();
        for case in [packet(), Case::common_origin(RAYS)] {
            let optimum = Optimum::new(case, Model::paper());
            let mut rng = rng();
            for program in random_programs(&graph, 30) {
                let improvement = optimum.improve(&program, &rules);
                improved += usize::from(improvement.formulation.is_some());
                assert!(improvement.after.units <= improvement.before.units);
                assert_eq!(improvement.finished.breaks(&rules), None);
                assert_eq!(program.equals(&improvement.finished, 40, &mut rng), Ok(()));
            }
        }
    }
    println!("{improved} of 180 have another formulation");
}

#[test]
fn improved_programs_have_the_cheapest_volumes() {
    let graph = kensler_shirley();
    let model = Model::paper();
    let best = [Formulation::WITH_V, Formulation::WITH_V0]
        .map(|volumes| cheapest(packet(), &model, volumes).cost.units)
        .into_iter()
        .min();
    let optimum = Optimum::new(packet(), model.clone());
    for program in random_programs(&graph, 60) {
        let finished = optimum.improve(&program, &Rules::ALL).finished;
        let derived = finished.formulas().len() as u32 - 4;
        let of_volumes = finished.cost_of_volumes(packet(), &model).units;
        // Two additions for a fifth volume, if the program wants one.
        assert_eq!(Some(of_volumes - derived * 2 * 64), best);
    }
}

#[test]
fn a_program_with_the_mask_begun_by_a_test_has_one_test_less_to_join() {
    let graph = kensler_shirley();
    for program in random_programs(&graph, 200) {
        let begun = program.beginning_with_first_test();
        assert_eq!(begun.statements().len(), program.statements().len() - 1);
        let model = Model::paper();
        let costs = [&program, &begun].map(|one| one.cost(Case::SINGLE, &model).units);
        assert_eq!(costs[0] - costs[1], 1);
        assert_eq!(program.equals(&begun, 40, &mut rng()), Ok(()));
        assert_eq!(begun.beginning_with_first_test(), begun);
        // A recipe that has it is read back.
        let text = serde_json::to_string(&begun).unwrap();
        assert_eq!(serde_json::from_str::<Program>(&text).unwrap(), begun);
    }
}

#[test]
fn a_mask_is_begun_once() {
    let graph = kensler_shirley();
    let program = graph.program(&appendix(&graph)).unwrap();
    let tests: Vec<usize> = (0..program.statements().len())
        .filter(|&index| program.statements()[index].op.is_test())
        .collect();
    for &test in &tests {
        let mut statements = program.statements().to_vec();
        statements[test].operands.remove(0);
        let error = Program::new(statements).unwrap_err().to_string();
        assert!(error.contains("which an earlier one has begun"), "{error}");
    }
    let begun = program.beginning_with_first_test();
    let mut statements = begun.statements().to_vec();
    statements.push(program.statements()[0].clone());
    let mask = program.statements().iter().find(|one| one.op == Op::Mask);
    let last = statements.len() - 1;
    statements[last] = mask.unwrap().clone();
    let error = Program::new(statements).unwrap_err().to_string();
    assert!(error.contains("which an earlier one has begun"), "{error}");
}

#[test]
fn programs_that_test_otherwise_are_told_apart() {
    let graph = kensler_shirley();
    let programs: Vec<Program> = random_programs(&graph, 40).collect();
    let mut told = 0;
    for pair in programs.windows(2) {
        match pair[0].equals(&pair[1], 10, &mut rng()) {
            Err(Difference::Tests(line)) => {
                assert!(!line.is_empty());
                told += 1;
            }
            Ok(()) => {}
            Err(other) => panic!("{other}"),
        }
    }
    assert!(told > 30, "{told}");
}

#[test]
fn exact_answers_are_those_of_f64_on_inputs_without_ties() {
    use program::{Exact, Ray, Triangle};
    use rand::RngExt;
    let graph = kensler_shirley();
    let mut rng = rng();
    for program in random_programs(&graph, 100) {
        let points: [[i32; 3]; 5] =
            std::array::from_fn(|_| std::array::from_fn(|_| rng.random_range(-1000..=1000)));
        let [a, d, p0, p1, p2] = points.map(|point| point.map(Exact::whole));
        let t_max = Exact::whole(2);
        let exact = program.run(&Ray { a, d, t_max }, &Triangle { p0, p1, p2 });
        let [a, d, p0, p1, p2] = points.map(|point| point.map(f64::from));
        let floating = program.run(&Ray { a, d, t_max: 2.0 }, &Triangle { p0, p1, p2 });
        assert_eq!(exact.is_some(), floating.is_some());
    }
}

#[test]
fn a_program_without_estimates_answers_the_same_in_exact_arithmetic() {
    use program::{Exact, Ray, Triangle};
    use rand::RngExt;
    let graph = kensler_shirley();
    let mut rng = rng();
    let mut estimated = 0;
    for program in random_programs(&graph, 300) {
        let exact = program.without_estimates();
        assert!(exact.is_portable());
        assert_eq!(exact.without_estimates(), exact);
        estimated += usize::from(!program.is_portable());
        if program.is_portable() {
            assert_eq!(exact, program);
        }
        let points: [[i32; 3]; 5] =
            std::array::from_fn(|_| std::array::from_fn(|_| rng.random_range(-20..=20)));
        let [a, d, p0, p1, p2] = points.map(|point| point.map(Exact::whole));
        let t_max = Exact::whole(2);
        let (ray, triangle) = (Ray { a, d, t_max }, Triangle { p0, p1, p2 });
        assert_eq!(exact.run(&ray, &triangle), program.run(&ray, &triangle));
    }
    assert!(estimated > 50, "{estimated}");
}

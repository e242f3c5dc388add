//! The operators that know the graph: always a permutation, always a legal program, and what each one changes.

use std::sync::LazyLock;

use evolve::{flip, graft, slide};
use program::{Decided, Genome, Graph, NodeId, Op, Program, extended, kensler_shirley, watertight};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

static GRAPHS: LazyLock<[Graph; 3]> =
    LazyLock::new(|| [kensler_shirley(), extended(), watertight()]);

/// Calls `check` with random genomes of every graph, and the program that each picks.
fn for_many(seed: u64, mut check: impl FnMut(&Graph, &Genome, &Program, &mut ChaCha8Rng)) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    for graph in &*GRAPHS {
        for _ in 0..300 {
            let genome = Genome::random(graph.nodes().len(), &mut rng);
            let program = graph.program(&genome).unwrap();
            check(graph, &genome, &program, &mut rng);
        }
    }
}

fn ops(program: &Program) -> Vec<Op> {
    let mut ops: Vec<Op> = program.statements().iter().map(|one| one.op).collect();
    ops.sort_unstable();
    ops
}

#[test]
fn whatever_an_operator_gives_is_a_permutation_that_picks_a_legal_program() {
    for_many(1, |graph, genome, program, rng| {
        let other = Genome::random(genome.len(), rng);
        let made = [
            flip(graph, genome, rng),
            slide(graph, genome, program, rng),
            graft(graph, genome, &other, rng),
        ];
        for genome in made.into_iter().flatten() {
            assert!(Genome::try_from(genome.priorities().to_vec()).is_ok());
            let program = graph.program(&genome).unwrap();
            assert!(Program::new(program.statements().to_vec()).is_ok());
        }
    });
}

#[test]
fn a_flip_exchanges_two_options_of_one_live_choice() {
    let (mut flipped, mut changed) = (0, 0);
    for_many(2, |graph, genome, program, rng| {
        let Some(mutant) = flip(graph, genome, rng) else {
            return;
        };
        flipped += 1;
        let pairs = genome.priorities().iter().zip(mutant.priorities());
        let moved: Vec<NodeId> = (pairs.enumerate())
            .filter(|(_, (before, after))| before != after)
            .map(|(node, _)| NodeId::from_index(node))
            .collect();
        let of_one_choice = |decided: &Decided| {
            let options = &graph.node(decided.choice).optional;
            moved.contains(&decided.option) && moved.iter().all(|node| options.contains(node))
        };
        assert_eq!(moved.len(), 2);
        assert!(graph.choices(genome).iter().any(of_one_choice));
        changed += usize::from(graph.program(&mutant).unwrap() != *program);
    });
    assert!(changed * 2 > flipped, "{changed} of {flipped}");
}

#[test]
fn a_slide_moves_one_statement_and_keeps_them_all() {
    let mut moved = 0;
    for_many(3, |graph, genome, program, rng| {
        let Some(mutant) = slide(graph, genome, program, rng) else {
            return;
        };
        moved += 1;
        let [before, after] = [genome, &mutant].map(|genome| graph.statements(genome));
        assert_ne!(before, after);
        let is_moved = |&from: &usize| {
            let (mut a, mut b) = (before.clone(), after.clone());
            let statement = a.remove(from);
            b.retain(|&id| id != statement);
            a == b
        };
        assert!((0..before.len()).any(|from| is_moved(&from)));
        assert_eq!(ops(&graph.program(&mutant).unwrap()), ops(program));
    });
    assert!(moved > 300, "{moved}");
}

#[test]
fn a_graft_brings_a_choice_as_the_other_has_made_it() {
    for_many(4, |graph, genome, _, rng| {
        let other = Genome::random(genome.len(), rng);
        let child = graft(graph, genome, &other, rng).unwrap();
        let theirs = graph.choices(&other);
        let brought = |decided: &Decided| theirs.contains(decided);
        assert!(graph.choices(&child).iter().any(brought));
    });
}

#[test]
fn a_genome_grafted_upon_itself_stays_the_program_that_it_is() {
    let mut same = 0;
    for_many(5, |graph, genome, program, rng| {
        let child = graft(graph, genome, genome, rng).unwrap();
        same += usize::from(ops(&graph.program(&child).unwrap()) == ops(program));
    });
    // Of two live options of a choice the walk may come to another first.
    assert!(same > 600, "{same}");
}

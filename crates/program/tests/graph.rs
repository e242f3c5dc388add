//! The graph of 1294 nodes: its size, and that none of it is padding.

use program::{COUNT, Genome, Graph, Op, family_table, kensler_shirley};

mod common;

#[test]
fn has_exactly_1294_nodes() {
    assert_eq!(kensler_shirley().nodes().len(), COUNT);
}

#[test]
fn is_made_up_of_the_families_of_its_table() {
    expect_test::expect![[r#"
        | family                                                                          | nodes |
        |---------------------------------------------------------------------------------|------:|
        | loads of p0, p1, p2, a, d and t_max; 0 and 1; the mask                          |     9 |
        | directed edges between a, p0, p1, p2                                            |    12 |
        | crosses: 120 of two edges, 24 of an edge and d                                  |   144 |
        | triple products of V, V0, V1, V2: 36 each, summed in two orders                 |   288 |
        | triple products of Va: 384, summed in two orders                                |   768 |
        | choices: which triple product a volume is                                       |     5 |
        | V = V0 + V1 + V2; V0, V1, V2 as what V leaves of the others; V1 + V2            |     5 |
        | choices: V, V0, V1, V2 direct or derived                                        |     4 |
        | 1/V exact, and by estimate and Newton step; t and α, β, γ each in two ways      |    10 |
        | choices: which way to 1/V, t, α, β, γ                                           |     5 |
        | V² and Va·V, for tests before the division                                      |     2 |
        | tests: 3 near, 2 far; 4, 3 and 3 for the sides; 2 of same signs                 |    17 |
        | choices: which near, far, side and same-sign test; which strategy               |     9 |
        | early exits: after near, far, each side, same signs                             |     6 |
        | choices: exit or not                                                            |     6 |
        | tests that go together: near and far on t, before the division; the three sides |     3 |
        | the store, which is the goal                                                    |     1 |
        | all nodes                                                                       |  1294 |
    "#]]
    .assert_eq(&family_table(&kensler_shirley()));
}

#[test]
fn reads_back_from_its_json() {
    let graph = kensler_shirley();
    assert_eq!(Graph::from_json(&graph.to_json()).unwrap(), graph);
}

#[test]
fn every_node_is_reachable_from_the_goal() {
    assert_eq!(common::reachable(&kensler_shirley()).len(), COUNT);
}

#[test]
fn every_node_is_live_for_some_genome() {
    let graph = kensler_shirley();
    for node in graph.nodes() {
        let live = |genome: &Genome| graph.live(genome).contains(&node.id);
        assert!(
            common::genomes_towards(&graph, node.id).any(|genome| live(&genome)),
            "{} is never live",
            node.name
        );
    }
}

#[test]
fn every_option_of_every_choice_can_win_it() {
    let graph = kensler_shirley();
    for node in graph.nodes().iter().filter(|node| node.op == Op::Choice) {
        for &option in &node.optional {
            let wins = |genome: &Genome| {
                let live = graph.live(genome);
                let others = node.optional.iter().filter(|&&other| other != option);
                live.contains(&node.id)
                    && live.contains(&option)
                    && others.into_iter().all(|other| {
                        // A test is live inside its own exit; the exit has then won.
                        !live.contains(other) || graph.node(option).required.contains(other)
                    })
            };
            assert!(
                common::genomes_towards(&graph, option).any(|genome| wins(&genome)),
                "{} never wins {}",
                graph.node(option).name,
                node.name
            );
        }
    }
}

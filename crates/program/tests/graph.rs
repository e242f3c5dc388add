//! The graphs: their sizes, and that none of them is padded.

use program::{
    COUNT, Genome, Graph, Node, NodeId, Op, extended, family_table, kensler_shirley, segment,
};

mod common;

#[test]
fn kensler_and_shirleys_graph_has_exactly_1294_nodes() {
    assert_eq!(kensler_shirley().nodes().len(), COUNT);
}

#[test]
fn graphs_are_made_up_of_the_families_of_their_tables() {
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
    expect_test::expect![[r#"
        | family                                                                          | nodes |
        |---------------------------------------------------------------------------------|------:|
        | loads of p0, p1, p2, a, d and t_max; 0 and 1; the mask                          |     9 |
        | directed edges between a, p0, p1, p2                                            |    12 |
        | crosses: 120 of two edges, 24 of an edge and d                                  |   144 |
        | the same crosses, fused                                                         |   144 |
        | choices: which of the two a cross is                                            |   144 |
        | triple products of V, V0, V1, V2: 36 each, summed in two orders                 |   288 |
        | triple products of V, V0, V1, V2, fused, in two orders                          |   288 |
        | triple products of Va: 384, summed in two orders                                |   768 |
        | triple products of Va, fused, in two orders                                     |   768 |
        | choices: which triple product a volume is                                       |     5 |
        | V = V0 + V1 + V2; V0, V1, V2 as what V leaves of the others; V1 + V2            |     5 |
        | choices: V, V0, V1, V2 direct or derived                                        |     4 |
        | 1/V exact, and by estimate and Newton step; t and α, β, γ each in two ways      |    10 |
        | 1/V by estimate and fused Newton step                                           |     1 |
        | choices: which way to 1/V, t, α, β, γ                                           |     5 |
        | V² and Va·V, for tests before the division                                      |     2 |
        | tests: 3 near, 2 far; 4, 3 and 3 for the sides; 2 of same signs                 |    17 |
        | choices: which near, far, side and same-sign test; which strategy               |    10 |
        | early exits: after near, far, each side, same signs                             |     6 |
        | choices: exit or not                                                            |     6 |
        | tests that go together: near and far on t, before the division; the three sides |     4 |
        | the store, which is the goal                                                    |     1 |
        | all nodes                                                                       |  2641 |
    "#]]
    .assert_eq(&family_table(&extended()));
    expect_test::expect![[r#"
        | family                                                                          | nodes |
        |---------------------------------------------------------------------------------|------:|
        | loads of p0, p1, p2, a, d and t_max; 0 and 1; the mask                          |     9 |
        | load of b, the other end of a segment                                           |     1 |
        | directed edges between a, p0, p1, p2                                            |    12 |
        | directed edges between b and p0, p1, p2                                         |     6 |
        | crosses: 120 of two edges, 24 of an edge and d                                  |   144 |
        | the same crosses, fused                                                         |   144 |
        | choices: which of the two a cross is                                            |   144 |
        | triple products of V, V0, V1, V2: 36 each, summed in two orders                 |   288 |
        | triple products of V, V0, V1, V2, fused, in two orders                          |   288 |
        | triple products of Va: 384, summed in two orders                                |   768 |
        | triple products of Va, fused, in two orders                                     |   768 |
        | triple products of Vb: 72, summed in two orders                                 |   144 |
        | triple products of Vb, fused, in two orders                                     |   144 |
        | choices: which triple product a volume is                                       |     6 |
        | V = V0 + V1 + V2; V0, V1, V2 as what V leaves of the others; V1 + V2            |     5 |
        | V = Va - Vb                                                                     |     1 |
        | choices: V, V0, V1, V2 direct or derived                                        |     5 |
        | 1/V exact, and by estimate and Newton step; t and α, β, γ each in two ways      |    10 |
        | 1/V by estimate and fused Newton step                                           |     1 |
        | choices: which way to 1/V, t, α, β, γ                                           |     5 |
        | V² and Va·V, for tests before the division                                      |     2 |
        | tests: 3 near, 2 far; 4, 3 and 3 for the sides; 2 of same signs                 |    17 |
        | test: a and b not on one side of the triangle's plane                           |     1 |
        | choices: which near, far, side and same-sign test; which strategy               |    13 |
        | early exits: after near, far, each side, same signs                             |     7 |
        | choices: exit or not                                                            |     7 |
        | tests that go together: near and far on t, before the division; the three sides |     7 |
        | the store, which is the goal                                                    |     1 |
        | all nodes                                                                       |  2948 |
    "#]]
    .assert_eq(&family_table(&segment()));
}

#[test]
fn reads_back_from_its_json() {
    for (name, graph) in common::graphs() {
        assert_eq!(Graph::from_json(&graph.to_json()).unwrap(), graph, "{name}");
    }
}

#[test]
fn every_node_is_reachable_from_the_goal() {
    for (name, graph) in common::graphs() {
        assert_eq!(
            common::reachable(&graph).len(),
            graph.nodes().len(),
            "{name}"
        );
    }
}

#[test]
fn every_node_is_live_for_some_genome() {
    for (name, graph) in common::graphs() {
        for node in graph.nodes() {
            let live = |genome: &Genome| graph.live(genome).contains(&node.id);
            assert!(
                common::genomes_towards(&graph, node.id).any(|genome| live(&genome)),
                "{name}: {} is never live",
                node.name
            );
        }
    }
}

#[test]
fn every_option_of_every_choice_can_win_it() {
    for (name, graph) in common::graphs() {
        for node in graph.nodes().iter().filter(|node| node.op == Op::Choice) {
            for &option in &node.optional {
                assert!(
                    common::genomes_towards(&graph, option)
                        .any(|genome| wins(&graph, node, option, &genome)),
                    "{name}: {} never wins {}",
                    graph.node(option).name,
                    node.name
                );
            }
        }
    }
}

/// Whether a choice is live and resolves to this option.
fn wins(graph: &Graph, choice: &Node, option: NodeId, genome: &Genome) -> bool {
    let live = graph.live(genome);
    let others = choice.optional.iter().filter(|&&other| other != option);
    live.contains(&choice.id)
        && live.contains(&option)
        && others.into_iter().all(|other| {
            // A test is live inside its own exit; the exit has then won.
            !live.contains(other) || graph.node(option).required.contains(other)
        })
}

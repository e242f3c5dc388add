//! The graph of 1294 nodes: its size, and that none of it is padding.

use std::collections::BTreeSet;

use program::{COUNT, Genome, Graph, NodeId, Op, family_table, kensler_shirley};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

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
    let graph = kensler_shirley();
    let mut reached = BTreeSet::from([graph.goal()]);
    let mut frontier = vec![graph.goal()];
    while let Some(id) = frontier.pop() {
        let node = graph.node(id);
        for &next in node.required.iter().chain(&node.optional) {
            if reached.insert(next) {
                frontier.push(next);
            }
        }
    }
    assert_eq!(reached.len(), COUNT);
}

#[test]
fn every_node_is_live_for_some_genome() {
    let graph = kensler_shirley();
    for node in graph.nodes() {
        let live = |genome: &Genome| graph.live(genome).contains(&node.id);
        assert!(
            genomes_towards(&graph, node.id).any(|genome| live(&genome)),
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
                genomes_towards(&graph, option).any(|genome| wins(&genome)),
                "{} never wins {}",
                graph.node(option).name,
                node.name
            );
        }
    }
}

/// Random genomes that prefer every node on a path from the goal to `target`.
fn genomes_towards(graph: &Graph, target: NodeId) -> impl Iterator<Item = Genome> {
    let path = path_to(graph, target);
    let mut rng = ChaCha8Rng::seed_from_u64(target.index() as u64);
    (0..200).map(move |_| Genome::random(COUNT, &mut rng).preferring(&path))
}

/// A shortest path from the goal to `target`, target first.
fn path_to(graph: &Graph, target: NodeId) -> Vec<NodeId> {
    let mut from = vec![None; graph.nodes().len()];
    let mut queue = std::collections::VecDeque::from([graph.goal()]);
    while let Some(id) = queue.pop_front() {
        let node = graph.node(id);
        for &next in node.required.iter().chain(&node.optional) {
            if from[next.index()].is_none() && next != graph.goal() {
                from[next.index()] = Some(id);
                queue.push_back(next);
            }
        }
    }
    let mut path = vec![target];
    while let Some(previous) = from[path[path.len() - 1].index()] {
        path.push(previous);
    }
    path
}

//! A graph file is data that nobody trusts: whatever is wrong with it is an error of one
//! sentence, never a panic.

use std::sync::LazyLock;

use program::{Graph, GraphError, MAX_DEPTH, MAX_NODES, Node, NodeId, Op, kensler_shirley};
use serde_json::{Value, json};

static GRAPH: LazyLock<Graph> = LazyLock::new(kensler_shirley);

#[test]
fn a_graph_cut_off_anywhere_is_refused() {
    let text = GRAPH.to_json();
    let end = text.trim_end().len();
    for cut in (0..end).step_by(997).chain(end - 50..end) {
        assert!(matches!(refused(&text[..cut]), GraphError::Json(_)));
    }
}

#[test]
fn a_graph_with_two_ways_to_one_value_makes_no_program_with_both() {
    let mut nodes = GRAPH.nodes().to_vec();
    let again = NodeId::from_index(nodes.len());
    let load = Node {
        id: again,
        name: "p0.again".into(),
        ..nodes[0].clone()
    };
    nodes.push(load);
    for node in &mut nodes {
        if node.name == "edge.p0-p2" {
            node.required[0] = again;
        }
    }
    let graph = Graph::new(GRAPH.goal(), nodes).unwrap();
    let genome = program::appendix(&graph);
    let refused = graph.program(&genome);
    assert!(matches!(refused, Err(program::ProgramError::Duplicate(_))));
}

#[test]
fn json_of_anything_else_is_refused() {
    for text in ["null", "7", "\"graph\"", "[]", "{}", "{\"goal\":0}", "\0"] {
        assert!(matches!(refused(text), GraphError::Json(_)), "{text}");
    }
    for pointer in ["/goal", "/nodes", "/nodes/0", "/nodes/0/required"] {
        for wrong in [json!(null), json!(true), json!(-1), json!(1.5), json!("x")] {
            let error = broken(|file| *file.pointer_mut(pointer).unwrap() = wrong);
            assert!(matches!(error, GraphError::Json(_)), "{pointer}");
        }
    }
    for field in ["id", "name", "op"] {
        for wrong in [json!(null), json!([]), json!({"x": 1}), json!(-1)] {
            let error = broken(|file| file["nodes"][9][field] = wrong);
            assert!(matches!(error, GraphError::Json(_)), "{field}");
        }
    }
    let beyond_32_bits = json!(1u64 << 32);
    for wrong in [
        json!("0"),
        json!([0]),
        json!(-1),
        json!(0.5),
        beyond_32_bits,
    ] {
        let error = broken(|file| file["nodes"][9]["required"][0] = wrong);
        assert!(matches!(error, GraphError::Json(_)));
    }
}

#[test]
fn a_field_too_few_or_too_many_is_refused() {
    for field in ["id", "name", "op", "required", "optional"] {
        let error = broken(|file| drop(file["nodes"][3].as_object_mut().unwrap().remove(field)));
        assert!(error.to_string().contains("missing field"), "{error}");
    }
    for name in ["comment", "required\nx", "\u{1b}[2J"] {
        let error = broken(|file| file["nodes"][3][name] = json!("x"));
        assert!(error.to_string().contains("unknown field"), "{error}");
        let error = broken(|file| file[name] = json!("x"));
        assert!(error.to_string().contains("unknown field"), "{error}");
    }
}

#[test]
fn an_operation_that_there_is_not_is_refused() {
    for op in ["", "Edge", "edge ", "volume.v3.xy_z", "goto\nx", "edge;"] {
        let error = broken(|file| file["nodes"][9]["op"] = json!(op));
        assert!(error.to_string().contains("unknown operation"), "{error}");
    }
}

#[test]
fn ten_thousand_levels_of_json_are_refused() {
    let deep = |open: &str, close: &str| open.repeat(10_000) + &close.repeat(10_000);
    for nested in [deep("[", "]"), deep("{\"nodes\":", "}")] {
        refused(&nested);
        refused(&format!("{{\"goal\":0,\"nodes\":{nested}}}"));
        refused(&format!("{{\"goal\":0,\"nodes\":[{{\"op\":{nested}}}]}}"));
        refused(&format!("{{\"x\":{nested},\"goal\":0,\"nodes\":[]}}"));
    }
}

#[test]
fn a_dependency_on_a_node_that_is_not_there_is_refused() {
    for beyond in [1294, u32::MAX] {
        let error = with(|nodes| at(nodes, "near.exit").required = vec![id(beyond)]);
        let to = beyond as usize;
        assert!(matches!(error, GraphError::Dangling(_, node) if node == to));
        let error = with(|nodes| at(nodes, "reciprocal").optional.push(id(beyond)));
        assert!(matches!(error, GraphError::Dangling(_, node) if node == to));
    }
}

#[test]
fn nodes_that_need_each_other_are_refused() {
    for (node, needs) in [
        ("near.exit", "near.exit"),
        ("edge.p1-p0", "store"),
        ("v0.rest", "v0"),
    ] {
        let error = with(|nodes| {
            let needs = at(nodes, needs).id;
            at(nodes, node).required[0] = needs;
        });
        assert!(matches!(error, GraphError::Cycle(_)), "{node}: {error}");
    }
    let error = with(|nodes| {
        let v = at(nodes, "v").id;
        at(nodes, "v.direct").optional.push(v);
    });
    assert!(matches!(error, GraphError::Cycle(_)));
}

#[test]
fn names_that_are_paths_or_taken_or_not_plain_are_refused() {
    let long = "x".repeat(101);
    for name in [
        "", "../../x", "a/b", "a..b", "Store", "a b", "a\nb", "é", "p0", &long,
    ] {
        let error = with(|nodes| at(nodes, "store").name = name.into());
        assert!(
            matches!(error, GraphError::Name(1293)),
            "{name:?}: {error:?}"
        );
    }
}

#[test]
fn ids_out_of_order_are_refused() {
    let changes: [fn(&mut Vec<Node>); 3] = [
        |nodes| nodes.swap(7, 8),
        |nodes| drop(nodes.remove(7)),
        |nodes| nodes[7].id = id(u32::MAX),
    ];
    for change in changes {
        assert!(matches!(with(change), GraphError::Misplaced(7)));
    }
}

#[test]
fn a_choice_has_options_only_and_everything_else_operands_only() {
    for name in ["store", "p0", "edge.p1-p0", "inside.sides", "v.direct"] {
        let error = with(|nodes| {
            let node = at(nodes, name);
            std::mem::swap(&mut node.required, &mut node.optional);
            node.required.push(id(0));
            node.optional.push(id(0));
        });
        assert!(
            matches!(error, GraphError::Dependencies(_)),
            "{name}: {error:?}"
        );
    }
}

#[test]
fn a_choice_has_two_options_and_of_one_quantity() {
    for count in [0, 1] {
        let error = with(|nodes| at(nodes, "reciprocal").optional.truncate(count));
        assert!(error.to_string().contains("at least two options"));
    }
    let error = with(|nodes| {
        let one = at(nodes, "one").id;
        at(nodes, "reciprocal").optional.push(one);
    });
    assert!(error.to_string().contains("is one, which does not fit"));
}

#[test]
fn an_edge_or_a_cross_the_wrong_way_round_is_a_volume_of_the_wrong_sign() {
    for op in [Op::Edge, Op::Cross] {
        for node in GRAPH.nodes().iter().filter(|n| n.op == op) {
            let error = with(|nodes| nodes[node.id.index()].required.reverse());
            assert!(error.to_string().contains("or its negative"), "{error}");
        }
    }
}

#[test]
fn an_operand_too_few_or_too_many_is_refused() {
    let takes_some = |node: &&Node| !node.required.is_empty();
    for node in GRAPH.nodes().iter().filter(takes_some) {
        let too_few = node.required.len() - 1;
        let error = with(|nodes| nodes[node.id.index()].required.truncate(too_few));
        assert!(matches!(error, GraphError::Misfit { .. }), "{}", node.name);
        let error = with(|nodes| nodes[node.id.index()].required.push(id(0)));
        assert!(matches!(error, GraphError::Misfit { .. }), "{}", node.name);
    }
}

#[test]
fn no_exit_follows_a_group_of_tests_for_it_has_no_single_mask() {
    for group in ["inside.sides", "inside"] {
        let error = with(|nodes| {
            let group = at(nodes, group).id;
            let next = id(nodes.len() as u32);
            nodes.push(exit(next, group));
        });
        assert!(matches!(error, GraphError::Group(1294)), "{group}: {error}");
    }
}

#[test]
fn the_goal_stores() {
    for goal in [0, 1292, 1294, u32::MAX] {
        let error = broken(|file| file["goal"] = json!(goal));
        assert!(matches!(error, GraphError::Goal), "{goal}");
    }
    let empty = refused("{\"goal\":0,\"nodes\":[]}");
    assert!(matches!(empty, GraphError::Goal));
}

#[test]
fn too_many_nodes_and_too_long_a_chain_are_refused() {
    let node = serde_json::to_string(&GRAPH.nodes()[0]).unwrap();
    let nodes = vec![node; MAX_NODES + 1].join(",");
    let error = refused(&format!("{{\"goal\":0,\"nodes\":[{nodes}]}}"));
    assert!(matches!(error, GraphError::TooManyNodes(count) if count == MAX_NODES + 1));

    let error = with(|nodes| {
        for index in nodes.len()..nodes.len() + MAX_DEPTH {
            let before = match index {
                1294 => at(nodes, "near").id,
                _ => id(index as u32 - 1),
            };
            nodes.push(exit(id(index as u32), before));
        }
    });
    assert!(matches!(error, GraphError::TooDeep(_)));
}

/// What is wrong with `text`, in one sentence.
fn refused(text: &str) -> GraphError {
    let error = Graph::from_json(text).map(drop).unwrap_err();
    let sentence = error.to_string();
    assert!(!sentence.contains(char::is_control), "{sentence:?}");
    assert!((10..400).contains(&sentence.len()), "{sentence:?}");
    error
}

/// What is wrong with the graph's file once it is changed.
fn broken(change: impl FnOnce(&mut Value)) -> GraphError {
    let mut file = serde_json::from_str(&GRAPH.to_json()).unwrap();
    change(&mut file);
    refused(&file.to_string())
}

/// What is wrong with the graph once its nodes are changed.
fn with(change: impl FnOnce(&mut Vec<Node>)) -> GraphError {
    let mut nodes = GRAPH.nodes().to_vec();
    change(&mut nodes);
    let error = Graph::new(GRAPH.goal(), nodes).map(drop).unwrap_err();
    assert!(!error.to_string().contains(char::is_control), "{error}");
    error
}

fn at<'a>(nodes: &'a mut [Node], name: &str) -> &'a mut Node {
    let node = nodes.iter_mut().find(|node| node.name == name);
    node.unwrap_or_else(|| panic!("the graph has no node {name:?}"))
}

fn id(index: u32) -> NodeId {
    NodeId::from_index(index as usize)
}

fn exit(id: NodeId, of: NodeId) -> Node {
    Node {
        id,
        name: format!("exit.{}", id.index()),
        op: Op::Exit,
        required: vec![of],
        optional: vec![],
    }
}

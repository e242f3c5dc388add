//! A program from a file is data that nobody trusts: whatever is wrong with it is an error of
//! one sentence, never a panic.

use program::{Op, Program, Rules, appendix, kensler_shirley};
use serde_json::{Value, json};

/// Places in the appendix's program; `programs.rs` prints all of it.
const FIRST_EDGE: usize = 2;
const T: usize = 14;
const FAR: u32 = 16;
const NEAR: u32 = 17;
const NEAR_EXIT: u32 = 18;
const STORE: usize = 31;

#[test]
fn the_programs_own_json_is_read_back() {
    let program = original();
    let text = serde_json::to_string(&program).unwrap();
    assert_eq!(serde_json::from_str::<Program>(&text).unwrap(), program);
}

#[test]
fn a_program_cut_off_anywhere_is_refused() {
    let text = serde_json::to_string(&original()).unwrap();
    for cut in 0..text.len() {
        refused(&text[..cut]);
    }
}

#[test]
fn json_of_anything_else_is_refused() {
    for text in ["null", "7", "\"program\"", "{}", "[[]]", "[{}]", "[null]"] {
        refused(text);
    }
    for wrong in [json!(null), json!(-1), json!(0.5), json!("0"), json!([0])] {
        broken(|statements| statements[FIRST_EDGE]["operands"][0] = wrong);
    }
    let error = broken(|statements| statements[0]["comment"] = json!("x"));
    assert!(error.contains("unknown field"), "{error}");
    let error = broken(|statements| statements[0]["op"] = json!("asm!(\"ud2\")\n"));
    assert!(error.contains("unknown operation"), "{error}");
    let deep = "[".repeat(10_000) + &"]".repeat(10_000);
    refused(&deep);
    refused(&format!("[{{\"op\":\"edge\",\"operands\":{deep}}}]"));
}

#[test]
fn an_operand_comes_before_its_statement() {
    for operand in [FIRST_EDGE, STORE, 32, u32::MAX as usize] {
        let error = broken(|statements| statements[FIRST_EDGE]["operands"][1] = json!(operand));
        assert!(
            error.contains("statement 2 works on one that does not come before it"),
            "{error}"
        );
    }
}

#[test]
fn choices_and_groups_are_only_for_graphs() {
    for op in ["choice", "all"] {
        for operands in [json!([]), json!([NEAR]), json!([27, 23, 30])] {
            let error = broken(|statements| {
                statements.insert(STORE, json!({"op": op, "operands": operands}));
            });
            let expected = format!("statement 31 is a {op}, which only a graph has");
            assert!(error.contains(&expected), "{error}");
        }
    }
}

#[test]
fn nothing_is_computed_twice_but_an_exit() {
    for place in (0..STORE).filter(|&place| original().statements()[place].op != Op::Exit) {
        let error = broken(|statements| {
            let again = statements[place].clone();
            statements.insert(STORE, again);
        });
        assert!(
            error.contains("statement 31 computes again"),
            "{place}: {error}"
        );
    }
}

#[test]
fn a_hit_needs_a_near_test_a_far_test_and_a_test_of_every_side() {
    let tests = original().statements()[STORE].operands[2..].to_vec();
    assert_eq!(tests, [NEAR, FAR, NEAR_EXIT, 27, 23, 30]);
    for condition in [
        vec![NEAR, NEAR_EXIT],
        vec![FAR],
        vec![27],
        vec![23],
        vec![30],
    ] {
        let error = broken(|statements| {
            let operands = statements[STORE]["operands"].as_array_mut().unwrap();
            operands.retain(|operand| !condition.iter().any(|test| *operand == json!(test)));
        });
        assert!(
            error.contains("a hit needs a near test, a far test"),
            "{error}"
        );
    }
    let error = broken(|statements| statements[STORE]["operands"][2] = json!(T));
    assert!(
        error.contains("operand 2 of store is t, which does not fit"),
        "{error}"
    );
}

/// It is for scenes whose volumes are finite, and sound in itself; the rules of others refuse it.
#[test]
fn a_near_test_before_the_division_with_a_far_test_after_it_is_for_finite_volumes() {
    let (mask, zero, v, va) = (15, 6, 10, 13);
    let mut file = serde_json::to_value(original()).unwrap();
    file[NEAR as usize] = json!({"op": "near.signs", "operands": [mask, zero, va, v]});
    let program: Program = serde_json::from_value(file).unwrap();
    assert_eq!(program.breaks(&Rules::ALL), None);
    let breach = program.breaks(&Rules::ORDINARY).unwrap();
    assert_eq!(breach.op, Op::Store);
}

#[test]
fn an_edge_or_a_cross_the_wrong_way_round_is_a_volume_of_the_wrong_sign() {
    for (place, statement) in original().statements().iter().enumerate() {
        if matches!(statement.op, Op::Edge | Op::Cross) {
            let error = broken(|statements| {
                let operands = &mut statements[place]["operands"];
                operands.as_array_mut().unwrap().reverse();
            });
            assert!(error.contains("or its negative"), "{place}: {error}");
        }
    }
}

#[test]
fn an_operand_too_few_or_too_many_is_refused() {
    for place in 0..STORE {
        let operands = |statements: &mut Vec<Value>, change: fn(&mut Vec<Value>)| {
            change(statements[place]["operands"].as_array_mut().unwrap());
        };
        let error = broken(|statements| operands(statements, |o| o.insert(0, json!(0))));
        assert!(
            error.contains("operands, not") || error.contains("does not come before"),
            "{error}"
        );
        if !original().statements()[place].operands.is_empty() {
            let error = broken(|statements| operands(statements, |o| drop(o.pop())));
            assert!(error.contains("operands, not"), "{error}");
        }
    }
}

#[test]
fn an_exit_follows_a_test() {
    let error = broken(|statements| statements[NEAR_EXIT as usize]["operands"] = json!([T]));
    assert!(error.contains("operand 0 of exit is t"), "{error}");
}

#[test]
fn a_program_stores_once_and_at_its_end() {
    let at_its_end = |error: String| {
        assert!(
            error.contains("a program stores once, at its end"),
            "{error}"
        );
    };
    at_its_end(refused("[]"));
    at_its_end(broken(|statements| drop(statements.pop())));
    at_its_end(broken(|statements| {
        statements.push(json!({"op": "one", "operands": []}));
    }));
    let error = broken(|statements| statements.push(statements[STORE].clone()));
    assert!(error.contains("statement 32 computes again"), "{error}");
}

/// What is wrong with `text`, in one sentence.
fn refused(text: &str) -> String {
    let error = serde_json::from_str::<Program>(text).expect_err("a broken program");
    let sentence = error.to_string();
    assert!(!sentence.contains(char::is_control), "{sentence:?}");
    sentence
}

/// What is wrong with the appendix's program once its statements are changed.
fn broken(change: impl FnOnce(&mut Vec<Value>)) -> String {
    let mut statements = serde_json::to_value(original()).unwrap();
    change(statements.as_array_mut().unwrap());
    refused(&statements.to_string())
}

fn original() -> Program {
    let graph = kensler_shirley();
    graph.program(&appendix(&graph)).unwrap()
}

//! A recipe file is data that nobody trusts: it is read back as it was written, and whatever is
//! wrong with one is an error of one sentence, never a panic.

mod sample;

use emit::{Name, Recipe, RecipeError};
use sample::{improved_recipe, recipe, stability};
use serde_json::{Value, json};

/// What must never reach a Rust file, nor a terminal.
const HOSTILE: &str = "x\n*/ pub fn evil() {} // \u{1b}[2J";

/// The appendix's program, or what comes nearest to it in a scene.
fn program_for(scene: &scene::SceneModel) -> program::Program {
    let isas = recipe("the-appendix").isas;
    let graph = emit::graph(scene, &isas);
    let genome = match emit::checked_in(scene, &isas) {
        program::CheckedIn::Watertight => program::Genome::identity(graph.nodes().len()),
        _ => program::appendix(&graph),
    };
    graph.program(&genome).unwrap()
}

#[test]
fn a_recipe_is_read_back_as_it_was_written() {
    for &scene in scene::SceneModel::PRESETS {
        for &regime in scene::Regime::ALL {
            let mut written = recipe("the-appendix");
            written.scene = scene::SceneModel::preset(scene).unwrap();
            written.scene.regime = regime;
            if written.scene.check().is_err() {
                continue;
            }
            written.program = program_for(&written.scene);
            let text = written.to_json();
            let read = Recipe::from_json(&text).unwrap();
            assert_eq!(read, written);
            assert_eq!(read.to_json(), text);
        }
    }
}

#[test]
fn figures_are_read_back_to_the_last_bit() {
    for n in 1..200 {
        let mut written = recipe("the-appendix");
        written.provenance.as_mut().unwrap().ratio = f64::from(n).sqrt() / 7e-11;
        written.error.as_mut().unwrap().max = 1.0 / f64::from(n).exp();
        written.stability = Some(stability());
        written.stability.as_mut().unwrap().t_p9999 = f64::from(n).cbrt() * 1e-7;
        assert_eq!(Recipe::from_json(&written.to_json()).unwrap(), written);
    }
}

#[test]
fn every_statement_has_its_line() {
    let recipe = recipe("the-appendix");
    let text = recipe.to_json();
    let lines = text.lines().map(|line| line.trim().trim_end_matches(','));
    let is_statement = |line: &&str| line.starts_with("{\"op\":") && line.ends_with("]}");
    let statements = recipe.program.statements().len();
    assert_eq!(lines.filter(is_statement).count(), statements);
    assert!(text.ends_with("}\n"));
}

#[test]
fn a_recipe_cut_off_anywhere_is_refused() {
    let text = recipe("the-appendix").to_json();
    let end = text.trim_end().len();
    for cut in (0..end).step_by(37).chain(end - 50..end) {
        assert!(matches!(refused(&text[..cut]), RecipeError::Json(_)));
    }
}

#[test]
fn a_field_too_few_or_too_many_is_refused() {
    let objects = [
        "",
        "/scene",
        "/provenance",
        "/provenance/search",
        "/provenance/improved",
        "/error",
        "/program/0",
    ];
    // A recipe by hand has none of the first; a scene has a default for the others.
    let optional = [
        "provenance",
        "improved",
        "worst_layout",
        "uncertainty",
        "error",
        "grouping",
        "origin",
        "query",
        "culling",
        "outputs",
        "range",
        "stored",
        "numeric",
        "regime",
        "bounds",
        "watertight",
    ];
    for pointer in objects {
        let whole: Value =
            serde_json::from_str(&improved_recipe("the-appendix").to_json()).unwrap();
        let fields = whole.pointer(pointer).unwrap().as_object().unwrap();
        for field in fields
            .keys()
            .filter(|name| !optional.contains(&name.as_str()))
        {
            let error = broken(pointer, |object| {
                object.as_object_mut().unwrap().remove(field);
            });
            assert!(error.to_string().contains("missing field"), "{error}");
        }
        for field in ["comment", HOSTILE] {
            let error = broken(pointer, |object| object[field] = json!("x"));
            assert!(error.to_string().contains("unknown field"), "{error}");
        }
    }
}

#[test]
fn names_that_are_paths_or_not_plain_are_refused() {
    let names = [
        "/name",
        "/scene/name",
        "/provenance/cpu",
        "/provenance/rustc",
        "/provenance/graph",
        "/provenance/search/strategy",
        "/provenance/improved/model",
    ];
    for pointer in names {
        for name in ["../../x", "a/b", "a\\b", "a..b", "..", "", "A", "a b", "é"] {
            let error = broken(pointer, |text| *text = json!(name));
            let sentence = error.to_string();
            assert!(sentence.contains("name"), "{pointer}: {sentence}");
            assert!(sentence.contains("[a-z0-9._-]"), "{pointer}: {sentence}");
        }
    }
    let too_long = "x".repeat(101);
    let error = broken("/name", |name| *name = json!(too_long));
    assert!(matches!(error, RecipeError::Json(_)));
}

#[test]
fn a_hostile_text_is_refused_wherever_a_text_may_stand() {
    let whole: Value = serde_json::from_str(&improved_recipe("the-appendix").to_json()).unwrap();
    let mut pointers = Vec::new();
    texts(&whole, String::new(), &mut pointers);
    assert!(pointers.len() > 40, "{pointers:?}");
    for pointer in pointers {
        let error = broken(&pointer, |text| *text = json!(HOSTILE));
        assert!(matches!(error, RecipeError::Json(_)), "{pointer}");
    }
}

#[test]
fn any_text_becomes_a_harmless_name() {
    let long = HOSTILE.repeat(100);
    for text in [HOSTILE, "../../etc/passwd", "", "..", &long] {
        let name = Name::of(text);
        assert_eq!(Name::new(name.as_str()), Ok(name));
    }
}

#[test]
fn an_isa_is_named_once_and_there_is_at_least_one() {
    for isas in [json!([]), json!(["sse2", "sse2"])] {
        let error = broken("/isas", |field| *field = isas);
        assert!(matches!(error, RecipeError::Isas), "{error}");
    }
    for isas in [json!(["sse1"]), json!(["SSE2"]), json!("sse2"), json!([2])] {
        let error = broken("/isas", |field| *field = isas);
        assert!(matches!(error, RecipeError::Json(_)), "{error}");
    }
}

#[test]
fn figures_are_numbers() {
    for wrong in [json!(null), json!("1"), json!([1]), json!(true)] {
        for pointer in [
            "/provenance/ratio",
            "/provenance/improved/cost",
            "/error/median",
            "/error/max",
        ] {
            broken(pointer, |figure| *figure = wrong.clone());
        }
    }
    for pointer in ["/error/hits", "/provenance/search/seed"] {
        for wrong in [json!(-1), json!(0.5), json!(2e19)] {
            broken(pointer, |figure| *figure = wrong);
        }
    }
    let text = recipe("the-appendix").to_json();
    let ratio = format!("{}", recipe("the-appendix").provenance.unwrap().ratio);
    assert!(text.contains(&ratio), "{text}");
    for wrong in ["1e999", "NaN", "Infinity", "-inf"] {
        refused(&text.replace(&ratio, wrong));
    }
}

#[test]
fn a_program_that_is_not_sound_is_refused() {
    let error = broken("/program/2/operands", |operands| {
        operands.as_array_mut().unwrap().reverse();
    });
    assert!(error.to_string().contains("or its negative"), "{error}");
    let error = broken("/program/2/operands/1", |operand| *operand = json!(31));
    assert!(error.to_string().contains("come before it"), "{error}");
    for program in [json!([]), json!(null), json!({})] {
        broken("/program", |field| *field = program);
    }
}

#[test]
fn a_file_too_large_for_a_recipe_is_refused_before_it_is_read() {
    let text = recipe("the-appendix").to_json();
    let limit = 1 << 20;
    let at_the_limit = text.clone() + &" ".repeat(limit - text.len());
    assert!(Recipe::from_json(&at_the_limit).is_ok());
    let error = refused(&(at_the_limit + " "));
    assert!(matches!(error, RecipeError::TooLarge(bytes) if bytes == limit + 1));
    let error = refused(&"[".repeat(limit + 1));
    assert!(matches!(error, RecipeError::TooLarge(_)));
    let error = refused(&"[".repeat(limit));
    assert!(matches!(error, RecipeError::Json(_)));
}

/// What is wrong with `text`, in one sentence.
fn refused(text: &str) -> RecipeError {
    let error = Recipe::from_json(text).map(drop).unwrap_err();
    let sentence = error.to_string();
    assert!(!sentence.contains(char::is_control), "{sentence:?}");
    assert!((10..400).contains(&sentence.len()), "{sentence:?}");
    error
}

/// What is wrong with a recipe once the value at `pointer` is changed.
fn broken(pointer: &str, change: impl FnOnce(&mut Value)) -> RecipeError {
    let mut whole: Value =
        serde_json::from_str(&improved_recipe("the-appendix").to_json()).unwrap();
    change(whole.pointer_mut(pointer).unwrap());
    refused(&whole.to_string())
}

/// The JSON pointers of every text in `value`.
fn texts(value: &Value, at: String, found: &mut Vec<String>) {
    match value {
        Value::String(_) => found.push(at),
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                texts(item, format!("{at}/{index}"), found);
            }
        }
        Value::Object(fields) => {
            for (field, item) in fields {
                texts(item, format!("{at}/{field}"), found);
            }
        }
        _ => {}
    }
}

#[test]
fn a_recipe_by_hand_is_read_and_is_no_kernel_of_the_package() {
    let mut by_hand = recipe("by-hand");
    by_hand.provenance = None;
    assert_eq!(Recipe::from_json(&by_hand.to_json()).unwrap(), by_hand);
    let error = emit::package(&[by_hand.clone()]).unwrap_err().to_string();
    assert!(error.contains("which search found it"), "{error}");
    by_hand.provenance = recipe("by-hand").provenance;
    by_hand.error = None;
    assert!(emit::package(&[by_hand]).is_err());
}

#[test]
fn a_kernel_that_was_improved_says_so() {
    let recipe = improved_recipe("the-appendix");
    assert_eq!(Recipe::from_json(&recipe.to_json()).unwrap(), recipe);
}

#[test]
fn an_estimate_in_a_portable_scene_is_refused() {
    let error = broken("/scene/numeric", |numeric| *numeric = json!("portable"));
    assert!(matches!(error, RecipeError::Breach(..)), "{error}");
    assert!(error.to_string().contains("reciprocal.newton"), "{error}");
}

//! Operation counts as programs read them, and the hand step from the command line.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// What the command prints.
fn opcount(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_xtask"))
        .arg("opcount")
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    String::from_utf8(output.stdout).unwrap()
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&opcount(&[arguments, &["--json"]].concat())).unwrap()
}

#[test]
fn every_row_has_the_fields_that_programs_rely_on() {
    let rows = json(&[]);
    let rows = rows.as_array().unwrap();
    let costs: Vec<f64> = rows
        .iter()
        .map(|row| row["cost"].as_f64().unwrap())
        .collect();
    assert_eq!(
        costs,
        [47.0, 47.0, 32.234375, 44.09375, 15.640625, 15.640625]
    );
    for row in rows {
        let fields: Vec<&String> = row.as_object().unwrap().keys().collect();
        assert_eq!(
            fields,
            [
                "case",
                "volume",
                "model",
                "combinations",
                "cost",
                "count",
                "formulations"
            ]
        );
        assert_eq!(row["combinations"], 17_915_904);
        let formulations = row["formulations"].as_array().unwrap();
        assert_eq!(row["count"], formulations.len());
        let volumes: Vec<&String> = formulations[0].as_object().unwrap().keys().collect();
        assert_eq!(volumes, [row["volume"].as_str().unwrap(), "Va", "V1", "V2"]);
    }
}

#[test]
fn a_stored_triangle_has_its_bytes() {
    let rows = json(&["--case", "triangles", "--stored", "--volume", "any"]);
    assert_eq!(rows.as_array().unwrap().len(), 4);
    assert!(
        rows.as_array()
            .unwrap()
            .iter()
            .all(|row| row["bytes"] == 48)
    );
}

#[test]
fn subexpressions_are_named_once_and_before_they_are_used() {
    let text = opcount(&["--case", "packet", "--volume", "V"]);
    for line in [
        "packet         V           paper  32 + 15/64                 2      17915904",
        "  e1  = p0-a        ray×triangle            3",
        "  c1  = e2 × e3     triangle             9/64",
        "  V   = c1 · d      ray×triangle            5",
        "  as cheap, 1 more:",
    ] {
        assert!(text.contains(line), "{line:?} is not in\n{text}");
    }
}

#[test]
fn a_whole_kernel_has_its_divisions_and_tests_counted() {
    let appendix = repository().join("dag/appendix.json");
    let kernels = json(&["--kernel", appendix.to_str().unwrap()]);
    let operations = &kernels[0]["operations"]["ray×triangle"];
    assert_eq!(
        (&operations["div"], &operations["test"]),
        (&1.into(), &14.into())
    );
}

#[test]
fn the_papers_kernel_is_recognised_as_optimal() {
    let appendix = repository().join("dag/appendix.json");
    let improve = ["--improve", appendix.to_str().unwrap(), "--untimed"];
    let text = opcount(&improve);
    assert!(text.contains("its volumes, 32 + 15/64"), "{text}");
    assert!(
        text.contains("none of the 54 cheapest makes it cheaper"),
        "{text}"
    );
    let row = &json(&improve)[0];
    assert_eq!(row["formulation"], Value::Null);
    assert_eq!(row["kept"], Value::Null);
}

#[test]
fn the_steps_can_be_followed() {
    // Its volumes are those of the paper's equations 2, which do not suit packets.
    let graph = program::kensler_shirley();
    let genome = program::moller_trumbore_volumes(&graph);
    let text = fs::read_to_string(repository().join("dag/appendix.json")).unwrap();
    let mut recipe = emit::Recipe::from_json(&text).unwrap();
    recipe.program = graph.program(&genome).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("equations-2.json");
    fs::write(&path, recipe.to_json()).unwrap();
    let text = opcount(&["--improve", path.to_str().unwrap(), "--untimed"]);
    for step in [
        "formulation  V  = (d × (p2-p0)) · (p1-p0)",
        "structure    ",
        "its volumes, 41 + 6/64",
        "nearest      of the 54 cheapest that which changes the fewest statements",
        "- V = (d × (p2-p0)) · (p1-p0)",
        "cleaned      ",
        "- mask = true in every lane",
        "4 volumes equal as polynomials",
        "its volumes, 32 + 15/64",
    ] {
        assert!(text.contains(step), "{step:?} is not in\n{text}");
    }
}

#[test]
fn other_cases_can_be_asked_for() {
    // With neither origin nor direction of its own, a ray shares everything.
    let shared = [
        "--case",
        "packet",
        "--volume",
        "V",
        "--direction",
        "packet",
        "--origin",
        "packet",
    ];
    assert_eq!(json(&shared)[0]["cost"], 47.0 / 64.0);
    // Parallel rays share all that does not have the origin.
    let parallel = json(&["--case", "packet", "--volume", "V", "--direction", "packet"]);
    assert_eq!(parallel[0]["case"], "packet/direction=packet");
    let single = json(&[
        "--case",
        "single",
        "--volume",
        "V",
        "--amortise",
        "triangle",
        "--packet-size",
        "64",
    ]);
    let packet = json(&["--case", "packet", "--volume", "V"]);
    assert_eq!(single[0]["cost"], packet[0]["cost"]);
}

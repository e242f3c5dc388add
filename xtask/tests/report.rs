//! The page of a run, of a small one and of what is left of it.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

const SECTIONS: [&str; 8] = [
    "How it went",
    "Where the champion comes from",
    "Which choices survived",
    "What each choice is worth",
    "How noisy the timings are",
    "Tried twice, and failed",
    "The champion's code",
    "The table at the end",
];

#[test]
fn a_run_has_a_page_with_every_section_that_loads_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let run = directory.path().join("run");
    let mut evolve = xtask();
    evolve.args(["evolve", "--population", "6", "--elite", "2"]);
    evolve.args(["--generations", "3", "--triangles", "500"]);
    finished(evolve.arg("--out").arg(&run));

    let data = finished(xtask().args(["report", "--json"]).arg(&run));
    let data: Value = serde_json::from_str(&data).unwrap();
    let page = fs::read_to_string(run.join("report.html")).unwrap();
    check(&page);
    assert!(page.contains("Möller and Trumbore"));
    let ancestors = data["ancestry"]["is"].as_array().unwrap();
    assert_eq!(ancestors[0]["operator"], "random");
    // The champion's line ends with the champion.
    assert_eq!(
        ancestors.last().unwrap()["id"],
        data["champion"]["is"]["id"]
    );
    assert!(
        !data["survivors"]["is"]["questions"]
            .as_array()
            .unwrap()
            .is_empty()
    );
    let flips = data["worth"]["is"]["flips"].as_array().unwrap();
    assert!(flips.iter().any(|flip| flip["speed"].is_array()));
    assert_eq!(data["losses"]["candidates"], 6 + 3 * 4);
    let standings = data["standings"]["is"].as_array().unwrap();
    assert!(
        standings
            .iter()
            .any(|one| one["kernel"] == "champion" && one["rank"].is_number())
    );
    assert!(
        data["listing"]["is"]["assembly"]
            .as_str()
            .unwrap()
            .contains("ps\t")
    );

    // What an interrupted run leaves is told, and what it lacks is said.
    for file in ["champion.json", "champion.rs", "run.json"] {
        fs::remove_file(run.join(file)).unwrap();
    }
    let out = directory.path().join("other.html");
    let mut command = xtask();
    command.args(["report", "--no-timing", "--out"]).arg(&out);
    let said = finished(command.arg(&run));
    assert!(said.contains("other.html"), "{said}");
    let page = fs::read_to_string(&out).unwrap();
    check(&page);
    for phrase in [
        "The best so far",
        "--no-timing",
        "There was no shoot-out",
        "interrupted",
    ] {
        assert!(page.contains(phrase), "{phrase}");
    }
}

#[test]
fn a_run_after_a_front_has_a_page() {
    let directory = tempfile::tempdir().unwrap();
    let run = directory.path().join("run");
    let mut evolve = xtask();
    evolve.args(["evolve", "--objective", "pareto", "--population", "6"]);
    evolve.args(["--elite", "2", "--generations", "1", "--triangles", "500"]);
    finished(evolve.arg("--out").arg(&run));
    finished(xtask().args(["report", "--no-timing"]).arg(&run));
    let page = fs::read_to_string(run.join("report.html")).unwrap();
    check(&page);
    assert!(page.contains("place on the front") && page.contains("the champion"));
}

#[test]
fn a_run_of_a_graph_of_its_own_keeps_it_and_can_be_gone_through_again() {
    let directory = tempfile::tempdir().unwrap();
    let run = directory.path().join("run");
    let graph = directory.path().join("own.json");
    let other = Path::new(env!("CARGO_MANIFEST_DIR")).join("../dag/extended.json");
    fs::copy(other, &graph).unwrap();
    let mut evolve = xtask();
    evolve.args(["evolve", "--population", "6", "--elite", "2"]);
    evolve.args(["--generations", "1", "--triangles", "500", "--graph"]);
    finished(evolve.arg(&graph).arg("--out").arg(&run));
    fs::remove_file(graph).unwrap();

    let data = finished(xtask().args(["report", "--no-timing", "--json"]).arg(&run));
    let data: Value = serde_json::from_str(&data).unwrap();
    assert!(data["survivors"]["is"].is_object(), "{}", data["survivors"]);
    finished(xtask().args(["evolve", "--replay"]).arg(&run));
}

/// Whether a page has its sections and is whole by itself.
fn check(page: &str) {
    for section in SECTIONS {
        let is_there = page.contains(&format!("<h2>{section}</h2>"));
        assert!(is_there, "{section}");
    }
    for loads in [
        "http", "src=", "href=", "url(", "@import", "<script", "<link", "<img",
    ] {
        assert!(!page.contains(loads), "{loads}");
    }
}

fn xtask() -> Command {
    Command::new(env!("CARGO_BIN_EXE_xtask"))
}

fn finished(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    String::from_utf8(output.stdout).unwrap()
}

//! A small experiment: its trials are runs, and are made once.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn compare(out: &Path, evaluations: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask"))
        .args([
            "compare-strategies",
            "--json",
            "--strategies",
            "random,guided",
        ])
        .args([
            "--seeds",
            "1",
            "--triangles",
            "1000",
            "--evaluations",
            evaluations,
        ])
        .arg("--out")
        .arg(out)
        .output()
        .unwrap()
}

#[test]
fn an_experiment_goes_on_with_the_trials_that_it_has() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("experiment");
    let journal = |trial: &str| fs::read(out.join(trial).join("evals.jsonl")).unwrap();
    let first = compare(&out, "12");
    let said = String::from_utf8_lossy(&first.stderr);
    assert!(first.status.success(), "{said}");
    let comparison: Value = serde_json::from_slice(&first.stdout).unwrap();
    let strategies = comparison["strategies"].as_array().unwrap();
    assert_eq!(strategies.len(), 2);
    for one in strategies {
        assert_eq!(one["evaluations"], 12.0);
        assert!(one["mean"].as_f64().unwrap() > 0.0, "{one}");
        assert!(one["seconds"].as_f64().unwrap() > 0.0, "{one}");
    }
    let plot = fs::read_to_string(out.join("best-so-far.svg")).unwrap();
    assert!(plot.contains("guided") && plot.contains("random") && plot.contains("evaluations"));

    // A trial that was lost is made again, and no other.
    let known = journal("random-1");
    fs::remove_dir_all(out.join("guided-1")).unwrap();
    let again = compare(&out, "12");
    let said = String::from_utf8_lossy(&again.stderr);
    assert_eq!(said.matches("known already").count(), 1, "{said}");
    assert_eq!(journal("random-1"), known);
    assert!(!journal("guided-1").is_empty());

    let other = compare(&out, "13");
    let said = String::from_utf8_lossy(&other.stderr);
    assert_eq!(other.status.code(), Some(2));
    assert!(
        said.contains("other settings") && said.contains("--out"),
        "{said}"
    );
}

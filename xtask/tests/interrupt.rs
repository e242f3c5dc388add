//! Ctrl-C ends a run, keeps the best so far and says so.
#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

use rustix::process::{Pid, Signal, kill_process};

#[test]
fn an_interrupted_run_keeps_its_champion() {
    for islands in ["1", "2"] {
        interrupted(islands);
    }
}

fn interrupted(islands: &str) {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("run");
    let mut child = Command::new(env!("CARGO_BIN_EXE_xtask"))
        .args([
            "evolve",
            "--population",
            "6",
            "--elite",
            "2",
            "--generations",
            "100000",
            "--islands",
            islands,
        ])
        .arg("--out")
        .arg(&out)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    let mut said = String::new();
    // By then some candidate has a fitness, or there is something wrong with the graph.
    while !said.contains("gen 5/") {
        assert!(stderr.read_line(&mut said).unwrap() > 0, "{said}");
    }
    kill_process(Pid::from_child(&child), Signal::INT).unwrap();
    stderr.read_to_string(&mut said).unwrap();
    let status = child.wait().unwrap();

    assert_eq!(status.code(), Some(130), "{said}");
    let last = said.lines().last().unwrap();
    assert!(
        last.contains("interrupted") && last.contains("is kept in"),
        "{said}"
    );
    assert!(
        !said.contains('\u{1b}'),
        "no control characters where nobody looks: {said}"
    );
    for file in ["champion.rs", "champion.json", "run.json"] {
        assert!(!fs::read_to_string(out.join(file)).unwrap().is_empty());
    }
    let journal = fs::read_to_string(out.join("evals.jsonl")).unwrap();
    let is_candidate = |line: &&str| line.contains("\"operator\"");
    assert!(journal.lines().filter(is_candidate).count() >= 6 + 5 * 4);
    assert!(journal.ends_with('\n'));
}

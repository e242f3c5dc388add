//! Real runs that are killed, resumed, limited and replayed.
#![cfg(target_os = "linux")]

use std::collections::HashSet;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use serde_json::Value;

/// Population 8, elite 2, 4 generations: 8 candidates and four times 6.
const CANDIDATES: usize = 32;

const SMALL: [&str; 8] = [
    "--population",
    "8",
    "--elite",
    "2",
    "--generations",
    "4",
    "--seed",
    "9",
];

#[test]
fn killed_five_times_a_run_loses_nothing_and_leaves_no_process() {
    killed(5, &[]);
}

/// One generation is being timed then, and the next one is being compiled.
#[test]
fn killed_twice_nor_does_a_run_on_islands() {
    killed(2, &["--islands", "2"]);
}

/// Kills a run so often.
fn killed(kills: usize, flags: &[&str]) {
    let directory = tempfile::tempdir().unwrap();
    let run = directory.path().join("run");
    let mut said = Vec::new();
    for kill in 0..kills {
        // In the middle of the next generation; the fifth time in the shoot-out.
        let mut child = match kill {
            0 => begin(&run, flags),
            _ => go_on(&run),
        };
        wait_for_a_generation(&mut child);
        let offspring = offspring_of(&child);
        assert!(!offspring.is_empty(), "it has at least a worker");
        child.kill().unwrap();
        child.wait().unwrap();
        for process in offspring {
            wait_for_end_of(process);
        }
        let journal = fs::read(run.join("evals.jsonl")).unwrap();
        assert!(journal.starts_with(&said), "kill {kill}");
        said = journal;
    }
    let output = finished(xtask().args(["evolve", "--json", "--resume"]).arg(&run));
    check_journal(&run);
    let result = output.lines().last().unwrap();
    let result: Value = serde_json::from_str(result).unwrap();
    let champion = |one: &Value| one["kernel"] == "champion";
    assert!(result["shootout"].as_array().unwrap().iter().any(champion));
    for file in ["champion.rs", "champion.json", "run.json"] {
        assert!(!fs::read_to_string(run.join(file)).unwrap().is_empty());
    }

    // And now that all is recorded, nothing need be timed.
    let before = fs::read(run.join("evals.jsonl")).unwrap();
    let replay = |more: &[&str]| -> Value {
        let mut command = xtask();
        command.args(["evolve", "--json", "--replay"]).arg(&run);
        let output = finished(command.args(more));
        serde_json::from_str(output.lines().last().unwrap()).unwrap()
    };
    let whole = replay(&[]);
    assert_eq!(whole["stopped"], "done");
    assert_eq!(whole["evaluations"], CANDIDATES);
    let other = replay(&["--seed", "10"]);
    let stopped = other["stopped"].as_str().unwrap();
    assert!(stopped.contains("was never timed"), "{stopped}");
    assert_eq!(fs::read(run.join("evals.jsonl")).unwrap(), before);
}

#[test]
fn a_second_run_in_the_directory_of_a_first_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let run = directory.path().join("run");
    let mut first = begin(&run, &[]);
    wait_for_a_generation(&mut first);
    let second = xtask().args(["evolve", "--resume"]).arg(&run).output();
    let again = xtask().args(["evolve", "--out"]).arg(&run).output();
    first.kill().unwrap();
    first.wait().unwrap();
    for (output, phrase) in [(second, "another run is writing"), (again, "not empty")] {
        let output = output.unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(phrase), "{said}");
    }
}

#[test]
fn a_limit_or_a_budget_ends_the_search_cleanly() {
    let directory = tempfile::tempdir().unwrap();
    let run = directory.path().join("run");
    let mut command = xtask();
    command.args(["evolve", "--json", "--budget", "0", "--evaluations", "7"]);
    let output = finished(command.args(SMALL).arg("--out").arg(&run));
    let generations = output.lines().filter(|line| line.contains("eta_seconds"));
    assert_eq!(generations.count(), 1);
    let description: Value =
        serde_json::from_str(&fs::read_to_string(run.join("run.json")).unwrap()).unwrap();
    assert_eq!(description["evaluations"], 7);
    assert!(description["shootout"].is_array());

    // What is tried depends on the limit, so it stays with the run.
    let output = finished(xtask().args(["evolve", "--json", "--replay"]).arg(&run));
    let replayed: Value = serde_json::from_str(output.lines().last().unwrap()).unwrap();
    assert_eq!(replayed["evaluations"], 7);
    finished(xtask().args(["evolve", "--json", "--resume"]).arg(&run));
    let mut more = xtask();
    more.args(["evolve", "--evaluations", "20", "--resume"]);
    let refused = more.arg(&run).output().unwrap();
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("begun with 7, not 20"), "{said}");
}

fn xtask() -> Command {
    Command::new(env!("CARGO_BIN_EXE_xtask"))
}

fn begin(run: &Path, flags: &[&str]) -> Child {
    let mut command = xtask();
    command.arg("evolve").args(SMALL).args(flags);
    start(command.arg("--out").arg(run), run)
}

fn go_on(run: &Path) -> Child {
    start(xtask().args(["evolve", "--resume"]).arg(run), run)
}

fn start(command: &mut Command, run: &Path) -> Child {
    // Killed, it leaves its libraries behind.
    command.env("TMPDIR", run.parent().unwrap());
    command.arg("--json");
    command.stdout(Stdio::piped()).stderr(Stdio::null());
    command.spawn().unwrap()
}

/// Returns when a run has a generation more than were recorded when it began.
fn wait_for_a_generation(child: &mut Child) {
    let mut line = String::new();
    let stdout = child.stdout.as_mut().unwrap();
    BufReader::new(stdout).read_line(&mut line).unwrap();
    assert!(line.contains("eta_seconds"), "{line:?}");
}

/// The processes that a process has started, and theirs.
fn offspring_of(child: &Child) -> Vec<u32> {
    let mut found = vec![child.id()];
    let mut next = 0;
    while let Some(&process) = found.get(next) {
        next += 1;
        let threads = fs::read_dir(format!("/proc/{process}/task"));
        for thread in threads.into_iter().flatten().flatten() {
            let children = fs::read_to_string(thread.path().join("children"));
            let children = children.unwrap_or_default();
            found.extend(children.split(' ').filter_map(|id| id.parse::<u32>().ok()));
        }
    }
    found.split_off(1)
}

/// Returns when a process is gone; one that nobody waits for any more is.
fn wait_for_end_of(process: u32) {
    let is_there = || {
        let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
        let state = stat
            .rsplit(')')
            .next()
            .and_then(|rest| rest.trim().chars().next());
        state.is_some_and(|state| state != 'Z' && state != 'X')
    };
    while is_there() {
        std::thread::yield_now();
    }
}

fn finished(command: &mut Command) -> String {
    let Output {
        status,
        stdout,
        stderr,
    } = command.output().unwrap();
    let said = String::from_utf8(stderr).unwrap();
    assert!(status.success(), "{said}");
    let control = |c: char| c.is_control() && c != '\n';
    assert!(!said.contains(control), "control characters: {said:?}");
    String::from_utf8(stdout).unwrap()
}

/// Every candidate is there once, every source is timed as new once.
fn check_journal(run: &Path) {
    let journal = fs::read_to_string(run.join("evals.jsonl")).unwrap();
    let mut ids = Vec::new();
    let mut sources = HashSet::new();
    for line in journal.lines() {
        let line: Value = serde_json::from_str(line).unwrap();
        if line["operator"].is_string() {
            ids.push(line["id"].as_u64().unwrap());
        }
        if line["line"] == "new" {
            assert!(sources.insert(line["source"].to_string()));
        }
    }
    assert!(ids.into_iter().eq(0..CANDIDATES as u64));
}

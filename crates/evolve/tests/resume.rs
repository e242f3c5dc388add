//! Runs that stop at any moment and go on: nothing measured is measured again or decided anew.

mod mock;

use std::collections::{HashMap, HashSet, VecDeque};
use std::convert::Infallible;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::LazyLock;

use evolve::{
    Batch, EvaluateAtOnce, Evaluation, Foresee, Journal, JournalError, Judged, Line, Memory,
    MemoryError, Outcome, Recorded, Settings, Stop, search,
};
use mock::{Breaks, FORMULA, Noisy, Watch, source};
use program::{Graph, Program, kensler_shirley};
use serde_json::Value;
use tempfile::TempDir;

static GRAPH: LazyLock<Graph> = LazyLock::new(kensler_shirley);

#[test]
fn whatever_was_recorded_before_the_end_the_resumed_run_decides_as_if_it_had_never_ended() {
    for settings in [small(), on_islands()] {
        let (_directory, path) = run_directory();
        let (whole, outcome) = recorded_run_of(settings, &path);
        let ends = (0..whole.len()).filter(|&at| whole[at] == b'\n');
        for end in ends
            .map(|at| at + 1)
            .collect::<Vec<_>>()
            .into_iter()
            .step_by(3)
        {
            // In the middle of the next line.
            let cut = (end + 20).min(whole.len());
            fs::write(&path, &whole[..cut]).unwrap();
            let (journal, recorded) = reopened(&path);
            let rest = Rest::after(recorded.lines.len(), &whole);
            let mut memory = Memory::resume(rest, journal, recorded);
            let resumed = search(&GRAPH, settings, &mut memory, &mut Watch::default());
            assert_eq!(resumed.population, outcome.population, "cut at {cut}");
            drop(memory);
            assert!(fs::read(&path).unwrap() == whole, "cut at {cut}");
        }
    }
}

#[test]
fn a_source_that_was_judged_before_or_is_being_judged_costs_nothing() {
    for settings in [small(), on_islands()] {
        let (_directory, path) = run_directory();
        let journal = Journal::create(&path, Value::Null).unwrap();
        // Panics when it is asked about a source twice.
        let mut memory = Memory::new(Noisy::default(), journal);
        let outcome = search(&GRAPH, settings, &mut memory, &mut Watch::default());
        assert!((memory.sources() as u64) < outcome.evaluations);
        let lines = Recorded::read(&path).unwrap().lines;
        let new = lines.iter().filter(|line| matches!(line, Line::New { .. }));
        assert_eq!(new.count(), memory.sources());
    }
}

#[test]
fn a_replay_asks_nobody_and_writes_nothing() {
    let (_directory, path) = run_directory();
    let (whole, outcome) = recorded_run(&path);
    let mut memory = Memory::replay(Breaks { after: 0 }, Recorded::read(&path).unwrap());
    let replayed = search(&GRAPH, small(), &mut memory, &mut Watch::default());
    assert!(matches!(replayed.stop, Stop::Done), "{:?}", replayed.stop);
    assert_eq!(replayed.population, outcome.population);
    assert_eq!(fs::read(&path).unwrap(), whole);
}

#[test]
fn a_replay_of_another_search_ends_at_what_was_never_judged() {
    let (_directory, path) = run_directory();
    recorded_run(&path);
    let other = Settings { seed: 6, ..small() };
    let mut memory = Memory::replay(Breaks { after: 0 }, Recorded::read(&path).unwrap());
    let replayed = search(&GRAPH, other, &mut memory, &mut Watch::default());
    assert!(matches!(
        replayed.stop,
        Stop::Evaluation(MemoryError::Evaluate("the worker is gone"))
    ));
    assert_eq!(replayed.evaluations, 0);
}

#[test]
fn another_search_does_not_go_on_with_a_recorded_one() {
    let (_directory, path) = run_directory();
    let (whole, _) = recorded_run(&path);
    let (journal, recorded) = reopened(&path);
    let mut memory = Memory::resume(FORMULA, journal, recorded);
    let other = Settings { seed: 6, ..small() };
    let outcome = search(&GRAPH, other, &mut memory, &mut Watch::default());
    let Stop::Evaluation(error @ MemoryError::Changed { id: 0 }) = outcome.stop else {
        panic!("{:?}", outcome.stop)
    };
    assert!(!error.to_string().contains('\n'));
    assert_eq!(fs::read(&path).unwrap(), whole);
}

#[test]
fn a_run_that_was_limited_goes_on_without_the_limit() {
    let (_directory, path) = run_directory();
    let limited = Settings {
        limit: Some(50),
        ..small()
    };
    let journal = Journal::create(&path, Value::Null).unwrap();
    let mut memory = Memory::new(FORMULA, journal);
    search(&GRAPH, limited, &mut memory, &mut Watch::default());
    drop(memory);
    let outcome = resume(&path);
    assert!(matches!(outcome.stop, Stop::Done));
    check_journal(&path);
}

/// The kills come when the journal has reached a certain length: at every stage of the run.
#[test]
fn killed_at_fifty_moments_a_run_resumes_with_all_that_was_recorded() {
    let (directory, path) = run_directory();
    let (whole, _) = recorded_run(&path);
    let mut killed = 0;
    for moment in 0..50 {
        fs::remove_file(&path).unwrap();
        let length = (whole.len() * moment / 50) as u64;
        let mut child = run_of_its_own(directory.path());
        let alive = loop {
            if fs::metadata(&path).is_ok_and(|file| file.len() >= length) {
                break true;
            }
            if child.try_wait().unwrap().is_some() {
                break false;
            }
            std::thread::yield_now();
        };
        child.kill().unwrap();
        killed += usize::from(alive && !child.wait().unwrap().success());
        let before = fs::read(&path).unwrap();
        match Journal::resume(&path) {
            Ok(opened) => drop(opened),
            // It had not come to its first line.
            Err(error) => {
                assert_eq!(length, 0, "{error}");
                continue;
            }
        }
        let outcome = resume(&path);
        assert!(matches!(outcome.stop, Stop::Done), "{:?}", outcome.stop);
        assert!(fs::read(&path).unwrap().starts_with(&before));
        check_journal(&path);
    }
    assert!(
        killed >= 40,
        "{killed} kills came before the end of the run"
    );
}

#[cfg(unix)]
#[test]
fn a_full_disk_stops_the_run_with_its_population_and_the_journal_resumes() {
    let (directory, path) = run_directory();
    // Eight blocks, of half a kilobyte or a whole one.
    let limits = "trap '' XFSZ; ulimit -f 8; exec \"$@\"";
    let mut command = Command::new("sh");
    command.args(["-c", limits, "sh"]);
    command.arg(std::env::current_exe().unwrap());
    let mut child = in_directory(&mut command, directory.path());
    assert!(child.wait().unwrap().success());
    let said = fs::read_to_string(directory.path().join("stopped")).unwrap();
    assert!(said.starts_with("the run cannot be recorded: "), "{said}");
    let (said, population) = said.rsplit_once('\n').unwrap();
    assert!(!said.contains('\n'), "{said}");
    assert_eq!(population, small().population.to_string());
    resume(&path);
    check_journal(&path);
}

/// Not a test but the run that others start and kill. By itself it does nothing.
#[test]
fn a_run_in_a_process_of_its_own() {
    let Some(directory) = std::env::var_os(DIRECTORY) else {
        return;
    };
    let directory = PathBuf::from(directory);
    let journal = Journal::create(&directory.join("evals.jsonl"), Value::Null).unwrap();
    let mut memory = Memory::new(Noisy::default(), journal);
    let outcome = search(&GRAPH, small(), &mut memory, &mut Watch::default());
    if let Stop::Evaluation(error) = outcome.stop {
        let said = format!("{error}\n{}", outcome.population.len());
        fs::write(directory.join("stopped"), said).unwrap();
    }
}

/// Where a run of its own finds its directory.
const DIRECTORY: &str = "RAYBREED_TEST_RUN_DIRECTORY";

fn run_of_its_own(directory: &Path) -> Child {
    in_directory(
        &mut Command::new(std::env::current_exe().unwrap()),
        directory,
    )
}

fn in_directory(command: &mut Command, directory: &Path) -> Child {
    command
        .args(["--exact", "a_run_in_a_process_of_its_own"])
        .env(DIRECTORY, directory)
        .stdout(Stdio::null())
        .spawn()
        .unwrap()
}

/// A journal that was closed. Children of tests beside this one hold its lock, too, between their fork and their exec.
fn reopened(path: &Path) -> (Journal, Recorded) {
    for _ in 0..10_000 {
        match Journal::resume(path) {
            Err(JournalError::Busy) => std::thread::yield_now(),
            resumed => return resumed.unwrap(),
        }
    }
    panic!("{} stays locked", path.display())
}

/// Goes on with a journal, by other timings than before.
fn resume(path: &Path) -> Outcome<MemoryError<Infallible>> {
    let (journal, recorded) = reopened(path);
    let noisy = Noisy {
        drift: 0.5,
        ..Noisy::default()
    };
    let mut memory = Memory::resume(noisy, journal, recorded);
    search(&GRAPH, small(), &mut memory, &mut Watch::default())
}

/// A journal of a whole run has every candidate once and every source as new once.
fn check_journal(path: &Path) {
    let mut next = 0;
    let mut sources = HashSet::new();
    for line in Recorded::read(path).unwrap().lines {
        let candidate = match line {
            Line::New { candidate, .. } => {
                assert!(sources.insert(candidate.source.clone()));
                candidate
            }
            Line::Duplicate { candidate } => {
                assert!(sources.contains(&candidate.source));
                candidate
            }
            Line::Again { source, .. } => {
                assert!(sources.contains(&source));
                continue;
            }
            Line::Run { .. } => panic!("a second beginning"),
        };
        assert_eq!(candidate.id, next);
        next += 1;
    }
    assert_eq!(next, small().evaluations());
}

/// What is in the journal after its first lines, to be asked for in order.
struct Rest {
    new: HashMap<String, Evaluation>,
    again: HashMap<String, VecDeque<Evaluation>>,
}

impl Rest {
    fn after(lines: usize, whole: &[u8]) -> Rest {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("whole");
        fs::write(&path, whole).unwrap();
        let mut rest = Rest {
            new: HashMap::new(),
            again: HashMap::new(),
        };
        for line in Recorded::read(&path).unwrap().lines.into_iter().skip(lines) {
            match line {
                Line::New {
                    candidate,
                    evaluation,
                } => {
                    rest.new.insert(candidate.source, evaluation);
                }
                Line::Again {
                    source, evaluation, ..
                } => rest.again.entry(source).or_default().push_back(evaluation),
                Line::Run { .. } | Line::Duplicate { .. } => {}
            }
        }
        rest
    }
}

impl Foresee for Rest {
    fn source(&mut self, program: &Program) -> String {
        source(program)
    }
}

impl EvaluateAtOnce for Rest {
    type Error = Infallible;

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, Infallible> {
        let new = batch.new.iter().map(|one| self.new.remove(&one.source));
        let new = new.map(|found| found.expect("the same candidates as before"));
        let new = new.collect();
        let again = batch.again.iter().map(|one| {
            let queue = self.again.get_mut(&one.candidate.source);
            queue.and_then(VecDeque::pop_front).expect("as before")
        });
        let again = again.collect();
        Ok(Judged { new, again })
    }
}

/// A run with timings that are never the same, and its journal's bytes.
fn recorded_run(path: &Path) -> (Vec<u8>, Outcome<MemoryError<Infallible>>) {
    recorded_run_of(small(), path)
}

fn recorded_run_of(settings: Settings, path: &Path) -> (Vec<u8>, Outcome<MemoryError<Infallible>>) {
    let journal = Journal::create(path, Value::Null).unwrap();
    let mut memory = Memory::new(Noisy::default(), journal);
    let outcome = search(&GRAPH, settings, &mut memory, &mut Watch::default());
    assert!(matches!(outcome.stop, Stop::Done));
    (fs::read(path).unwrap(), outcome)
}

fn run_directory() -> (TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("evals.jsonl");
    (directory, path)
}

/// The paper's strategy, which tries what another island is trying.
fn on_islands() -> Settings {
    Settings {
        islands: 2,
        generations: 30,
        ..small()
    }
}

fn small() -> Settings {
    Settings {
        population: 20,
        elite: 8,
        generations: 8,
        seed: 5,
        ..Settings::default()
    }
}

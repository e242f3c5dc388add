//! The journal of a run: what a line says, and that nothing it says is lost or made up.

use std::fs;
use std::io;
use std::path::PathBuf;

use evolve::{Evaluation, Identity, Journal, JournalError, Line, Origin, Recorded};
use serde_json::{Value, json};
use tempfile::TempDir;

#[test]
fn the_first_line_describes_the_run_and_the_others_what_became_of_whom() {
    let (_directory, path) = journal_path();
    let mut journal = Journal::create(&path, json!({"seed": 7})).unwrap();
    let parents = Origin::Crossover { parents: [4, 2] };
    journal
        .append(&[
            new(3, Origin::Random, Some(0.25)),
            Line::Duplicate {
                candidate: identity(4, parents),
            },
            again(3, Some(0.5)),
        ])
        .unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let said = text.lines().map(|line| {
        let mut line: Value = line.parse().unwrap();
        let check = line.as_object_mut().unwrap().remove("check").unwrap();
        assert_eq!(check.as_str().unwrap().len(), 16);
        line
    });
    let details = json!({"seconds": [0.5, 4.0], "note": "two\nlines"});
    let expected = [
        json!({"line": "run", "run": {"seed": 7}}),
        json!({
            "line": "new", "id": 3, "generation": 7, "operator": "random", "source": "5eed",
            "fitness": 0.25, "uncertainty": 0.01, "costs": [0.1, 0.0], "details": details,
        }),
        json!({
            "line": "duplicate", "id": 4, "generation": 7, "operator": "crossover",
            "parents": [4, 2], "source": "5eed",
        }),
        json!({
            "line": "again", "id": 3, "generation": 8, "source": "5eed",
            "fitness": 0.5, "uncertainty": 0.01, "costs": [0.1, 0.0], "details": details,
        }),
    ];
    assert!(said.eq(expected));
}

#[test]
fn lines_are_read_back_as_they_were_written_and_appended_to() {
    let (_directory, path) = journal_path();
    let mut journal = Journal::create(&path, Value::Null).unwrap();
    let mut written = Vec::new();
    for (id, fitness) in (0..).zip(awkward_numbers()) {
        let fitness = (id % 5 != 4).then_some(fitness);
        let origin = Origin::Crossover {
            parents: [u64::MAX, 0],
        };
        let lines = [new(id, origin, fitness), again(id, fitness)];
        journal.append(&lines).unwrap();
        written.extend(lines);
        if id % 50 == 0 {
            drop(journal);
            let (resumed, recorded) = Journal::resume(&path).unwrap();
            assert_eq!((recorded.lines, recorded.torn), (written.clone(), 0));
            journal = resumed;
        }
    }
    assert_eq!(Recorded::read(&path).unwrap().lines, written);
}

#[test]
fn cut_off_at_any_byte_it_keeps_every_whole_line() {
    let (_directory, path) = journal_path();
    let (text, lines) = sample(&path);
    for cut in 0..text.len() {
        fs::write(&path, &text[..cut]).unwrap();
        let whole = text[..cut].iter().filter(|&&byte| byte == b'\n').count();
        match Journal::resume(&path) {
            Ok((mut journal, recorded)) => {
                assert_eq!(recorded.lines, lines[..whole - 1]);
                assert_eq!(text[..cut - recorded.torn].last(), Some(&b'\n'));
                journal.append(&lines[whole - 1..]).unwrap();
                assert_eq!(fs::read(&path).unwrap(), text, "cut at {cut}");
            }
            Err(error) => {
                assert!(matches!(error, JournalError::Empty), "{error}");
                assert_eq!(whole, 0);
            }
        }
    }
}

#[test]
fn no_flipped_bit_goes_unnoticed() {
    let (_directory, path) = journal_path();
    let (text, lines) = sample(&path);
    for bit in 0..8 * text.len() {
        let mut flipped = text.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        fs::write(&path, &flipped).unwrap();
        match Recorded::read(&path) {
            // The last line's end may be gone; that line is then torn off.
            Ok(recorded) => {
                assert!(recorded.torn > 0 && bit / 8 == text.len() - 1, "bit {bit}");
                assert_eq!(recorded.lines, lines[..lines.len() - 1]);
            }
            Err(error) => assert!(matches!(error, JournalError::Damaged(_)), "{error}"),
        }
    }
}

#[test]
fn no_line_can_be_missing_doubled_or_moved() {
    let (_directory, path) = journal_path();
    let (text, _) = sample(&path);
    let lines: Vec<&str> = str::from_utf8(&text).unwrap().lines().collect();
    let mut others: Vec<(usize, Vec<&str>)> = Vec::new();
    for index in 0..lines.len() {
        let mut doubled = lines.clone();
        doubled.insert(index, lines[index]);
        others.push((index + 2, doubled));
        if index + 1 < lines.len() {
            let mut missing = lines.clone();
            missing.remove(index);
            others.push((index + 1, missing));
            let mut moved = lines.clone();
            moved.swap(index, index + 1);
            others.push((index + 1, moved));
        }
    }
    for (number, lines) in others {
        fs::write(&path, lines.join("\n") + "\n").unwrap();
        let error = Recorded::read(&path).unwrap_err();
        assert!(
            matches!(error, JournalError::Damaged(at) if at == number),
            "{error}"
        );
    }
}

#[test]
fn every_error_is_one_sentence() {
    for error in [
        JournalError::Busy,
        JournalError::Empty,
        JournalError::Damaged(3),
        JournalError::Foreign(3),
    ] {
        let text = error.to_string();
        assert!(!text.contains('\n') && text.len() > 30, "{text}");
    }
}

#[test]
fn a_second_run_in_the_journal_is_refused_while_the_first_has_it_open() {
    let (_directory, path) = journal_path();
    let journal = Journal::create(&path, Value::Null).unwrap();
    assert!(matches!(Journal::resume(&path), Err(JournalError::Busy)));
    // Reading disturbs nobody.
    assert!(Recorded::read(&path).is_ok());
    drop(journal);
    assert!(Journal::resume(&path).is_ok());
}

#[test]
fn a_journal_that_is_there_already_is_refused_and_left_alone() {
    let (_directory, path) = journal_path();
    fs::write(&path, "a run of hours\n").unwrap();
    let error = Journal::create(&path, Value::Null).unwrap_err();
    let JournalError::Io(error) = error else {
        panic!("{error}")
    };
    assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
    assert!(matches!(
        Journal::resume(&path),
        Err(JournalError::Damaged(1))
    ));
    assert_eq!(fs::read_to_string(&path).unwrap(), "a run of hours\n");
}

#[test]
fn a_journal_that_is_not_there_is_an_error() {
    let (directory, path) = journal_path();
    let not_there = |error| match error {
        JournalError::Io(error) => error.kind() == io::ErrorKind::NotFound,
        _ => false,
    };
    assert!(not_there(Journal::resume(&path).unwrap_err()));
    assert!(not_there(Recorded::read(&path).unwrap_err()));
    let none = directory.path().join("none/evals.jsonl");
    assert!(not_there(Journal::create(&none, Value::Null).unwrap_err()));
}

/// A short journal's bytes, and its lines after the first.
fn sample(path: &std::path::Path) -> (Vec<u8>, Vec<Line>) {
    let lines = vec![
        new(0, Origin::Random, Some(1.5)),
        new(1, Origin::Random, None),
        Line::Duplicate {
            candidate: identity(2, Origin::Crossover { parents: [1, 0] }),
        },
        again(0, Some(1.25)),
    ];
    let mut journal = Journal::create(path, json!({"seed": 1})).unwrap();
    journal.append(&lines[..2]).unwrap();
    journal.append(&lines[2..]).unwrap();
    (fs::read(path).unwrap(), lines)
}

/// A place for a journal, which lasts as long as the directory's handle.
fn journal_path() -> (TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("evals.jsonl");
    (directory, path)
}

fn identity(id: u64, origin: Origin) -> Identity {
    Identity {
        id,
        generation: 7,
        origin,
        source: "5eed".into(),
    }
}

fn new(id: u64, origin: Origin, fitness: Option<f64>) -> Line {
    Line::New {
        candidate: identity(id, origin),
        evaluation: evaluation(fitness),
    }
}

fn again(id: u64, fitness: Option<f64>) -> Line {
    Line::Again {
        id,
        generation: 8,
        source: "5eed".into(),
        evaluation: evaluation(fitness),
    }
}

fn evaluation(fitness: Option<f64>) -> Evaluation {
    Evaluation {
        fitness,
        uncertainty: 0.01,
        costs: vec![0.1, 0.0],
        code: None,
        details: json!({"seconds": [0.5, 4.0], "note": "two\nlines"}),
    }
}

/// Numbers whose shortest decimals need every bit to be read back.
fn awkward_numbers() -> Vec<f64> {
    let extremes = [f64::MIN_POSITIVE, f64::MAX, 5e-324, 1.0 / 3.0, 1e23];
    let quotients = (1..200).map(|n| f64::from(n).sqrt() / 7e-11);
    extremes.into_iter().chain(quotients).collect()
}

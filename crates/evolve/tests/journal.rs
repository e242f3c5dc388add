//! The journal of a run: what a line says, and that none is ever lost.

use std::fs;
use std::io;
use std::path::PathBuf;

use evolve::{Evaluation, Individual, Journal, Line, Origin};
use program::{Genome, appendix, kensler_shirley};
use serde_json::{Value, json};
use tempfile::TempDir;

#[test]
fn a_line_of_a_random_individual_says_what_became_of_it() {
    let lines = written(&[individual(3, Origin::Random, Some(0.25))]);
    let expected = json!({
        "id": 3,
        "generation": 7,
        "again": false,
        "operator": "random",
        "source": "5eed",
        "fitness": 0.25,
        "uncertainty": 0.01,
        "details": {"seconds": [0.5, 4.0], "note": "two\nlines"},
    });
    assert_eq!(lines.parse::<Value>().unwrap(), expected);
}

#[test]
fn a_line_of_offspring_names_its_parents() {
    let origin = Origin::Crossover { parents: [4, 2] };
    let line: Value = written(&[individual(9, origin, None)]).parse().unwrap();
    assert_eq!(line["operator"], "crossover");
    assert_eq!(line["parents"], json!([4, 2]));
    assert_eq!(line["fitness"], Value::Null);
}

#[test]
fn lines_are_read_back_as_they_were_written() {
    let origins = [
        Origin::Random,
        Origin::Crossover {
            parents: [u64::MAX, 0],
        },
    ];
    let mut individuals = Vec::new();
    for (id, fitness) in awkward_numbers().into_iter().enumerate() {
        let fitness = (id % 5 != 4).then_some(fitness);
        individuals.push(individual(id as u64, origins[id % 2], fitness));
    }
    let text = written(&individuals);
    assert_eq!(text.lines().count(), individuals.len());
    assert!(text.ends_with('\n'));
    for (line, individual) in text.lines().zip(individuals) {
        let expected = Line {
            id: individual.id,
            generation: 7,
            again: false,
            origin: individual.origin,
            evaluation: individual.evaluation,
        };
        assert_eq!(serde_json::from_str::<Line>(line).unwrap(), expected);
    }
}

#[test]
fn a_line_that_is_cut_off_or_lies_about_its_origin_is_refused() {
    let origin = Origin::Crossover { parents: [4, 2] };
    let text = written(&[individual(9, origin, Some(1.5))]);
    let line = text.trim_end();
    for cut in 0..line.len() {
        assert!(serde_json::from_str::<Line>(&line[..cut]).is_err(), "{cut}");
    }
    for (part, other) in [
        ("\"crossover\"", "\"mutation\""),
        ("[4,2]", "[4]"),
        ("[4,2]", "[4,-2]"),
        ("\"parents\"", "\"ancestors\""),
        ("\"operator\"", "\"operators\""),
    ] {
        assert!(line.contains(part), "{line}");
        let line = line.replace(part, other);
        assert!(serde_json::from_str::<Line>(&line).is_err(), "{line}");
    }
}

#[test]
fn a_journal_that_is_there_already_is_refused_and_left_alone() {
    let (_directory, path) = journal_path();
    fs::write(&path, "a run of hours\n").unwrap();
    let error = Journal::create(&path).unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
    assert_eq!(fs::read_to_string(&path).unwrap(), "a run of hours\n");
}

#[test]
fn a_directory_that_is_not_there_is_an_error() {
    let (directory, _) = journal_path();
    let error = Journal::create(&directory.path().join("none/evals.jsonl")).unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::NotFound);
}

#[test]
fn generations_go_to_the_end_and_are_there_before_the_next() {
    let (_directory, path) = journal_path();
    let mut journal = Journal::create(&path).unwrap();
    let mut before = String::new();
    for generation in 0..4 {
        let pair = [0, 1].map(|twin| {
            let id = 2 * generation as u64 + twin;
            individual(id, Origin::Random, Some(1.0))
        });
        journal.append(generation, &pair, &[]).unwrap();
        let now = fs::read_to_string(&path).unwrap();
        let appended: Vec<Line> = now
            .strip_prefix(&before)
            .unwrap()
            .lines()
            .map(line)
            .collect();
        let said = appended.iter().map(|line| (line.generation, line.id));
        assert!(said.eq(pair.iter().map(|individual| (generation, individual.id))));
        before = now;
    }
    journal.append(4, &[], &[]).unwrap();
    drop(journal);
    assert_eq!(fs::read_to_string(&path).unwrap(), before);
}

#[test]
fn who_is_judged_again_has_a_line_again() {
    let (_directory, path) = journal_path();
    let mut journal = Journal::create(&path).unwrap();
    let first = individual(3, Origin::Random, Some(2.0));
    let again = individual(3, Origin::Random, Some(1.5));
    journal.append(0, &[first], &[again]).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let said: Vec<(u64, bool, Option<f64>)> = text
        .lines()
        .map(line)
        .map(|line| (line.id, line.again, line.evaluation.fitness))
        .collect();
    assert_eq!(said, [(3, false, Some(2.0)), (3, true, Some(1.5))]);
}

#[test]
fn what_somebody_else_appends_is_not_overwritten() {
    let (_directory, path) = journal_path();
    let mut journal = Journal::create(&path).unwrap();
    journal
        .append(0, &[individual(0, Origin::Random, None)], &[])
        .unwrap();
    let first = fs::read_to_string(&path).unwrap();
    fs::write(&path, first.clone() + "by somebody else\n").unwrap();
    journal
        .append(1, &[individual(1, Origin::Random, None)], &[])
        .unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.starts_with(&(first + "by somebody else\n")), "{text}");
    assert_eq!(line(text.lines().last().unwrap()).id, 1);
}

/// The journal of one generation, number 7.
fn written(individuals: &[Individual]) -> String {
    let (_directory, path) = journal_path();
    let mut journal = Journal::create(&path).unwrap();
    journal.append(7, individuals, &[]).unwrap();
    fs::read_to_string(&path).unwrap()
}

/// A place for a journal, which lasts as long as the directory's handle.
fn journal_path() -> (TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("evals.jsonl");
    (directory, path)
}

fn line(text: &str) -> Line {
    serde_json::from_str(text).unwrap()
}

fn individual(id: u64, origin: Origin, fitness: Option<f64>) -> Individual {
    let graph = kensler_shirley();
    let genome: Genome = appendix(&graph);
    Individual {
        id,
        origin,
        program: graph.program(&genome).unwrap(),
        genome,
        evaluation: Evaluation {
            source: "5eed".into(),
            fitness,
            uncertainty: 0.01,
            details: json!({"seconds": [0.5, 4.0], "note": "two\nlines"}),
        },
    }
}

/// Numbers whose shortest decimals need every bit to be read back.
fn awkward_numbers() -> Vec<f64> {
    let extremes = [f64::MIN_POSITIVE, f64::MAX, 5e-324, 1.0 / 3.0, 1e23];
    let quotients = (1..200).map(|n| f64::from(n).sqrt() / 7e-11);
    extremes.into_iter().chain(quotients).collect()
}

//! Bad input gets one clear sentence and exit code 2, and nothing is written.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn xtask(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask"))
        .args(arguments)
        .output()
        .expect("the command under test runs")
}

/// The one sentence that the command has to say.
fn refusal(arguments: &[&str]) -> String {
    let output = xtask(arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(!said.contains("panicked"), "{said}");
    said
}

#[test]
fn each_wrong_flag_of_evolve_has_its_sentence() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("run");
    let cases: [(&[&str], &[&str]); 14] = [
        (
            &["--scene", "sponza"],
            &["unknown scene", "sponza", "packet, common-origin"],
        ),
        (&["--isa", "avx9"], &["unknown ISA", "avx9", "sse2"]),
        (
            &["--bounds", "coordinates=4"],
            &["bounds without edge", "coordinates=LENGTH"],
        ),
        (
            &["--bounds", "coordinates=4,edge=-1"],
            &["edge=-1", "no part of bounds"],
        ),
        (
            &["--bounds", "coordinates=2,edge=0.001"],
            &["the origin of ray", "out of bounds", "or none"],
        ),
        (
            &["--regime", "growing"],
            &["unknown regime", "growing", "leaf"],
        ),
        (
            &["--strategy", "magic"],
            &["magic", "no strategy", "paper", "memetic"],
        ),
        (
            &["--population", "20", "--elite", "20"],
            &["elite of 20", "population of 20"],
        ),
        (
            &["--population", "21", "--elite", "20"],
            &["1 offspring", "pairs"],
        ),
        (&["--population", "0"], &["population of 0"]),
        (&["--islands", "0"], &["0 islands", "at least 1"]),
        (&["--evaluations", "0"], &["0 evaluations"]),
        (&["--budget", "-1"], &["--budget", "negative"]),
        (
            &["--graph", "nowhere.json"],
            &["nowhere.json", "cannot read"],
        ),
    ];
    for (flags, phrases) in cases {
        let out = out.to_str().unwrap();
        let said = refusal(&[&["evolve", "--out", out], flags].concat());
        assert_eq!(said.lines().count(), 1, "{said}");
        for phrase in phrases {
            assert!(said.contains(phrase), "{phrase:?} is not in {said:?}");
        }
    }
    assert!(!out.exists(), "nothing is written");
}

#[test]
fn numbers_that_are_none_are_refused_by_the_flags_themselves() {
    for flags in [
        ["--population", "-1"],
        ["--seed", "many"],
        ["--generations", "1.5"],
    ] {
        assert!(refusal(&[&["evolve"], &flags[..]].concat()).contains(flags[0]));
    }
}

#[test]
fn a_broken_graph_is_refused_by_name() {
    let directory = tempfile::tempdir().unwrap();
    let graph = directory.path().join("broken.json");
    let whole = fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../dag/kensler-shirley.json"),
    );
    let whole = whole.unwrap();
    for text in [
        "",
        "{}",
        "[]",
        &whole[..whole.len() / 2],
        &whole.replace("near.signs", "near.sings"),
    ] {
        fs::write(&graph, text).unwrap();
        let path = graph.to_str().unwrap();
        let out = directory.path().join("run");
        let said = refusal(&["evolve", "--graph", path, "--out", out.to_str().unwrap()]);
        assert!(said.contains(path) && said.lines().count() == 1, "{said}");
        assert!(!out.exists());
    }
}

#[test]
fn a_place_that_cannot_hold_a_run_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("file");
    fs::write(&file, "mine").unwrap();
    let below_a_file = file.join("run");
    let said = refusal(&["evolve", "--out", below_a_file.to_str().unwrap()]);
    assert!(
        said.contains("--out") && said.lines().count() == 1,
        "{said}"
    );
    let said = refusal(&["evolve", "--out", directory.path().to_str().unwrap()]);
    assert!(said.contains("not empty"), "{said}");
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
}

#[test]
fn a_run_that_cannot_go_on_is_refused_and_left_as_it_is() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().to_str().unwrap();
    let journal = directory.path().join("evals.jsonl");
    for flag in ["--resume", "--replay"] {
        let said = refusal(&["evolve", flag, path]);
        assert!(said.contains("evals.jsonl: No such file"), "{said}");
        for (text, phrase) in [
            ("", "no whole line"),
            ("{\"line\":\"run\"", "no whole line"),
            ("{\"line\":\"run\"}\n", "line 1 is damaged"),
        ] {
            fs::write(&journal, text).unwrap();
            let said = refusal(&["evolve", flag, path]);
            assert!(said.contains(phrase) && said.lines().count() == 1, "{said}");
            assert_eq!(fs::read_to_string(&journal).unwrap(), text);
        }
        fs::remove_file(&journal).unwrap();
    }
    // A run goes on with its own flags.
    let said = refusal(&["evolve", "--resume", path, "--seed", "2"]);
    assert!(said.contains("--seed"), "{said}");
}

#[test]
fn an_unknown_kernel_is_refused_with_those_that_are_known() {
    let said = refusal(&["bench", "--kernel", "fastest"]);
    assert!(said.contains("fastest") && said.contains("kensler-shirley"));
}

#[test]
fn what_cannot_be_judged_is_refused() {
    let said = refusal(&["accuracy", "--scene", "shadow"]);
    assert!(said.contains("shadow") && said.contains("can be judged"));
    let said = refusal(&["accuracy", "--samples", "many"]);
    assert!(said.contains("not a number"));
}

#[test]
fn an_unknown_axis_is_refused_with_those_that_are_known() {
    let said = refusal(&["scaling", "--scene", "single", "--axis", "rays"]);
    assert!(said.contains("\"rays\"") && said.contains("triangles, hits, cores"));
    let said = refusal(&["scaling", "--kernel", "fastest"]);
    assert!(said.contains("fastest") && said.contains("kensler-shirley"));
}

#[test]
fn an_unknown_regime_is_refused_with_those_that_are_known() {
    let said = refusal(&["bench", "--regime", "growing"]);
    assert!(said.contains("growing") && said.contains("shrinking, fixed, leaf"));
}

/// It would be left out of every table without a word.
#[test]
fn a_champion_that_no_scene_asked_for_is_like_is_refused() {
    let appendix = concat!(env!("CARGO_MANIFEST_DIR"), "/../dag/appendix.json");
    let said = refusal(&["bench", "--scene", "single", appendix]);
    assert!(
        said.contains("appendix.json was bred for the scene packet"),
        "{said}"
    );
}

#[test]
fn promoting_and_timing_what_is_no_run_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().to_str().unwrap();
    for command in ["promote", "bench"] {
        assert!(refusal(&[command, path]).contains("champion.json"));
    }
    fs::write(
        directory.path().join("champion.json"),
        "{\"name\": \"../../x\"}",
    )
    .unwrap();
    for command in ["promote", "bench"] {
        assert!(refusal(&[command, path]).contains("not a recipe"));
    }
}

#[test]
fn a_page_of_what_is_no_run_is_refused_and_none_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().to_str().unwrap();
    let said = refusal(&["report", path]);
    assert!(said.contains("no run directory"), "{said}");
    let said = refusal(&["report", "--no-timing", "nowhere"]);
    assert!(said.contains("nowhere is no run directory"), "{said}");
    let journal = directory.path().join("evals.jsonl");
    fs::write(&journal, "{\"line\":\"run\"}\n").unwrap();
    let said = refusal(&["report", path]);
    assert!(said.contains("line 1 is damaged"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    let said = refusal(&["report", path, "--scene", "packet"]);
    assert!(said.contains("--scene"), "{said}");
    assert!(refusal(&["report", "--no-timing"]).contains("RUN_DIR"));
    assert!(!directory.path().join("report.html").exists());
}

#[test]
fn a_scene_model_that_is_none_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("mine.json");
    let scene = path.to_str().unwrap();
    let model = r#"{"name": "mine", "grouping": "packet", "origin": "common", "numeric": "fast"}"#;
    let cases = [
        (
            model.replace("common", "anywhere"),
            "unknown variant `anywhere`",
        ),
        (
            model.replace("\"fast\"", "\"fast\", \"cullling\": \"back\""),
            "unknown field `cullling`",
        ),
        (
            model.replace("\"name\": \"mine\", ", ""),
            "missing field `name`",
        ),
        (model.replace("packet", "single"), "there is only one ray"),
        (
            model.replace("\"mine\"", "\"../mine\""),
            "is not of [a-z0-9._-]",
        ),
        ("packet".to_owned(), "not a scene model"),
    ];
    for (text, phrase) in cases {
        fs::write(&path, &text).unwrap();
        for command in ["evolve", "bench"] {
            let said = refusal(&[command, "--scene", scene]);
            assert!(
                said.contains(phrase) && said.contains("mine.json"),
                "{said}"
            );
        }
    }
    // The scene is read; it is the flag behind it that is wrong.
    fs::write(&path, model).unwrap();
    let said = refusal(&["bench", "--scene", scene, "--isa", "avx9"]);
    assert!(said.contains("unknown ISA"), "{said}");
}

#[test]
fn each_wrong_flag_of_opcount_has_its_sentence() {
    let cases: [(&[&str], &str); 7] = [
        (&["--case", "beam"], "beam"),
        (&["--packet-size", "0"], "--packet-size"),
        (&["--amortise", "moon"], "moon"),
        (&["--model", "ports", "--ports", "mul"], "like mul+add=2"),
        (&["--kernel", "nowhere.json"], "nowhere.json"),
        (&["--improve", "nowhere.json"], "nowhere.json"),
        (&["--untimed"], "--improve"),
    ];
    for (flags, phrase) in cases {
        let said = refusal(&[&["opcount"], flags].concat());
        assert!(said.contains(phrase), "{flags:?}: {said}");
    }
}

#[test]
fn each_wrong_flag_of_compare_strategies_has_its_sentence() {
    let cases: [(&[&str], &str); 5] = [
        (&["--seeds", "0"], "--seeds 0"),
        (&["--strategies", "paper,magic"], "magic"),
        (&["--strategies", "guided:0"], "number of islands"),
        (&["--evaluations", "0"], "0 evaluations"),
        (&["--isa", "avx9"], "unknown ISA"),
    ];
    for (flags, phrase) in cases {
        let said = refusal(&[&["compare-strategies"], flags].concat());
        assert!(said.contains(phrase), "{flags:?}: {said}");
    }
}

#[test]
fn every_command_explains_itself_with_an_example() {
    for command in [
        "evolve",
        "compare-strategies",
        "opcount",
        "bench",
        "scaling",
        "accuracy",
        "report",
        "promote",
        "emit",
        "dag",
    ] {
        let output = xtask(&[command, "--help"]);
        assert!(output.status.success());
        let help = String::from_utf8(output.stdout).unwrap();
        let example = format!("cargo xtask {command}");
        assert!(
            help.contains("Example") && help.contains(&example),
            "{help}"
        );
    }
}

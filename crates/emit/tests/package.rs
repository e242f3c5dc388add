//! The emitted part of the published package: written, checked, and never over what somebody
//! wrote by hand. Without rustfmt nothing can be emitted, and these tests say so and pass.

mod sample;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use emit::{
    Difference, Isa, MARKER, Name, Package, PackageError, Recipe, RustfmtError, package, rules,
};
use program::{Genome, kensler_shirley};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sample::{recipe, stability};
use scene::{Culling, Query, Range, SceneModel};
use tempfile::TempDir;

/// The package of two recipes, unless there is no rustfmt.
static PACKAGE: LazyLock<Option<Package>> =
    LazyLock::new(|| emitted(&[recipe("first"), recipe("second-2.0")]));

const KERNEL: &str = "kernels/sse2/second_2_0.rs";

#[test]
fn what_was_written_needs_no_change() {
    let Some((package, src)) = written() else {
        return;
    };
    assert_eq!(package.check(src.path()).unwrap(), []);
    let before = files(src.path());
    assert_eq!(package.write(src.path()).unwrap(), []);
    assert_eq!(files(src.path()), before);
}

#[test]
fn the_package_holds_a_file_for_every_kernel_and_what_binds_them() {
    let Some((_, src)) = written() else { return };
    let paths: Vec<String> = files(src.path()).into_keys().collect();
    let expected = [
        "catalogue.rs",
        "kernels/choice.rs",
        "kernels/mod.rs",
        "kernels/sse2/first.rs",
        "kernels/sse2/lanes.rs",
        "kernels/sse2/mod.rs",
        "kernels/sse2/second_2_0.rs",
    ];
    assert_eq!(paths, expected);
}

#[test]
fn what_was_bred_for_more_than_a_caller_can_count_on_is_refused() {
    let scenes: [fn(&mut SceneModel); 4] = [
        |scene| scene.query = Query::Any,
        |scene| scene.culling = Culling::Back,
        |scene| scene.range = Range::Segment,
        |scene| scene.bounds = Some("coordinates=100,edge=0.01".parse().unwrap()),
    ];
    for change in scenes {
        let mut other = recipe("other");
        change(&mut other.scene);
        let error = package(&[other]).map(drop).unwrap_err();
        assert!(matches!(error, PackageError::NotPlain(_)), "{error}");
    }
}

#[test]
fn an_instruction_set_at_the_end_of_a_name_is_the_module() {
    let Some(package) = emitted(&[
        recipe("packet-leaf-sse2"),
        of(Isa::Avx2, "packet-leaf-avx2"),
    ]) else {
        return;
    };
    let src = TempDir::new().unwrap();
    package.write(src.path()).unwrap();
    let files = files(src.path());
    assert!(files["kernels/sse2/packet_leaf.rs"].contains("from recipes/packet-leaf-sse2.json"));
    assert!(files["kernels/avx2/mod.rs"].contains("pub use packet_leaf::packet_leaf;"));
}

#[test]
fn a_requirement_is_served_by_the_fastest_that_keeps_it() {
    let edges = |name, ratio| {
        let graph = kensler_shirley()
            .restricted(&rules(&of_edges(), &Isa::ALL))
            .unwrap();
        let genome = Genome::random(graph.nodes().len(), &mut ChaCha8Rng::seed_from_u64(1));
        let mut recipe = recipe(name);
        recipe.program = graph.program(&genome).unwrap();
        recipe.scene = of_edges();
        with_ratio(recipe, ratio)
    };
    let of_scalar = with_ratio(of(Isa::Scalar, "fast-scalar"), 2.0);
    let mut edges_of_scalar = edges("tight-scalar", 1.0);
    edges_of_scalar.isas = vec![Isa::Scalar];
    let recipes = [
        of_scalar,
        edges_of_scalar,
        with_ratio(recipe("slow-sse2"), 1.5),
        with_ratio(recipe("fast-sse2"), 2.0),
        edges("tight-sse2", 1.7),
    ];
    let Some(package) = emitted(&recipes) else {
        return;
    };
    let src = TempDir::new().unwrap();
    package.write(src.path()).unwrap();
    let choice = &files(src.path())["kernels/choice.rs"];
    // What was bred on long lists serves those first; nobody is wider than SSE2, and nobody portable or full.
    expect_test::expect![[r#"
        packet fn packet, packet_name {
        Fast No Short:
        scalar::fast
        sse2::fast
        sse2::fast
        sse2::fast
        sse2::fast;
        Fast No Long:
        scalar::fast
        sse2::fast
        sse2::fast
        sse2::fast
        sse2::fast;
        Fast Edges Short:
        scalar::tight
        sse2::tight
        sse2::tight
        sse2::tight
        sse2::tight;
        Fast Edges Long:
        scalar::tight
        sse2::tight
        sse2::tight
        sse2::tight
        sse2::tight;
        }
    "#]]
    .assert_eq(&section(choice, "packet fn packet,"));
}

#[test]
fn what_the_accuracy_lab_found_is_said_of_the_kernel_and_in_the_catalogue() {
    let mut judged = recipe("judged-1.0");
    judged.stability = Some(stability());
    let Some(package) = emitted(&[judged, recipe("unjudged")]) else {
        return;
    };
    let src = TempDir::new().unwrap();
    package.write(src.path()).unwrap();
    let files = files(src.path());
    let docs = &files["kernels/sse2/judged_1_0.rs"];
    for line in [
        "/// - rays at shared edges that go through: 12.5% of 80000\n",
        "/// - rays at shared vertices that go through: none of 40000\n",
        "/// - rays at either that hit twice: 25.0% of 120000\n",
        "included: p99.99 3.0e-7\n",
        "/// - safe scales: everything times 2^-19 to 2^20 changes no verdict, nor t\n",
    ] {
        assert!(docs.contains(line), "{line}");
    }
    assert!(!files["kernels/sse2/unjudged.rs"].contains("scales"));
    let catalogue = &files["catalogue.rs"];
    assert!(catalogue.contains("scale: (-19, 20)") && catalogue.contains("stability: None"));
}

#[test]
fn the_first_line_of_every_file_is_marked_and_names_its_source() {
    let Some((_, src)) = written() else { return };
    let files = files(src.path());
    for (path, text) in &files {
        assert!(text.starts_with(MARKER), "{path}");
    }
    let first_line = files[KERNEL].lines().next().unwrap();
    assert!(
        first_line.contains("recipes/second-2.0.json"),
        "{first_line}"
    );
}

#[test]
fn a_missing_an_extra_and_a_changed_file_are_reported_and_put_right() {
    let Some((package, src)) = written() else {
        return;
    };
    let right = files(src.path());
    fs::remove_file(src.path().join("catalogue.rs")).unwrap();
    put(
        &src,
        "kernels/sse2/stale.rs",
        &format!("{MARKER} from recipes/stale.json\n"),
    );
    put(&src, "kernels/avx9/lanes.rs", &format!("{MARKER}\n"));
    put(&src, KERNEL, &(right[KERNEL].clone() + "// faster\n"));

    let found = package.check(src.path()).unwrap();
    let expected = [
        Difference::Missing("catalogue.rs".into()),
        Difference::Different(KERNEL.into()),
        Difference::Extra("kernels/avx9/lanes.rs".into()),
        Difference::Extra("kernels/sse2/stale.rs".into()),
    ];
    assert_eq!(found, expected);
    let said: Vec<String> = found.iter().map(Difference::to_string).collect();
    assert_eq!(said[0], "missing    catalogue.rs");

    assert_eq!(package.write(src.path()).unwrap(), expected);
    assert_eq!(files(src.path()), right);
}

#[test]
fn to_check_changes_nothing() {
    let Some(package) = &*PACKAGE else { return };
    let src = tempfile::tempdir().unwrap();
    put(&src, "kernels/sse2/stale.rs", MARKER);
    let before = files(src.path());
    assert_eq!(package.check(src.path()).unwrap().len(), 8);
    assert_eq!(files(src.path()), before);
}

#[test]
fn files_by_hand_are_left_alone_wherever_they_are() {
    let Some((package, src)) = written() else {
        return;
    };
    let by_hand = ["lib.rs", "kernels/notes.md", "kernels/sse2/mine.rs"];
    for path in by_hand {
        put(&src, path, "// By hand.\n");
    }
    put(&src, "marked_but_elsewhere.rs", MARKER);
    assert_eq!(package.write(src.path()).unwrap(), []);
    let files = files(src.path());
    assert!(by_hand.iter().all(|&path| files[path] == "// By hand.\n"));
    assert_eq!(files["marked_but_elsewhere.rs"], MARKER);
}

#[test]
fn a_file_by_hand_in_the_way_is_an_error_and_nothing_is_written() {
    let Some(package) = &*PACKAGE else { return };
    for text in [
        "fn by_hand() {}\n",
        "",
        " // @generated by `cargo xtask emit`",
    ] {
        let src = tempfile::tempdir().unwrap();
        put(&src, KERNEL, text);
        put(&src, "kernels/sse2/stale.rs", MARKER);
        let before = files(src.path());
        let error = package.write(src.path()).unwrap_err();
        assert!(matches!(&error, PackageError::InTheWay(path) if path.ends_with(KERNEL)));
        assert!(error.to_string().contains("second_2_0.rs"), "{error}");
        assert_eq!(files(src.path()), before);
    }
}

#[test]
fn a_directory_in_the_way_is_an_error_and_nothing_is_written() {
    let Some(package) = &*PACKAGE else { return };
    let src = tempfile::tempdir().unwrap();
    fs::create_dir_all(src.path().join(KERNEL)).unwrap();
    assert!(matches!(
        package.write(src.path()),
        Err(PackageError::Io { .. })
    ));
    assert_eq!(files(src.path()), BTreeMap::new());
}

#[test]
fn recipes_in_any_order_make_the_same_files() {
    let [a, b, c] = ["a", "b", "c"].map(recipe);
    let forwards = [a.clone(), b.clone(), c.clone()];
    let Some(forwards) = emitted(&forwards) else {
        return;
    };
    let src = tempfile::tempdir().unwrap();
    forwards.write(src.path()).unwrap();
    for recipes in [[c.clone(), b.clone(), a.clone()], [b, c, a]] {
        let Some(package) = emitted(&recipes) else {
            return;
        };
        assert_eq!(package.check(src.path()).unwrap(), []);
    }
}

#[test]
fn recipes_that_would_be_one_file_are_refused() {
    for names in [
        &["a", "a"][..],
        &["a-b", "a_b"],
        &["a-b", "a.a", "a_b"],
        &["1", "_1"],
    ] {
        let recipes: Vec<Recipe> = names.iter().map(|name| recipe(name)).collect();
        let error = package(&recipes).map(drop).unwrap_err();
        assert!(
            matches!(error, PackageError::SameName(_)),
            "{names:?}: {error}"
        );
    }
}

#[test]
fn a_kernel_does_not_take_the_name_of_what_stands_beside_it() {
    for name in ["lanes", "mod", "store", "is_empty"] {
        let error = package(&[recipe(name)]).map(drop).unwrap_err();
        assert!(
            matches!(error, PackageError::SameName(_)),
            "{name}: {error}"
        );
    }
}

#[test]
fn no_recipes_make_an_empty_catalogue() {
    let Some(package) = emitted(&[]) else { return };
    let src = tempfile::tempdir().unwrap();
    package.write(src.path()).unwrap();
    let files = files(src.path());
    assert_eq!(files.len(), 3);
    assert!(files["catalogue.rs"].contains("CATALOGUE: &[Entry] = &[];"));
}

#[test]
fn what_a_machine_says_of_itself_is_emitted_as_a_plain_name_in_a_comment() {
    let mut hostile = recipe("hostile");
    hostile.provenance.as_mut().unwrap().cpu = Name::of("x\n*/ pub fn evil() {} // \u{1b}[2J");
    let Some(package) = emitted(&[hostile]) else {
        return;
    };
    let src = tempfile::tempdir().unwrap();
    package.write(src.path()).unwrap();
    let mut said = Vec::new();
    for text in files(src.path()).values() {
        said.extend(
            text.lines()
                .filter(|line| line.contains("evil"))
                .map(str::to_owned),
        );
    }
    assert_eq!(said, ["//! Timed on x-pub-fn-evil-2j with rustc 1.89.0."]);
}

/// The same recipe for another instruction set.
fn of(isa: Isa, name: &str) -> Recipe {
    let mut recipe = recipe(name);
    recipe.isas = vec![isa];
    recipe
}

/// The same recipe, timed otherwise.
fn with_ratio(mut recipe: Recipe, ratio: f64) -> Recipe {
    recipe.provenance.as_mut().unwrap().ratio = ratio;
    recipe
}

/// What is tight at edges.
fn of_edges() -> SceneModel {
    SceneModel::preset("packet-edges").unwrap()
}

/// The lines from one that holds `head` to the next brace alone, as if there were no indentation.
fn section(text: &str, head: &str) -> String {
    let lines = text
        .lines()
        .map(str::trim)
        .skip_while(|line| !line.contains(head));
    let section: Vec<&str> = lines.take_while(|line| *line != "}").collect();
    section.join("\n") + "\n}\n"
}

/// The package, or none if there is no rustfmt.
fn emitted(recipes: &[Recipe]) -> Option<Package> {
    match package(recipes) {
        Err(PackageError::Rustfmt(RustfmtError::Missing(error))) => {
            eprintln!("skipped: emitting needs rustfmt, which is not there ({error})");
            None
        }
        package => Some(package.unwrap()),
    }
}

/// The package of two recipes and where it has been written.
fn written() -> Option<(&'static Package, TempDir)> {
    let package = PACKAGE.as_ref()?;
    let src = tempfile::tempdir().unwrap();
    assert_eq!(package.write(src.path()).unwrap().len(), 7);
    Some((package, src))
}

fn put(src: &TempDir, path: &str, text: &str) {
    let path = src.path().join(path);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

/// Every file below `src` by its path there.
fn files(src: &Path) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let mut directories = vec![PathBuf::new()];
    while let Some(directory) = directories.pop() {
        for entry in fs::read_dir(src.join(&directory)).unwrap() {
            let entry = entry.unwrap();
            let path = directory.join(entry.file_name());
            if entry.file_type().unwrap().is_dir() {
                directories.push(path);
            } else {
                let text = fs::read_to_string(entry.path()).unwrap();
                found.insert(path.to_str().unwrap().to_owned(), text);
            }
        }
    }
    found
}

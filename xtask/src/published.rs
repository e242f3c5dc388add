//! Rivals that others have published as crates: built as a library when they are to be timed, and loaded by
//! the worker like any other. Nothing else of this repository waits for them to compile.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use emit::{InLibrary, Isa, Kernel};
use rivals::published::{Published, all};
use scene::{Grouping, Query, Regime};
use serde_json::Value;

use crate::arena::{Arena, Contestant};
use crate::files;
use crate::progress::with_spinner;

/// The library that all of them are in; none if it cannot be built, which is said on standard error.
pub fn build() -> Option<PathBuf> {
    let built = with_spinner("building the crates of others", || {
        let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
        let mut command = Command::new(cargo);
        command
            .args(["rustc", "--release", "--package", "rivals", "--lib"])
            .args(["--features", "published", "--crate-type", "cdylib"])
            .args(["--message-format", "json"])
            .current_dir(files::in_repository("."))
            .stdin(Stdio::null());
        command.output()
    });
    let output = match built {
        Ok(output) => output,
        Err(error) => return skipped(&error.to_string()),
    };
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let error = said.lines().find(|line| line.starts_with("error"));
        return skipped(error.unwrap_or("cargo failed"));
    }
    let lines = String::from_utf8_lossy(&output.stdout);
    let library = lines.lines().rev().find_map(library);
    library.or_else(|| skipped("cargo named no library"))
}

fn skipped(why: &str) -> Option<PathBuf> {
    let names: Vec<&str> = all().iter().map(|one| one.name).collect();
    eprintln!("skipped: {}: {why}", names.join(", "));
    None
}

/// The library of which a line of cargo's tells that it was made.
fn library(line: &str) -> Option<PathBuf> {
    let message: Value = serde_json::from_str(line).ok()?;
    if message["reason"] != "compiler-artifact" || message["target"]["name"] != "rivals" {
        return None;
    }
    let files = message["filenames"].as_array()?.iter();
    let mut files = files.filter_map(|file| file.as_str().map(PathBuf::from));
    files.find(|file| {
        file.extension()
            .is_some_and(|it| it == std::env::consts::DLL_EXTENSION)
    })
}

/// Whether any of them can take part: they take a ray and a triangle at a time.
pub fn take_part_in(arena: &Arena) -> bool {
    let scene = &arena.scene;
    arena.isas.0 == [Isa::Scalar]
        && matches!(scene.grouping, Grouping::Single | Grouping::Scalar)
        && scene.query == Query::Closest
        && !scene.has_hits()
        && scene.range == scene::Range::TMax
}

/// Those of the library that take part: all that see what the scene wants to be seen, and in scenes that see
/// both sides also those that do not.
pub fn contestants(library: &Path, arena: &Arena) -> Vec<Contestant> {
    if !take_part_in(arena) {
        return Vec::new();
    }
    let scene = &arena.scene;
    let fixed = scene.regime == Regime::Fixed;
    let sees = |published: &Published| {
        scene.culling == scene::Culling::None || scene.culling == published.culling
    };
    let numbered = all().iter().enumerate();
    let numbered = numbered.filter(|(_, published)| sees(published));
    let contestants = numbered.map(|(place, published)| {
        let library = InLibrary {
            path: library.to_owned(),
            index: 2 * place + usize::from(fixed),
        };
        let kernel = Kernel::compiled(published.reference.to_owned(), library);
        Contestant {
            name: published.name.to_owned(),
            kernels: vec![match published.numbers {
                None => kernel,
                Some(numbers) => kernel.preparing(numbers, published.name),
            }],
        }
    });
    contestants.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_found_in_what_cargo_says() {
        let artifact = |name: &str, file: &str| {
            format!(
                r#"{{"reason":"compiler-artifact","target":{{"name":"{name}"}},"filenames":["{file}"]}}"#
            )
        };
        let file = format!(
            "target/release/librivals.{}",
            std::env::consts::DLL_EXTENSION
        );
        assert_eq!(
            library(&artifact("rivals", &file)),
            Some(file.clone().into())
        );
        assert_eq!(library(&artifact("bvh", &file)), None);
        assert_eq!(library(&artifact("rivals", "librivals.rlib")), None);
        assert_eq!(library("warning: not JSON"), None);
    }
}

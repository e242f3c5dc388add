//! Where things are in the repository, and how files are written.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;
use emit::Recipe;
use program::Graph;
use scene::SceneModel;
use serde::Serialize;
use serde_json::Value;

use crate::failure::bad_input;

/// A path in the repository that this program was built in.
pub fn in_repository(path: impl AsRef<Path>) -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask).join(path)
}

/// A checked-in graph.
pub fn graph_path(name: &str) -> PathBuf {
    in_repository(format!("dag/{name}.json"))
}

/// A graph from its file, with the first 16 digits of the file's hash.
pub fn read_graph(path: &Path) -> anyhow::Result<(Graph, emit::Name)> {
    let text = read(path)?;
    let graph = Graph::from_json(&text).map_err(|error| {
        let path = path.display();
        bad_input(format!("{path}: {error}; `cargo xtask dag` writes it anew"))
    })?;
    let hash = &blake3::hash(text.as_bytes()).to_hex()[..16];
    Ok((graph, emit::Name::of(hash)))
}

/// A scene model from its file.
pub fn read_scene(path: &Path) -> anyhow::Result<SceneModel> {
    let text = read(path)?;
    let scene: SceneModel = serde_json::from_str(&text).map_err(|error| {
        let path = path.display();
        bad_input(format!("{path}: not a scene model: {error}"))
    })?;
    scene
        .check()
        .map_err(|error| bad_input(format!("{}: {error}", path.display())))?;
    Ok(scene)
}

/// A recipe from its file.
pub fn read_recipe(path: &Path) -> anyhow::Result<Recipe> {
    let text = read(path)?;
    Recipe::from_json(&text).map_err(|error| bad_input(format!("{}: {error}", path.display())))
}

/// A recipe from its file, or the champion's from a run's directory.
pub fn read_champion(path: &Path) -> anyhow::Result<Recipe> {
    match path.is_dir() {
        true => read_recipe(&path.join("champion.json")),
        false => read_recipe(path),
    }
}

/// Every checked-in recipe, in order of their files' names.
pub fn read_recipes() -> anyhow::Result<Vec<Recipe>> {
    let directory = in_repository("generated/recipes");
    let mut paths = Vec::new();
    for entry in fs::read_dir(&directory).with_context(|| directory.display().to_string())? {
        let path = entry?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "json")
        {
            paths.push(path);
        }
    }
    paths.sort();
    paths.iter().map(|path| read_recipe(path)).collect()
}

fn read(path: &Path) -> anyhow::Result<String> {
    fs::read_to_string(path)
        .map_err(|error| bad_input(format!("cannot read {}: {error}", path.display())))
}

/// Writes a file as a whole or not at all: beside its place, synced, and then moved there.
pub fn write(path: &Path, text: &str) -> anyhow::Result<()> {
    let put = || -> io::Result<()> {
        // Of a bare name the parent is nothing, which is here.
        let parent = path.parent().filter(|parent| *parent != Path::new(""));
        let directory = parent.unwrap_or(Path::new("."));
        fs::create_dir_all(directory)?;
        let mut file = temporary_file(directory)?;
        file.write_all(text.as_bytes())?;
        file.as_file().sync_all()?;
        file.persist(path)?;
        fs::File::open(directory)?.sync_all()
    };
    put().with_context(|| format!("cannot write {}", path.display()))
}

/// A file that is to become another one, with the permissions of any that is made.
fn temporary_file(directory: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(directory)
}

/// Writes a value as JSON, as a whole or not at all.
pub fn write_json(path: &Path, value: &impl Serialize) -> anyhow::Result<()> {
    write(path, &(serde_json::to_string_pretty(value)? + "\n"))
}

/// Rows as CSV, below a line with the names of their fields. What is not there is left empty.
///
/// # Panics
///
/// If a row is no struct of plain values.
pub fn to_csv(rows: &[impl Serialize]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for (place, row) in rows.iter().enumerate() {
        // By way of JSON, for csv takes no struct that is part of another.
        let row = serde_json::to_value(row)?;
        let row = row.as_object().expect("a row has fields");
        if place == 0 {
            writer.write_record(row.keys())?;
        }
        writer.write_record(row.values().map(|value| match value {
            Value::Null => String::new(),
            Value::String(text) => text.clone(),
            value => value.to_string(),
        }))?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Row {
        #[serde(flatten)]
        of: Of,
        speed: f64,
        bytes: Option<usize>,
    }

    #[derive(Serialize)]
    struct Of {
        kernel: &'static str,
    }

    #[test]
    fn csv_has_a_line_a_row_below_the_names_and_leaves_empty_what_is_not_there() {
        let row = |kernel, speed, bytes| Row {
            of: Of { kernel },
            speed,
            bytes,
        };
        let csv = to_csv(&[row("wald", 1e-7, None), row("a,b", 2.0, Some(36))]).unwrap();
        assert_eq!(csv, "kernel,speed,bytes\nwald,1e-7,\n\"a,b\",2.0,36\n");
    }
}

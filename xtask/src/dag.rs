//! `cargo xtask dag`: the graphs as checked-in data.

use std::fs;

use program::{family_table, kensler_shirley};

use crate::failure::bad_input;
use crate::files;

/// Writes dag/kensler-shirley.json and prints its families.
///
/// The graph is built from the algebra of signed volumes; the file is what `evolve` reads. The
/// table in dag/README.md is kept true as well.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  cargo xtask dag --check")]
pub struct Dag {
    /// Only compare what is checked in with what would be written
    #[arg(long)]
    check: bool,
}

const TABLE_BEGINS: &str = "<!-- table of families: written by cargo xtask dag -->\n";
const TABLE_ENDS: &str = "<!-- end of table -->\n";

impl Dag {
    /// Writes or checks the graph's file and its table.
    pub fn run(self) -> anyhow::Result<()> {
        let graph = kensler_shirley();
        let table = family_table(&graph);
        let readme = files::in_repository("dag/README.md");
        let wanted = [
            (files::graph_path(), graph.to_json()),
            (
                readme.clone(),
                with_table(&fs::read_to_string(&readme)?, &table)?,
            ),
        ];
        print!("{table}");
        for (path, text) in wanted {
            let name = path
                .strip_prefix(files::in_repository(""))
                .unwrap_or(&path)
                .display();
            if fs::read_to_string(&path).is_ok_and(|found| found == text) {
                println!("{name} is up to date");
            } else if self.check {
                let todo = "run `cargo xtask dag` and commit what it writes";
                anyhow::bail!("{name} is not what would be written; {todo}");
            } else {
                files::write(&path, &text)?;
                println!("{name} written");
            }
        }
        Ok(())
    }
}

/// The text with the table between its two marks.
fn with_table(text: &str, table: &str) -> anyhow::Result<String> {
    let marked = text.split_once(TABLE_BEGINS).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(TABLE_ENDS)?;
        Some((before, after))
    });
    match marked {
        Some((before, after)) => Ok(format!(
            "{before}{TABLE_BEGINS}\n{table}\n{TABLE_ENDS}{after}"
        )),
        None => Err(bad_input(
            "dag/README.md has lost the marks around its table",
        )),
    }
}

//! `cargo xtask dag`: the graphs as checked-in data.

use std::fs;

use emit::{Isa, Name, Recipe};
use program::{Graph, appendix, family_table, kensler_shirley};
use scene::{Regime, SceneModel};

use crate::failure::bad_input;
use crate::files;

/// Writes dag/kensler-shirley.json and dag/appendix.json, and prints the graph's families.
///
/// The graph is built from the algebra of signed volumes; the file is what `evolve` reads. The
/// table in dag/README.md is kept true as well. The appendix is the paper's own kernel (GA+), a
/// program of the graph, as a recipe by hand.
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
                files::in_repository("dag/appendix.json"),
                appendix_recipe(&graph)?.to_json(),
            ),
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

/// The kernel of the paper's appendix as a recipe.
fn appendix_recipe(graph: &Graph) -> anyhow::Result<Recipe> {
    Ok(Recipe {
        name: Name::of("kensler-shirley-appendix"),
        scene: SceneModel::preset("packet")?,
        regime: Regime::Shrinking,
        isas: vec![Isa::Sse2],
        provenance: None,
        error: None,
        program: graph.program(&appendix(graph))?,
    })
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

//! `cargo xtask dag`: the graphs as checked-in data.

use std::fs;

use emit::{Isa, Name, Recipe};
use program::{CheckedIn, Graph, appendix, family_table, kensler_shirley};
use scene::SceneModel;

use crate::failure::bad_input;
use crate::files;

/// Writes the graphs of dag/ and dag/appendix.json, and prints the graphs' families.
///
/// The graphs are built from the algebra of signed volumes; the files are what `evolve` reads. The
/// tables in dag/README.md are kept true as well. The appendix is the paper's own kernel (GA+), a
/// program of the first graph, as a recipe by hand.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  cargo xtask dag --check")]
pub struct Dag {
    /// Only compare what is checked in with what would be written
    #[arg(long)]
    check: bool,
}

impl Dag {
    /// Writes or checks the graphs' files and their tables.
    pub fn run(self) -> anyhow::Result<()> {
        let graphs = CheckedIn::ALL.map(|one| (one.name(), one.graph()));
        let readme = files::in_repository("dag/README.md");
        let mut text = fs::read_to_string(&readme)?;
        let appendix = appendix_recipe(&kensler_shirley())?.to_json();
        let mut wanted = vec![(files::in_repository("dag/appendix.json"), appendix)];
        for (name, graph) in &graphs {
            let table = family_table(graph);
            println!("{name}\n\n{table}");
            text = with_table(&text, name, &table)?;
            let path = files::in_repository(format!("dag/{name}.json"));
            wanted.push((path, graph.to_json()));
        }
        wanted.push((readme, text));
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
        isas: vec![Isa::Sse2],
        provenance: None,
        error: None,
        stability: None,
        program: graph.program(&appendix(graph))?,
    })
}

/// The text with a graph's table between its two marks.
fn with_table(text: &str, graph: &str, table: &str) -> anyhow::Result<String> {
    let begins = format!("<!-- families of {graph}.json: written by cargo xtask dag -->\n");
    let ends = format!("<!-- end of {graph}.json -->\n");
    let marked = text.split_once(&begins).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(&ends)?;
        Some((before, after))
    });
    match marked {
        Some((before, after)) => Ok(format!("{before}{begins}\n{table}\n{ends}{after}")),
        None => Err(bad_input(format!(
            "dag/README.md has lost the marks around the table of {graph}.json"
        ))),
    }
}

//! The operations of whole kernels, divisions and tests included.

use std::io::{self, Write};
use std::path::PathBuf;

use emit::Recipe;
use serde_json::{Map, Value, json};
use volumes::{Case, Kind, Model, Rate};

use super::asked::Asked;
use crate::files;

/// A kernel, and what it is counted by.
pub struct Counted {
    recipe: Recipe,
    case: Case,
    model: Model,
    model_name: String,
}

/// Reads recipes, to be counted by what is asked for.
pub fn read(paths: &[PathBuf], asked: &Asked) -> anyhow::Result<Vec<Counted>> {
    let read = |path: &PathBuf| {
        let recipe = files::read_champion(path)?;
        Ok(Counted {
            case: asked.case_of(&recipe),
            model: asked.model()?,
            model_name: asked.model_name(),
            recipe,
        })
    };
    paths.iter().map(read).collect()
}

/// Prints a table with a line for every rate of every kernel.
pub fn print_text(mut out: impl Write, kernels: &[Counted]) -> io::Result<()> {
    let width = kernels.iter().map(|one| one.recipe.name.to_string().len());
    let width = width.max().unwrap_or(0).max(6);
    let kinds = Kind::ALL.map(|kind| format!("{:>5}", kind.name())).join("");
    writeln!(
        out,
        "{:width$}  {:15}{kinds}  {:>14}",
        "kernel", "rate", "cost"
    )?;
    for kernel in kernels {
        let program = &kernel.recipe.program;
        let operations = program.operations(kernel.case, kernel.model.fused);
        let counted = Rate::ALL.into_iter().zip(operations);
        for (rate, operations) in counted.filter(|(_, operations)| operations.total() > 0) {
            let counts = Kind::ALL.map(|kind| format!("{:5}", operations.count(kind)));
            let weighted = operations * kernel.case.weight(rate);
            let cost = kernel.case.cost(&kernel.model, weighted).to_string();
            let (name, rate) = (kernel.recipe.name.to_string(), rate.to_string());
            writeln!(
                out,
                "{name:width$}  {rate:15}{}  {cost:>14}",
                counts.join("")
            )?;
        }
        let cost = program.cost(kernel.case, &kernel.model).to_string();
        let all = format!("all, {}", kernel.model_name);
        let (name, blank) = (kernel.recipe.name.to_string(), " ".repeat(25));
        writeln!(out, "{name:width$}  {all:15}{blank}  {cost:>14}")?;
    }
    out.flush()
}

/// Prints a list with an object a kernel.
pub fn print_json(mut out: impl Write, kernels: &[Counted]) -> io::Result<()> {
    let kernels = kernels.iter().map(|kernel| {
        let program = &kernel.recipe.program;
        let operations = program.operations(kernel.case, kernel.model.fused);
        let rates = Rate::ALL
            .into_iter()
            .zip(operations)
            .map(|(rate, of_rate)| {
                let kinds =
                    Kind::ALL.map(|kind| (kind.name().to_owned(), json!(of_rate.count(kind))));
                (rate.to_string(), Value::Object(Map::from_iter(kinds)))
            });
        json!({
            "kernel": kernel.recipe.name,
            "model": kernel.model_name,
            "cost": program.cost(kernel.case, &kernel.model).operations(),
            "operations": Map::from_iter(rates),
        })
    });
    serde_json::to_writer_pretty(&mut out, &Value::Array(kernels.collect()))?;
    writeln!(out)?;
    out.flush()
}

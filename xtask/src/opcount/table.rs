//! The cheapest formulations, as a table and spelled out, or as JSON.

use std::io::{self, Write};

use serde::{Serialize, Serializer};
use volumes::Formulation;

use super::asked::Row;
use super::steps;

/// From this many formulations on, each is printed on one line.
const MANY: usize = 16;

/// Characters of the longest triple product, `((p1-p0) × (p2-p0)) · (p0-a)`.
const WIDTH: usize = 28;

/// Prints all rows, then the formulations of each.
pub fn print_text(mut out: impl Write, rows: &[Row]) -> io::Result<()> {
    let width = rows.iter().map(|row| row.case_name.len()).max();
    let width = width.unwrap_or(0).max(13);
    let bytes = rows.iter().any(|row| row.count.bytes.is_some());
    let head = if bytes { "  bytes" } else { "" };
    writeln!(
        out,
        "{:width$}  {:10}  {:5}  {:14}{head}  {:>12}  {:>12}  {:>12}",
        "case", "volume", "model", "cost", "formulations", "combinations", "milliseconds"
    )?;
    for row in rows {
        let bytes = row.count.bytes.map(|bytes| format!("  {bytes:5}"));
        writeln!(
            out,
            "{:width$}  {:10}  {:5}  {:14}{}  {:12}  {:12}  {:12.1}",
            row.case_name,
            row.volume,
            row.model_name,
            row.count.cost,
            bytes.unwrap_or_default(),
            row.count.formulations.len(),
            row.count.combinations,
            row.time.as_secs_f64() * 1e3
        )?;
    }
    for row in rows {
        print_formulations(&mut out, row)?;
    }
    out.flush()
}

/// The first one step by step, the others by their formulas.
fn print_formulations(mut out: impl Write, row: &Row) -> io::Result<()> {
    let formulations = &row.count.formulations;
    let (case, volume) = (&row.case_name, &row.volume);
    writeln!(out, "\n{case}, {volume}: {}", row.count.cost)?;
    let Some((first, others)) = formulations.split_first() else {
        return Ok(());
    };
    writeln!(out)?;
    steps::print(&mut out, first, row.case, &row.model)?;
    if !others.is_empty() {
        writeln!(out, "\n  as cheap, {} more:", others.len())?;
    }
    if formulations.len() < MANY {
        for formulation in others {
            writeln!(out)?;
            for line in formulation.to_string().lines() {
                writeln!(out, "  {line}")?;
            }
        }
        return Ok(());
    }
    writeln!(out)?;
    for formulation in others {
        let columns = formulation.products.map(|(volume, product)| {
            let product = product.to_string();
            format!("{volume} = {product:WIDTH$}")
        });
        writeln!(out, "  {}", columns.join("  ").trim_end())?;
    }
    Ok(())
}

/// Prints a list with an object a row.
pub fn print_json(mut out: impl Write, rows: &[Row]) -> io::Result<()> {
    let rows: Vec<_> = rows.iter().map(JsonRow::new).collect();
    serde_json::to_writer_pretty(&mut out, &rows)?;
    writeln!(out)?;
    out.flush()
}

/// A row as other programs read it.
#[derive(Serialize)]
struct JsonRow<'a> {
    case: &'a str,
    volume: &'a str,
    model: &'a str,
    combinations: u64,
    cost: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    bytes: Option<u32>,
    count: usize,
    formulations: Vec<JsonFormulation>,
}

impl<'a> JsonRow<'a> {
    fn new(row: &'a Row) -> Self {
        let formulations = &row.count.formulations;
        Self {
            case: &row.case_name,
            volume: &row.volume,
            model: &row.model_name,
            combinations: row.count.combinations,
            cost: row.count.cost.operations(),
            bytes: row.count.bytes,
            count: formulations.len(),
            formulations: formulations.iter().copied().map(JsonFormulation).collect(),
        }
    }
}

/// Formulas by volume, in the formulation's order.
struct JsonFormulation(Formulation);

impl Serialize for JsonFormulation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let formulas = self.0.products;
        serializer.collect_map(
            formulas.map(|(volume, product)| (volume.to_string(), product.to_string())),
        )
    }
}

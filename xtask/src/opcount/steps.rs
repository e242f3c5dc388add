//! A formulation spelled out: common subexpressions named once, in order.

use std::collections::BTreeMap;
use std::io::{self, Write};

use volumes::{Case, Formulation, Model, Operations, Step, TripleProduct, Vector};

/// Writes a line for every step: its name, its value, how often it changes, and what it adds to
/// the cost.
pub fn print(
    out: &mut impl Write,
    formulation: &Formulation,
    case: Case,
    model: &Model,
) -> io::Result<()> {
    let mut names = Names::default();
    for step in formulation.steps() {
        let (name, value) = names.name(step);
        let rate = step.rate(case);
        let weighted: Operations = step.operations(model) * case.weight(rate);
        let cost = case.cost(model, weighted);
        let (rate, cost) = (rate.to_string(), cost.to_string());
        writeln!(out, "  {name:3} = {value:10}  {rate:15}  {cost:>8}")?;
    }
    let stored = formulation.stored(case).len();
    if case.stored {
        writeln!(
            out,
            "  stored with the triangle: {stored} vectors, {} bytes",
            formulation.bytes(case)
        )?;
    }
    Ok(())
}

/// Short names of vectors: edges `e1`, `e2`, crosses `c1`, `c2`.
#[derive(Default)]
struct Names {
    edges: BTreeMap<volumes::Edge, String>,
    crosses: BTreeMap<volumes::Cross, String>,
}

impl Names {
    /// A step's name, and its value in terms of the names before.
    fn name(&mut self, step: Step) -> (String, String) {
        match step {
            Step::Edge(edge) => {
                let name = format!("e{}", self.edges.len() + 1);
                self.edges.insert(edge, name.clone());
                (name, edge.to_string())
            }
            Step::Cross(cross) => {
                let name = format!("c{}", self.crosses.len() + 1);
                self.crosses.insert(cross, name.clone());
                let [left, right] = [cross.left, cross.right].map(|vector| self.vector(vector));
                (name, format!("{left} × {right}"))
            }
            Step::Volume(volume, TripleProduct { cross, dot }) => {
                let value = format!("{} · {}", self.crosses[&cross], self.vector(dot));
                (volume.to_string(), value)
            }
        }
    }

    fn vector(&self, vector: Vector) -> String {
        match vector {
            Vector::Edge(edge) => self.edges[&edge].clone(),
            Vector::Direction => "d".into(),
        }
    }
}

//! What a program has chosen, in words: question by question, so that two programs can be compared.

use std::collections::BTreeSet;

use program::{Formula, Op, Program, Quantity, Summation};
use serde::Serialize;
use volumes::{Cross, TripleProduct, Vector};

/// What a question is about, in the order in which they are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Topic {
    /// How a volume is found, whichever way its edges are walked.
    Formulation,
    /// How values are divided by `V`.
    Division,
    /// How a test is made.
    Test,
    /// After which tests the triangle may be left.
    Exit,
    /// In which order the tests are made.
    Order,
    /// Which way edges are walked, products summed, and what is fused.
    Writing,
}

/// A question and what a program answers. To one about exits it may have several answers.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Trait {
    /// What it is about.
    pub topic: Topic,
    /// The question.
    pub question: String,
    /// The answer.
    pub option: String,
}

/// What another program answers differently.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Change {
    /// The question.
    pub question: String,
    /// What only the first program answers.
    pub from: Vec<String>,
    /// What only the other one answers.
    pub to: Vec<String>,
}

/// All that a program has chosen but for the order of statements that are no tests.
pub fn traits(program: &Program) -> BTreeSet<Trait> {
    let mut traits = BTreeSet::new();
    let mut add = |topic, question: &str, option: String| {
        let question = question.to_owned();
        traits.insert(Trait {
            topic,
            question,
            option,
        });
    };
    let listing = program.listing();
    let formulas = program.formulas();
    let mut tests = Vec::new();
    let (mut takes_sides, mut divides) = (false, false);
    let statements = program.statements().iter().zip(program.quantities());
    for ((statement, quantity), line) in statements.zip(&listing) {
        let after = |start: &str| {
            line.split_once(start)
                .map_or(line.as_str(), |(_, rest)| rest)
        };
        match (statement.op, *quantity) {
            (op, Quantity::Volume(volume)) => {
                let mut own = formulas.iter().filter(|(of, _)| *of == volume);
                let (formula, writing) = match own.next() {
                    Some((_, Formula::Product(product))) => (plain(*product), after(" = ")),
                    Some((_, formula)) => (formula.to_string(), after(" = ")),
                    None => (op.to_string(), line.as_str()),
                };
                add(Topic::Formulation, &volume.to_string(), formula);
                let writing = match op {
                    Op::Volume(_, summation) => format!("{writing}, {}", sum(summation)),
                    _ => writing.to_owned(),
                };
                add(Topic::Writing, &format!("{volume} is written"), writing);
            }
            (Op::Reciprocal(_), _) => {
                divides = true;
                add(Topic::Division, "1 / V", after("1 / V ").to_owned());
            }
            (Op::TMultiply | Op::TDivide, _) => {
                add(Topic::Division, "t", after("t = ").to_owned());
            }
            (Op::BarycentricMultiply(side) | Op::BarycentricRest(side), _) => {
                add(Topic::Division, side.barycentric(), after(" = ").to_owned());
            }
            (Op::Exit, _) => add(Topic::Exit, "may leave", after("exit ").to_owned()),
            (op, quantity) if op.is_test() => {
                takes_sides |= matches!(op, Op::Side(..));
                let kept = after("mask = ");
                let kept = kept.strip_prefix("mask and ").unwrap_or(kept);
                let test = quantity.to_string();
                add(Topic::Test, &test, kept.to_owned());
                tests.push(short(&test).to_owned());
            }
            _ => {}
        }
    }
    if takes_sides {
        add(Topic::Test, "the inside test", "side by side".into());
    }
    if !divides {
        add(Topic::Division, "1 / V", "not needed".into());
    }
    add(Topic::Order, "order of tests", tests.join(", "));
    traits
}

/// What another program answers differently, question by question.
pub fn changes(one: &BTreeSet<Trait>, other: &BTreeSet<Trait>) -> Vec<Change> {
    let mut changes: Vec<Change> = Vec::new();
    let mut differing: Vec<(&Trait, bool)> = one.difference(other).map(|it| (it, false)).collect();
    differing.extend(other.difference(one).map(|it| (it, true)));
    differing.sort();
    for (differs, is_new) in differing {
        let place = changes
            .iter()
            .position(|change| change.question == differs.question)
            .unwrap_or_else(|| {
                changes.push(Change {
                    question: differs.question.clone(),
                    from: Vec::new(),
                    to: Vec::new(),
                });
                changes.len() - 1
            });
        let change = &mut changes[place];
        match is_new {
            true => change.to.push(differs.option.clone()),
            false => change.from.push(differs.option.clone()),
        }
    }
    // How a volume is written goes without saying where it is another one.
    let formulations: Vec<String> = changes.iter().map(|it| it.question.clone()).collect();
    changes.retain(|change| match change.question.strip_suffix(" is written") {
        Some(volume) => !formulations.iter().any(|one| one == volume),
        None => true,
    });
    changes
}

/// A triple product with edges walked from the ray to the triangle and up, and the factors of the cross in one
/// order: but for its sign, the same number.
fn plain(product: TripleProduct) -> String {
    let walked = |vector: Vector| match vector {
        Vector::Edge(edge) if edge.to < edge.from => Vector::Edge(edge.reversed()),
        other => other,
    };
    let (left, right) = (walked(product.cross.left), walked(product.cross.right));
    let cross = Cross {
        left: left.min(right),
        right: left.max(right),
    };
    let dot = walked(product.dot);
    TripleProduct { cross, dot }.to_string()
}

fn sum(summation: Summation) -> &'static str {
    match summation {
        Summation::XyZ | Summation::FusedXyZ => "(x + y) + z",
        Summation::XYz | Summation::FusedXYz => "x + (y + z)",
    }
}

/// `near` of `the near test`, `side 1` of `the test of side 1`.
fn short(test: &str) -> &str {
    let test = test.strip_prefix("the ").unwrap_or(test);
    let test = test.strip_prefix("test of ").unwrap_or(test);
    test.strip_suffix(" test").unwrap_or(test)
}

#[cfg(test)]
mod tests {
    use program::{appendix, kensler_shirley, moller_trumbore_volumes};

    use super::*;

    fn options<'a>(traits: &'a BTreeSet<Trait>, question: &str) -> Vec<&'a str> {
        let own = traits.iter().filter(|one| one.question == question);
        own.map(|one| one.option.as_str()).collect()
    }

    #[test]
    fn the_papers_two_programs_differ_in_what_the_paper_says() {
        let graph = kensler_shirley();
        let of = |genome| traits(&graph.program(&genome).unwrap());
        let (bred, by_hand) = (of(appendix(&graph)), of(moller_trumbore_volumes(&graph)));
        assert_eq!(
            options(&bred, "1 / V"),
            ["by an estimate and a Newton step"]
        );
        assert_eq!(options(&by_hand, "1 / V"), ["by division"]);
        assert_eq!(options(&bred, "V"), ["((p1-p0) × (p2-p0)) · d"]);
        assert_eq!(
            options(&bred, "may leave"),
            [
                "after the near test",
                "after the test of side 1",
                "after the test of side 2"
            ]
        );
        assert_eq!(
            options(&by_hand, "order of tests"),
            ["side 1, side 2, side 0, near, far"]
        );
        let changes = changes(&by_hand, &bred);
        let division = changes.iter().find(|change| change.question == "1 / V");
        let division = division.unwrap();
        assert_eq!(division.from, ["by division"]);
        assert_eq!(division.to, ["by an estimate and a Newton step"]);
        assert!(
            changes
                .iter()
                .all(|change| change.question != "V0 is written")
        );
    }

    #[test]
    fn the_same_program_differs_in_nothing() {
        let graph = kensler_shirley();
        let one = traits(&graph.program(&appendix(&graph)).unwrap());
        assert_eq!(changes(&one, &one), []);
    }
}

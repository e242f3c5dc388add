//! A model of speed that is cheap to ask: the logarithm of fitness as a sum over what a program has, fitted by
//! ridge regression (Hoerl and Kennard 1970).
//!
//! What a program has: how often every operation stands before the first exit, between that and the next, and so
//! on; how many operations those parts take by kind; how much work it looks like as a whole; and how many values are
//! alive at once at most.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};
use program::{Op, Program};
use volumes::Kind;

/// Parts of a program that are told apart: before the first exit, up to the second, and the rest.
const PARTS: usize = 3;

/// Weight of the penalty on weights, in observations.
const RIDGE: f64 = 1.0;

/// Something that a program may have.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Feature {
    /// Everybody has this once.
    Bias,
    /// An operation in a part.
    Op(usize, Op),
    /// Arithmetic of a kind in a part, in tens.
    Work(usize, Kind),
    /// The logarithm of the work that it looks like.
    Whole,
    /// Values alive at once, in tens.
    Alive,
}

/// Observations of speed.
#[derive(Default)]
pub struct Surrogate {
    places: HashMap<Feature, usize>,
    /// What every program had, by places, and the logarithm of its fitness.
    observed: Vec<(Vec<(usize, f64)>, f64)>,
}

/// The weight of every feature, by its place.
pub struct Weights(DVector<f64>);

impl Surrogate {
    /// Learns how fast a program is that looks like so much work.
    pub fn learn(&mut self, program: &Program, work: f64, fitness: f64) {
        let mut row: HashMap<usize, f64> = HashMap::new();
        for (feature, amount) in features(program, work) {
            let next = self.places.len();
            let place = *self.places.entry(feature).or_insert(next);
            *row.entry(place).or_default() += amount;
        }
        let mut row: Vec<(usize, f64)> = row.into_iter().collect();
        // The order of summation, and so every bit of the weights, must not be the hash map's.
        row.sort_by_key(|&(place, _)| place);
        self.observed.push((row, fitness.ln()));
    }

    /// The weights that explain best what was learnt.
    pub fn fit(&self) -> Weights {
        let count = self.places.len();
        let mut normal = DMatrix::from_diagonal_element(count, count, RIDGE);
        let mut right = DVector::zeros(count);
        for (row, speed) in &self.observed {
            for &(i, amount) in row {
                right[i] += amount * speed;
                for &(j, other) in row {
                    normal[(i, j)] += amount * other;
                }
            }
        }
        let factors = normal.cholesky().expect("a ridge makes it positive");
        Weights(factors.solve(&right))
    }

    /// The logarithm of the fitness that a program is expected to have. What was never seen counts nothing.
    pub fn predict(&self, weights: &Weights, program: &Program, work: f64) -> f64 {
        let features = features(program, work).into_iter();
        let known = features.filter_map(|(feature, amount)| {
            let place = *self.places.get(&feature)?;
            Some(weights.0[place] * amount)
        });
        known.sum()
    }
}

fn features(program: &Program, work: f64) -> Vec<(Feature, f64)> {
    let mut features = vec![
        (Feature::Bias, 1.0),
        (Feature::Whole, work.ln()),
        (Feature::Alive, alive_at_most(program) as f64 / 10.0),
    ];
    let mut part = 0;
    for statement in program.statements() {
        features.push((Feature::Op(part, statement.op), 1.0));
        let operations = statement.op.operations(false);
        for kind in Kind::ALL {
            let count = operations.counts[kind as usize];
            if count > 0 {
                features.push((Feature::Work(part, kind), f64::from(count) / 10.0));
            }
        }
        if statement.op == Op::Exit {
            part = (part + 1).min(PARTS - 1);
        }
    }
    features
}

/// How many values somebody still needs, at the statement where these are most.
fn alive_at_most(program: &Program) -> usize {
    let statements = program.statements();
    let mut last_use = vec![0; statements.len()];
    for (index, statement) in statements.iter().enumerate() {
        for &operand in &statement.operands {
            last_use[operand as usize] = index;
        }
    }
    let alive = |at: usize| (0..=at).filter(|&value| last_use[value] > at).count();
    (0..statements.len()).map(alive).max().unwrap_or(0)
}

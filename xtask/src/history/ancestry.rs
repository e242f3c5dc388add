//! Where a candidate comes from: the line of its first parents, with the other parents beside it.

use std::collections::BTreeSet;

use serde::Serialize;

use super::traits::{Change, Trait, changes};
use super::{History, Tried};

/// A step of the line: a candidate, and what became of its parent in it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Step {
    /// The candidate's number.
    pub id: u64,
    /// The generation that it was made for.
    pub generation: usize,
    /// How it was made.
    pub operator: &'static str,
    /// Its fitness in the end.
    pub fitness: Option<f64>,
    /// Its fitness as a multiple of its first parent's.
    pub gain: Option<f64>,
    /// The other parent.
    pub other: Option<Other>,
    /// How many descendants of the same source stand between it and the next step.
    pub copies: usize,
    /// In what its program differs from its first parent's; none if that is not known.
    pub changes: Option<Vec<Change>>,
}

/// A parent that gave a part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Other {
    /// Its number.
    pub id: u64,
    /// Its fitness in the end.
    pub fitness: Option<f64>,
}

/// The line that ends with a candidate, the oldest first. Those of the same source as their parent are no steps of their
/// own. `traits` says what a candidate's program has chosen.
pub fn line<'a>(
    history: &History,
    id: u64,
    traits: impl Fn(u64) -> Option<&'a BTreeSet<Trait>>,
) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    let mut copies = 0;
    let mut here = history.find(id);
    while let Some(one) = here {
        let parent = parent(history, one);
        here = parent;
        if parent.is_some_and(|parent| parent.source == one.source) {
            copies += 1;
            continue;
        }
        let fitness = |tried: Option<&Tried>| tried.and_then(|tried| tried.fitness);
        let gain = one.fitness.zip(fitness(parent));
        let chosen = parent.and_then(|parent| traits(parent.id).zip(traits(one.id)));
        let other = one.origin.parents().get(1).map(|&id| Other {
            id,
            fitness: fitness(history.find(id)),
        });
        steps.push(Step {
            id: one.id,
            generation: one.generation,
            operator: one.origin.name(),
            fitness: one.fitness,
            gain: gain.map(|(own, parents)| own / parents),
            other,
            copies: std::mem::take(&mut copies),
            changes: chosen.map(|(before, now)| changes(before, now)),
        });
    }
    steps.reverse();
    steps
}

/// The first parent. A parent is older than its child, or a journal could send us round for ever.
fn parent<'a>(history: &'a History, one: &Tried) -> Option<&'a Tried> {
    let parent = one.origin.parents().first();
    parent
        .filter(|parent| **parent < one.id)
        .and_then(|&parent| history.find(parent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::example::{duplicate, new};

    #[test]
    fn the_line_goes_by_first_parents_and_passes_over_copies() {
        let history = History::of(&[
            new(0, 0, r#""random""#, "a", 1.0),
            new(1, 0, r#""random""#, "b", 0.8),
            new(2, 1, r#""crossover","parents":[0,1]"#, "c", 1.5),
            duplicate(3, 2, r#""flip","parent":2"#, "c"),
            new(4, 3, r#""slide","parent":3"#, "d", 1.8),
        ]);
        let steps = line(&history, 4, |_| None);
        let told: Vec<(u64, &str, usize)> = steps
            .iter()
            .map(|step| (step.id, step.operator, step.copies))
            .collect();
        assert_eq!(
            told,
            [(0, "random", 0), (2, "crossover", 1), (4, "slide", 0)]
        );
        assert_eq!(steps[0].gain, None);
        assert_eq!(steps[1].gain, Some(1.5));
        assert!((steps[2].gain.unwrap() - 1.2).abs() < 1e-9);
        let other = steps[1].other.as_ref().unwrap();
        assert_eq!((other.id, other.fitness), (1, Some(0.8)));
    }

    #[test]
    fn a_parent_that_is_not_older_ends_the_line() {
        let history = History::of(&[
            new(0, 0, r#""flip","parent":1"#, "a", 1.0),
            new(1, 1, r#""flip","parent":0"#, "b", 1.1),
        ]);
        assert_eq!(line(&history, 1, |_| None).len(), 2);
        assert!(line(&history, 7, |_| None).is_empty());
    }
}

//! How a search went: the best so far and the middle of every generation, against evaluations.

use measure::median;
use serde::Serialize;

use super::History;

/// The course of a search. Points are numbers of evaluations and fitness in the end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Course {
    /// The best so far, wherever it rises, and at the end.
    pub best: Vec<(u64, f64)>,
    /// The median of those made for each generation, failures left out.
    pub median: Vec<(u64, f64)>,
}

impl Course {
    /// That of a run.
    pub fn of(history: &History) -> Course {
        let mut best = history.rises();
        if let (Some(&(_, highest)), Some(last)) = (best.last(), history.tried.last())
            && best.last().is_some_and(|(at, _)| *at <= last.id)
        {
            best.push((last.id + 1, highest));
        }
        let generations = history.tried.chunk_by(|a, b| a.generation == b.generation);
        let median = generations.filter_map(|generation| {
            let fit: Vec<f64> = generation.iter().filter_map(|one| one.fitness).collect();
            let last = generation.last()?;
            (!fit.is_empty()).then(|| (last.id + 1, median(&fit)))
        });
        Course {
            median: median.collect(),
            best,
        }
    }

    /// The number of evaluations at which the best was first within a share of its last value.
    pub fn reached(&self, share: f64) -> Option<u64> {
        let (_, last) = self.best.last()?;
        let near = self
            .best
            .iter()
            .find(|(_, fitness)| *fitness >= share * last);
        near.map(|(at, _)| *at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::example::{again, new};

    #[test]
    fn the_best_rises_by_what_was_known_in_the_end_and_generations_have_their_middles() {
        let history = History::of(&[
            new(0, 0, r#""random""#, "a", 1.0),
            new(1, 0, r#""random""#, "b", 9.0),
            new(2, 0, r#""random""#, "c", 0.9),
            new(3, 1, r#""flip","parent":0"#, "d", 1.2),
            new(4, 1, r#""flip","parent":0"#, "e", 0.8),
            again(1, "b", 1.1),
        ]);
        let course = Course::of(&history);
        assert_eq!(course.best, [(1, 1.0), (2, 1.1), (4, 1.2), (5, 1.2)]);
        assert_eq!(course.median, [(3, 1.0), (5, 1.0)]);
        assert_eq!(course.reached(0.9), Some(2));
    }

    #[test]
    fn of_a_run_that_hardly_began_there_is_no_course() {
        let course = Course::of(&History::of(&[]));
        assert_eq!((course.best.len(), course.median.len()), (0, 0));
        assert_eq!(course.reached(0.9), None);
    }
}

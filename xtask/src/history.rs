//! What a journal says of a run, candidate by candidate; how the run went, where a candidate comes from, and what a
//! program has chosen.

pub mod ancestry;
pub mod course;
pub mod traits;

use std::collections::HashMap;

use evolve::{Evaluation, Line, Origin};

/// A candidate, by what was known of it in the end: a first timing that was lucky is none.
pub struct Tried {
    /// Its number.
    pub id: u64,
    /// The generation that it was made for.
    pub generation: usize,
    /// How it was made.
    pub origin: Origin,
    /// The hash of its source.
    pub source: String,
    /// Its fitness in the end; none if it failed.
    pub fitness: Option<f64>,
}

/// All candidates of a run.
pub struct History {
    /// They, in the order of their numbers.
    pub tried: Vec<Tried>,
    /// By source, the first evaluation and the last.
    known: HashMap<String, (Evaluation, Evaluation)>,
}

impl History {
    /// That of the lines behind a journal's first one.
    pub fn of(lines: &[Line]) -> History {
        let mut known: HashMap<String, (Evaluation, Evaluation)> = HashMap::new();
        let mut identities = Vec::new();
        for line in lines {
            match line {
                Line::Run { .. } => {}
                Line::New {
                    candidate,
                    evaluation,
                } => {
                    identities.push(candidate);
                    let both = (evaluation.clone(), evaluation.clone());
                    known.insert(candidate.source.clone(), both);
                }
                Line::Duplicate { candidate } => identities.push(candidate),
                Line::Again {
                    source, evaluation, ..
                } => {
                    if let Some((_, last)) = known.get_mut(source) {
                        *last = evaluation.clone();
                    }
                }
            }
        }
        identities.sort_by_key(|identity| identity.id);
        let tried = identities.into_iter().map(|identity| Tried {
            id: identity.id,
            generation: identity.generation,
            origin: identity.origin,
            source: identity.source.clone(),
            fitness: known.get(&identity.source).and_then(|(_, it)| it.fitness),
        });
        History {
            tried: tried.collect(),
            known,
        }
    }

    /// A candidate by its number.
    pub fn find(&self, id: u64) -> Option<&Tried> {
        let place = self.tried.binary_search_by_key(&id, |one| one.id);
        place.ok().map(|place| &self.tried[place])
    }

    /// The first candidate of a source.
    pub fn first_of(&self, source: &str) -> Option<&Tried> {
        self.tried.iter().find(|one| one.source == source)
    }

    /// The fittest candidate, the first one of several.
    pub fn fittest(&self) -> Option<&Tried> {
        let fit = self.tried.iter().rev().filter(|one| one.fitness.is_some());
        fit.max_by(|a, b| {
            a.fitness
                .unwrap_or(0.0)
                .total_cmp(&b.fitness.unwrap_or(0.0))
        })
    }

    /// Numbers of evaluations and the fitness of the best so far, wherever that rises.
    pub fn rises(&self) -> Vec<(u64, f64)> {
        let mut rises: Vec<(u64, f64)> = Vec::new();
        for one in &self.tried {
            let highest = rises.last().map_or(0.0, |(_, fitness)| *fitness);
            if let Some(fitness) = one.fitness.filter(|fitness| *fitness > highest) {
                rises.push((one.id + 1, fitness));
            }
        }
        rises
    }

    /// The candidates that were the first of their source, each with the first evaluation and the last.
    pub fn sources(&self) -> impl Iterator<Item = (&Tried, &Evaluation, &Evaluation)> {
        let mut seen = std::collections::HashSet::new();
        let first = self
            .tried
            .iter()
            .filter(move |one| seen.insert(&one.source));
        first.filter_map(|one| {
            let (first, last) = self.known.get(&one.source)?;
            Some((one, first, last))
        })
    }
}

#[cfg(test)]
pub mod example {
    use super::*;

    /// A line of a journal.
    pub fn line(text: &str) -> Line {
        serde_json::from_str(text).unwrap()
    }

    /// A candidate by an operator, which is given as it is in journals, with its parents.
    pub fn new(id: u64, generation: usize, operator: &str, source: &str, fitness: f64) -> Line {
        line(&format!(
            r#"{{"line":"new","id":{id},"generation":{generation},"operator":{operator},"source":"{source}",
                "fitness":{fitness},"uncertainty":0.0,"details":null}}"#
        ))
    }

    /// One with the source of an earlier one.
    pub fn duplicate(id: u64, generation: usize, operator: &str, source: &str) -> Line {
        line(&format!(
            r#"{{"line":"duplicate","id":{id},"generation":{generation},"operator":{operator},"source":"{source}"}}"#
        ))
    }

    /// A later timing of a source.
    pub fn again(id: u64, source: &str, fitness: f64) -> Line {
        line(&format!(
            r#"{{"line":"again","id":{id},"generation":1,"source":"{source}","fitness":{fitness},
                "uncertainty":0.0,"details":null}}"#
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::example::{again, duplicate, new};
    use super::*;

    #[test]
    fn a_candidate_is_worth_what_was_known_in_the_end_and_so_is_who_is_the_same() {
        let history = History::of(&[
            new(0, 0, r#""random""#, "a", 1.0),
            new(1, 0, r#""random""#, "b", 9.0),
            duplicate(2, 1, r#""flip","parent":1"#, "b"),
            again(1, "b", 1.5),
        ]);
        let fitness: Vec<Option<f64>> = history.tried.iter().map(|one| one.fitness).collect();
        assert_eq!(fitness, [Some(1.0), Some(1.5), Some(1.5)]);
        assert_eq!(history.fittest().unwrap().id, 1);
        assert_eq!(history.find(2).unwrap().origin.parents(), [1]);
        assert!(history.find(3).is_none());
        let sources: Vec<(u64, f64)> = history
            .sources()
            .map(|(one, first, _)| (one.id, first.fitness.unwrap()))
            .collect();
        assert_eq!(sources, [(0, 1.0), (1, 9.0)]);
    }
}

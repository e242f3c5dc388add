//! What a search spent on kernels that it had tried, and on those that failed.

use std::collections::HashSet;

use serde::Serialize;

use crate::evolve::cause;
use crate::history::History;

/// Duplicates and failures of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Losses {
    /// Drafts that were drawn again, since their source had been tried; none if that is not known.
    pub redrawn: Option<u64>,
    /// Candidates.
    pub candidates: usize,
    /// Of these, how many had a source that had been tried.
    pub same_source: usize,
    /// Different sources.
    pub sources: usize,
    /// Of these, how many were machine code that had been timed; none if that is not known.
    pub same_code: Option<u64>,
    /// Failures, the most frequent first.
    pub failures: Vec<Failure>,
}

/// Failures of a kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Failure {
    /// What became of the kernels.
    pub verdict: String,
    /// How many sources failed so.
    pub count: usize,
    /// The first candidate among them.
    pub candidate: u64,
    /// Why that one did.
    pub cause: String,
}

impl Losses {
    /// Those of a run. `twins` is how many were the same machine code by the run's own count, should the journal not say
    /// which code anybody is.
    pub fn of(history: &History, redrawn: Option<u64>, twins: Option<u64>) -> Losses {
        let (mut sources, mut same_code, mut codes) = (0, 0, HashSet::new());
        let mut failures: Vec<Failure> = Vec::new();
        for (one, first, last) in history.sources() {
            sources += 1;
            if let Some(code) = &first.code {
                same_code += u64::from(!codes.insert(code.as_str()));
            }
            if last.fitness.is_some() {
                continue;
            }
            let verdict = last.details["verdict"].as_str().unwrap_or("failed");
            let verdict = verdict.replace('-', " ");
            match failures.iter_mut().find(|known| known.verdict == verdict) {
                Some(known) => known.count += 1,
                None => failures.push(Failure {
                    verdict,
                    count: 1,
                    candidate: one.id,
                    cause: cause(&last.details),
                }),
            }
        }
        failures.sort_by_key(|failure| std::cmp::Reverse(failure.count));
        Losses {
            redrawn,
            candidates: history.tried.len(),
            same_source: history.tried.len() - sources,
            sources,
            same_code: if codes.is_empty() {
                twins
            } else {
                Some(same_code)
            },
            failures,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::example::{duplicate, line};

    fn judged(id: u64, source: &str, rest: &str) -> evolve::Line {
        line(&format!(
            r#"{{"line":"new","id":{id},"generation":0,"operator":"random","source":"{source}","uncertainty":0.0,{rest}}}"#
        ))
    }

    #[test]
    fn what_was_the_same_is_counted_by_source_and_by_code_and_a_failure_has_its_example() {
        let timed = r#""fitness":1.0,"code":"x","details":null"#;
        let wrong =
            r#""fitness":null,"details":{"verdict":"wrong-answer","message":"ray 3\nmore"}"#;
        let history = History::of(&[
            judged(0, "a", timed),
            judged(1, "b", timed),
            duplicate(2, 0, r#""random""#, "a"),
            judged(3, "c", wrong),
            judged(4, "d", wrong),
        ]);
        let losses = Losses::of(&history, Some(7), None);
        assert_eq!((losses.candidates, losses.same_source), (5, 1));
        assert_eq!((losses.sources, losses.same_code), (4, Some(1)));
        let [failure] = losses.failures.as_slice() else {
            panic!("{:?}", losses.failures);
        };
        assert_eq!(
            (failure.verdict.as_str(), failure.count),
            ("wrong answer", 2)
        );
        assert_eq!((failure.candidate, failure.cause.as_str()), (3, "ray 3"));
    }
}

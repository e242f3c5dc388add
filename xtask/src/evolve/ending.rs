//! Why a search ended, in words.

use evolve::{MemoryError, Stop};
use measure::MeasureError;

use crate::failure::{Interrupted, bad_input};

/// Whether a search has come to an end that it may come to.
pub fn is_end<E>(stop: &Stop<E>) -> bool {
    matches!(
        stop,
        Stop::Done | Stop::Enough | Stop::Ended | Stop::Exhausted
    )
}

/// The reason as a clause.
pub fn reason<E: std::fmt::Display>(stop: &Stop<E>) -> String {
    match stop {
        Stop::Done => "done".into(),
        Stop::Enough => "as many evaluations as asked for".into(),
        Stop::Ended => "its time was over".into(),
        Stop::NobodyFit => "no candidate has any fitness".into(),
        Stop::Exhausted => "nothing is left that was not tried".into(),
        Stop::Graph(error) => format!("the graph makes a program that is none: {error}"),
        Stop::Evaluation(error) => error.to_string(),
    }
}

/// The error of a search that did not come to its end; `kept` says what became of its best.
pub fn ended_early(stop: &Stop<MemoryError<MeasureError>>, kept: &str) -> anyhow::Error {
    match stop {
        Stop::Evaluation(MemoryError::Evaluate(MeasureError::Interrupted)) => {
            anyhow::Error::new(Interrupted).context(kept.to_owned())
        }
        Stop::Evaluation(MemoryError::Changed { .. }) => bad_input(reason(stop)),
        _ => anyhow::anyhow!("{}; {kept}", reason(stop)),
    }
}

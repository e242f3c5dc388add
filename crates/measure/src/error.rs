//! Why nothing can be measured at all. A kernel that fails is a verdict.

use std::io;

use crate::verdict::Verdict;

/// Measuring as a whole cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// The user asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// No place for the libraries.
    #[error("cannot make a temporary directory for compiled candidates: {0}")]
    Directory(io::Error),
    /// No worker.
    #[error("cannot run the process that times candidates: {0}")]
    Worker(io::Error),
    /// The reference itself fails.
    #[error("the reference kernel cannot be timed: {0:?}")]
    Reference(Box<Verdict>),
}

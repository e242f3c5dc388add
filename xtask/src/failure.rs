//! How a command fails: with one sentence on standard error, and an exit code.

use std::fmt::Display;
use std::process::ExitCode;

use measure::MeasureError;

/// The user asked for something that cannot be; nothing was done.
#[derive(Debug)]
pub struct BadInput(String);

/// The user stopped the command; what it has to say of it has been said.
#[derive(Debug)]
pub struct Interrupted;

/// The error for bad input, by a sentence that says what is wrong, where, and what to do.
pub fn bad_input(sentence: impl Display) -> anyhow::Error {
    anyhow::Error::new(BadInput(sentence.to_string()))
}

impl Display for BadInput {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BadInput {}

impl Display for Interrupted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("interrupted")
    }
}

impl std::error::Error for Interrupted {}

/// Says what went wrong, and gives the exit code for it.
pub fn report(error: &anyhow::Error) -> ExitCode {
    let interrupted = error.is::<Interrupted>()
        || matches!(error.downcast_ref(), Some(MeasureError::Interrupted));
    eprintln!("error: {error:#}");
    if interrupted {
        ExitCode::from(130)
    } else if error.is::<BadInput>() {
        ExitCode::from(2)
    } else {
        ExitCode::FAILURE
    }
}

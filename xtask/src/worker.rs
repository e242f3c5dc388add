//! `cargo xtask worker`: the process that loads and times candidates. Not for people.

use std::time::Duration;

use measure::WorkerCommand;

/// A round takes milliseconds and the workload a second; a machine may be busy.
const PATIENCE: Duration = Duration::from_secs(20);

/// Times candidates for another command.
#[derive(clap::Args)]
pub struct Worker {}

impl Worker {
    /// Serves requests on standard input until it ends.
    pub fn run(self) -> anyhow::Result<()> {
        Ok(measure::run_worker()?)
    }
}

/// How to start this program as a worker.
pub fn command() -> anyhow::Result<WorkerCommand> {
    Ok(WorkerCommand {
        program: std::env::current_exe()?,
        arguments: vec!["worker".into()],
        patience: PATIENCE,
    })
}

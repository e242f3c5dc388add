//! `cargo xtask worker`: the process that loads and times candidates. Not for people.

use std::time::Duration;

use measure::{WorkerCommand, WorkloadSpec};

/// A round takes milliseconds and the workload a second; a machine may be busy.
const PATIENCE: Duration = Duration::from_secs(20);

/// Triangles that all rays of a packet are tested against in `f64` in a millisecond, on a machine that is slow or
/// busy: the oracle is silent while it judges a packet.
const JUDGED_IN_A_MILLISECOND: u64 = 80;

/// Times candidates for another command.
#[derive(clap::Args)]
pub struct Worker {}

impl Worker {
    /// Serves requests on standard input until it ends.
    pub fn run(self) -> anyhow::Result<()> {
        Ok(measure::run_worker()?)
    }
}

/// How to start this program as a worker for a workload.
pub fn command(workload: &WorkloadSpec) -> anyhow::Result<WorkerCommand> {
    let judging = Duration::from_millis(workload.triangles as u64 / JUDGED_IN_A_MILLISECOND);
    Ok(WorkerCommand {
        program: std::env::current_exe()?,
        arguments: vec!["worker".into()],
        patience: PATIENCE.max(judging),
    })
}

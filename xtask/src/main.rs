//! The commands of raybreed: `cargo xtask <command>`.
//!
//! One file a command. A command parses its flags, calls the crates and prints; whatever decides
//! anything lives in `crates/`. Exit codes: 0 done, 2 bad usage or bad input, 1 anything else,
//! 130 interrupted.

use std::process::ExitCode;

use clap::{Parser, Subcommand};

mod accuracy;
mod arena;
mod asked;
mod bench;
mod benches;
mod cases;
mod compare;
mod dag;
mod emit;
mod evolve;
mod failure;
mod fields;
mod files;
mod history;
mod interrupt;
mod isas;
mod opcount;
mod plots;
mod progress;
mod promote;
mod published;
mod report;
mod retime;
mod scaling;
mod shootout;
mod worker;

/// Breeds ray-triangle intersection kernels, after Kensler and Shirley (2006).
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Evolve(evolve::Evolve),
    #[command(name = "compare-strategies")]
    Compare(compare::Compare),
    Opcount(opcount::Opcount),
    Bench(bench::Bench),
    Scaling(scaling::Scaling),
    Accuracy(accuracy::Accuracy),
    Report(report::Report),
    Promote(promote::Promote),
    Retime(retime::Retime),
    Emit(emit::Emit),
    Dag(dag::Dag),
    #[command(hide = true)]
    Worker(worker::Worker),
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Evolve(command) => command.run(),
        Command::Compare(command) => command.run(),
        Command::Opcount(command) => command.run(),
        Command::Bench(command) => command.run(),
        Command::Scaling(command) => command.run(),
        Command::Accuracy(command) => command.run(),
        Command::Report(command) => command.run(),
        Command::Promote(command) => command.run(),
        Command::Retime(command) => command.run(),
        Command::Emit(command) => command.run(),
        Command::Dag(command) => command.run(),
        Command::Worker(command) => command.run(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failure::report(&error),
    }
}

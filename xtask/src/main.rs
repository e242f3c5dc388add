//! The commands of raybreed: `cargo xtask <command>`.
//!
//! One file a command. A command parses its flags, calls the crates and prints; whatever decides
//! anything lives in `crates/`. Exit codes: 0 done, 2 bad usage or bad input, 1 anything else,
//! 130 interrupted.

use clap::{Parser, Subcommand};

mod opcount;

/// Breeds ray-triangle intersection kernels, after Kensler and Shirley (2006).
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Opcount(opcount::Opcount),
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().command {
        Command::Opcount(command) => command.run(),
    }
}

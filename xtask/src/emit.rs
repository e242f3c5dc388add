//! `cargo xtask emit`: the library's kernels from their recipes.

use emit::package;

use crate::files;

/// Writes generated/src/kernels and generated/src/catalogue.rs from generated/recipes.
///
/// Only files whose first line says that they are generated are ever overwritten or removed.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  cargo xtask emit --check")]
pub struct Emit {
    /// Only compare what is checked in with what would be written
    #[arg(long)]
    check: bool,
}

impl Emit {
    /// Writes or checks the emitted files.
    pub fn run(self) -> anyhow::Result<()> {
        let package = package(&files::read_recipes()?)?;
        let src = files::in_repository("generated/src");
        let differences = if self.check {
            package.check(&src)?
        } else {
            package.write(&src)?
        };
        for difference in &differences {
            println!("{difference}");
        }
        match (self.check, differences.len()) {
            (_, 0) => println!("generated/src is up to date"),
            (false, count) => println!("{count} files of generated/src written"),
            (true, count) => {
                let todo = "run `cargo xtask emit` and commit what it writes";
                anyhow::bail!(
                    "{count} files of generated/src are not what would be written; {todo}"
                );
            }
        }
        Ok(())
    }
}

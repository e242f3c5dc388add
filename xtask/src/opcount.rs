//! `cargo xtask opcount`.

/// (to be written)
#[derive(clap::Args)]
pub struct Opcount {}

impl Opcount {
    pub fn run(self) -> anyhow::Result<()> {
        Ok(())
    }
}

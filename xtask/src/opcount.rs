//! `cargo xtask opcount`: operation counts of formulations and of whole kernels, and the step from
//! GA to GA+.

mod asked;
mod improve;
mod kernels;
mod steps;
mod table;

use std::io::{self, BufWriter, ErrorKind};
use std::path::PathBuf;

use asked::Asked;

/// Counts operations: of every formulation, for the cheapest ones; or of kernels.
///
/// A formulation chooses one triple product for each of four volumes: 36*384*36*36 are covered a
/// case. An edge takes 3 operations, a cross product 9, a dot product 5, and each distinct one
/// counts once (Kensler and Shirley 2006, section 4).
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    cargo xtask opcount --case packet --volume V\n  \
    cargo xtask opcount --case triangles --stored --volume any\n  \
    cargo xtask opcount --case packet --direction packet\n  \
    cargo xtask opcount --model ports --ports mul+fma=2,add=2\n  \
    cargo xtask opcount --kernel runs/packet-sse2-shrinking-seed1\n  \
    cargo xtask opcount --improve runs/packet-sse2-shrinking-seed1")]
pub struct Opcount {
    #[command(flatten)]
    asked: Asked,

    /// Count this recipe's, or run's champion's, operations; may be given several times
    #[arg(long, value_name = "RECIPE|RUN_DIR", conflicts_with_all = ["case", "volume", "amortise", "vertices", "origin", "direction", "improve"])]
    kernel: Vec<PathBuf>,

    /// Give this recipe, or run's champion, the cheapest formulation that is nearest to its own,
    /// and keep it if that is faster; may be given several times
    #[arg(long, value_name = "RECIPE|RUN_DIR", conflicts_with_all = ["case", "volume", "amortise", "vertices", "origin", "direction", "stored"])]
    improve: Vec<PathBuf>,

    /// With --improve: neither time nor write anything
    #[arg(long, requires = "improve")]
    untimed: bool,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Opcount {
    /// Counts, and prints what is found.
    pub fn run(self) -> anyhow::Result<()> {
        if !self.improve.is_empty() {
            return improve::run(&self.improve, &self.asked, self.untimed, self.json);
        }
        let out = BufWriter::new(io::stdout().lock());
        let printed = if self.kernel.is_empty() {
            let rows = self.asked.rows()?;
            match self.json {
                true => table::print_json(out, &rows),
                false => table::print_text(out, &rows),
            }
        } else {
            let kernels = kernels::read(&self.kernel, &self.asked)?;
            match self.json {
                true => kernels::print_json(out, &kernels),
                false => kernels::print_text(out, &kernels),
            }
        };
        match printed {
            // Whoever reads has seen enough, as `head` does.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            printed => Ok(printed?),
        }
    }
}

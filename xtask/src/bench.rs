//! `cargo xtask bench`: the rivals, the library's kernels and any champions in one table.

use std::path::PathBuf;

use measure::{Machine, Rustc};

use crate::arena::{ArenaFlags, Contestant, REFERENCE, interrupt_on_ctrl_c, with_spinner};
use crate::failure::bad_input;
use crate::files;
use crate::shootout::{print_table, shootout};

/// Times kernels together on the full workload.
///
/// The rivals take part, the library's kernels for the same scene, and the champions of the runs
/// that are named. Each is compiled as a library of its own; figures are ratios to
/// Möller-Trumbore's packet kernel, timed in turn with it.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    cargo xtask bench runs/packet-sse2-shrinking-seed1\n  \
    cargo xtask bench --kernel packet-shrinking --json")]
pub struct Bench {
    /// Time only this rival or kernel of the library; may be given several times
    #[arg(long, value_name = "NAME")]
    kernel: Vec<String>,

    /// Run directories, or recipes
    #[arg(value_name = "RUN_DIR|RECIPE")]
    champions: Vec<PathBuf>,

    #[command(flatten)]
    arena: ArenaFlags,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Bench {
    /// Times them and prints the table.
    pub fn run(self) -> anyhow::Result<()> {
        let arena = self.arena.arena()?;
        let mut contestants = arena.contestants();
        for recipe in files::read_recipes()? {
            let is_for = |isa| recipe.isas.contains(isa);
            if recipe.scene == arena.scene && arena.isas.iter().all(is_for) {
                contestants.push(Contestant {
                    name: recipe.name.to_string(),
                    kernels: arena.kernels(&recipe.program),
                });
            }
        }
        self.keep_asked(&mut contestants)?;
        for path in &self.champions {
            let recipe = files::read_champion(path)?;
            if recipe.scene != arena.scene {
                let (path, theirs, ours) = (path.display(), recipe.scene.name, arena.scene.name);
                return Err(bad_input(format!(
                    "{path} was bred for the scene {theirs}, not {ours}; name its scene with --scene"
                )));
            }
            contestants.push(Contestant {
                name: path.display().to_string(),
                kernels: arena.kernels(&recipe.program),
            });
        }
        let interrupt = interrupt_on_ctrl_c()?;
        let mut bench = arena.bench(&Rustc::of_this_build()?, &interrupt)?;
        let what = format!("timing {} kernels together", contestants.len() + 1);
        let standings = with_spinner(&what, || shootout(&mut bench, &contestants))?;
        if self.json {
            println!("{}", serde_json::to_string_pretty(&standings)?);
        } else {
            let machine = Machine::here();
            println!(
                "{}, {}, {} on {}",
                arena.scene.name, arena.isas, arena.scene.regime, machine.cpu
            );
            print_table(&standings);
        }
        Ok(())
    }

    /// Leaves only the kernels that were asked for, if any were.
    fn keep_asked(&self, contestants: &mut Vec<Contestant>) -> anyhow::Result<()> {
        let names: Vec<&str> = contestants.iter().map(|one| one.name.as_str()).collect();
        let known = |name: &str| name == REFERENCE || names.contains(&name);
        if let Some(unknown) = self.kernel.iter().find(|name| !known(name)) {
            return Err(bad_input(format!(
                "no kernel {unknown:?} for this scene and ISA; known: {REFERENCE}, {}",
                names.join(", ")
            )));
        }
        if !self.kernel.is_empty() {
            contestants.retain(|contestant| self.kernel.contains(&contestant.name));
        }
        Ok(())
    }
}

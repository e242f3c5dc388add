//! `cargo xtask promote`: a run's champion becomes a kernel of the library.

use std::path::PathBuf;

use emit::{Name, PackageError, Recipe, package};
use measure::max_p99_error;

use crate::accuracy::stability;
use crate::failure::bad_input;
use crate::files;
use crate::interrupt::interrupt_on_ctrl_c;
use crate::progress::with_spinner;

/// Makes a run's champion a checked-in recipe, and emits it.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  cargo xtask promote runs/packet-sse2-shrinking-seed1")]
pub struct Promote {
    /// The directory of the run, or a recipe
    #[arg(value_name = "RUN_DIR|RECIPE")]
    run: PathBuf,

    /// The kernel's name in the library [default: the scene and the regime]
    #[arg(long)]
    name: Option<String>,
}

impl Promote {
    /// Writes the recipe and the kernels.
    pub fn run(self) -> anyhow::Result<()> {
        let mut recipe = files::read_champion(&self.run)?;
        if let Some(name) = self.name {
            recipe.name = Name::new(name).map_err(bad_input)?;
            recipe = Recipe::from_json(&recipe.to_json()).map_err(bad_input)?;
        }
        let (Some(provenance), Some(error)) = (&recipe.provenance, recipe.error) else {
            return Err(bad_input(PackageError::ByHand(recipe.name.to_string())));
        };
        let (p99, limit) = (error.p99, max_p99_error(recipe.scene.watertight));
        if p99 > limit {
            return Err(bad_input(format!(
                "the champion's t is off by {p99:.1e} at the 99th percentile, and the library \
                 takes {limit:.0e} at most; breed on"
            )));
        }
        let path = format!("generated/recipes/{}.json", recipe.name);
        let mut recipes = files::read_recipes()?;
        let ratio = provenance.ratio;
        let old = recipes.iter().position(|other| other.name == recipe.name);
        let old = old.and_then(|index| recipes.remove(index).provenance);
        let old = old.map(|provenance| provenance.ratio);
        if let Some(old) = old.filter(|&old| old > ratio) {
            return Err(bad_input(format!(
                "the champion's {ratio:.2} times Möller-Trumbore is less than the {old:.2} of {path}; \
                 keep both with --name, or remove that file first"
            )));
        }
        let interrupt = interrupt_on_ctrl_c()?;
        let what = format!("judging {} by exact arithmetic", recipe.name);
        recipe.stability = with_spinner(&what, || stability::of(&recipe, &interrupt))?;
        recipes.push(recipe.clone());
        let package = package(&recipes)?;
        package.write(&files::in_repository("generated/src"))?;
        files::write(&files::in_repository(&path), &recipe.to_json())?;
        match old {
            None => println!("{path}: {ratio:.2} times Möller-Trumbore"),
            Some(old) => {
                println!("{path}: {ratio:.2} times Möller-Trumbore, in place of one of {old:.2}")
            }
        }
        Ok(())
    }
}

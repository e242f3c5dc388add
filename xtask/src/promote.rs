//! `cargo xtask promote`: a run's champion becomes a kernel of the library.

use std::path::PathBuf;

use emit::{Name, Recipe, package};

use crate::failure::bad_input;
use crate::files;

/// Makes a run's champion a checked-in recipe, and emits it.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  cargo xtask promote runs/packet-sse2-shrinking-seed1")]
pub struct Promote {
    /// The directory of the run
    #[arg(value_name = "RUN_DIR")]
    run: PathBuf,

    /// The kernel's name in the library [default: the scene and the regime]
    #[arg(long)]
    name: Option<String>,
}

impl Promote {
    /// Writes the recipe and the kernels.
    pub fn run(self) -> anyhow::Result<()> {
        let mut recipe = files::read_recipe(&self.run.join("champion.json"))?;
        if let Some(name) = self.name {
            recipe.name = Name::new(name).map_err(bad_input)?;
            recipe = Recipe::from_json(&recipe.to_json()).map_err(bad_input)?;
        }
        let path = format!("generated/recipes/{}.json", recipe.name);
        let mut recipes = files::read_recipes()?;
        let old = recipes.iter().position(|other| other.name == recipe.name);
        let old = old.map(|index| recipes.remove(index));
        recipes.push(recipe.clone());
        let package = package(&recipes)?;
        package.write(&files::in_repository("generated/src"))?;
        files::write(&files::in_repository(&path), &recipe.to_json())?;
        let ratio = recipe.provenance.ratio;
        match old {
            None => println!("{path}: {ratio:.2} times Möller-Trumbore"),
            Some(old) => println!(
                "{path}: {ratio:.2} times Möller-Trumbore, in place of one of {:.2}",
                old.provenance.ratio
            ),
        }
        Ok(())
    }
}

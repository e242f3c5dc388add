//! `cargo xtask promote`: champions of runs become kernels of the library.

use std::path::{Path, PathBuf};

use emit::{Name, PackageError, Recipe, package, package_name};
use measure::MAX_P99_ERROR;

use crate::accuracy::stability;
use crate::failure::bad_input;
use crate::files;
use crate::interrupt::interrupt_on_ctrl_c;
use crate::progress::with_spinner;

/// Makes champions of runs checked-in recipes, and emits them.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  cargo xtask promote runs/packet-sse2-shrinking-seed1
  cargo xtask promote runs/*/")]
pub struct Promote {
    /// Directories of runs, or recipes
    #[arg(value_name = "RUN_DIR|RECIPE", required = true)]
    runs: Vec<PathBuf>,

    /// The kernel's name in the library, if there is one [default: what it is for, as packet-edges-leaf-avx2]
    #[arg(long)]
    name: Option<String>,
}

/// A kernel that may enter the library.
struct Promoted {
    recipe: Recipe,
    ratio: f64,
    /// The ratio of the one of this name, if there is one.
    before: Option<f64>,
}

impl Promote {
    /// Writes the recipes and the kernels.
    pub fn run(self) -> anyhow::Result<()> {
        if self.name.is_some() && self.runs.len() > 1 {
            return Err(bad_input("--name names one kernel: promote that alone"));
        }
        let mut recipes = files::read_recipes()?;
        // Whoever may not enter is said before anybody is judged.
        let promoted = self.runs.iter().map(|run| self.promoted(run, &recipes));
        let mut promoted: Vec<Promoted> = promoted.collect::<Result<_, _>>()?;
        let interrupt = interrupt_on_ctrl_c()?;
        for Promoted { recipe, .. } in &mut promoted {
            let what = format!("judging {} by exact arithmetic", recipe.name);
            recipe.stability = with_spinner(&what, || stability::of(recipe, &interrupt))?;
        }
        for Promoted { recipe, .. } in &promoted {
            recipes.retain(|other| other.name != recipe.name);
            recipes.push(recipe.clone());
        }
        let package = package(&recipes).map_err(bad_input)?;
        package.write(&files::in_repository("generated/src"))?;
        for one in &promoted {
            let path = path(&one.recipe);
            files::write(&files::in_repository(&path), &one.recipe.to_json())?;
            let before = one.before.map_or(String::new(), |before| {
                format!(", in place of one of {before:.2}")
            });
            println!("{path}: {:.2} times Möller-Trumbore{before}", one.ratio);
        }
        Ok(())
    }

    /// A champion under its name in the library, if it is good enough.
    fn promoted(&self, run: &Path, recipes: &[Recipe]) -> anyhow::Result<Promoted> {
        let mut recipe = files::read_champion(run)?;
        recipe.name = match &self.name {
            Some(name) => Name::new(name).map_err(bad_input)?,
            None => package_name(&recipe),
        };
        let recipe = Recipe::from_json(&recipe.to_json()).map_err(bad_input)?;
        let (Some(provenance), Some(error)) = (&recipe.provenance, recipe.error) else {
            return Err(bad_input(PackageError::ByHand(recipe.name.to_string())));
        };
        let p99 = error.p99;
        if p99 > MAX_P99_ERROR {
            return Err(bad_input(format!(
                "{}: the champion's t is off by {p99:.1e} at the 99th percentile, and the library \
                 takes {MAX_P99_ERROR:.0e} at most; breed on",
                run.display()
            )));
        }
        let ratio = provenance.ratio;
        let before = recipes.iter().find(|other| other.name == recipe.name);
        let before = before.and_then(|before| Some(before.provenance.as_ref()?.ratio));
        if let Some(before) = before.filter(|&before| before > ratio) {
            return Err(bad_input(format!(
                "the champion's {ratio:.2} times Möller-Trumbore is less than the {before:.2} of {}; \
                 keep both with --name, or remove that file first",
                path(&recipe)
            )));
        }
        Ok(Promoted {
            ratio,
            before,
            recipe,
        })
    }
}

/// Where a recipe is checked in.
fn path(recipe: &Recipe) -> String {
    format!("generated/recipes/{}.json", recipe.name)
}

//! `cargo xtask retime`: checked-in kernels timed again on this machine.

use anyhow::Context;
use emit::{Name, Recipe, package};
use indicatif::ProgressBar;
use measure::{Interrupt, Machine, Rustc};

use crate::arena::{Arena, Contestant};
use crate::benches::disbelieved;
use crate::failure::bad_input;
use crate::files;
use crate::interrupt::interrupt_on_ctrl_c;
use crate::progress::bar;
use crate::shootout::{Standing, shootout};

/// Times kernels of the library again, beside one another on the full workload, and writes what they make into their
/// recipes.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  cargo xtask retime ray-
  cargo xtask retime packet-leaf-avx2 packet-shrinking-avx2")]
pub struct Retime {
    /// Beginnings of names; all that begin so are timed
    #[arg(value_name = "NAME", required = true)]
    names: Vec<String>,
}

/// Kernels that are timed together: they require the same, but for promises.
struct Group {
    arena: Arena,
    recipes: Vec<Recipe>,
}

impl Retime {
    /// Times them, prints what they had before and have now, and writes the recipes and the package.
    pub fn run(self) -> anyhow::Result<()> {
        let mut recipes = files::read_recipes()?;
        for name in &self.names {
            if !recipes.iter().any(|one| begins(one, name)) {
                return Err(bad_input(format!(
                    "no kernel of the library has a name that begins with {name:?}; generated/recipes has them all"
                )));
            }
        }
        let asked = |recipe: &&Recipe| self.names.iter().any(|name| begins(recipe, name));
        let groups = groups(recipes.iter().filter(asked))?;
        let (rustc, interrupt) = (Rustc::of_this_build()?, interrupt_on_ctrl_c()?);
        let bar = bar(groups.len(), "timing kernels of the library again");
        let width = recipes.iter().map(|one| one.name.to_string().len()).max();
        let width = width.unwrap_or(0);
        println!("{:width$}  before     now          worst layout", "kernel");
        for group in groups {
            // What was timed is kept, whatever becomes of the rest.
            let timed = group.time(&rustc, &interrupt, &bar, width)?;
            for recipe in timed {
                let path = format!("generated/recipes/{}.json", recipe.name);
                files::write(&files::in_repository(&path), &recipe.to_json())?;
                let place = recipes.iter().position(|one| one.name == recipe.name);
                recipes[place.context("it was read")?] = recipe;
            }
            let package = package(&recipes).map_err(bad_input)?;
            package.write(&files::in_repository("generated/src"))?;
        }
        bar.finish_and_clear();
        Ok(())
    }
}

fn begins(recipe: &Recipe, name: &str) -> bool {
    recipe.name.to_string().starts_with(name)
}

/// Recipes by where they are timed.
fn groups<'a>(recipes: impl Iterator<Item = &'a Recipe>) -> anyhow::Result<Vec<Group>> {
    let mut groups: Vec<Group> = Vec::new();
    for recipe in recipes {
        let arena = Arena::of(recipe);
        arena.check()?;
        match groups.iter_mut().find(|group| group.arena == arena) {
            Some(group) => group.recipes.push(recipe.clone()),
            None => groups.push(Group {
                arena,
                recipes: vec![recipe.clone()],
            }),
        }
    }
    Ok(groups)
}

impl Group {
    /// Times its kernels, prints a line for each, and gives them with their new figures.
    fn time(
        self,
        rustc: &Rustc,
        interrupt: &Interrupt,
        bar: &ProgressBar,
        width: usize,
    ) -> anyhow::Result<Vec<Recipe>> {
        let Group { arena, mut recipes } = self;
        bar.set_message(arena.name());
        let contestants = recipes.iter().map(|recipe| Contestant {
            name: recipe.name.to_string(),
            kernels: arena.kernels(&recipe.program),
        });
        let contestants: Vec<Contestant> = contestants.collect();
        let mut bench = arena.bench(rustc, interrupt)?;
        let standings = shootout(&mut bench, &contestants)?;
        if let Some(line) = disbelieved(bench.processes()) {
            bar.suspend(|| eprintln!("{line}"));
        }
        for recipe in &mut recipes {
            let name = recipe.name.to_string();
            let standing = standings.iter().find(|one| one.kernel == name);
            let standing = standing.context("everyone has a standing")?;
            let line = update(recipe, standing, rustc)?;
            bar.suspend(|| println!("{name:width$}  {line}"));
        }
        bar.inc(1);
        Ok(recipes)
    }
}

/// Writes figures into a recipe. Gives the rest of its line.
fn update(recipe: &mut Recipe, standing: &Standing, rustc: &Rustc) -> anyhow::Result<String> {
    let &Standing {
        ratio,
        uncertainty,
        worst_layout,
        verdict,
        ..
    } = standing;
    if standing.accuracy.is_none() {
        anyhow::bail!("{}: {verdict}; its recipe is as it was", recipe.name);
    }
    let provenance = recipe.provenance.as_mut();
    let provenance = provenance.context("kernels of the library have a provenance")?;
    let line = format!(
        "{:5.2}x   {ratio:5.2}x ±{:4.1}%  {:>9}",
        provenance.ratio,
        100.0 * uncertainty,
        worst_layout.map_or("-".into(), |worst| format!("{worst:.2}x")),
    );
    provenance.ratio = ratio;
    provenance.worst_layout = worst_layout;
    provenance.cpu = Name::of(&Machine::here().cpu);
    provenance.rustc = Name::new(rustc.number()).unwrap_or_else(|_| Name::of(rustc.number()));
    Ok(line)
}

//! `cargo xtask retime`: checked-in kernels timed again on this machine.

use anyhow::Context;
use emit::{Name, Recipe, package};
use indicatif::ProgressBar;
use measure::{Interrupt, Machine, Rustc};
use similar::{ChangeTag, TextDiff};

use crate::arena::{Arena, Contestant};
use crate::benches::disbelieved;
use crate::failure::bad_input;
use crate::files;
use crate::interrupt::interrupt_on_ctrl_c;
use crate::progress::bar;
use crate::shootout::{Standing, shootout};

/// Times kernels of the library again, beside one another on the full workload, and writes what they make into their
/// recipes. Overwrites generated/recipes and generated/src as it goes: what was printed is kept, however it ends.
///
/// Which kernel the library calls goes by these figures, so kernels that serve the same scenes are better timed
/// together; which choices change is printed. A kernel takes about five seconds an instruction set.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  cargo xtask retime ray-
  cargo xtask retime packet-leaf packet-portable-leaf
  cargo xtask retime --all")]
pub struct Retime {
    /// Beginnings of names; all that begin so are timed
    #[arg(value_name = "NAME", required_unless_present = "all")]
    names: Vec<String>,

    /// All kernels of the library
    #[arg(long, conflicts_with = "names")]
    all: bool,
}

/// Which kernel serves which scene.
const CHOICES: &str = "generated/src/kernels/choice.rs";

/// The lines by which one text differs from another, each with its sign.
fn changed<'a>(before: &'a str, after: &'a str) -> impl Iterator<Item = String> {
    let diff = TextDiff::from_lines(before, after);
    let changes: Vec<String> = diff
        .iter_all_changes()
        .filter(|change| change.tag() != ChangeTag::Equal)
        .map(|change| format!("{} {}", change.tag(), change.value().trim()))
        .collect();
    changes.into_iter()
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
            if name.is_empty() || !recipes.iter().any(|one| begins(one, name)) {
                return Err(bad_input(format!(
                    "no kernel of the library has a name that begins with {name:?}; names are those of the files in \
                     generated/recipes, without .json, and --all is all of them"
                )));
            }
        }
        let asked =
            |recipe: &&Recipe| self.all || self.names.iter().any(|name| begins(recipe, name));
        let groups = groups(recipes.iter().filter(asked))?;
        let kernels: usize = groups.iter().map(|group| group.recipes.len()).sum();
        // Refused before anything is timed, not after.
        let directory = files::in_repository("generated/recipes");
        tempfile::NamedTempFile::new_in(&directory).map_err(|error| {
            bad_input(format!("cannot write in {}: {error}", directory.display()))
        })?;
        let (rustc, interrupt) = (Rustc::of_this_build()?, interrupt_on_ctrl_c()?);
        let steps = groups.len();
        let bar = bar(steps, &format!("timing {kernels} kernels, {steps} batches"));
        let widths = recipes.iter().map(|one| one.name.to_string().len());
        let width = widths.max().unwrap_or(0);
        println!("{:width$}  before     now          worst layout", "kernel");
        for group in groups {
            let (timed, lines) = group.time(&rustc, &interrupt, &bar, width)?;
            for recipe in &timed {
                let place = recipes.iter().position(|one| one.name == recipe.name);
                recipes[place.context("it was read")?] = recipe.clone();
            }
            // What takes long is done before the first file is written, so that no kill comes between.
            let package = package(&recipes).map_err(bad_input)?;
            for recipe in &timed {
                let path = format!("generated/recipes/{}.json", recipe.name);
                files::write(&files::in_repository(&path), &recipe.to_json())?;
            }
            let choices = files::in_repository(CHOICES);
            let before = std::fs::read_to_string(&choices).unwrap_or_default();
            package.write(&files::in_repository("generated/src"))?;
            let after = std::fs::read_to_string(&choices).unwrap_or_default();
            bar.suspend(|| {
                lines.iter().for_each(|line| println!("{line}"));
                changed(&before, &after).for_each(|line| println!("choice: {line}"));
            });
            bar.inc(1);
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
    /// Times its kernels. Gives them with their new figures, and a line for each.
    fn time(
        self,
        rustc: &Rustc,
        interrupt: &Interrupt,
        bar: &ProgressBar,
        width: usize,
    ) -> anyhow::Result<(Vec<Recipe>, Vec<String>)> {
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
        let mut lines = Vec::new();
        for recipe in &mut recipes {
            let name = recipe.name.to_string();
            let standing = standings.iter().find(|one| one.kernel == name);
            let standing = standing.context("every contestant has a standing")?;
            let line = update(recipe, standing, rustc)?;
            lines.push(format!("{name:width$}  {line}"));
        }
        Ok((recipes, lines))
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
    provenance.uncertainty = Some(uncertainty);
    provenance.worst_layout = worst_layout;
    provenance.cpu = Name::of(&Machine::here().cpu);
    provenance.rustc = Name::new(rustc.number()).unwrap_or_else(|_| Name::of(rustc.number()));
    Ok(line)
}

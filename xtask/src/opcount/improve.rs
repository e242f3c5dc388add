//! `cargo xtask opcount --improve`: what Kensler and Shirley did by hand with the best programs of
//! their search, step by step, and whether it was worth it.

use std::path::{Path, PathBuf};

use emit::{Improved, Name, Recipe, rules};
use measure::{Lead, MAX_P99_ERROR, Rustc};
use program::{Improvement, Op, Optimum, Program};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde_json::json;
use similar::TextDiff;
use volumes::{Cost, Point};

use super::asked::Asked;
use crate::arena::{Arena, Contestant};
use crate::failure::bad_input;
use crate::files;
use crate::interrupt::interrupt_on_ctrl_c;
use crate::progress::with_spinner;
use crate::shootout::{Standing, shootout};

/// Rays and triangles in exact arithmetic that a program has to answer as before.
const SAMPLES: usize = 4000;

/// A champion and what it became.
struct Champion {
    path: PathBuf,
    recipe: Recipe,
    improvement: Improvement,
}

/// How both did, timed together.
struct Timed {
    before: Standing,
    after: Standing,
    /// How many times as fast it became, as a logarithm.
    lead: Lead,
}

impl Timed {
    /// Whether it is faster beyond doubt.
    fn is_faster(&self) -> bool {
        self.lead.mean > 1.96 * self.lead.error
    }

    /// Whether the library's limit of error lets it in, or had not let in what it was.
    fn is_accurate(&self) -> bool {
        let is_below = |one: &Standing| one.accuracy.is_some_and(|is| is.p99 <= MAX_P99_ERROR);
        is_below(&self.after) || !is_below(&self.before)
    }

    /// Whether it takes the place of what it was.
    fn is_kept(&self) -> bool {
        self.is_faster() && self.is_accurate()
    }
}

/// Improves champions, shows every step, times them, and keeps what became faster.
pub fn run(paths: &[PathBuf], asked: &Asked, untimed: bool, json: bool) -> anyhow::Result<()> {
    let mut champions = Vec::new();
    for path in paths {
        let recipe = files::read_champion(path)?;
        let mut statements = recipe.program.statements().iter();
        if statements.any(|statement| statement.op == Op::Load(Point::B)) {
            return Err(bad_input(format!(
                "{}: the program has the volume of a segment's other end, which no formulation knows; \
                 improve a champion of another scene",
                path.display()
            )));
        }
        let optimum = Optimum::new(asked.case_of(&recipe), asked.model()?);
        let improvement = optimum.improve(&recipe.program, &rules(&recipe.scene, &recipe.isas));
        let champion = Champion {
            path: path.clone(),
            recipe,
            improvement,
        };
        let proof = champion.proof()?;
        if !json {
            champion.print_steps(&proof);
        }
        champions.push(champion);
    }
    let timed = match untimed {
        true => champions.iter().map(|_| None).collect(),
        false => time(&champions)?,
    };
    if json {
        print_json(&champions, &timed)?;
    } else if !untimed {
        print_table(&champions, &timed);
    }
    for (champion, timed) in champions.iter().zip(&timed) {
        if let Some(timed) = timed.as_ref().filter(|timed| timed.is_kept()) {
            champion.keep(timed, &asked.model_name())?;
        }
    }
    Ok(())
}

impl Champion {
    /// Proves that nothing but the formulation changed. Gives a clause about it.
    fn proof(&self) -> anyhow::Result<String> {
        let Improvement {
            rewritten,
            clean,
            finished,
            ..
        } = &self.improvement;
        let mut rng = ChaCha8Rng::seed_from_u64(0);
        let before = &self.recipe.program;
        for step in [rewritten, clean, finished] {
            before
                .equals(step, SAMPLES, &mut rng)
                .map_err(|difference| {
                    anyhow::anyhow!(
                        "{}: the improved program differs: {difference}",
                        self.name()
                    )
                })?;
        }
        let volumes = finished.formulas().len();
        Ok(format!(
            "{volumes} volumes equal as polynomials; tests and exits as before; {SAMPLES} rays and \
             triangles, half of them tied, answered alike in exact arithmetic"
        ))
    }

    fn name(&self) -> String {
        self.path.display().to_string()
    }

    fn print_steps(&self, proof: &str) {
        let Recipe { scene, program, .. } = &self.recipe;
        let Improvement {
            formulation,
            tried,
            rewritten,
            clean,
            finished,
            before,
            after,
            of_volumes,
        } = &self.improvement;
        let operations = |cost: &Cost, of_volumes: &Cost| {
            format!("{cost} a ray and triangle; its volumes, {of_volumes}")
        };
        println!("{} ({}, {})\n", self.name(), scene.name, scene.regime);
        say("formulation", &volumes(program));
        say("structure", &structure(program));
        say("operations", &operations(before, &of_volumes[0]));
        match formulation {
            None => say(
                "nearest",
                &format!("its own: none of the {tried} cheapest makes it cheaper"),
            ),
            Some(formulation) => {
                let changes = program.changes(clean);
                let found = format!(
                    "of the {tried} cheapest that which changes the fewest statements, {changes}:"
                );
                say("nearest", &format!("{found}\n{formulation}"));
                say("rewritten", &diff(program, rewritten));
                say("cleaned", &diff(rewritten, clean));
            }
        }
        say("mask", &diff(clean, finished));
        say("proved", proof);
        say("operations", &operations(after, &of_volumes[1]));
        println!();
    }

    /// Writes the improved recipe: into the run's directory, or beside whoever asks.
    fn keep(&self, timed: &Timed, model: &str) -> anyhow::Result<()> {
        let mut recipe = self.recipe.clone();
        recipe.program = self.improvement.finished.clone();
        // That was the program before.
        recipe.stability = None;
        if let Some(accuracy) = timed.after.accuracy {
            recipe.error = recipe.error.map(|_| accuracy_profile(accuracy));
        }
        if let Some(provenance) = &mut recipe.provenance {
            provenance.ratio = timed.after.ratio;
            provenance.uncertainty = Some(timed.after.uncertainty);
            provenance.worst_layout = timed.after.worst_layout;
            provenance.improved = Some(Improved {
                model: Name::new(model).map_err(bad_input)?,
                cost_before: self.improvement.before.operations(),
                cost: self.improvement.after.operations(),
                ratio_before: timed.before.ratio,
            });
        }
        let path = match self.path.is_dir() {
            true => self.path.join("improved.json"),
            false => Path::new(&format!("{}-improved.json", recipe.name)).to_owned(),
        };
        files::write(&path, &recipe.to_json())?;
        eprintln!("kept       {0}; cargo xtask promote {0}", path.display());
        Ok(())
    }
}

fn accuracy_profile(accuracy: measure::Accuracy) -> emit::ErrorProfile {
    emit::ErrorProfile {
        hits: accuracy.hits,
        median: accuracy.median,
        p99: accuracy.p99,
        max: accuracy.max,
    }
}

/// A paragraph with what it is about before it.
fn say(about: &str, text: &str) {
    let mut about = about;
    for line in text.lines() {
        println!("{}", format!("{about:11}  {line}").trim_end());
        about = "";
    }
}

fn volumes(program: &Program) -> String {
    let lines = program.formulas().into_iter();
    let lines = lines.map(|(volume, formula)| format!("{volume:2} = {formula}\n"));
    lines.collect()
}

/// Divisions, tests and exits.
fn structure(program: &Program) -> String {
    let lines = program.listing().into_iter().zip(program.statements());
    let told = lines.filter(|(_, statement)| {
        use program::Op;
        statement.op.is_test()
            || matches!(
                statement.op,
                Op::Exit
                    | Op::TMultiply
                    | Op::TDivide
                    | Op::Reciprocal(_)
                    | Op::BarycentricMultiply(_)
                    | Op::BarycentricRest(_)
            )
    });
    let lines = told.map(|(line, _)| line.replace("mask = ", "").replace("mask and ", "") + "\n");
    lines.collect()
}

/// What changed between two programs, a statement a line.
fn diff(before: &Program, after: &Program) -> String {
    let [before, after] = [before, after].map(|program| program.listing().join("\n") + "\n");
    if before == after {
        return "nothing".into();
    }
    let diff = TextDiff::from_lines(&before, &after);
    let mut lines = String::new();
    for (number, hunk) in diff
        .unified_diff()
        .context_radius(1)
        .iter_hunks()
        .enumerate()
    {
        if number > 0 {
            lines += "  ...\n";
        }
        for change in hunk.iter_changes() {
            lines += &format!("{} {}", change.tag(), change.value());
        }
    }
    lines
}

/// Times originals and improved ones together, those of one scene at a time.
fn time(champions: &[Champion]) -> anyhow::Result<Vec<Option<Timed>>> {
    let mut timed: Vec<Option<Timed>> = champions.iter().map(|_| None).collect();
    let mut arenas: Vec<Arena> = Vec::new();
    for Champion { recipe, .. } in champions {
        let arena = Arena::of(recipe);
        arena.check()?;
        if !arenas.contains(&arena) {
            arenas.push(arena);
        }
    }
    let interrupt = interrupt_on_ctrl_c()?;
    for arena in arenas {
        let here = champions.iter().enumerate();
        let here = here.filter(|(_, champion)| Arena::of(&champion.recipe) == arena);
        let here: Vec<(usize, &Champion)> = here.collect();
        let mut contestants = Vec::new();
        for (number, champion) in &here {
            for (which, program) in [
                (BEFORE, &champion.recipe.program),
                (AFTER, &champion.improvement.finished),
            ] {
                contestants.push(Contestant {
                    name: format!("{number} {which}"),
                    kernels: arena.kernels(program),
                });
            }
        }
        let rustc = Rustc::of_this_build().map_err(bad_input)?;
        let mut bench = arena.bench(&rustc, &interrupt)?;
        let what = format!("timing {} kernels together", contestants.len() + 1);
        let standings = with_spinner(&what, || shootout(&mut bench, &contestants))?;
        for (number, champion) in here {
            let standing = |which: &str| {
                let name = format!("{number} {which}");
                let found = standings.iter().find(|one| one.kernel == name);
                let found = found.expect("every contestant has its standing");
                match found.accuracy {
                    Some(_) => Ok(found.clone()),
                    None => Err(anyhow::anyhow!(
                        "{}, {which}: {}",
                        champion.name(),
                        found.verdict
                    )),
                }
            };
            let (before, after) = (standing(BEFORE)?, standing(AFTER)?);
            let lead = Lead::of(&after.rounds, &before.rounds);
            timed[number] = Some(Timed {
                before,
                after,
                lead,
            });
        }
    }
    Ok(timed)
}

const BEFORE: &str = "GA";
const AFTER: &str = "GA+";

/// As the paper's Table 1: GA and GA+ side by side.
fn print_table(champions: &[Champion], timed: &[Option<Timed>]) {
    let width = champions.iter().map(|one| one.name().len()).max();
    let width = width.unwrap_or(0).max(8);
    println!(
        "{:width$}  {:>11}  {:>11}  {:>7}  {:>7}  {:>13}  kept",
        "champion", "operations", "of GA+", "GA", "GA+", "gain"
    );
    for (champion, timed) in champions.iter().zip(timed) {
        let Improvement { before, after, .. } = &champion.improvement;
        let (name, before, after) = (champion.name(), before.to_string(), after.to_string());
        let Some(timed) = timed else { continue };
        let (gain, error) = percent(timed.lead);
        let kept = match (timed.is_faster(), champion.improvement.formulation) {
            (true, _) if timed.is_accurate() => "GA+",
            (true, _) => "GA, GA+ is not accurate enough for the library",
            (false, None) => "GA, whose formulation is the cheapest already",
            (false, Some(_)) => "GA, GA+ is not clearly faster",
        };
        println!(
            "{name:width$}  {before:>11}  {after:>11}  {:6.2}x  {:6.2}x  {gain:+5.1}% ±{error:4.1}%  {kept}",
            timed.before.ratio, timed.after.ratio,
        );
    }
}

/// A lead in percent, and the half-width of its 95% interval.
fn percent(lead: Lead) -> (f64, f64) {
    (lead.mean.exp_m1() * 100.0, lead.error * 196.0)
}

fn print_json(champions: &[Champion], timed: &[Option<Timed>]) -> anyhow::Result<()> {
    let rows = champions.iter().zip(timed).map(|(champion, timed)| {
        let improvement = &champion.improvement;
        let formulation = improvement.formulation.map(|formulation| {
            let formulas = formulation.products.into_iter();
            let formulas =
                formulas.map(|(volume, one)| (volume.to_string(), json!(one.to_string())));
            serde_json::Map::from_iter(formulas)
        });
        json!({
            "champion": champion.name(),
            "kernel": champion.recipe.name,
            "cost_before": improvement.before.operations(),
            "cost": improvement.after.operations(),
            "changes": champion.recipe.program.changes(&improvement.finished),
            "formulation": formulation,
            "ratio_before": timed.as_ref().map(|timed| timed.before.ratio),
            "ratio": timed.as_ref().map(|timed| timed.after.ratio),
            "gain": timed.as_ref().map(|timed| timed.lead.mean.exp_m1()),
            "uncertainty": timed.as_ref().map(|timed| 1.96 * timed.lead.error),
            "kept": timed.as_ref().map(Timed::is_faster),
        })
    });
    let rows: Vec<_> = rows.collect();
    println!("{}", serde_json::to_string_pretty(&rows)?);
    Ok(())
}

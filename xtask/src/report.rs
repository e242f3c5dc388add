//! `cargo xtask report`: the library's page, by which its kernels and their rivals are compared in speed and in
//! what they get wrong.
//!
//! ```text
//! flags ─► cases ─► timed as by `bench`, judged as by `accuracy` ─► library.rs: the data ─► JSON
//!                                         overview.rs: sections of plots and tables ─► HTML
//! ```

mod axis;
mod catalogue;
mod labels;
mod library;
mod lines;
mod overview;
mod page;
mod scatter;
mod section;
mod tables;
mod text;

use std::path::PathBuf;

use emit::Recipe;
use measure::{Interrupt, Look, Rustc};
use scene::{Regime, SceneModel};

use crate::accuracy::{self, Profiled};
use crate::arena::PACKETS;
use crate::asked::{Asked, Usual};
use crate::bench::running::{self, PARTS, Running};
use crate::cases::Case;
use crate::failure::bad_input;
use crate::interrupt::interrupt_on_ctrl_c;
use crate::{files, progress};
use library::Library;

/// Writes the library's page: its kernels and their rivals by speed, errors of t and leaks.
///
/// Kernels are timed together as by `bench`, and judged as by `accuracy`; the page shows who is beaten
/// in nothing, errors as everything is scaled or moved away, the extremes that each kernel fails at,
/// and the catalogue. Without flags: the scenes and regimes that the library's kernels were bred for, with
/// all rivals. The page is one file, which loads nothing.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    cargo xtask report\n  \
    cargo xtask report --isa avx2 --run runs/packet-avx2-leaf-seed1 --out avx2.html\n  \
    cargo xtask report --scene single --quick --samples 2000 --json")]
pub struct Report {
    #[command(flatten)]
    asked: Asked,

    /// A run directory, or a recipe, whose champion takes part; may be given several times. Without
    /// --scene, only their scenes and regimes are looked at
    #[arg(long, value_name = "RUN_DIR|RECIPE")]
    run: Vec<PathBuf>,

    /// Time on a quarter of the rays: a quick look
    #[arg(long)]
    quick: bool,

    /// Rays of each of the lab's 22 cases; kernels for a common origin have a 32nd of them
    #[arg(long, value_name = "N", default_value = "20000", value_parser = accuracy::samples)]
    samples: u64,

    /// Seed of the lab's cases: what is reported is judged on other rays than what was chosen by
    #[arg(long, value_name = "N", default_value_t = accuracy::HELD_OUT)]
    seed: u64,

    /// Where to write the page
    #[arg(long, value_name = "FILE", default_value = "target/report.html")]
    out: PathBuf,

    /// Print the data of the page as JSON
    #[arg(long)]
    json: bool,
}

/// The plain scenes in which the library's kernels can meet: what is tested together in every regime that some were
/// bred on, whatever they promise.
fn scenes(recipes: &[Recipe]) -> anyhow::Result<Vec<SceneModel>> {
    let mut scenes = Vec::new();
    for plain in Usual::presets(false)?.scenes {
        for &regime in Regime::ALL {
            let scene = SceneModel {
                regime,
                ..plain.clone()
            };
            let is_met = |recipe: &Recipe| {
                let own = &recipe.scene;
                (own.grouping, own.origin, own.regime) == (scene.grouping, scene.origin, regime)
            };
            if recipes.iter().any(is_met) {
                scenes.push(scene);
            }
        }
    }
    Ok(scenes)
}

impl Report {
    /// Times, judges and writes the page. Stopped before its end, it writes none.
    pub fn run(self) -> anyhow::Result<()> {
        let recipes = files::read_recipes()?;
        let usual = Usual {
            scenes: scenes(&recipes)?,
            all_regimes: false,
        };
        let cases = self.asked.cases(&self.run, &usual)?;
        accuracy::check_judgeable(&cases)?;
        if self.out.is_dir() {
            let out = self.out.display();
            return Err(bad_input(format!(
                "--out {out} is a directory; name a file in it"
            )));
        }
        let interrupt = interrupt_on_ctrl_c()?;
        let rustc = Rustc::of_this_build()?;
        let running = self.time(&cases, &rustc, &interrupt)?;
        let look = Look {
            samples: self.samples,
            seed: self.seed,
        };
        let mut profiled: Vec<Profiled> = Vec::new();
        accuracy::judge(&cases, look, &interrupt, &mut profiled)?;
        let packets = PACKETS * self.parts() / PARTS;
        let library = Library::new(&running, &profiled, packets, look, &rustc, &recipes);
        files::write(&self.out, &overview::html(&library))?;
        if self.json {
            println!("{}", serde_json::to_string_pretty(&library)?);
        } else {
            for case in &library.cases {
                let front: Vec<&str> = case.front().map(|(_, one)| one.name()).collect();
                println!(
                    "{}: on the front are {}",
                    case.title(", "),
                    front.join(", ")
                );
            }
            println!("page       {}", self.out.display());
        }
        Ok(())
    }

    /// How many of the parts of the rounds are timed.
    fn parts(&self) -> usize {
        if self.quick { 1 } else { PARTS }
    }

    fn time<'a>(
        &self,
        cases: &'a [Case],
        rustc: &Rustc,
        interrupt: &Interrupt,
    ) -> anyhow::Result<Vec<Running<'a>>> {
        let parts = self.parts();
        let what = format!("timing {} cases", cases.len());
        let bar = progress::bar(cases.len() * (1 + parts), &what);
        let mut running = Vec::new();
        running::build_and_time(cases, parts, rustc, interrupt, &bar, &mut running)?;
        bar.finish_and_clear();
        Ok(running)
    }
}

//! `cargo xtask report`: the library's page, by which its kernels and their rivals are compared in speed and in
//! what they get wrong; and with a run directory, that run's page (`report/run.rs`).
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
mod run;
mod scatter;
mod section;
mod tables;
mod text;

use std::path::{Path, PathBuf};

use emit::Recipe;
use measure::{Interrupt, Look, Rustc};
use scene::{Regime, SceneModel};
use serde::Serialize;

use crate::accuracy::{self, Profiled};
use crate::arena::PACKETS;
use crate::asked::{Asked, Usual};
use crate::bench::running::{self, PARTS, Running};
use crate::cases::Case;
use crate::failure::bad_input;
use crate::interrupt::interrupt_on_ctrl_c;
use crate::{files, progress};
use library::Library;
use run::RunPage;

/// Writes the library's page: its kernels and their rivals by speed, errors of t and leaks; or the page of a run.
///
/// Of a run directory: how the search went, where its champion comes from, which choices survived and what each is
/// worth, which is timed; the noise, what was tried twice or failed, the champion's code, and the table at the end.
/// Of the library:
/// Kernels are timed together as by `bench`, and judged as by `accuracy`; the page shows who is beaten
/// in nothing, errors as everything is scaled or moved away, the extremes that each kernel fails at,
/// and the catalogue. Without flags: the scenes and regimes that the library's kernels were bred for, with
/// all rivals. The page is one file, which loads nothing.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    cargo xtask report\n  \
    cargo xtask report runs/packet-sse2-shrinking-seed1\n  \
    cargo xtask report --isa avx2 --run runs/packet-avx2-leaf-seed1 --out avx2.html\n  \
    cargo xtask report --scene single --quick --samples 2000 --json")]
pub struct Report {
    /// The run that the page is about [default: none, and the page is the library's]
    #[arg(value_name = "RUN_DIR", conflicts_with_all = [
        "kernel", "scene", "isa", "triangles", "run", "quick", "samples", "seed", "grouping", "origin", "query",
        "culling", "outputs", "range", "stored", "numeric", "watertight", "regime", "bounds",
    ])]
    directory: Option<PathBuf>,

    /// With a run: time nothing, and leave out what the champion's choices are worth
    #[arg(long, requires = "directory")]
    no_timing: bool,

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

    /// Where to write the page [default: target/report.html, or report.html in the run's directory]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

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
    /// Writes the page. Stopped before its end, it writes none.
    pub fn run(self) -> anyhow::Result<()> {
        if let Some(out) = self.out.as_ref().filter(|out| out.is_dir()) {
            let out = out.display();
            return Err(bad_input(format!(
                "--out {out} is a directory; name a file in it"
            )));
        }
        match &self.directory {
            Some(directory) => self.of_run(directory),
            None => self.of_library(),
        }
    }

    /// Reads a run, times its champion's choices and writes its page.
    fn of_run(&self, directory: &Path) -> anyhow::Result<()> {
        let interrupt = interrupt_on_ctrl_c()?;
        let page = RunPage::new(directory, !self.no_timing, &interrupt)?;
        let in_run = || directory.join("report.html");
        let out = self.out.clone().unwrap_or_else(in_run);
        self.write(&out, &run::html(&page), &page, &[])
    }

    /// Times, judges and writes the library's page.
    fn of_library(&self) -> anyhow::Result<()> {
        let recipes = files::read_recipes()?;
        let usual = Usual {
            scenes: scenes(&recipes)?,
            all_regimes: false,
        };
        let cases = self.asked.cases(&self.run, &usual)?;
        accuracy::check_judgeable(&cases)?;
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
        let fronts = library.cases.iter().map(|case| {
            let front: Vec<&str> = case.front().map(|(_, one)| one.name()).collect();
            format!(
                "{}: on the front are {}",
                case.title(", "),
                front.join(", ")
            )
        });
        let fronts: Vec<String> = fronts.collect();
        let usual = || PathBuf::from("target/report.html");
        let out = self.out.clone().unwrap_or_else(usual);
        self.write(&out, &overview::html(&library), &library, &fronts)
    }

    /// Writes a page. Prints its data if JSON is asked for, or else what is to be said of it and where it is.
    fn write(
        &self,
        out: &Path,
        html: &str,
        data: &impl Serialize,
        said: &[String],
    ) -> anyhow::Result<()> {
        files::write(out, html)?;
        if self.json {
            println!("{}", serde_json::to_string_pretty(data)?);
        } else {
            for line in said {
                println!("{line}");
            }
            println!("page       {}", out.display());
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

//! Recipes: what a kernel is emitted from, byte for byte, and where it comes from.

use std::fmt;

use program::{Breach, Program};
use scene::{Contradiction, SceneModel};
use serde::{Deserialize, Serialize};

use crate::in_scene::{operations, rules};
use crate::isa::Isa;
use crate::name::Name;

/// The most bytes that a recipe's file may have.
const MAX_BYTES: usize = 1 << 20;

/// A program with the scene it was bred for, its origin and its measured error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// The kernel's name: the emitted function's, with underscores.
    pub name: Name,
    /// What the scene requires.
    pub scene: SceneModel,
    /// The instruction sets that it is emitted for.
    pub isas: Vec<Isa>,
    /// How it came about; none if it was entered by hand. Then it can be looked at, timed and
    /// improved, but it is no kernel of the package.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub provenance: Option<Provenance>,
    /// How far its `t` is from the true one, if that was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<ErrorProfile>,
    /// Where it leaks and over which scales it is right, if it has been to the accuracy lab.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<Stability>,
    /// The statements.
    pub program: Program,
}

/// The search that found a program, and what was measured of it there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// The search as it was asked for.
    pub search: Search,
    /// How many genomes it evaluated.
    pub evaluations: u64,
    /// How many different sources it compiled and timed for them.
    pub distinct: u64,
    /// Speed as a multiple of the Möller-Trumbore kernel's, both timed together on the
    /// full workload.
    pub ratio: f64,
    /// Relative uncertainty of that, if it was kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
    /// How many times as slow it is where stack and rays lie worst in memory as where they lie in most; none if that
    /// was not measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst_layout: Option<f64>,
    /// The processor that it was timed on.
    pub cpu: Name,
    /// The version of rustc that compiled it there.
    pub rustc: Name,
    /// The graph: the first 16 digits of the BLAKE3 hash of its file.
    pub graph: Name,
    /// What was done to the program after the search.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub improved: Option<Improved>,
}

/// The step from GA to GA+: another formulation, by operation count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Improved {
    /// The cost model.
    pub model: Name,
    /// What the program of the search cost per ray and triangle.
    pub cost_before: f64,
    /// What it costs now.
    pub cost: f64,
    /// The ratio of the program of the search, timed together with what it became.
    pub ratio_before: f64,
}

/// The flags of `cargo xtask evolve` that a result depends on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Search {
    /// `--strategy`.
    pub strategy: Name,
    /// `--objective`; none is the speed alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objective: Option<Name>,
    /// `--population`.
    pub population: u32,
    /// `--elite`.
    pub elite: u32,
    /// `--generations`.
    pub generations: u32,
    /// `--islands`; none is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub islands: Option<u32>,
    /// `--seed`.
    pub seed: u64,
}

/// Relative error of `t` against `f64`, over hits that are clear of every edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ErrorProfile {
    /// How many hits were looked at.
    pub hits: u64,
    /// Half of them are below this.
    pub median: f64,
    /// 99 of 100 are below this.
    pub p99: f64,
    /// The greatest seen, which is no bound.
    pub max: f64,
}

/// What the accuracy lab found, on the instruction set on which it was worst.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stability {
    /// Rays of each of the lab's cases.
    pub samples: u64,
    /// Their seed.
    pub seed: u64,
    /// Rays aimed at shared edges of closed surfaces that no triangle reports.
    pub edge_leak: Share,
    /// The same at vertices.
    pub vertex_leak: Share,
    /// Rays aimed at either that are reported once too often.
    pub double: Share,
    /// What 9,999 of 10,000 relative errors of `t` are below, at ordinary triangles.
    pub t_p9999: f64,
    /// The same of the absolute errors of `u` and `v`, reported by the same program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uv_p9999: Option<f64>,
    /// Exponents of 2, from the least to the greatest, by which everything can be scaled without another verdict or `t`.
    pub scale: [i32; 2],
}

/// So many of so many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// How often it happened.
    pub events: u64,
    /// How often it could have.
    pub samples: u64,
}

impl fmt::Display for Share {
    /// In percent; none is said as it is.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Share { events, samples } = *self;
        match events {
            0 => write!(f, "none of {samples}"),
            _ => write!(
                f,
                "{:.1}% of {samples}",
                100.0 * events as f64 / samples as f64
            ),
        }
    }
}

/// What is wrong with a recipe.
#[derive(Debug, thiserror::Error)]
pub enum RecipeError {
    /// Not the JSON of a recipe, or not a sound program.
    #[error("not a recipe: {}", .0.to_string().replace(char::is_control, " "))]
    Json(#[from] serde_json::Error),
    /// Too large to be one.
    #[error("{0} bytes, more than the {MAX_BYTES} that a recipe may have")]
    TooLarge(usize),
    /// A name that could be a word of Rust, or of the lanes.
    #[error("a kernel's name begins with a letter and has a hyphen, unlike {0:?}")]
    Name(String),
    /// A program that does what its scene rules out.
    #[error("the scene {0} rules this program out: {1}")]
    Breach(String, Breach),
    /// A scene that no kernel can serve.
    #[error("the scene {0}: {1}")]
    Scene(String, Contradiction),
    /// No instruction set, or one twice.
    #[error("a recipe names at least one ISA, and none twice")]
    Isas,
}

impl Recipe {
    /// Reads and checks a recipe.
    ///
    /// # Errors
    ///
    /// [`RecipeError`] if the text is not the JSON of a recipe, or its program is not sound.
    pub fn from_json(text: &str) -> Result<Recipe, RecipeError> {
        if text.len() > MAX_BYTES {
            return Err(RecipeError::TooLarge(text.len()));
        }
        let recipe: Recipe = serde_json::from_str(text)?;
        let name = recipe.name.as_str();
        if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.contains('-') {
            return Err(RecipeError::Name(name.to_owned()));
        }
        if let Err(contradiction) = recipe.scene.check() {
            return Err(RecipeError::Scene(recipe.scene.name, contradiction));
        }
        if let Some(breach) = recipe.program.breaks(&rules(&recipe.scene, &recipe.isas)) {
            return Err(RecipeError::Breach(recipe.scene.name, breach));
        }
        let mut isas = recipe.isas.clone();
        isas.sort_unstable();
        isas.dedup();
        if isas.is_empty() || isas.len() != recipe.isas.len() {
            return Err(RecipeError::Isas);
        }
        Ok(recipe)
    }

    /// Operations of a ray and a triangle by the paper's count, if no ray leaves early: tests and divisions included,
    /// and work that a packet's rays share, or a ray's triangles, divided among them.
    pub fn operations(&self) -> f64 {
        operations(&self.program, &self.scene)
    }

    /// The recipe as JSON: a field a line, a statement a line.
    pub fn to_json(&self) -> String {
        let mut head = serde_json::to_value(self).expect("a recipe is plain data");
        let fields = head.as_object_mut().expect("a recipe is an object");
        fields.remove("program");
        let mut text = serde_json::to_string_pretty(&head).expect("a recipe is plain data");
        text.truncate(text.len() - "\n}".len());
        let statements = self.program.statements().iter();
        let lines: Vec<String> = statements
            .map(|statement| serde_json::to_string(statement).expect("a statement is plain data"))
            .collect();
        text += &format!(
            ",\n  \"program\": [\n    {}\n  ]\n}}\n",
            lines.join(",\n    ")
        );
        text
    }
}

//! Cases: a scene in a regime on an instruction set, and who takes part in it.

use std::fmt;
use std::path::Path;

use emit::{Recipe, print_kernel};
use program::Program;
use scene::{Origin, SceneModel};
use serde::Serialize;

use crate::arena::{Arena, Contestant, REFERENCE};
use crate::failure::bad_input;
use crate::files;
use crate::published;

/// A recipe that is named on the command line.
pub struct Champion {
    /// The path that it was named by.
    pub name: String,
    /// The recipe.
    pub recipe: Recipe,
}

impl Champion {
    /// Reads a recipe, or that of a run's champion.
    pub fn read(path: &Path) -> anyhow::Result<Champion> {
        Ok(Champion {
            name: path.display().to_string(),
            recipe: files::read_champion(path)?,
        })
    }
}

/// A scene in a regime on one instruction set.
pub struct Case {
    /// Where kernels meet.
    pub arena: Arena,
    contestants: Vec<Participant>,
}

/// Which kernel figures are of, and in which case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Identity {
    /// Its name.
    pub kernel: String,
    /// The instruction set.
    pub isa: String,
    /// What is tested together.
    pub grouping: String,
    /// Where the packets' rays start.
    pub origin: String,
    /// What is asked of a ray.
    pub query: String,
    /// What the kernel's arithmetic may be.
    pub numeric: String,
    /// Where the kernel is watertight.
    pub watertight: String,
    /// What becomes of `t`.
    pub regime: String,
}

/// What a kernel takes part as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// One of the literature's, or of another crate.
    Rival,
    /// A kernel of the library.
    Library,
    /// The champion of a run.
    Champion,
}

#[cfg(test)]
impl Identity {
    /// A kernel for packets on SSE2.
    pub fn example(kernel: &str, regime: &str) -> Identity {
        Identity {
            kernel: kernel.into(),
            isa: "sse2".into(),
            grouping: "packet".into(),
            origin: "general".into(),
            query: "closest".into(),
            numeric: "fast".into(),
            watertight: "none".into(),
            regime: regime.into(),
        }
    }
}

/// Who takes part, and what for.
struct Participant {
    contestant: Contestant,
    role: Role,
    /// The scene that it is for.
    scene: SceneModel,
    /// What it does, statement by statement; a rival by hand has none.
    program: Option<Program>,
}

impl Case {
    /// The case of an arena of one instruction set, with the rivals, those in the library of published ones
    /// too, and those of our library and of the champions that give the answers that it asks for.
    pub fn new(
        arena: Arena,
        published: Option<&Path>,
        library: &[Recipe],
        champions: &[Champion],
    ) -> Case {
        let published = published.map(|path| published::contestants(path, &arena));
        let rivals = arena.contestants().into_iter();
        let rivals = rivals.chain(published.into_iter().flatten());
        let rivals = rivals.map(|contestant| Participant {
            contestant,
            role: Role::Rival,
            scene: arena.scene.clone(),
            program: None,
        });
        let of_library = library
            .iter()
            .map(|recipe| (recipe.name.to_string(), Role::Library, recipe));
        let of_champions = champions
            .iter()
            .map(|champion| (champion.name.clone(), Role::Champion, &champion.recipe));
        let bred = of_library.chain(of_champions);
        let bred = bred.filter_map(|(name, role, recipe)| participant(&arena, name, role, recipe));
        let contestants = rivals.chain(bred).collect();
        Case { arena, contestants }
    }

    /// A kernel of this name, as tables and programs tell it from others.
    pub fn identity(&self, name: &str) -> Identity {
        let Arena {
            scene: asked, isas, ..
        } = &self.arena;
        // The reference is for whatever is asked.
        let own = self.participant(name).map_or(asked, |one| &one.scene);
        Identity {
            kernel: name.to_owned(),
            isa: isas.to_string(),
            grouping: asked.grouping.to_string(),
            origin: asked.origin.to_string(),
            query: asked.query.to_string(),
            numeric: own.numeric.to_string(),
            watertight: own.watertight.to_string(),
            regime: asked.regime.to_string(),
        }
    }

    /// What a kernel of this name takes part as; the reference, which is not among the others, as a rival.
    pub fn role(&self, name: &str) -> Role {
        self.participant(name).map_or(Role::Rival, |one| one.role)
    }

    /// The program of a kernel of this name, if it has one.
    pub fn program(&self, name: &str) -> Option<&Program> {
        self.participant(name)?.program.as_ref()
    }

    fn participant(&self, name: &str) -> Option<&Participant> {
        let mut all = self.contestants.iter();
        all.find(|one| one.contestant.name == name)
    }

    /// Who takes part.
    pub fn contestants(&self) -> impl Iterator<Item = &Contestant> {
        self.contestants.iter().map(|one| &one.contestant)
    }

    /// Who takes part.
    pub fn into_contestants(self) -> Vec<Contestant> {
        self.contestants
            .into_iter()
            .map(|one| one.contestant)
            .collect()
    }

    /// Leaves only those of these names.
    pub fn keep(&mut self, keep: impl Fn(&str) -> bool) {
        self.contestants.retain(|one| keep(&one.contestant.name));
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Arena { scene, isas, .. } = &self.arena;
        write!(f, "{} {isas} {}", scene.name, scene.regime)
    }
}

/// The kernel of a recipe where it gives the answers that the arena asks for: it may be more than is needed,
/// as a kernel for any origin is where that is common, or a watertight one. Whatever is to be reported of hits
/// is printed beside the same program.
fn participant(arena: &Arena, name: String, role: Role, recipe: &Recipe) -> Option<Participant> {
    let (asked, own) = (&arena.scene, &recipe.scene);
    let has_isas = arena.isas.iter().all(|isa| recipe.isas.contains(isa));
    let answers = own.grouping == asked.grouping
        && own.query == asked.query
        && own.culling == asked.culling
        && own.range == asked.range;
    let origin = own.origin == Origin::General || own.origin == asked.origin;
    let bounds = own.bounds.is_none() || own.bounds == asked.bounds;
    if !(has_isas && answers && origin && bounds) {
        return None;
    }
    let scene = SceneModel {
        regime: asked.regime,
        outputs: asked.outputs.clone(),
        ..own.clone()
    };
    let print = |&isa| print_kernel(&recipe.program, &scene, isa, "kernel", "");
    let kernels = arena.isas.iter().map(print).collect();
    Some(Participant {
        contestant: Contestant { name, kernels },
        role,
        scene,
        program: Some(recipe.program.clone()),
    })
}

/// Whether a champion takes part in any case.
pub fn any_has(cases: &[Case], champion: &Champion) -> bool {
    let mut all = cases.iter().flat_map(|case| &case.contestants);
    all.any(|one| one.contestant.name == champion.name)
}

/// Refuses names that nobody has who takes part.
pub fn check_names(asked: &[String], cases: &[Case]) -> anyhow::Result<()> {
    let mut known = vec![REFERENCE];
    for one in cases.iter().flat_map(Case::contestants) {
        if !known.contains(&one.name.as_str()) {
            known.push(&one.name);
        }
    }
    match asked.iter().find(|name| !known.contains(&name.as_str())) {
        None => Ok(()),
        Some(unknown) => Err(bad_input(format!(
            "no kernel {unknown:?} for what is asked; known: {}",
            known.join(", ")
        ))),
    }
}

//! Cases: a scene in a regime on an instruction set, and who takes part in it.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use emit::{Kernel, Recipe, print_kernel};
use measure::{Counts, Interrupt, Mca, MeasureError, Pipes, Rustc};
use scene::{Origin, SceneModel};

use crate::arena::{Arena, Contestant, PACKETS, REFERENCE};
use crate::benches::Benches;
use crate::files;
use crate::published;
use crate::shootout::{Shootout, Standing};

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
    running: Option<(Benches, Shootout)>,
    /// How often kernels use the words of their lanes.
    counts: BTreeMap<String, Counts>,
    /// llvm-mca's estimates of a test that leaves at the first exit, in cycles.
    estimates: BTreeMap<String, f64>,
    /// Cycles a second, after every part.
    clocks: Vec<f64>,
}

/// A test of one ray and one triangle in cycles.
pub struct Cycles {
    /// What it takes.
    pub taken: f64,
    /// What its arithmetic takes at least.
    pub least: f64,
}

/// Of so many packets, one is run through to count.
const COUNTED_PACKETS: usize = 25;

/// Who takes part, and what for.
struct Participant {
    contestant: Contestant,
    /// The scene that it is for.
    scene: SceneModel,
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
            scene: arena.scene.clone(),
        });
        let of_library = library
            .iter()
            .map(|recipe| (recipe.name.to_string(), recipe));
        let of_champions = champions
            .iter()
            .map(|champion| (champion.name.clone(), &champion.recipe));
        let bred = of_library.chain(of_champions);
        let bred = bred.filter_map(|(name, recipe)| participant(&arena, name, recipe));
        let contestants = rivals.chain(bred).collect();
        Case {
            arena,
            contestants,
            running: None,
            counts: BTreeMap::new(),
            estimates: BTreeMap::new(),
            clocks: Vec::new(),
        }
    }

    /// The scene that a kernel is for: its own, or that of the case.
    pub fn scene_of(&self, name: &str) -> &SceneModel {
        let mut all = self.contestants.iter();
        let found = all.find(|one| one.contestant.name == name);
        found.map_or(&self.arena.scene, |one| &one.scene)
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

    /// Builds all kernels.
    pub fn build(&mut self, rustc: &Rustc, interrupt: &Interrupt) -> anyhow::Result<()> {
        let mut benches = self.arena.bench(rustc, interrupt)?;
        let contestants: Vec<&Contestant> =
            self.contestants.iter().map(|one| &one.contestant).collect();
        let shootout = Shootout::new(&mut benches, &contestants, 0..PACKETS)?;
        self.running = Some((benches, shootout));
        Ok(())
    }

    /// Times the next one of so many parts of the rounds; nothing before it was built.
    pub fn time_part(&mut self, parts: usize) -> Result<(), MeasureError> {
        if let Some((benches, shootout)) = &mut self.running {
            shootout.time_part(benches, parts)?;
            self.clocks.push(measure::clock());
        }
        Ok(())
    }

    /// Counts how often kernels use their words, and has their hot paths estimated if there is llvm-mca.
    pub fn count(&mut self, rustc: &Rustc, mca: Option<&Mca>) -> anyhow::Result<()> {
        let Some((benches, _)) = &mut self.running else {
            return Ok(());
        };
        let reference = self.arena.reference()?;
        let all = self.contestants.iter().map(|one| &one.contestant);
        let all: Vec<&Contestant> = [&reference].into_iter().chain(all).collect();
        let kernels: Vec<&[Kernel]> = all.iter().map(|one| one.kernels.as_slice()).collect();
        let packets = (0..PACKETS).step_by(COUNTED_PACKETS);
        let rounds = packets.map(|packet| packet..packet + 1).collect();
        if let Some(mca) = mca {
            let estimate = |one: &&Contestant| {
                let cycles = mca.cycles(rustc, &one.kernels[0])?;
                Some((one.name.clone(), cycles))
            };
            self.estimates.extend(all.iter().filter_map(estimate));
        }
        let counts = std::iter::zip(all, benches.count(&kernels, rounds)?);
        let counts = counts.filter_map(|(one, counts)| Some((one.name.clone(), counts?)));
        self.counts.extend(counts);
        Ok(())
    }

    /// llvm-mca's estimate, in cycles, of a test that leaves a kernel at the first exit.
    pub fn estimate(&self, kernel: &str) -> Option<f64> {
        self.estimates.get(kernel).copied()
    }

    /// The cycles of a kernel of this speed, in millions of tests a second, if its words were counted and the
    /// processor's pipes are known.
    pub fn cycles(&self, kernel: &str, speed: f64) -> Option<Cycles> {
        let counts = self.counts.get(kernel)?;
        if self.clocks.is_empty() || counts.words.iter().all(|&times| times == 0) {
            return None;
        }
        Some(Cycles {
            taken: measure::median(&self.clocks) / (speed * 1e6),
            least: Pipes::here()?.least_cycles(self.arena.isas[0], counts)?,
        })
    }

    /// Times how records are made of triangles.
    pub fn time_precomputations(&mut self) -> Result<(), MeasureError> {
        match &mut self.running {
            Some((benches, shootout)) => shootout.time_precomputations(benches),
            None => Ok(()),
        }
    }

    /// How everyone did so far.
    pub fn standings(&self) -> Vec<Standing> {
        let running = self.running.as_ref();
        running.map_or(Vec::new(), |(_, shootout)| shootout.standings())
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Arena { scene, isas, .. } = &self.arena;
        write!(f, "{} {isas} {}", scene.name, scene.regime)
    }
}

/// The kernel of a recipe where it gives the answers that the arena asks for: it may be more than is needed,
/// as a kernel for any origin is where that is common, or a watertight one.
fn participant(arena: &Arena, name: String, recipe: &Recipe) -> Option<Participant> {
    let (asked, own) = (&arena.scene, &recipe.scene);
    let has_isas = arena.isas.iter().all(|isa| recipe.isas.contains(isa));
    let answers = own.grouping == asked.grouping
        && own.query == asked.query
        && own.culling == asked.culling
        && own.outputs == asked.outputs
        && own.range == asked.range;
    let origin = own.origin == Origin::General || own.origin == asked.origin;
    let bounds = own.bounds.is_none() || own.bounds == asked.bounds;
    if !(has_isas && answers && origin && bounds) {
        return None;
    }
    let scene = SceneModel {
        regime: asked.regime,
        ..own.clone()
    };
    let print = |&isa| print_kernel(&recipe.program, &scene, isa, "kernel", "");
    let kernels = arena.isas.iter().map(print).collect();
    Some(Participant {
        contestant: Contestant { name, kernels },
        scene,
    })
}

/// Whether a champion takes part in any case.
pub fn any_has(cases: &[Case], champion: &Champion) -> bool {
    let mut all = cases.iter().flat_map(|case| &case.contestants);
    all.any(|one| one.contestant.name == champion.name)
}

/// The names of all who take part, each once.
pub fn names(cases: &[Case]) -> Vec<String> {
    let mut names = vec![REFERENCE.to_owned()];
    for one in cases.iter().flat_map(|case| &case.contestants) {
        if !names.contains(&one.contestant.name) {
            names.push(one.contestant.name.clone());
        }
    }
    names
}

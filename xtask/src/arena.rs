//! Where kernels meet: a scene and an instruction set, with Möller-Trumbore's packet
//! kernel as the reference.

use std::path::Path;

use anyhow::Context;
use emit::{Isa, Kernel, Name, Recipe, checked_in, print_kernel, rules};
use measure::{Bench, Interrupt, Rustc, WorkloadSpec};
use program::{
    Graph, Program, Rules, Watertight, appendix, kensler_shirley, moller_trumbore_volumes,
};
use rivals::Rival;
use scene::{Grouping, Output, SceneModel};

use crate::benches::Benches;
use crate::failure::bad_input;
use crate::fields::Fields;
use crate::files;
use crate::isas::Isas;
use crate::worker;

/// Triangles and packets of the paper's full workload.
pub const TRIANGLES: usize = 20_000;
/// Triangles that a workload has at least: enough hits to be checked on.
const FEWEST_TRIANGLES: usize = 500;
/// Packets of 64 rays of the paper's full workload.
pub const PACKETS: usize = 400;

/// The packets that the hit fraction is worked out for.
const SAMPLED_PACKETS: usize = 40;

/// Seed of the workload's generator: the same rays and triangles in every run.
const WORKLOAD_SEED: u32 = 2006;

/// The kernel that every other is timed against.
pub const REFERENCE: &str = "moller-trumbore";

/// The kernel of Kensler and Shirley's appendix.
const PAPERS_OWN: &str = "kensler-shirley";

/// A kernel that takes part, by the name in the table.
pub struct Contestant {
    /// Its name.
    pub name: String,
    /// Its code for every instruction set of the arena.
    pub kernels: Vec<Kernel>,
}

/// Flags that say where.
#[derive(clap::Args)]
pub struct ArenaFlags {
    /// What the scene requires: packet, common-origin, single, … (a wrong name lists them all); or a
    /// scene model's file, NAME.json
    #[arg(long, value_name = "NAME|FILE", default_value = "packet")]
    scene: String,

    #[command(flatten)]
    fields: Fields,

    /// Instruction set: scalar, sse2, sse4.1, avx2 or avx512; several with commas, or all that this
    /// machine has, and then figures are geometric means
    #[arg(long, value_name = "NAMES", default_value = "sse2")]
    isa: String,

    /// Triangles of the workload; with fewer than the default it is a quick look, whose champion
    /// cannot be promoted
    #[arg(long, value_name = "N", default_value_t = TRIANGLES)]
    triangles: usize,
}

/// Where kernels meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Arena {
    /// What the scene requires.
    pub scene: SceneModel,
    /// The instruction sets.
    pub isas: Isas,
    /// How many triangles the workload has.
    pub triangles: usize,
}

impl ArenaFlags {
    /// Checks the flags.
    pub fn arena(&self) -> anyhow::Result<Arena> {
        let scene = self.fields.change(scene(&self.scene)?)?;
        let isas = Isas::parse(&self.isa, &scene)?;
        let arena = Arena {
            scene,
            isas,
            triangles: self.triangles,
        };
        arena.check()?;
        Ok(arena)
    }
}

/// A preset by its name, or a scene model's file by its name NAME.json.
pub fn scene(name: &str) -> anyhow::Result<SceneModel> {
    match name.ends_with(".json") {
        true => files::read_scene(Path::new(name)),
        false => SceneModel::preset(name).map_err(bad_input),
    }
}

impl Arena {
    /// Where a recipe's kernel was bred.
    pub fn of(recipe: &Recipe) -> Arena {
        Arena {
            scene: recipe.scene.clone(),
            isas: Isas(recipe.isas.clone()),
            triangles: TRIANGLES,
        }
    }

    /// Refuses an instruction set that this processor does not have, and what goes with no other
    /// part of the arena.
    pub fn check(&self) -> anyhow::Result<()> {
        let Arena {
            scene,
            isas,
            triangles,
        } = self;
        if *triangles < FEWEST_TRIANGLES {
            return Err(bad_input(format!(
                "--triangles {triangles} are too few to check a kernel on; give {FEWEST_TRIANGLES} or more"
            )));
        }
        let several = isas.iter().find(|&&isa| isa != Isa::Scalar);
        if let Some(isa) = several.filter(|_| scene.grouping == Grouping::Scalar) {
            return Err(bad_input(format!(
                "the scene {} takes one triangle at a time, and {isa} several; give --isa scalar, or \
                 the grouping single",
                scene.name
            )));
        }
        if let Some(isa) = isas.iter().find(|isa| !isa.is_available()) {
            return Err(bad_input(format!(
                "this processor has no {isa}; choose another ISA"
            )));
        }
        if scene.bounds.is_some() {
            self.check_bounds()?;
        }
        Ok(())
    }

    /// Whether its kernels can go to the accuracy lab: whatever they report, it is of closest hits of both sides,
    /// from 0 on.
    pub fn is_for_lab(&self) -> bool {
        self.reporting(Vec::new()).scene.is_plain()
    }

    /// Refuses scenes whose kernels cannot go to the accuracy lab.
    pub fn check_for_lab(&self) -> anyhow::Result<()> {
        match self.is_for_lab() {
            true => Ok(()),
            false => Err(bad_input(format!(
                "the scene {} asks for other hits than the closest ones of both sides, from 0 on, which are \
                 what can be judged; name another one",
                self.scene.name
            ))),
        }
    }

    /// The same, but that other things are reported of a hit.
    pub fn reporting(&self, outputs: Vec<Output>) -> Arena {
        let scene = SceneModel {
            outputs,
            ..self.scene.clone()
        };
        Arena {
            scene,
            ..self.clone()
        }
    }

    /// Refuses bounds that the workload does not keep to: nothing could be bred on it.
    fn check_bounds(&self) -> anyhow::Result<()> {
        let workload = self.workload().generator().generate();
        let Some(bounds) = self.scene.bounds_check() else {
            return Ok(());
        };
        let mut rays = workload.packets.iter().flat_map(|packet| {
            let rays = 0..scene::PACKET_SIZE;
            rays.map(move |ray| {
                bounds
                    .origin(packet, ray)
                    .and(bounds.direction(packet, ray))
            })
        });
        let mut triangles = workload
            .triangles
            .iter()
            .enumerate()
            .map(|(number, triangle)| {
                bounds.vertices(number, [triangle.p0, triangle.p1, triangle.p2])
            });
        let out = rays
            .find_map(Result::err)
            .or_else(|| triangles.find_map(Result::err));
        match out {
            None => Ok(()),
            Some(out) => Err(bad_input(format!(
                "the scene {}: in the workload {out}; give bounds that hold it, or none",
                self.scene.name
            ))),
        }
    }

    /// What this is, in three words.
    pub fn name(&self) -> String {
        let Arena { scene, isas, .. } = self;
        format!("{}, {isas}, {}", scene.name, scene.regime)
    }

    /// What this is, and how many of its tests are hits.
    pub fn describe(&self) -> String {
        format!("{}: {}", self.name(), self.describe_workload())
    }

    /// The workload, and how many of its tests are hits.
    pub fn describe_workload(&self) -> String {
        let workload = self.workload();
        let generated = workload.generator().generate();
        let hits = scene::hit_fraction(generated.part(0..SAMPLED_PACKETS)) * 100.0;
        format!(
            "{} packets of {} rays, {} triangles, {hits:.0}% hits with t fixed",
            workload.packets,
            scene::PACKET_SIZE,
            workload.triangles,
        )
    }

    /// Whether figures are those of the paper's full workload.
    pub fn is_full(&self) -> bool {
        self.triangles == TRIANGLES
    }

    /// The name of the checked-in graph to search.
    pub fn graph(&self) -> &'static str {
        checked_in(&self.scene, &self.isas).name()
    }

    /// What the scene leaves of a graph from its file, or of the checked-in one that fits it; and the hash of the file.
    pub fn graph_to_search(&self, path: Option<&Path>) -> anyhow::Result<(Graph, Name)> {
        let path = path.map_or_else(|| files::graph_path(self.graph()), Path::to_owned);
        let (graph, hash) = files::read_graph(&path)?;
        let left = graph.restricted(&self.rules()).map_err(|_| {
            let (scene, path) = (&self.scene.name, path.display());
            bad_input(format!(
                "the scene {scene} rules out every program of {path}"
            ))
        })?;
        Ok((left, hash))
    }

    /// What the scene leaves of a graph.
    pub fn rules(&self) -> Rules {
        rules(&self.scene, &self.isas)
    }

    /// What of a graph a search for a front begins from as well: where leaks are allowed, those that are tight at
    /// edges. Hardly any random program is, and one that is so at two sides of three leaks like others.
    pub fn nurseries(&self, graph: &Graph) -> Vec<Graph> {
        if self.scene.watertight != scene::Watertight::None {
            return Vec::new();
        }
        let tight = SceneModel {
            watertight: scene::Watertight::Edges,
            ..self.scene.clone()
        };
        let tight = graph.restricted(&rules(&tight, &self.isas));
        tight.into_iter().collect()
    }

    /// The paper's full workload in this scene.
    pub fn workload(&self) -> WorkloadSpec {
        WorkloadSpec {
            seed: WORKLOAD_SEED,
            triangles: self.triangles,
            packets: PACKETS,
            target_range: None,
            scene: self.scene.clone(),
        }
    }

    /// Benches for it.
    pub fn bench(&self, rustc: &Rustc, interrupt: &Interrupt) -> anyhow::Result<Benches> {
        let reference = self.reference()?;
        let bench = |reference| self.bench_on(self.workload(), reference, rustc, interrupt);
        let benches: anyhow::Result<_> = reference.kernels.into_iter().map(bench).collect();
        Ok(Benches::new(benches?))
    }

    /// A bench on a workload, against a reference for one of its instruction sets.
    pub fn bench_on(
        &self,
        workload: WorkloadSpec,
        reference: Kernel,
        rustc: &Rustc,
        interrupt: &Interrupt,
    ) -> anyhow::Result<Bench> {
        let (rustc, worker) = (rustc.clone(), worker::command(&workload)?);
        Ok(Bench::new(
            rustc,
            worker,
            workload,
            reference,
            interrupt.clone(),
        ))
    }

    /// The reference.
    pub fn reference(&self) -> anyhow::Result<Contestant> {
        let mut rivals = self.rivals().into_iter();
        let reference = rivals.find(|rival| rival.name == REFERENCE);
        reference.context("Möller-Trumbore is among the rivals")
    }

    /// The rivals but for the reference, which is in every table by itself.
    pub fn contestants(&self) -> Vec<Contestant> {
        let mut rivals = self.rivals();
        rivals.retain(|rival| rival.name != REFERENCE);
        rivals
    }

    /// The rival that a champion has to beat beside the reference: the paper's own.
    pub fn papers_own(&self) -> Vec<Contestant> {
        let mut rivals = self.rivals();
        rivals.retain(|rival| rival.name == PAPERS_OWN);
        rivals
    }

    /// The rivals: as they are written by hand or, where they do not do what the scene asks for, by
    /// their programs, which have the same volumes, divisions, tests and exits.
    fn rivals(&self) -> Vec<Contestant> {
        if self.scene.is_plain() {
            let on_all = |rival: &&Rival| self.isas.iter().all(|isa| rival.is_for(*isa));
            let by_hand = rivals::of(self.scene.grouping, self.scene.origin).filter(on_all);
            let contestants = by_hand.map(|rival| Contestant {
                name: rival.name.to_owned(),
                kernels: self
                    .isas
                    .iter()
                    .map(|&isa| rival.kernel(isa, self.scene.regime))
                    .collect(),
            });
            return contestants.collect();
        }
        let graph = kensler_shirley();
        // What the scene rules out is what it rules out for its rivals too; but they leak.
        let rules = Rules {
            watertight: Watertight::No,
            ..self.rules()
        };
        let graph = graph.restricted(&rules).unwrap_or(graph);
        let programs = [
            (REFERENCE, moller_trumbore_volumes(&graph)),
            (PAPERS_OWN, appendix(&graph)),
        ];
        let contestants = programs.into_iter().filter_map(|(name, genome)| {
            Some(Contestant {
                name: name.to_owned(),
                kernels: self.kernels(&graph.program(&genome).ok()?),
            })
        });
        contestants.collect()
    }

    /// A program as a kernel for every instruction set.
    pub fn kernels(&self, program: &Program) -> Vec<Kernel> {
        let print = |&isa| print_kernel(program, &self.scene, isa, "kernel", "");
        self.isas.iter().map(print).collect()
    }
}

//! Which kernels, in which scenes, on which instruction sets: what is asked of the commands that compare
//! kernels.

use std::path::PathBuf;

use emit::Isa;
use scene::{Regime, SceneModel};

use crate::arena::{self, Arena, TRIANGLES};
use crate::cases::{self, Case, Champion};
use crate::failure::bad_input;
use crate::fields::Fields;
use crate::files;
use crate::isas::Isas;
use crate::published;

/// Flags that say which.
#[derive(clap::Args)]
pub struct Asked {
    /// Only this rival or kernel of the library; may be given several times
    #[arg(long, value_name = "NAME")]
    kernel: Vec<String>,

    /// Only in this scene: packet, common-origin, single, … (a wrong name lists them all); or in a
    /// scene model's file, NAME.json [default: those that the command is for]
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,

    #[command(flatten)]
    fields: Fields,

    /// Instruction set: scalar, sse2, sse4.1, avx2 or avx512; several with commas, or all that this
    /// machine has, each by itself [default: that of the champions, or sse2]
    #[arg(long, value_name = "NAMES")]
    isa: Option<String>,

    /// Triangles of the workload
    #[arg(long, value_name = "N", default_value_t = TRIANGLES)]
    triangles: usize,
}

/// What is looked at if nothing else is asked for.
pub struct Usual {
    /// The scenes, unless there are champions, which have their own.
    pub scenes: Vec<SceneModel>,
    /// Whether in all regimes, or in that of the scene.
    pub all_regimes: bool,
}

impl Usual {
    /// Packets of both kinds and single rays.
    pub fn presets(all_regimes: bool) -> anyhow::Result<Usual> {
        let scenes = ["packet", "common-origin", "single"].map(arena::scene);
        Ok(Usual {
            scenes: scenes.into_iter().collect::<anyhow::Result<_>>()?,
            all_regimes,
        })
    }
}

impl Asked {
    /// The cases, with the champions in these run directories or recipes. Without --scene, only their scenes
    /// and regimes are looked at.
    pub fn cases(&self, champions: &[PathBuf], usual: &Usual) -> anyhow::Result<Vec<Case>> {
        let champions = champions.iter().map(|path| Champion::read(path));
        let champions: Vec<Champion> = champions.collect::<anyhow::Result<_>>()?;
        let library = files::read_recipes()?;
        let arenas = self.arenas(&champions, usual)?;
        let published = match arenas.iter().any(published::take_part_in) {
            true => published::build(),
            false => None,
        };
        let case = |arena| Case::new(arena, published.as_deref(), &library, &champions);
        let mut cases: Vec<Case> = arenas.into_iter().map(case).collect();
        if let Some(stranger) = champions.iter().find(|one| !cases::any_has(&cases, one)) {
            return Err(bad_input(format!(
                "{} was bred for the scene {}, which none of the scenes asked for is like; name its scene \
                 with --scene, or none",
                stranger.name, stranger.recipe.scene.name
            )));
        }
        self.keep_asked(&mut cases, &champions)?;
        Ok(cases)
    }

    /// Whether figures are those of the paper's full workload.
    pub fn is_full(&self) -> bool {
        self.triangles == TRIANGLES
    }

    /// Where kernels meet: every scene in every regime on every instruction set that is asked for.
    fn arenas(&self, champions: &[Champion], usual: &Usual) -> anyhow::Result<Vec<Arena>> {
        let of_champions = self.scene.is_none() && !champions.is_empty();
        let scenes = match &self.scene {
            Some(name) => vec![arena::scene(name)?],
            None if of_champions => champions
                .iter()
                .map(|one| one.recipe.scene.clone())
                .collect(),
            None => usual.scenes.clone(),
        };
        let all_regimes = usual.all_regimes && !of_champions && !self.fields.name_regime();
        let scenes = scenes.into_iter().map(|scene| self.fields.change(scene));
        let scenes: Vec<SceneModel> = scenes.collect::<anyhow::Result<_>>()?;
        // What is missing is said once.
        let asked = match (&self.isa, of_champions) {
            (Some(names), _) => Some(Isas::parse(names, &scenes[0])?.here()?),
            (None, true) => None,
            (None, false) => Some(Isas(vec![Isa::Sse2])),
        };
        let mut arenas: Vec<Arena> = Vec::new();
        for (place, scene) in scenes.into_iter().enumerate() {
            let of_champion = || Isas(champions[place].recipe.isas.clone());
            let isas = asked.clone().unwrap_or_else(of_champion);
            let regimes = match all_regimes {
                true => Regime::ALL.to_vec(),
                false => vec![scene.regime],
            };
            for &isa in isas.iter() {
                for &regime in &regimes {
                    let arena = Arena {
                        scene: SceneModel {
                            regime,
                            ..scene.clone()
                        },
                        isas: Isas(vec![isa]),
                        triangles: self.triangles,
                    };
                    arena.check()?;
                    if !arenas.contains(&arena) {
                        arenas.push(arena);
                    }
                }
            }
        }
        Ok(arenas)
    }

    /// Leaves only the kernels that were asked for, if any were, and the champions.
    fn keep_asked(&self, cases: &mut [Case], champions: &[Champion]) -> anyhow::Result<()> {
        if self.kernel.is_empty() {
            return Ok(());
        }
        cases::check_names(&self.kernel, cases)?;
        for case in cases {
            case.keep(|name| {
                self.kernel.iter().any(|asked| asked == name)
                    || champions.iter().any(|champion| champion.name == name)
            });
        }
        Ok(())
    }
}

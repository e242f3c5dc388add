//! A recipe with what every kernel of the package has.

use scene::{Grouping, Numeric, Origin, SceneModel, Watertight};

use super::PackageError;
use crate::isa::Isa;
use crate::name::Name;
use crate::recipe::{ErrorProfile, Provenance, Recipe};

pub(super) struct Entry<'a> {
    pub recipe: &'a Recipe,
    pub provenance: &'a Provenance,
    pub error: &'a ErrorProfile,
}

impl<'a> Entry<'a> {
    pub fn new(recipe: &'a Recipe) -> Result<Entry<'a>, PackageError> {
        let (Some(provenance), Some(error)) = (&recipe.provenance, &recipe.error) else {
            return Err(PackageError::ByHand(recipe.name.to_string()));
        };
        let plain = SceneModel {
            name: recipe.scene.name.clone(),
            grouping: recipe.scene.grouping,
            origin: recipe.scene.origin,
            numeric: recipe.scene.numeric,
            watertight: recipe.scene.watertight,
            regime: recipe.scene.regime,
            ..SceneModel::preset("packet").expect("there is such a preset")
        };
        if recipe.scene != plain {
            return Err(PackageError::NotPlain(recipe.name.to_string()));
        }
        Ok(Entry {
            recipe,
            provenance,
            error,
        })
    }

    /// Whether there is a kernel for an instruction set: what is portable is one program on all, also on those that it
    /// was not bred on.
    pub fn is_for(&self, isa: Isa) -> bool {
        self.recipe.scene.numeric == Numeric::Portable || self.recipe.isas.contains(&isa)
    }

    /// The kernel's name: the recipe's, but for the instruction set at its end, of which module it is.
    pub fn kernel(&self, isa: Isa) -> String {
        let name = self.recipe.name.to_string();
        let short = name.strip_suffix(isa.name());
        let short = short.and_then(|short| short.strip_suffix('-'));
        short.unwrap_or(&name).to_owned()
    }

    /// The name of its function.
    pub fn function(&self, isa: Isa) -> String {
        let name = Name::new(self.kernel(isa));
        name.expect("the beginning of a name is one").identifier()
    }

    /// What a call takes.
    pub fn takes_packets(&self) -> bool {
        self.recipe.scene.grouping == Grouping::Packet
    }
}

/// What a recipe is called in the package: what a call takes, what is promised, which lists it was bred on and, if it
/// is for one instruction set alone, for which: `packet-edges-leaf-avx2`.
pub fn package_name(recipe: &Recipe) -> Name {
    let scene = &recipe.scene;
    let takes = match (scene.grouping, scene.origin) {
        (Grouping::Packet, Origin::General) => "packet",
        (Grouping::Packet, Origin::Common) => "common-origin",
        (Grouping::Single | Grouping::Scalar, _) => "ray",
    };
    let numeric = match scene.numeric {
        Numeric::Fast => None,
        Numeric::Portable => Some(scene.numeric.word()),
    };
    let watertight = match scene.watertight {
        Watertight::None => None,
        Watertight::Edges | Watertight::Full => Some(scene.watertight.word()),
    };
    let isa = match (recipe.isas.as_slice(), scene.numeric) {
        ([isa], Numeric::Fast) => Some(isa.name()),
        _ => None,
    };
    let words = [
        Some(takes),
        numeric,
        watertight,
        Some(scene.regime.word()),
        isa,
    ];
    let words: Vec<&str> = words.into_iter().flatten().collect();
    Name::new(words.join("-")).expect("words make a name")
}

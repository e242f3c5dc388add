//! The library's kernels, as their recipes describe them.

use emit::{ErrorProfile, Isa, Name, Provenance, Recipe, Stability};
use scene::SceneModel;
use serde::Serialize;

/// A kernel of the library.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    /// Its name, and that of its recipe.
    pub name: Name,
    /// What it was bred for.
    pub scene: SceneModel,
    /// The instruction sets that it is emitted for.
    pub isas: Vec<Isa>,
    /// Bytes of a triangle's record.
    pub bytes: usize,
    /// Statements of its program.
    pub statements: usize,
    /// Operations that a ray and a triangle take if no ray leaves early, tests and divisions included, work on the
    /// packet shared among its rays.
    pub operations: f64,
    /// Where it comes from.
    pub provenance: Option<Provenance>,
    /// Its errors of `t`.
    pub error: Option<ErrorProfile>,
    /// What the accuracy lab found when it was promoted.
    pub stability: Option<Stability>,
}

/// What a recipe says of its kernel.
pub fn entry(recipe: &Recipe) -> Entry {
    Entry {
        name: recipe.name.clone(),
        scene: recipe.scene.clone(),
        isas: recipe.isas.clone(),
        bytes: recipe.scene.stored.bytes(),
        statements: recipe.program.statements().len(),
        operations: recipe.operations(),
        provenance: recipe.provenance.clone(),
        error: recipe.error,
        stability: recipe.stability,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files;

    #[test]
    fn a_common_origin_saves_operations() {
        let recipes = files::read_recipes().unwrap();
        let operations = |name: &str| {
            let mut all = recipes.iter().map(entry);
            let found = all.find(|one| one.name.as_str() == name);
            found.unwrap().operations
        };
        let general = operations("packet-shrinking-sse2");
        let common = operations("common-origin-shrinking-sse2");
        assert!((30.0..60.0).contains(&general), "{general}");
        assert!(common < general, "{common}");
    }
}

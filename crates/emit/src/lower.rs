//! What a scene model makes of a program of the graph.

use program::Program;
use scene::{Numeric, SceneModel};

/// The program with what the scene rules out replaced by what it allows: for a portable scene,
/// estimates by exact divisions.
pub fn lower(program: &Program, scene: &SceneModel) -> Program {
    match scene.numeric {
        Numeric::Portable => program.without_estimates(),
        Numeric::Fast => program.clone(),
    }
}

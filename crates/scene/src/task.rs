//! What a kernel is asked to answer, which is what its answers are judged by.

use serde::{Deserialize, Serialize};

use crate::{Culling, Query, Range, Regime, SceneModel};

/// What becomes of `t`, what is asked, and which hits count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Task {
    /// What becomes of `t`.
    pub regime: Regime,
    /// What is asked of a ray.
    pub query: Query,
    /// Which side of a triangle is not there.
    pub culling: Culling,
    /// Between which ends a hit counts.
    pub range: Range,
}

impl Task {
    /// That of a scene.
    pub fn of(scene: &SceneModel) -> Task {
        Task {
            regime: scene.regime,
            query: scene.query,
            culling: scene.culling,
            range: scene.range,
        }
    }
}

impl From<Regime> for Task {
    /// The closest hit, or in the fixed regime the last, of both sides and before `t_max`.
    fn from(regime: Regime) -> Task {
        Task {
            regime,
            query: Query::default(),
            culling: Culling::default(),
            range: Range::default(),
        }
    }
}

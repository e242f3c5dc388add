//! The regimes: how a workload treats `t`.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Triangles in a list of the [`Regime::Leaf`] regime: a BVH leaf.
pub const LEAF_TRIANGLES: usize = 8;

/// How a workload treats `t`. A claim about speed holds for one regime.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Regime {
    /// `t` is the best so far through a long list of triangles, as in Kensler-Shirley's appendix.
    /// After a few hundred triangles the far test rejects nearly everything.
    Shrinking,
    /// `t` never rejects: Havel-Herout's worst case. Hits are stored in the packet's `hit_t`, the
    /// last one in the list's order staying there, and `t` is left alone.
    Fixed,
    /// Lists of [`LEAF_TRIANGLES`] triangles, `t` reset before each: a BVH leaf.
    Leaf,
}

impl Regime {
    /// All of them, in the order in which tables print them.
    pub const ALL: [Self; 3] = [Self::Shrinking, Self::Fixed, Self::Leaf];

    /// The word for it on the command line and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shrinking => "shrinking",
            Self::Fixed => "fixed",
            Self::Leaf => "leaf",
        }
    }
}

impl fmt::Display for Regime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Regime {
    type Err = UnknownRegime;

    fn from_str(name: &str) -> Result<Self, UnknownRegime> {
        Self::ALL
            .into_iter()
            .find(|regime| regime.name() == name)
            .ok_or_else(|| UnknownRegime { name: name.into() })
    }
}

/// There is no regime of this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown regime {name:?}; known: {}", Regime::ALL.map(Regime::name).join(", "))]
pub struct UnknownRegime {
    /// The name asked for.
    pub name: String,
}

#[cfg(test)]
mod tests {
    use super::Regime;

    #[test]
    fn is_spelled_alike_in_text_and_on_the_command_line() {
        for regime in Regime::ALL {
            assert_eq!(regime.to_string().parse(), Ok(regime));
        }
        assert_eq!(format!("{:>6}", Regime::Leaf), "  leaf");
    }

    #[test]
    fn names_the_known_ones_when_asked_for_another() {
        let error = "shrunk".parse::<Regime>().unwrap_err();
        assert_eq!(
            error.to_string(),
            "unknown regime \"shrunk\"; known: shrinking, fixed, leaf"
        );
    }
}

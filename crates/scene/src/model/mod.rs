//! Scene models: what a scene requires of a kernel. A kernel contains nothing else.
//!
//! A model is a small file of JSON, of which all but the name may be left out:
//!
//! ```json
//! {
//!   "name": "shadows",
//!   "grouping": "packet",
//!   "origin": "common",
//!   "query": "any",
//!   "culling": "none",
//!   "outputs": [],
//!   "range": "t_min..t_max",
//!   "stored": "vertices",
//!   "numeric": "fast",
//!   "watertight": "none",
//!   "regime": "leaf",
//!   "bounds": {"coordinates": 1000, "edge": 0.001, "directions": "unit"}
//! }
//! ```

mod bounds;
mod contradiction;
mod words;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use volumes::{Rate, Rates};

pub use bounds::{Bounds, Length, NoBounds, NoLength, VolumeBounds};
pub use contradiction::Contradiction;
pub use words::{
    Culling, Directions, Grouping, Numeric, Origin, Output, Query, Range, Regime, Stored,
    UnknownWord, Watertight,
};

use crate::{Layout, Record};

/// What a scene requires. Kernels are bred, named and published per scene model.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneModel {
    /// Its name, of `[a-z0-9._-]` without `..`: names of files are built from it.
    #[serde(deserialize_with = "plain_name")]
    pub name: String,
    /// What one kernel call takes.
    #[serde(default)]
    pub grouping: Grouping,
    /// Where the rays of a packet start.
    #[serde(default)]
    pub origin: Origin,
    /// What is asked of a ray.
    #[serde(default)]
    pub query: Query,
    /// Which side of a triangle is not there.
    #[serde(default)]
    pub culling: Culling,
    /// What is reported of a hit, beside `t`.
    #[serde(default)]
    pub outputs: Vec<Output>,
    /// Between which ends a hit counts.
    #[serde(default)]
    pub range: Range,
    /// What is kept of a triangle.
    #[serde(default)]
    pub stored: Stored,
    /// What its arithmetic may be.
    #[serde(default)]
    pub numeric: Numeric,
    /// Where a closed mesh may let a ray through.
    #[serde(default)]
    pub watertight: Watertight,
    /// What becomes of `t` while it is bred.
    #[serde(default)]
    pub regime: Regime,
    /// What its rays and triangles keep to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds: Option<Bounds>,
}

/// The checked-in models, by name.
macro_rules! presets {
    ($($name:literal,)+) => {
        const PRESETS: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../presets/", $name, ".json")))),+];

        impl SceneModel {
            /// The names that [`SceneModel::preset`] knows; the first is the default.
            pub const PRESETS: &[&str] = &[$($name),+];
        }
    };
}

presets! {
    "packet",
    "common-origin",
    "packet-portable",
    "common-origin-portable",
    "packet-edges",
    "packet-watertight",
    "common-origin-watertight",
    "packet-stored",
    "packet-bounded",
    "primary",
    "shadow",
    "segment",
    "single",
    "single-portable",
    "single-edges",
    "single-watertight",
    "single-stored",
    "single-any",
    "scalar",
}

impl SceneModel {
    /// The scene model of this name.
    ///
    /// # Errors
    ///
    /// The name is not in [`SceneModel::PRESETS`].
    ///
    /// # Panics
    ///
    /// Never: a test reads every preset.
    ///
    /// ```
    /// use scene::{Origin, SceneModel};
    ///
    /// assert_eq!(SceneModel::preset("common-origin").unwrap().origin, Origin::Common);
    /// assert!(SceneModel::preset("pakcet").is_err());
    /// ```
    pub fn preset(name: &str) -> Result<Self, UnknownScene> {
        let found = PRESETS.iter().find(|(preset, _)| *preset == name);
        let (_, text) = found.ok_or_else(|| UnknownScene { name: name.into() })?;
        Ok(serde_json::from_str(text).expect("presets are sound"))
    }

    /// How often the inputs of a kernel change in this scene, when it is a packet that a kernel
    /// takes. One ray's triangles share it as a packet's rays share theirs; what depends on a
    /// triangle changes with every vector of them.
    pub fn rates(&self) -> Rates {
        match (self.grouping, self.origin) {
            (Grouping::Packet, Origin::General) => Rates::GENERAL,
            (Grouping::Packet, Origin::Common) => Rates::COMMON_ORIGIN,
            (Grouping::Single | Grouping::Scalar, _) => Rates {
                vertices: Rate::Triangle,
                origin: Rate::Packet,
                direction: Rate::Packet,
            },
        }
    }

    /// How a kernel of so many lanes has its triangles in memory.
    pub fn layout(&self, lanes: usize) -> Layout {
        Layout {
            record: Record::Stored(self.stored),
            lanes: match self.grouping {
                Grouping::Single => lanes,
                Grouping::Packet | Grouping::Scalar => 1,
            },
        }
    }

    /// Whether a kernel by hand that finds the closest hits of both sides before `t_max`, and reports
    /// `t` alone, does what is asked.
    pub fn is_plain(&self) -> bool {
        self.query == Query::Closest
            && self.culling == Culling::None
            && self.range == Range::TMax
            && !self.has_hits()
    }

    /// Whether an output is asked for.
    pub fn reports(&self, output: Output) -> bool {
        self.outputs.contains(&output)
    }

    /// Whether kernels report more than `t`.
    pub fn has_hits(&self) -> bool {
        self.outputs.iter().any(|&output| output != Output::T)
    }
}

/// There is no preset scene model of this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown scene {name:?}; known: {}", SceneModel::PRESETS.join(", "))]
pub struct UnknownScene {
    /// The name asked for.
    pub name: String,
}

/// Reads a name that is safe in a file's name.
fn plain_name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let name = String::deserialize(deserializer)?;
    let plain = |byte| matches!(byte, b'a'..=b'z' | b'0'..=b'9' | b'.' | b'_' | b'-');
    if name.is_empty() || !name.bytes().all(plain) || name.contains("..") {
        return Err(D::Error::custom(format_args!(
            "name {name:?} is not of [a-z0-9._-] without \"..\""
        )));
    }
    Ok(name)
}

#[cfg(test)]
mod tests {
    use super::{Origin, SceneModel};

    fn parse(text: &str) -> Result<SceneModel, serde_json::Error> {
        serde_json::from_str(text)
    }

    #[test]
    fn every_preset_bears_its_name_and_is_no_contradiction() {
        for &name in SceneModel::PRESETS {
            let model = SceneModel::preset(name).unwrap();
            assert_eq!(model.name, name);
            assert_eq!(model.check(), Ok(()), "{name}");
        }
    }

    #[test]
    fn no_two_presets_require_the_same() {
        for &one in SceneModel::PRESETS {
            for &other in SceneModel::PRESETS {
                let mut model = SceneModel::preset(one).unwrap();
                model.name = other.into();
                assert!(one == other || model != SceneModel::preset(other).unwrap());
            }
        }
    }

    #[test]
    fn names_the_presets_when_asked_for_another() {
        let error = SceneModel::preset("sponza").unwrap_err();
        let known = SceneModel::PRESETS.join(", ");
        assert_eq!(
            error.to_string(),
            format!("unknown scene \"sponza\"; known: {known}")
        );
    }

    #[test]
    fn what_is_left_out_is_what_the_first_preset_has() {
        let model = parse(r#"{"name": "packet"}"#).unwrap();
        assert_eq!(model, SceneModel::preset("packet").unwrap());
        let model = parse(r#"{"name": "mine", "origin": "common"}"#).unwrap();
        assert_eq!(model.origin, Origin::Common);
    }

    #[test]
    fn a_model_is_read_as_it_was_written() {
        for &name in SceneModel::PRESETS {
            let model = SceneModel::preset(name).unwrap();
            let text = serde_json::to_string(&model).unwrap();
            assert_eq!(parse(&text).unwrap(), model);
        }
    }

    #[test]
    fn refuses_unknown_fields_and_words_and_names_that_are_paths() {
        for name in ["", "../../x", "a/b", "a..b", "Mine", "a b"] {
            let text = serde_json::json!({ "name": name }).to_string();
            assert!(parse(&text).is_err(), "{name:?}");
        }
        assert!(parse(r#"{"name": "mine-2.0"}"#).is_ok());
        assert!(parse(r#"{"name": "mine", "origin": "anywhere"}"#).is_err());
        assert!(parse(r#"{"name": "mine", "cullling": "back"}"#).is_err());
        assert!(parse(r#"{"origin": "common"}"#).is_err());
    }
}

//! Scene models: what a scene requires of a kernel. A kernel contains nothing else.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use volumes::Rates;

/// What a scene requires. Kernels are bred, named and published per scene model.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneModel {
    /// Its name, of `[a-z0-9._-]` without `..`: names of files are built from it.
    #[serde(deserialize_with = "plain_name")]
    pub name: String,
    /// What one kernel call takes.
    pub grouping: Grouping,
    /// Where the rays of a group start.
    pub origin: Origin,
    /// What its arithmetic may be.
    pub numeric: Numeric,
}

/// What one kernel call takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Grouping {
    /// A packet of rays and a slice of triangles: work on a triangle is shared by the packet.
    Packet,
}

/// Where the rays of a group start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// Anywhere.
    General,
    /// All in one point, as primary rays and shadow rays to a point light do: work without the
    /// direction is shared by the packet.
    Common,
}

/// What the arithmetic of a kernel may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Numeric {
    /// Only what every processor rounds alike: one program has the same answers, to the last bit,
    /// on every instruction set.
    Portable,
    /// Estimates of reciprocals too, with a Newton step. They differ between instruction sets, and
    /// between makers of processors.
    Fast,
}

impl SceneModel {
    /// The names that [`SceneModel::preset`] knows; the first is the default.
    pub const PRESETS: [&str; 4] = [
        "packet",
        "common-origin",
        "packet-portable",
        "common-origin-portable",
    ];

    /// The scene model of this name.
    ///
    /// # Errors
    ///
    /// The name is not in [`SceneModel::PRESETS`].
    ///
    /// ```
    /// use scene::{Origin, SceneModel};
    ///
    /// assert_eq!(SceneModel::preset("common-origin").unwrap().origin, Origin::Common);
    /// assert!(SceneModel::preset("pakcet").is_err());
    /// ```
    pub fn preset(name: &str) -> Result<Self, UnknownScene> {
        let (origin, numeric) = match name {
            "packet" => (Origin::General, Numeric::Fast),
            "common-origin" => (Origin::Common, Numeric::Fast),
            "packet-portable" => (Origin::General, Numeric::Portable),
            "common-origin-portable" => (Origin::Common, Numeric::Portable),
            _ => return Err(UnknownScene { name: name.into() }),
        };
        Ok(Self {
            name: name.into(),
            grouping: Grouping::Packet,
            origin,
            numeric,
        })
    }

    /// How often the inputs of a kernel change in this scene.
    pub fn rates(&self) -> Rates {
        match self.origin {
            Origin::General => Rates::GENERAL,
            Origin::Common => Rates::COMMON_ORIGIN,
        }
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
    use serde::Deserialize;
    use serde::de::IntoDeserializer;
    use serde::de::value::{Error, MapDeserializer};

    use super::SceneModel;

    fn parse(fields: &[(&str, &str)]) -> Result<SceneModel, Error> {
        let fields = fields.iter().copied();
        SceneModel::deserialize(MapDeserializer::new(fields).into_deserializer())
    }

    #[test]
    fn every_preset_bears_its_name() {
        for name in SceneModel::PRESETS {
            assert_eq!(SceneModel::preset(name).unwrap().name, name);
        }
    }

    #[test]
    fn names_the_presets_when_asked_for_another() {
        let error = SceneModel::preset("sponza").unwrap_err();
        assert_eq!(
            error.to_string(),
            "unknown scene \"sponza\"; known: packet, common-origin, packet-portable, \
             common-origin-portable"
        );
    }

    #[test]
    fn reads_what_a_preset_is() {
        let read = parse(&[
            ("name", "common-origin"),
            ("grouping", "packet"),
            ("origin", "common"),
            ("numeric", "fast"),
        ]);
        assert_eq!(read.unwrap(), SceneModel::preset("common-origin").unwrap());
    }

    #[test]
    fn refuses_unknown_fields_and_words_and_names_that_are_paths() {
        let model = |name, origin| {
            vec![
                ("name", name),
                ("grouping", "packet"),
                ("origin", origin),
                ("numeric", "portable"),
            ]
        };
        assert!(parse(&model("mine-2.0", "general")).is_ok());
        for name in ["", "../../x", "a/b", "a..b", "Mine", "a b"] {
            assert!(parse(&model(name, "general")).is_err(), "{name:?}");
        }
        assert!(parse(&model("mine", "anywhere")).is_err());
        let mut extra = model("mine", "general");
        extra.push(("culling", "back"));
        assert!(parse(&extra).is_err());
    }
}

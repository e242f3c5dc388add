//! Flags that change one field of a scene model each.

use std::fmt::Display;
use std::str::FromStr;

use scene::{
    Bounds, Culling, Grouping, Numeric, Origin, Output, Query, Range, SceneModel, Stored,
    UnknownWord, Watertight,
};

use crate::failure::bad_input;

/// What is asked of the scene beside its name. A wrong word lists those that there are.
#[derive(clap::Args)]
#[command(next_help_heading = "Changes to the scene")]
pub struct Fields {
    /// What a call takes: packet, single (a ray and blocks of triangles) or scalar
    #[arg(long, value_name = "WORD")]
    grouping: Option<String>,

    /// Where a packet's rays start: general or common
    #[arg(long, value_name = "WORD")]
    origin: Option<String>,

    /// What is asked of a ray: its closest hit, or whether there is any
    #[arg(long, value_name = "WORD")]
    query: Option<String>,

    /// Which side of a triangle is not there: none, back or front
    #[arg(long, value_name = "WORD")]
    culling: Option<String>,

    /// What is reported of a hit beside t: uv, triangle, normal, point; with commas
    #[arg(long, value_name = "WORDS", value_delimiter = ',')]
    outputs: Option<Vec<String>>,

    /// Where a hit counts: t_max, t_min..t_max or segment
    #[arg(long, value_name = "WORD")]
    range: Option<String>,

    /// What is kept of a triangle: vertices, vertices+normal, edges or edges+normal
    #[arg(long, value_name = "WORD")]
    stored: Option<String>,

    /// What the arithmetic may be: fast or portable
    #[arg(long, value_name = "WORD")]
    numeric: Option<String>,

    /// Where a closed mesh lets no ray through: none, edges or full
    #[arg(long, value_name = "WORD")]
    watertight: Option<String>,

    /// What becomes of t: shrinking (the closest hit so far), fixed, or leaf (lists of 8)
    #[arg(long, value_name = "WORD")]
    regime: Option<String>,

    /// What rays and triangles keep to: coordinates=LENGTH,edge=LENGTH, perhaps with directions=unit; or none
    #[arg(long, value_name = "BOUNDS")]
    bounds: Option<String>,
}

impl Fields {
    /// Whether the regime is asked for.
    pub fn name_regime(&self) -> bool {
        self.regime.is_some()
    }

    /// The scene with these fields. What differs from the scene is added to its name, but for the
    /// regime, which whatever is named after a scene has in its name anyway.
    pub fn change(&self, scene: SceneModel) -> anyhow::Result<SceneModel> {
        let mut change = Change { scene };
        change.field::<Grouping>(&self.grouping, |scene| &mut scene.grouping)?;
        change.field::<Origin>(&self.origin, |scene| &mut scene.origin)?;
        change.field::<Query>(&self.query, |scene| &mut scene.query)?;
        change.field::<Culling>(&self.culling, |scene| &mut scene.culling)?;
        change.field::<Range>(&self.range, |scene| &mut scene.range)?;
        change.field::<Stored>(&self.stored, |scene| &mut scene.stored)?;
        change.field::<Numeric>(&self.numeric, |scene| &mut scene.numeric)?;
        change.field::<Watertight>(&self.watertight, |scene| &mut scene.watertight)?;
        if let Some(words) = &self.outputs {
            let words = words.iter().filter(|word| !word.is_empty());
            let outputs: Result<Vec<Output>, UnknownWord> =
                words.map(|word| word.parse()).collect();
            let outputs = outputs.map_err(bad_input)?;
            if outputs != change.scene.outputs {
                for output in &outputs {
                    change.name(output);
                }
                change.scene.outputs = outputs;
            }
        }
        if let Some(regime) = &self.regime {
            change.scene.regime = regime.parse().map_err(bad_input)?;
        }
        if let Some(bounds) = &self.bounds {
            let bounds = match bounds.as_str() {
                "none" => None,
                bounds => Some(bounds.parse::<Bounds>().map_err(bad_input)?),
            };
            if bounds != change.scene.bounds {
                change.name(&if bounds.is_some() {
                    "bounded"
                } else {
                    "unbounded"
                });
                change.scene.bounds = bounds;
            }
        }
        change.scene.check().map_err(bad_input)?;
        Ok(change.scene)
    }
}

/// A scene that is being changed.
struct Change {
    scene: SceneModel,
}

impl Change {
    fn field<T>(
        &mut self,
        word: &Option<String>,
        field: impl Fn(&mut SceneModel) -> &mut T,
    ) -> anyhow::Result<()>
    where
        T: FromStr<Err = UnknownWord> + Display + PartialEq,
    {
        let Some(word) = word else {
            return Ok(());
        };
        let value: T = word.parse().map_err(bad_input)?;
        if *field(&mut self.scene) != value {
            self.name(&value);
            *field(&mut self.scene) = value;
        }
        Ok(())
    }

    /// Adds a word to the name, of the letters that a name has.
    fn name(&mut self, word: &impl Display) {
        let word = word.to_string().replace(['+', '_'], "-").replace("..", "-");
        self.scene.name = format!("{}-{word}", self.scene.name);
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Flags {
        #[command(flatten)]
        fields: Fields,
    }

    fn change(flags: &str) -> anyhow::Result<SceneModel> {
        let arguments = ["x"].into_iter().chain(flags.split_whitespace());
        let flags = Flags::try_parse_from(arguments)?;
        flags.fields.change(SceneModel::preset("packet")?)
    }

    #[test]
    fn flags_change_their_fields_and_the_name() {
        assert_eq!(change("").unwrap(), SceneModel::preset("packet").unwrap());
        let scene = change("--query any --range t_min..t_max --stored edges+normal").unwrap();
        assert_eq!(scene.name, "packet-any-t-min-t-max-edges-normal");
        assert_eq!(scene.query, Query::Any);
        let scene = change("--outputs uv,triangle --culling none").unwrap();
        assert_eq!(scene.name, "packet-uv-triangle");
        assert_eq!(scene.outputs, [Output::Uv, Output::Triangle]);
    }

    #[test]
    fn wrong_words_and_contradictions_are_one_sentence() {
        for (flags, says) in [
            (
                "--query some",
                "unknown query \"some\"; known: closest, any",
            ),
            ("--outputs uv,w", "unknown output \"w\""),
            ("--query any --outputs uv", "reports no hit"),
            ("--watertight full --stored edges", "must be stored"),
        ] {
            let error = change(flags).unwrap_err().to_string();
            assert!(error.contains(says) && !error.contains('\n'), "{error}");
        }
    }
}

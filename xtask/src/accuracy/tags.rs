//! What a program's statements say of it, beside what was found of its kernel.

use accuracy::Scaling;
use program::{Degree, Program, Watertight};
use serde::Serialize;

/// The tags of a program on an instruction set.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tags {
    /// Where it is watertight, in the words of scenes.
    pub watertight: scene::Watertight,
    /// Whether it uses coordinates by their differences alone.
    pub translation_safe: bool,
    /// Over which exponents of 2 a scale is safe, as they are measured.
    pub scales: Vec<(Scaling, i32, i32)>,
}

impl Tags {
    /// Those of a program where products are fused with sums, or are not.
    pub fn of(program: &Program, fuses: bool) -> Tags {
        let tags = program.tags(fuses);
        let scale = |scaling| {
            let (least, most) = tags.safe_scales(weights(scaling)).into_inner();
            (scaling, least, most)
        };
        Tags {
            watertight: match tags.watertight {
                Watertight::No => scene::Watertight::None,
                Watertight::Edges => scene::Watertight::Edges,
                Watertight::Full => scene::Watertight::Full,
            },
            translation_safe: tags.translation_safe,
            scales: Scaling::ALL.map(scale).into(),
        }
    }

    /// In a table: where it is watertight, the scales of everything, and what it is not.
    pub fn words(&self) -> String {
        let everything = self
            .scales
            .iter()
            .find(|(scaling, ..)| *scaling == Scaling::Everything);
        let scales =
            everything.map_or(String::new(), |(_, least, most)| format!("{least}..{most}"));
        let moves = match self.translation_safe {
            true => "",
            false => " near",
        };
        format!("{} {scales}{moves}", self.watertight)
    }
}

/// What a scaling of the lab multiplies.
fn weights(scaling: Scaling) -> Degree {
    match scaling {
        Scaling::Everything => Degree::EVERYTHING,
        Scaling::Positions => Degree::POSITIONS,
        Scaling::Directions => Degree::DIRECTIONS,
    }
}

#[cfg(test)]
mod tests {
    use super::Tags;

    #[test]
    fn the_paper_s_own_program_promises_little() {
        let graph = program::kensler_shirley();
        let program = graph.program(&program::appendix(&graph)).unwrap();
        assert_eq!(Tags::of(&program, false).words(), "none -16..16");
    }
}

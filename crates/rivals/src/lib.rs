//! Ray-triangle tests written by hand from the literature: what bred kernels have to beat.
//!
//! A rival's file is compiled here, so that its answers can be tested, and handed out as text, so
//! that the benchmark can compile it exactly as it compiles a candidate, for any instruction set. It
//! therefore uses the words of the lanes, `Packet`, `Triangle` and `core`, and nothing else.
//!
//! Rust crates of others are in `published`: their list, and with the feature of that name what calls them.

pub use mailbox::Mailbox;
pub use scene::abi::{Packet, Triangle};

use emit::{Isa, Kernel};
use scene::{Grouping, Origin, PACKET_SIZE, Regime};

#[path = "../../../templates/any.rs"]
mod any;
mod mailbox;
mod table;
/// The lanes of SSE2, as `emit` prints them.
#[cfg(target_arch = "x86_64")]
pub mod lanes {
    pub use crate::any::*;
    pub use crate::sse2::*;
}
#[cfg(target_arch = "x86_64")]
pub mod methods;
#[cfg(target_arch = "x86_64")]
pub mod packet;
pub mod published;
#[cfg(target_arch = "x86_64")]
pub mod single;
#[cfg(target_arch = "x86_64")]
#[expect(
    clippy::missing_safety_doc,
    reason = "nothing in it is unsafe to call but for the ISA"
)]
#[path = "../../../templates/sse2.rs"]
mod sse2;

/// A handwritten method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rival {
    /// Its name in tables and on the command line, `[a-z0-9-]`. No two rivals of a grouping share
    /// one.
    pub name: &'static str,
    /// What it tests together: a packet's rays, or a block's triangles with one ray. With one lane
    /// the latter is also the scalar form.
    pub grouping: Grouping,
    /// Where it comes from: paper and section.
    pub reference: &'static str,
    /// The text of its file, as it is compiled here, for SSE2.
    source: &'static str,
    /// What it keeps of a triangle, if that is not its vertices.
    pub precomputation: Option<Precomputation>,
    /// Whether it takes packets of one origin alone, that of ray 0.
    pub common_origin: bool,
    /// The one instruction set that it is written for, where it is not in the words of the lanes. Such a rival
    /// takes triangles one at a time: `fn(&mut Packet<N>, ray: usize, &[Record<[f32; 1]>])`.
    pub only_on: Option<Isa>,
    /// The function in it: `fn<const N: usize, const FIXED: bool>(&mut Packet<N>, &[Triangle])`, or
    /// `(&mut Packet<N>, ray: usize, &[Triangle<[f32; LANES]>])`; with records instead of triangles if it
    /// has its own.
    ///
    /// It stores the closest hit of each ray in `t`, or if `FIXED` every hit in `hit_t`. `N` is a
    /// multiple of the ISA's lanes.
    pub function: &'static str,
}

/// What is computed once of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Precomputation {
    /// The function in the rival's file: `fn(&Triangle) -> [f32; NUMBERS]`.
    pub function: &'static str,
    /// How many numbers it gives: four bytes each.
    pub numbers: usize,
}

/// The attribute of every function here.
const ATTRIBUTE: &str = "#[target_feature(enable = \"sse2\")]\n";

impl Rival {
    /// Whether there is a form of it for an instruction set.
    pub fn is_for(&self, isa: Isa) -> bool {
        self.only_on.is_none_or(|only| only == isa)
    }

    /// Its kernel for an instruction set that it is for, and a regime.
    pub fn kernel(&self, isa: Isa, regime: Regime) -> Kernel {
        let fixed = regime == Regime::Fixed;
        let function = format!("{}::<{PACKET_SIZE}, {fixed}>", self.function);
        let source = self.source(&isa.attribute());
        let mut kernel = Kernel::by_hand(isa, self.grouping, source, function);
        if let Some(Precomputation { function, numbers }) = self.precomputation {
            kernel = kernel.preparing(numbers, function);
        }
        match self.only_on {
            None => kernel,
            Some(_) => kernel.one_by_one(),
        }
    }

    /// The text of its file with another attribute, a line of its own or nothing, for the
    /// functions: a module whose parent has an instruction set's template as `lanes`, in a crate
    /// that has `Packet` and `Triangle` at its root.
    fn source(&self, attribute: &str) -> String {
        // What such files have in common becomes a module in it.
        let uses = "use super::common::*;";
        let source = match self.source.contains(uses) {
            true => {
                let common = COMMON.replace("use super::lanes::*;", "use super::super::lanes::*;");
                let own = self.source.replace(uses, "use common::*;");
                format!("{own}\nmod common {{\n{common}}}\n")
            }
            false => self.source.to_owned(),
        };
        source.replace(ATTRIBUTE, attribute)
    }
}

/// What the files of `methods` have in common.
const COMMON: &str = include_str!("methods/common.rs");

/// All rivals, in the order in which tables print them.
pub fn all() -> &'static [Rival] {
    &table::RIVALS
}

/// The rivals of a grouping, for rays that start where `origin` says.
pub fn of(grouping: Grouping, origin: Origin) -> impl Iterator<Item = &'static Rival> {
    let grouping = match grouping {
        Grouping::Packet => Grouping::Packet,
        Grouping::Single | Grouping::Scalar => Grouping::Single,
    };
    let takes = move |rival: &&Rival| !rival.common_origin || origin == Origin::Common;
    let rivals = all().iter().filter(takes);
    rivals.filter(move |rival| rival.grouping == grouping)
}

/// The rival of this name for a grouping, if there is one.
///
/// ```
/// use scene::{Grouping, Origin};
///
/// let rival = rivals::find("moller-trumbore", Grouping::Packet).unwrap();
/// assert_eq!(rival.function, "moller_trumbore");
/// assert_eq!(rivals::find("muller-trumbore", Grouping::Packet), None);
/// ```
pub fn find(name: &str, grouping: Grouping) -> Option<&'static Rival> {
    of(grouping, Origin::Common).find(|rival| rival.name == name)
}

#[cfg(test)]
mod tests {
    use super::{Precomputation, all, find};

    #[test]
    fn every_rival_is_found_by_its_name() {
        for rival in all() {
            assert_eq!(find(rival.name, rival.grouping), Some(rival));
        }
    }

    #[test]
    fn a_source_has_the_attribute_that_it_is_asked_for() {
        for rival in all() {
            let own = rival.source(super::ATTRIBUTE);
            assert!(own.contains(super::ATTRIBUTE), "{}", rival.name);
            assert!(!rival.source("").contains(super::ATTRIBUTE));
            let avx2 = rival.source("#[target_feature(enable = \"avx2\")]\n");
            assert_eq!(
                avx2.matches("enable = \"avx2\"").count(),
                own.matches("enable = \"sse2\"").count(),
            );
        }
    }

    #[test]
    fn every_source_defines_its_functions_and_borrows_only_what_the_benchmark_offers() {
        for rival in all() {
            let source = rival.source("");
            // By itself, or as a form of the method.
            let definitions = [
                "pub fn {}<const N: usize, const FIXED: bool>(",
                "    {}, ",
                ", {}: ",
            ];
            let mut definitions = definitions
                .map(|text| text.replace("{}", rival.function))
                .into_iter();
            assert!(
                definitions.any(|text| source.contains(&text)),
                "{}",
                rival.name
            );
            let uses = source.lines().filter(|line| line.starts_with("use "));
            let offered = [
                "use super::lanes::*;",
                "use super::super::lanes::*;",
                "use common::*;",
                "use crate::{Packet, Triangle};",
            ];
            for line in uses {
                assert!(offered.contains(&line), "{}: {line}", rival.name);
            }
            if let Some(Precomputation { function, .. }) = rival.precomputation {
                let definition = format!("pub fn {function}(triangle: &Triangle) -> Record {{");
                assert!(source.contains(&definition), "{}", rival.name);
            }
        }
    }
}

//! Ray-triangle tests written by hand from the literature: what bred kernels have to beat.
//!
//! A rival's file is compiled here, so that its answers can be tested, and handed out as text, so
//! that the benchmark can compile it exactly as it compiles a candidate, for any instruction set. It
//! therefore uses the words of the lanes, `Packet`, `Triangle` and `core`, and nothing else.

pub use scene::abi::{Packet, Triangle};

use scene::Grouping;

#[path = "../../../templates/any.rs"]
mod any;
/// The lanes of SSE2, as `emit` prints them.
#[cfg(target_arch = "x86_64")]
pub mod lanes {
    pub use crate::any::*;
    pub use crate::sse2::*;
}
#[cfg(target_arch = "x86_64")]
pub mod packet;
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
    /// The function in it: `fn<const N: usize, const FIXED: bool>(&mut Packet<N>, &[Triangle])`, or
    /// `(&mut Packet<N>, ray: usize, &[Triangle<[f32; LANES]>])`.
    ///
    /// It stores the closest hit of each ray in `t`, or if `FIXED` every hit in `hit_t`. `N` is a
    /// multiple of the ISA's lanes.
    pub function: &'static str,
}

/// The attribute of every function here.
const ATTRIBUTE: &str = "#[target_feature(enable = \"sse2\")]\n";

impl Rival {
    /// The text of its file with another attribute, a line of its own or nothing, for the
    /// functions: a module whose parent has an instruction set's template as `lanes`, in a crate
    /// that has `Packet` and `Triangle` at its root.
    pub fn source(&self, attribute: &str) -> String {
        self.source.replace(ATTRIBUTE, attribute)
    }
}

/// All rivals, in the order in which tables print them.
pub fn all() -> &'static [Rival] {
    const {
        &[
            Rival {
                name: "moller-trumbore",
                grouping: Grouping::Packet,
                reference: "Möller and Trumbore 1997, section 3, as adapted to packets in \
                            Kensler and Shirley 2006, table 1, row MT",
                source: include_str!("packet/moller_trumbore.rs"),
                function: "moller_trumbore",
            },
            Rival {
                name: "kensler-shirley",
                grouping: Grouping::Packet,
                reference: "Kensler and Shirley 2006, appendix (GA+ for general packets)",
                source: include_str!("packet/kensler_shirley.rs"),
                function: "kensler_shirley",
            },
            Rival {
                name: "moller-trumbore",
                grouping: Grouping::Single,
                reference: "Möller and Trumbore 1997, section 3, one ray against a block of \
                            triangles",
                source: include_str!("single/moller_trumbore.rs"),
                function: "moller_trumbore",
            },
            Rival {
                name: "kensler-shirley",
                grouping: Grouping::Single,
                reference: "Kensler and Shirley 2006, appendix (GA+ for general packets), its \
                            statements with one ray against a block of triangles",
                source: include_str!("single/kensler_shirley.rs"),
                function: "kensler_shirley",
            },
        ]
    }
}

/// The rivals of a grouping.
pub fn of(grouping: Grouping) -> impl Iterator<Item = &'static Rival> {
    let grouping = match grouping {
        Grouping::Packet => Grouping::Packet,
        Grouping::Single | Grouping::Scalar => Grouping::Single,
    };
    all().iter().filter(move |rival| rival.grouping == grouping)
}

/// The rival of this name for a grouping, if there is one.
///
/// ```
/// use scene::Grouping;
///
/// let rival = rivals::find("moller-trumbore", Grouping::Packet).unwrap();
/// assert_eq!(rival.function, "moller_trumbore");
/// assert_eq!(rivals::find("muller-trumbore", Grouping::Packet), None);
/// ```
pub fn find(name: &str, grouping: Grouping) -> Option<&'static Rival> {
    of(grouping).find(|rival| rival.name == name)
}

#[cfg(test)]
mod tests {
    use super::{all, find};

    #[test]
    fn every_rival_is_found_by_its_name() {
        for rival in all() {
            assert_eq!(find(rival.name, rival.grouping), Some(rival));
        }
    }

    #[test]
    fn a_source_has_the_attribute_that_it_is_asked_for() {
        for rival in all() {
            assert_eq!(rival.source(super::ATTRIBUTE), rival.source);
            assert!(!rival.source("").contains("target_feature"));
            let avx2 = rival.source("#[target_feature(enable = \"avx2\")]\n");
            assert_eq!(
                avx2.matches("enable = \"avx2\"").count(),
                2,
                "itself and its dot product"
            );
        }
    }

    #[test]
    fn every_source_defines_its_function_and_borrows_only_what_the_benchmark_offers() {
        for rival in all() {
            let definition = format!(
                "pub fn {}<const N: usize, const FIXED: bool>(",
                rival.function
            );
            assert!(rival.source.contains(&definition), "{}", rival.name);
            let uses: Vec<&str> = rival
                .source
                .lines()
                .filter(|line| line.starts_with("use "))
                .collect();
            assert_eq!(
                uses,
                ["use super::lanes::*;", "use crate::{Packet, Triangle};"],
                "{}",
                rival.name
            );
        }
    }
}

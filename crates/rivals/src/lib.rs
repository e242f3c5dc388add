//! Ray-triangle tests written by hand from the literature: what bred kernels have to beat.
//!
//! A rival's file is compiled here, so that its answers can be tested, and handed out as text, so
//! that the benchmark can compile it exactly as it compiles a candidate, for any instruction set. It
//! therefore uses the words of the lanes, `Packet`, `Triangle` and `core`, and nothing else.

pub use scene::abi::{Packet, Triangle};

#[cfg(target_arch = "x86_64")]
pub mod packet;

/// A handwritten method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rival {
    /// Its name in tables and on the command line, `[a-z0-9-]`. No two rivals share one.
    pub name: &'static str,
    /// Where it comes from: paper and section.
    pub reference: &'static str,
    /// The text of its file, as it is compiled here, for SSE2.
    source: &'static str,
    /// The function in it: `fn<const N: usize, const FIXED: bool>(&mut Packet<N>, &[Triangle])`.
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
                reference: "Möller and Trumbore 1997, section 3, as adapted to packets in \
                            Kensler and Shirley 2006, table 1, row MT",
                source: include_str!("packet/moller_trumbore.rs"),
                function: "moller_trumbore",
            },
            Rival {
                name: "kensler-shirley",
                reference: "Kensler and Shirley 2006, appendix (GA+ for general packets)",
                source: include_str!("packet/kensler_shirley.rs"),
                function: "kensler_shirley",
            },
        ]
    }
}

/// The rival of this name, if there is one.
///
/// ```
/// assert_eq!(rivals::find("moller-trumbore").unwrap().function, "moller_trumbore");
/// assert_eq!(rivals::find("muller-trumbore"), None);
/// ```
pub fn find(name: &str) -> Option<&'static Rival> {
    all().iter().find(|rival| rival.name == name)
}

#[cfg(test)]
mod tests {
    use super::{all, find};

    #[test]
    fn every_rival_is_found_by_its_name() {
        for rival in all() {
            assert_eq!(find(rival.name), Some(rival));
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

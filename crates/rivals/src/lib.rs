//! Ray-triangle tests written by hand from the literature: what bred kernels have to beat.
//!
//! A rival's file is compiled here, so that its answers can be tested, and handed out as text, so
//! that the benchmark can compile it exactly as it compiles a candidate. It therefore uses the
//! lanes of its ISA, `Packet`, `Triangle` and `core`, and nothing else.

pub use scene::abi::{Packet, Triangle};

#[cfg(target_arch = "x86_64")]
pub mod sse2;

/// A handwritten method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rival {
    /// Its name in tables and on the command line, `[a-z0-9-]`. No two rivals share one.
    pub name: &'static str,
    /// The ISA it is written for, by the name of its template.
    pub isa: &'static str,
    /// Where it comes from: paper and section.
    pub reference: &'static str,
    /// The text of its file: a module whose parent has the ISA's template as `lanes`, in a crate
    /// that has `Packet` and `Triangle` at its root.
    pub source: &'static str,
    /// The function in it: `fn<const N: usize, const FIXED: bool>(&mut Packet<N>, &[Triangle])`.
    ///
    /// It stores the closest hit of each ray in `t`, or if `FIXED` every hit in `hit_t`. `N` is a
    /// multiple of the ISA's lanes.
    pub function: &'static str,
}

/// All rivals, in the order in which tables print them.
pub fn all() -> &'static [Rival] {
    const {
        &[
            Rival {
                name: "moller-trumbore",
                isa: "sse2",
                reference: "Möller and Trumbore 1997, section 3, as adapted to packets in \
                            Kensler and Shirley 2006, table 1, row MT",
                source: include_str!("sse2/moller_trumbore.rs"),
                function: "moller_trumbore",
            },
            Rival {
                name: "kensler-shirley",
                isa: "sse2",
                reference: "Kensler and Shirley 2006, appendix (GA+ for general packets)",
                source: include_str!("sse2/kensler_shirley.rs"),
                function: "kensler_shirley",
            },
        ]
    }
}

/// The rival of this name, if there is one.
///
/// ```
/// assert_eq!(rivals::find("moller-trumbore").unwrap().isa, "sse2");
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

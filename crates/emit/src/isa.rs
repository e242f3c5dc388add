//! Instruction sets. None decides anything: all print the same statements, in the words that the
//! set's file in `templates/` spells.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// An instruction set that kernels are printed for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Isa {
    /// One lane, on every processor.
    #[serde(rename = "scalar")]
    Scalar,
    /// Four lanes, on every x86-64 processor.
    #[serde(rename = "sse2")]
    Sse2,
    /// Four lanes, with blends.
    #[serde(rename = "sse4.1")]
    Sse41,
    /// Eight lanes, with instructions that leave their operands alone.
    #[serde(rename = "avx2")]
    Avx2,
    /// Sixteen lanes, with registers of masks.
    #[serde(rename = "avx512")]
    Avx512,
}

/// What the lanes of all instruction sets have in common.
const ANY: &str = include_str!("../../../templates/any.rs");

/// What is known of an instruction set.
struct Traits {
    name: &'static str,
    module: &'static str,
    features: &'static str,
    lane_count: usize,
    lanes: &'static str,
    overwrites: bool,
}

impl Isa {
    /// Every instruction set, narrowest first.
    pub const ALL: [Isa; 5] = [Isa::Scalar, Isa::Sse2, Isa::Sse41, Isa::Avx2, Isa::Avx512];

    /// The words that templates define and kernels are written in, beside types and constants.
    pub const WORDS: [&'static str; 37] = [
        "add",
        "afresh",
        "align_frame",
        "all_true",
        "at_most",
        "axes_along",
        "bit_or",
        "bit_xor",
        "bits",
        "both",
        "div",
        "either",
        "estimate_reciprocal",
        "exact_difference",
        "first_of_least",
        "flip_sign",
        "is_empty",
        "last_of_most",
        "least",
        "less",
        "load",
        "load_bits",
        "max",
        "min",
        "mul",
        "mul_add",
        "mul_sub",
        "neg_mul_add",
        "read",
        "select",
        "sign_is_clear",
        "splat",
        "store",
        "store_bits",
        "sub",
        "to_array",
        "zeros",
    ];

    fn traits(self) -> Traits {
        match self {
            Isa::Scalar => Traits {
                name: "scalar",
                lane_count: 1,
                module: "scalar",
                features: "",
                lanes: include_str!("../../../templates/scalar.rs"),
                overwrites: false,
            },
            Isa::Sse2 => Traits {
                name: "sse2",
                lane_count: 4,
                module: "sse2",
                features: "sse2",
                lanes: include_str!("../../../templates/sse2.rs"),
                overwrites: true,
            },
            Isa::Sse41 => Traits {
                name: "sse4.1",
                lane_count: 4,
                module: "sse4_1",
                features: "sse4.1",
                lanes: include_str!("../../../templates/sse4_1.rs"),
                overwrites: true,
            },
            Isa::Avx2 => Traits {
                name: "avx2",
                lane_count: 8,
                module: "avx2",
                features: "avx2,fma",
                lanes: include_str!("../../../templates/avx2.rs"),
                overwrites: false,
            },
            Isa::Avx512 => Traits {
                name: "avx512",
                lane_count: 16,
                module: "avx512",
                features: "avx512f,avx512dq,avx512vl",
                lanes: include_str!("../../../templates/avx512.rs"),
                overwrites: false,
            },
        }
    }

    /// Its name in flags, recipes and tables: `sse4.1`.
    pub fn name(self) -> &'static str {
        self.traits().name
    }

    /// Its name in paths of files and of Rust: `sse4_1`.
    pub fn module(self) -> &'static str {
        self.traits().module
    }

    /// What `#[target_feature]` enables; nothing for scalar kernels, which need nothing.
    pub fn features(self) -> &'static str {
        self.traits().features
    }

    /// The attribute of a function that needs it, on a line of its own.
    pub fn attribute(self) -> String {
        match self.features() {
            "" => String::new(),
            features => format!("#[target_feature(enable = \"{features}\")]\n"),
        }
    }

    /// The text of its lanes: a module that defines [`Isa::WORDS`], but for `afresh` where that is
    /// of no use.
    pub(crate) fn lanes(self) -> String {
        // The head of a file does not stand in the middle of one.
        let (_, any) = ANY.split_once("\n\n").expect("a head, then an empty line");
        format!("{}\n{any}", self.traits().lanes)
    }

    /// Numbers in a vector.
    pub fn lane_count(self) -> usize {
        self.traits().lane_count
    }

    /// Whether a product fused with a sum is one instruction, which rounds once.
    pub fn fuses(self) -> bool {
        matches!(self, Isa::Avx2 | Isa::Avx512)
    }

    /// Whether an instruction's result takes the place of an operand.
    pub(crate) fn overwrites(self) -> bool {
        self.traits().overwrites
    }

    /// Whether the components of one ray are read for every block. One load fills a vector with a number, and there are
    /// too few registers to keep seven such vectors: those that do not fit are stored on the stack before the first
    /// block, and read from there.
    pub(crate) fn rereads(self) -> bool {
        self == Isa::Avx2
    }

    /// Whether this machine has it.
    pub fn is_available(self) -> bool {
        match self {
            Isa::Scalar => true,
            #[cfg(target_arch = "x86_64")]
            Isa::Sse2 => std::is_x86_feature_detected!("sse2"),
            #[cfg(target_arch = "x86_64")]
            Isa::Sse41 => std::is_x86_feature_detected!("sse4.1"),
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 => {
                std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma")
            }
            #[cfg(target_arch = "x86_64")]
            Isa::Avx512 => {
                std::is_x86_feature_detected!("avx512f")
                    && std::is_x86_feature_detected!("avx512dq")
                    && std::is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }
}

impl fmt::Display for Isa {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Nobody knows an instruction set of that name.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[error("unknown ISA {name:?}; known: {}", Isa::ALL.map(Isa::name).join(", "))]
pub struct UnknownIsa {
    /// The name asked for.
    pub name: String,
}

impl FromStr for Isa {
    type Err = UnknownIsa;

    fn from_str(name: &str) -> Result<Isa, UnknownIsa> {
        let isa = Isa::ALL.into_iter().find(|isa| isa.name() == name);
        isa.ok_or_else(|| UnknownIsa { name: name.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_template_defines_every_word() {
        for isa in Isa::ALL {
            for word in Isa::WORDS {
                let defines = isa.lanes().contains(&format!("pub fn {word}"))
                    || isa.lanes().contains(&format!(" as {word}"));
                let needs = word != "afresh" || isa.overwrites();
                assert_eq!(defines, needs, "{isa}: {word}");
            }
        }
    }

    #[test]
    fn no_template_defines_a_function_that_is_no_word() {
        for isa in Isa::ALL {
            let lanes = isa.lanes();
            let functions = lanes.lines().filter_map(|line| {
                let name = line.strip_prefix("pub fn ")?.split(['(', '<']).next()?;
                Some(name)
            });
            for name in functions {
                assert!(Isa::WORDS.contains(&name), "{isa}: {name}");
            }
        }
    }

    #[test]
    fn every_function_of_a_template_needs_what_its_kernels_need() {
        for isa in Isa::ALL {
            let attributes = isa.lanes().matches("#[target_feature").count();
            let own = isa.lanes().matches(isa.attribute().trim_end()).count();
            if !isa.features().is_empty() {
                assert_eq!(attributes, own, "{isa}");
            }
        }
    }

    #[test]
    fn an_isa_is_written_in_files_as_it_is_on_the_command_line() {
        for isa in Isa::ALL {
            let text = serde_json::to_string(&isa).unwrap();
            assert_eq!(text, format!("{:?}", isa.name()));
            assert_eq!(isa.name().parse(), Ok(isa));
        }
    }
}

//! Instruction sets: what each can do and how it spells it. One file each; none decides anything.

mod sse2;

use std::fmt;
use std::str::FromStr;

use program::{Binary, Unary};
use serde::{Deserialize, Serialize};

/// An instruction set that kernels are printed for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Isa {
    /// Four lanes, on every x86-64 processor.
    Sse2,
}

/// The spelling of one instruction set.
pub(crate) struct Spelling {
    /// Its name in `--isa`, in paths and in modules.
    pub name: &'static str,
    /// What `#[target_feature]` enables.
    pub features: &'static str,
    /// The handwritten functions that kernels may call beside the intrinsics.
    pub lanes: &'static str,
    /// A number in every lane, by the Rust expression of the number.
    pub splat: fn(&str) -> String,
    /// The number zero in every lane.
    pub zero: &'static str,
    /// The intersection of two masks.
    pub both: fn(&str, &str) -> String,
    /// An operation of one number.
    pub unary: fn(Unary, &str) -> String,
    /// An operation of two.
    pub binary: fn(Binary, &str, &str) -> String,
}

impl Isa {
    /// Every instruction set, narrowest first.
    pub const ALL: [Isa; 1] = [Isa::Sse2];

    /// Its name: `sse2`.
    pub fn name(self) -> &'static str {
        self.spelling().name
    }

    /// Whether this machine has it.
    pub fn is_available(self) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Isa::Sse2 => std::is_x86_feature_detected!("sse2"),
            #[cfg(not(target_arch = "x86_64"))]
            Isa::Sse2 => false,
        }
    }

    pub(crate) fn spelling(self) -> &'static Spelling {
        match self {
            Isa::Sse2 => &sse2::SPELLING,
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

//! The graphs that are checked in, by name.

use crate::graph::Graph;
use crate::rules::{Rules, Watertight};
use crate::{extended, kensler_shirley, segment, watertight};

/// A graph of `dag/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CheckedIn {
    /// Kensler and Shirley's.
    KenslerShirley,
    /// The same with fused operations as choices.
    Extended,
    /// That with the other end of a segment.
    Segment,
    /// The sheared test.
    Watertight,
}

impl CheckedIn {
    /// All, in the order of their tables.
    pub const ALL: [CheckedIn; 4] = [
        CheckedIn::KenslerShirley,
        CheckedIn::Extended,
        CheckedIn::Segment,
        CheckedIn::Watertight,
    ];

    /// The graph to search under these rules; `fuses` if some instruction set fuses.
    pub fn of(rules: &Rules, fuses: bool) -> CheckedIn {
        match rules.watertight {
            Watertight::Full => CheckedIn::Watertight,
            Watertight::No | Watertight::Edges if rules.ends => CheckedIn::Segment,
            Watertight::No | Watertight::Edges if rules.finite || rules.fused && fuses => {
                CheckedIn::Extended
            }
            Watertight::No | Watertight::Edges => CheckedIn::KenslerShirley,
        }
    }

    /// The name of its file, without the ending.
    pub fn name(self) -> &'static str {
        match self {
            CheckedIn::KenslerShirley => "kensler-shirley",
            CheckedIn::Extended => "extended",
            CheckedIn::Segment => "segment",
            CheckedIn::Watertight => "watertight",
        }
    }

    /// Builds it.
    pub fn graph(self) -> Graph {
        match self {
            CheckedIn::KenslerShirley => kensler_shirley(),
            CheckedIn::Extended => extended(),
            CheckedIn::Segment => segment(),
            CheckedIn::Watertight => watertight(),
        }
    }
}

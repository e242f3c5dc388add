//! What a processor can begin in a cycle, and what a kernel's arithmetic takes of it at least.

use std::hint::black_box;
use std::time::Instant;

use emit::{COUNTED_WORDS, Isa};

use crate::protocol::Counts;

/// How many vector instructions of a kind a core can begin in a cycle, after the tables of Agner Fog
/// ("Instruction tables") and uops.info. Where processors of a maker differ, the fastest: a bound holds for
/// all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pipes {
    /// Multiplications, fused or not.
    multiply: f64,
    /// Additions.
    add: f64,
    /// Multiplications and additions together.
    arithmetic: f64,
    /// All of them, comparisons and logic too.
    all: f64,
    /// Cycles between two divisions of 4, 8 and 16 lanes.
    division: [f64; 3],
    /// How many of these an instruction of 16 lanes takes.
    widest: f64,
}

/// Zen and later. Zen 5 has pipes of 16 lanes, its forerunners put two of 8 together.
const AMD: Pipes = Pipes {
    multiply: 2.0,
    add: 2.0,
    arithmetic: 4.0,
    all: 4.0,
    division: [3.0, 5.0, 10.0],
    widest: 2.0,
};

/// Skylake and later.
const INTEL: Pipes = Pipes {
    multiply: 2.0,
    add: 2.0,
    arithmetic: 2.0,
    all: 3.0,
    division: [3.0, 5.0, 10.0],
    widest: 1.0,
};

/// AMD's family of Zen 5.
const ZEN_5: u8 = 26;

impl Pipes {
    /// Those of this processor, if they are known.
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    pub fn here() -> Option<Pipes> {
        let id = raw_cpuid::CpuId::new();
        let vendor = id.get_vendor_info()?;
        let family = id.get_feature_info()?.family_id();
        match vendor.as_str() {
            "AuthenticAMD" if family >= ZEN_5 => Some(Pipes { widest: 1.0, ..AMD }),
            "AuthenticAMD" if family >= 23 => Some(AMD),
            "GenuineIntel" => Some(INTEL),
            _ => None,
        }
    }

    /// Those of this processor, if they are known.
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    pub fn here() -> Option<Pipes> {
        None
    }

    /// The least cycles that a test of one ray and one triangle can take, by what was counted: if nothing ever
    /// waits for anything, and loads, copies and jumps take no time. None for scalar code, of which a compiler may
    /// make vectors.
    pub fn least_cycles(self, isa: Isa, counts: &Counts) -> Option<f64> {
        if isa == Isa::Scalar {
            return None;
        }
        let mut work = Work::default();
        for (word, times) in COUNTED_WORDS.iter().zip(&counts.words) {
            work.add(word, *times as f64, isa);
        }
        let Work {
            multiply,
            add,
            other,
            divide,
        } = work;
        let (wide, division) = match isa.lane_count() {
            16 => (self.widest, self.division[2]),
            8 => (1.0, self.division[1]),
            _ => (1.0, self.division[0]),
        };
        // A division is an instruction of a pipe that multiplies.
        let multiply = multiply + divide;
        let bounds = [
            wide * multiply / self.multiply,
            wide * add / self.add,
            wide * (multiply + add) / self.arithmetic,
            wide * (multiply + add + other) / self.all,
            divide * division,
        ];
        Some(bounds.into_iter().fold(0.0, f64::max) / counts.tests as f64)
    }
}

/// Instructions by the pipes that they can go to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Work {
    multiply: f64,
    add: f64,
    divide: f64,
    /// To any.
    other: f64,
}

impl Work {
    /// Adds a word, used so many times: of the instructions that an instruction set spells it with, those
    /// that no compiler can do without.
    fn add(&mut self, word: &str, times: f64, isa: Isa) {
        let fuses = matches!(isa, Isa::Avx2 | Isa::Avx512);
        let (mut multiply, mut add, mut divide, mut other) = (0.0, 0.0, 0.0, 0.0);
        match word {
            "mul" => multiply = 1.0,
            "mul_add" | "mul_sub" | "neg_mul_add" if fuses => multiply = 1.0,
            "mul_add" | "mul_sub" | "neg_mul_add" => (multiply, add) = (1.0, 1.0),
            "add" | "sub" => add = 1.0,
            "div" => divide = 1.0,
            // Of each half of the lanes: two products and a difference.
            "exact_difference" => (multiply, add) = (4.0, 2.0),
            // Masks are registers of their own, with pipes of their own.
            "both" | "either" if isa == Isa::Avx512 => {}
            "select" if isa == Isa::Sse2 => other = 3.0,
            "flip_sign" if isa != Isa::Avx512 => other = 2.0,
            _ => other = 1.0,
        }
        self.multiply += times * multiply;
        self.add += times * add;
        self.divide += times * divide;
        self.other += times * other;
    }
}

/// Pairs of operations that [`clock`] times.
const PAIRS: u32 = 1 << 20;

/// Cycles a second of the core that this runs on, by a chain of additions and exclusive ors of which each
/// waits for the one before, a cycle each. The best of a few goes: whatever interrupts makes it slower.
pub fn clock() -> f64 {
    let go = |_| {
        let (addend, mask) = (
            black_box(0x9e37_79b9_7f4a_7c15_u64),
            black_box(0x5bd1_e995_u64),
        );
        let mut number = black_box(1_u64);
        let start = Instant::now();
        for _ in 0..PAIRS {
            number = number.wrapping_add(addend) ^ mask;
        }
        black_box(number);
        2.0 * f64::from(PAIRS) / start.elapsed().as_secs_f64()
    };
    (0..5).map(go).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(tests: u64, words: &[(&str, u64)]) -> Counts {
        let of = |word: &&str| words.iter().find(|(name, _)| name == word);
        let words = COUNTED_WORDS
            .iter()
            .map(|word| of(word).map_or(0, |(_, times)| *times));
        Counts {
            tests,
            words: words.collect(),
        }
    }

    #[test]
    fn the_fullest_pipe_bounds_the_cycles() {
        let eight = |words| AMD.least_cycles(Isa::Avx2, &counts(8, words)).unwrap();
        assert_eq!(eight(&[("mul", 4)]), 2.0 / 8.0);
        assert_eq!(eight(&[("mul", 4), ("add", 4)]), 2.0 / 8.0);
        assert_eq!(eight(&[("mul", 4), ("add", 4), ("less", 4)]), 3.0 / 8.0);
        assert_eq!(eight(&[("mul", 4), ("div", 1)]), 5.0 / 8.0);
        let intel = INTEL.least_cycles(Isa::Avx2, &counts(8, &[("mul", 4), ("add", 4)]));
        assert_eq!(intel, Some(4.0 / 8.0));
        assert_eq!(INTEL.least_cycles(Isa::Scalar, &counts(1, &[])), None);
    }

    #[test]
    fn a_fused_product_is_two_instructions_where_nothing_fuses() {
        let of = |isa| {
            AMD.least_cycles(isa, &counts(1, &[("mul_add", 4), ("add", 4)]))
                .unwrap()
        };
        assert_eq!((of(Isa::Avx2), of(Isa::Sse2)), (2.0, 4.0));
    }

    #[test]
    fn sixteen_lanes_take_two_pipes_of_eight() {
        let of = |isa| AMD.least_cycles(isa, &counts(1, &[("mul", 4)])).unwrap();
        assert_eq!(of(Isa::Avx512), 2.0 * of(Isa::Avx2));
    }

    #[test]
    fn the_clock_ticks() {
        assert!(clock().is_finite() && clock() > 0.0);
    }
}

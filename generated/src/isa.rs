//! Instruction sets, and which of them the processor has.

use core::fmt;

/// An instruction set that kernels are made for, narrowest first.
///
/// All exist on every architecture; there but for [`Isa::Scalar`] none is available beyond x86-64.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Isa {
    /// One number at a time, on any processor.
    Scalar,
    /// Four numbers: every x86-64 processor.
    Sse2,
    /// Four numbers, with blends.
    Sse41,
    /// Eight numbers, with fused operations (`avx2`, `fma`).
    Avx2,
    /// Sixteen numbers (`avx512f`, `avx512dq`, `avx512vl`).
    Avx512,
}

/// Whether the processor has a feature. Without `std` nobody can ask it, and what the compiler may take for granted
/// is all there is.
#[cfg(target_arch = "x86_64")]
macro_rules! has {
    ($($feature:tt),+) => {{
        #[cfg(feature = "std")]
        let has = true $(&& std::is_x86_feature_detected!($feature))+;
        #[cfg(not(feature = "std"))]
        let has = true $(&& cfg!(target_feature = $feature))+;
        has
    }};
}

impl Isa {
    /// All of them, narrowest first.
    pub const ALL: [Isa; 5] = [Isa::Scalar, Isa::Sse2, Isa::Sse41, Isa::Avx2, Isa::Avx512];

    /// The widest that the processor has. It is asked once; the answer is kept.
    #[inline]
    pub fn detect() -> Isa {
        let mut isas = Isa::ALL.into_iter().rev();
        isas.find(|isa| isa.is_available()).unwrap_or(Isa::Scalar)
    }

    /// Whether the processor has it, and all that are narrower. Without the feature `std`, whether the compiler was
    /// told that it has.
    #[inline]
    pub fn is_available(self) -> bool {
        match self {
            Isa::Scalar => true,
            #[cfg(target_arch = "x86_64")]
            Isa::Sse2 => has!("sse2"),
            #[cfg(target_arch = "x86_64")]
            Isa::Sse41 => has!("sse4.1"),
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 => has!("sse4.1", "avx2", "fma"),
            #[cfg(target_arch = "x86_64")]
            Isa::Avx512 => has!("sse4.1", "avx2", "fma", "avx512f", "avx512dq", "avx512vl"),
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// Its name: `sse4.1`.
    pub const fn name(self) -> &'static str {
        match self {
            Isa::Scalar => "scalar",
            Isa::Sse2 => "sse2",
            Isa::Sse41 => "sse4.1",
            Isa::Avx2 => "avx2",
            Isa::Avx512 => "avx512",
        }
    }

    /// Numbers in a vector.
    pub const fn lanes(self) -> usize {
        match self {
            Isa::Scalar => 1,
            Isa::Sse2 | Isa::Sse41 => 4,
            Isa::Avx2 => 8,
            Isa::Avx512 => 16,
        }
    }

    /// The widest set, up to this one, of whose vectors so many numbers are a whole number.
    #[inline]
    pub(crate) const fn of_whole_vectors(self, numbers: usize) -> Isa {
        match self {
            Isa::Avx512 if numbers.is_multiple_of(16) => Isa::Avx512,
            Isa::Avx512 | Isa::Avx2 if numbers.is_multiple_of(8) => Isa::Avx2,
            Isa::Avx512 | Isa::Avx2 | Isa::Sse41 if numbers.is_multiple_of(4) => Isa::Sse41,
            Isa::Sse2 if numbers.is_multiple_of(4) => Isa::Sse2,
            _ => Isa::Scalar,
        }
    }
}

impl fmt::Display for Isa {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

//! Rivals of which a file has all forms: for packets and for one ray, and the precomputation of those that
//! keep a record of their own of every triangle; in the words of any instruction set's lanes, compiled here
//! for SSE2.
//!
//! The tests of the papers are left as they are, in order and in what they compare; only what is not finite
//! misses here, as in every other rival.
//!
//! # Safety
//!
//! Functions with `sse2` call these safely; others have to know that the CPU has it, as every
//! x86-64 has.
#![expect(
    clippy::missing_safety_doc,
    reason = "nothing here is unsafe to call but for the ISA, which the module's text says"
)]

use crate::lanes;

pub mod badouel;
pub mod benthin;
mod common;
pub mod havel_herout;
pub mod kensler_shirley;
pub mod pluecker;
pub mod shevtsov;
pub mod wald;
pub mod woop;

//! Rivals for one ray and blocks of triangles, in the words of any instruction set's lanes; compiled
//! here for SSE2, four triangles at a time.
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

pub mod kensler_shirley;
pub mod moller_trumbore;

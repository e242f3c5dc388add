//! The search: genomes bred by the genetic algorithm of Kensler and Shirley (2006, section 5), for speed as there,
//! or for a [front](pareto) of speed and costs.
//!
//! ```text
//! Settings + Graph ─► paper ── batches ──► Memory ── the unknown ─► Evaluate (somebody else's:
//!                     ▲   │                │   ▲                             compiles and times)
//!                     │   │                ▼   │
//!                     │   │             Journal (what is known, on the disk)
//!                     │   └─ generations ─► Observe (somebody else's: progress)
//!                     └───── evaluations
//! ```
//!
//! This crate knows no compiler, no clock and no instruction set; what it knows of speed is what
//! [`Evaluate`] tells. With the same seed and the same evaluations it makes the same candidates,
//! so a run is resumed by going through it again with the evaluations that were recorded.

mod evaluate;
mod individual;
mod journal;
mod memory;
mod operators;
mod paper;
pub mod pareto;
mod selection;
mod settings;

pub use evaluate::{Batch, Evaluate, Evaluation, Judged};
pub use individual::{Candidate, Individual, Origin};
pub use journal::{Identity, Journal, JournalError, Line, Recorded};
pub use memory::{Memory, MemoryError};
pub use operators::{crossover, draw_parent, mutate};
pub use paper::{Generation, Observe, Outcome, Stop, search, search_from};
pub use selection::Objective;
pub use settings::{Settings, SettingsError};

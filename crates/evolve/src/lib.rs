//! The search: genomes bred by the genetic algorithm of Kensler and Shirley (2006, section 5).
//!
//! ```text
//! Settings + Graph ─► paper ─── programs ──► Evaluate (somebody else's: compiles and times)
//!                     ▲   └── generations ─► Observe  (somebody else's: journal, progress)
//!                     └────── evaluations ──┘
//! ```
//!
//! This crate knows no compiler, no clock and no instruction set; what it knows of speed is what
//! [`Evaluate`] tells. With the same seed and the same evaluations it makes the same candidates.

mod evaluate;
mod individual;
mod journal;
mod operators;
mod paper;
mod settings;

pub use evaluate::{Evaluate, Evaluation};
pub use individual::{Individual, Origin};
pub use journal::{Journal, Line};
pub use operators::{crossover, draw_parent, mutate};
pub use paper::{Generation, Observe, Outcome, Stop, search};
pub use settings::{Settings, SettingsError};

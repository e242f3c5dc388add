//! The search: genomes bred for speed, by the genetic algorithm of Kensler and Shirley (2006, section 5) or by
//! another [`Strategy`]; or for a [front](pareto) of speed and costs.
//!
//! ```text
//! Settings + Graph ─► search ── batches ──► Memory ── the unknown ─► Evaluate (somebody else's:
//!             World ▲ │  ▲ │                 │   ▲                             compiles and times)
//!                   │ ▼  │ │                 ▼   │
//!  operators ─► Propose  │ │              Journal (what is known, on the disk)
//!       (one a strategy) │ └─ generations ─► Observe (somebody else's: progress)
//!                        └─── evaluations
//! ```
//!
//! This crate knows no compiler, no clock and no instruction set; what it knows of speed is what
//! [`Evaluate`] tells. With the same seed and the same evaluations it makes the same candidates,
//! so a run is resumed by going through it again with the evaluations that were recorded.

mod evaluate;
mod individual;
mod island;
mod journal;
mod memory;
mod operators;
mod outcome;
pub mod pareto;
mod search;
mod selection;
mod settings;
mod strategy;
mod world;

pub use evaluate::{Batch, Evaluate, EvaluateAtOnce, Evaluation, Foresee, Judged};
pub use individual::{Candidate, Draft, Individual, Origin};
pub use journal::{Identity, Journal, JournalError, Line, Recorded};
pub use memory::{Asked, Memory, MemoryError};
pub use operators::{crossover, draw_parent, flip, graft, mutate, slide, tournament};
pub use outcome::{Generation, Observe, Outcome, Stop};
pub use search::{search, search_from};
pub use selection::Objective;
pub use settings::{Settings, SettingsError};
pub use strategy::{Propose, Strategy, UnknownStrategy};
pub use world::World;

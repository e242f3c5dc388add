//! Kernels compiled, checked and timed, so that a figure can be trusted.
//!
//! ```text
//!             driver (this process)                   workers, one a core (may die)
//! Kernel ─► compile ─► libraries ─► Driver ── Request ──► load ─► check ─► time ─► check
//!           (rustc)                   ▲                                     │
//!                                     └──────────── Event, a line each ─────┘
//!                                     ▼
//!                            Outcome: a verdict, ratios to the reference
//! ```
//!
//! Candidate code is loaded by the worker alone. Every candidate is timed in turn with the
//! reference kernel, and its figure is the ratio of their times, never a time.

mod assembly;
mod bench;
mod built;
mod calibrated;
mod check;
mod compile;
mod cores;
mod crew;
mod driver;
mod error;
mod group;
mod hot_function;
mod interrupt;
mod isolation;
mod job;
mod judge;
mod left;
mod load;
mod machine;
mod memory_layout;
mod pipes;
mod placed;
mod plan;
mod precomputation;
mod processes;
mod protocol;
mod reported;
mod rustc;
mod statistics;
mod stopwatch;
mod sweep;
mod tally;
mod timing;
mod track;
mod twins;
mod verdict;
mod witness;
mod worker;

pub use assembly::Mca;
pub use bench::{Bench, Spent, source_hash};
pub use built::Built;
pub use calibrated::Calibrated;
pub use check::{Accuracy, MAX_EXCESS, MAX_P99_ERROR};
pub use cores::timing_cores;
pub use driver::WorkerCommand;
pub use error::MeasureError;
pub use hot_function::kernel_assembly;
pub use interrupt::Interrupt;
pub use isolation::ADDRESS_SPACE;
pub use job::{Done, Job};
pub use judge::{Judged, Look};
pub use machine::Machine;
pub use memory_layout::Sweep;
pub use pipes::{Pipes, clock};
pub use plan::{Deal, Plan};
pub use processes::{LIMIT, Processes};
pub use protocol::{Counts, Phase, Race, WorkloadSpec};
pub use rustc::{FLAGS, Rustc, RustcError};
pub use statistics::{
    Lead, MAX_WORST_LAYOUT, Summary, layout_weight, median, summarise, uncertainty_over,
};
pub use verdict::Verdict;
pub use worker::run_worker;

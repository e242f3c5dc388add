//! Ray-triangle programs: the statement graph, the genomes that pick programs from it, and what
//! the programs mean.
//!
//! ```text
//! volumes ─► kensler_shirley, extended,
//!            segment, watertight ───► Graph ─┐
//!                                   Genome ──────┴─► order ─► Program ─► interpret
//!                                                                   └──► emit (another crate)
//! ```
//!
//! An [`Op`] says what a node computes and of what; [`Op::quantity`] is the type check that makes
//! a graph or a recipe read from a file safe to print; [`Op::definition`] is its arithmetic, the
//! one source that the interpreter evaluates and that every instruction set spells.
//!
//! This crate is pure: it knows no file, no compiler and no instruction set.

mod builder;
mod checked_in;
mod definition;
mod dimension;
mod exact;
mod extended;
mod family;
mod genome;
mod graph;
mod improve;
mod interpret;
mod kensler_shirley;
mod listing;
mod op;
mod operations;
mod order;
mod quantity;
mod rewrite;
mod rules;
mod same;
mod segment;
mod shear;
mod statements;
mod tags;
mod watertight;

pub use checked_in::CheckedIn;
pub use definition::{Binary, Definition, Expr, Ternary, Unary};
pub use dimension::Degree;
pub use exact::{Difference, Exact};
pub use extended::extended;
pub use family::{Family, family_table};
pub use genome::{Genome, NotAPermutation};
pub use graph::{Graph, GraphError, MAX_DEPTH, MAX_NODES, Node, NodeId};
pub use improve::{Improvement, Optimum};
pub use interpret::{Ray, Real, Triangle};
pub use kensler_shirley::{COUNT, appendix, kensler_shirley, moller_trumbore_volumes};
pub use listing::Formula;
pub use op::{On, Op, Reciprocal, SameSign, Side, SideTest, StoredEdge, Summation, UnknownOp};
pub use order::Decided;
pub use quantity::{Condition, Misfit, Quantity};
pub use rules::{Breach, Rules, Unsatisfiable, Vertices, Watertight};
pub use segment::segment;
pub use shear::{Axis, ProductDifference, Rounding, Shear};
pub use statements::{Program, ProgramError, Statement};
pub use tags::Tags;
pub use watertight::watertight;

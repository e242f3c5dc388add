//! Programs printed as Rust, and everything that is printed from them.
//!
//! ```text
//! Program ─► in_scene ─► kernel ─► library   (many kernels, to be timed)
//!              ▲        ▲  └────► package   (generated/src, from the recipes)
//!            scene     isa           ▲
//!                                 recipe
//! ```
//!
//! The template of an [`Isa`] spells operations and never decides: order, early exits and the ways of division are
//! the program's. What comes from a file reaches the printed text only through closed enums,
//! numbers and checked names.

mod check;
mod hit;
mod in_scene;
mod inputs;
mod isa;
mod kernel;
mod library;
mod name;
mod package;
mod recipe;
mod rustfmt;
mod schedule;
mod statement;
mod when;
mod words;

pub use in_scene::{checked_in, graph, operations, rules};
pub use isa::{Isa, UnknownIsa};
pub use kernel::{InLibrary, Kernel, Signature, print_kernel};
pub use library::{
    COUNTED_WORDS, counted_library, counts_symbol, entry_symbol, library, prepare_symbol,
};
pub use name::{Name, NotAName};
pub use package::{Difference, MARKER, Package, PackageError, package, package_name};
pub use recipe::{
    ErrorProfile, Improved, Provenance, Recipe, RecipeError, Search, Share, Stability,
};
pub use rustfmt::{RustfmtError, rustfmt};

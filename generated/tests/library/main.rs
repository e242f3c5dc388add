//! What the library promises, of every kernel: each requirement of a scene, each call, each instruction set that
//! the processor has.
//!
//! All tests are one program: a kernel is compiled once for a scene, and there are thousands.

mod answers;
mod bounds;
mod calls;
mod catalogue;
mod checks;
mod fuzz;
mod kernels;
mod layouts;
mod promises;
mod reference;
mod shapes;
mod surprises;
mod watertight;
mod worlds;

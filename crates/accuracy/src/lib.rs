//! How often, and how far, ray-triangle kernels are wrong.

mod exact;

pub use exact::{Class, Corner, Exact, Side};

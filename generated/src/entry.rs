//! What the catalogue says of a kernel.

/// A kernel of the library.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The function's name, with hyphens.
    pub name: &'static str,
    /// The instruction set that it needs.
    pub isa: &'static str,
    /// The origins that it takes.
    pub origin: Origin,
    /// What became of `t` in the workload that it was bred on: `shrinking` (the closest hit so
    /// far, through a long list), `leaf` (lists of 8 triangles) or `fixed`.
    pub regime: &'static str,
    /// Speed as a multiple of Möller-Trumbore's packet test on the same instruction set, timed
    /// together on 400 packets of 64 rays and 20,000 triangles.
    pub ratio: f64,
    /// Error of `t`.
    pub t_error: TError,
}

/// Which origins the rays of a packet have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Each its own.
    General,
    /// All that of ray 0.
    Common,
}

/// Relative error of `t` against a computation in `f64`, over random hits clear of every edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TError {
    /// How many hits were looked at.
    pub hits: u64,
    /// Half of them were below this.
    pub median: f64,
    /// 99 of 100 were below this.
    pub p99: f64,
    /// The greatest seen, which is no bound.
    pub max: f64,
}

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
    /// Where it leaks and over which scales it is right, if that was measured.
    pub stability: Option<Stability>,
    /// What its statements say, whatever was measured.
    pub tags: Tags,
}

/// What is known of a kernel from its statements alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tags {
    /// Which rays cannot slip between the triangles of a closed surface.
    pub watertight: Watertight,
    /// Whether it uses coordinates by their differences alone, and so is as exact far from the world's origin
    /// as near it.
    pub translation_safe: bool,
    /// By what scenes can be multiplied.
    pub scales: Scales,
}

/// Which rays cannot slip between the triangles of a closed surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watertight {
    /// Any may.
    No,
    /// Those through an edge that two triangles share.
    Edges,
    /// None may, at a vertex either.
    Full,
}

/// Exponents of 2, from the least to the greatest, by which no verdict and no bit of `t` changes, since nothing that
/// is computed leaves the normal numbers: for triangles about 1 across, of any shape that is not thin, and rays
/// that start at most 20 away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scales {
    /// Of positions and directions alike.
    pub everything: (i32, i32),
    /// Of vertices and origins.
    pub positions: (i32, i32),
    /// Of directions.
    pub directions: (i32, i32),
}

/// What becomes of rays where triangles meet, of `t`, and of scales.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stability {
    /// Rays aimed at shared edges of closed fans and meshes that no triangle reports.
    pub edge_leak: Share,
    /// The same at shared vertices.
    pub vertex_leak: Share,
    /// Rays aimed at either that are reported once too often.
    pub double: Share,
    /// What 9,999 of 10,000 relative errors of `t` were below, at ordinary triangles, rays at their edges
    /// included.
    pub t_p9999: f64,
    /// The same of absolute errors of barycentric coordinates, by the program in a kernel that reports them.
    pub uv_p9999: Option<f64>,
    /// Exponents of 2, from the least to the greatest, by which everything can be scaled without another
    /// verdict, or `t`.
    pub scale: (i32, i32),
}

/// So many of so many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// How often it happened.
    pub events: u64,
    /// How often it could have.
    pub samples: u64,
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

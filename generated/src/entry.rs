//! What the catalogue says of a kernel.

use crate::catalogue::CATALOGUE;
use crate::isa::Isa;
use crate::scene::{Lists, Numeric, Origin, Watertight};

/// A kernel of the library: the scene model that it was bred for, and what was measured of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Entry {
    /// The function's name, with hyphens, in the module of its instruction set: `packet-leaf` of AVX2 is
    /// `kernels::avx2::packet_leaf`.
    pub name: &'static str,
    /// The instruction set that it needs.
    pub isa: Isa,
    /// What a call takes.
    pub grouping: Grouping,
    /// The origins that it takes.
    pub origin: Origin,
    /// What its arithmetic is.
    pub numeric: Numeric,
    /// The lists of triangles that it was bred on: of 8, or of 20,000.
    pub lists: Lists,
    /// Bytes that are kept of a triangle.
    pub bytes: u32,
    /// Operations of a ray and a triangle if nothing leaves early, tests and divisions included; work that 64 rays
    /// share, or a ray's triangles, counts a 64th. A product fused with a sum counts as two.
    pub operations: f64,
    /// Speed as a multiple of Möller-Trumbore's test of the same grouping on the same instruction set, timed
    /// together on 400 packets of 64 rays and 20,000 triangles. Of a portable kernel, which is one program for
    /// all instruction sets, it is the geometric mean of them.
    pub ratio: f64,
    /// How many times as slow it is where stack and rays lie worst in memory as where they lie in most; none if that
    /// was not measured.
    pub worst_layout: Option<f64>,
    /// Error of `t`.
    pub t_error: TError,
    /// Where it leaks and over which scales it is right, if that was measured.
    pub stability: Option<Stability>,
    /// What its statements say, whatever was measured.
    pub tags: Tags,
    /// The file of the package that it is made from: its program, and the search that found it.
    pub recipe: &'static str,
}

impl Entry {
    /// The entry of a function in a module.
    ///
    /// # Panics
    ///
    /// Never: the catalogue has every kernel.
    pub(crate) fn find((module, function): (&str, &str)) -> &'static Entry {
        let mut entries = CATALOGUE.iter();
        let found = entries.find(|one| {
            is_identifier_of(module, one.isa.name()) && is_identifier_of(function, one.name)
        });
        found.expect("the catalogue has every kernel")
    }
}

/// Whether an identifier is a name's, whose dots and hyphens it cannot have.
fn is_identifier_of(identifier: &str, name: &str) -> bool {
    let plain = |byte: u8| {
        if byte.is_ascii_alphanumeric() {
            byte
        } else {
            b'_'
        }
    };
    identifier.bytes().eq(name.bytes().map(plain))
}

/// What a call of a kernel takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Grouping {
    /// A packet of rays, and triangles.
    Packet,
    /// One ray, and blocks of triangles.
    Ray,
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

//! The signed volumes of a ray and a triangle, and every triple product that equals one.

use std::collections::BTreeSet;
use std::fmt;

use crate::{Cross, Edge, Point, Sample, TripleProduct, Vector};

/// A signed volume, times six, with the signs of the paper's equations 2.
///
/// Section 3 of the paper prints the negatives. What a test needs does not change if all of them
/// are negated: with these signs `t = Va/V` and the barycentric coordinates of `p0`, `p1`, `p2` are
/// `V0/V`, `V1/V`, `V2/V`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Volume {
    /// `(d × (p2-p0)) · (p1-p0)`: the direction and the triangle, the sum of the next three.
    V,
    /// `V - V1 - V2`: the direction, the ray's origin and the edge opposite `p0`.
    V0,
    /// `(d × (p2-p0)) · (a-p0)`: the direction, the ray's origin and the edge opposite `p1`.
    V1,
    /// `((a-p0) × (p1-p0)) · d`: the direction, the ray's origin and the edge opposite `p2`.
    V2,
    /// `((a-p0) × (p1-p0)) · (p2-p0)`: the ray's origin and the triangle.
    Va,
    /// `((b-p0) × (p1-p0)) · (p2-p0)`, which is `Va - V`: the other end of a segment and the triangle.
    /// A ray has none; it is not in [`ALL`](Self::ALL).
    Vb,
}

impl Volume {
    /// The volumes of a ray and a triangle, in ascending order.
    pub const ALL: [Self; 5] = [Self::V, Self::V0, Self::V1, Self::V2, Self::Va];

    /// A name that can be used as an identifier: `v`, `v0`, `v1`, `v2`, `va` or `vb`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::V => "v",
            Self::V0 => "v0",
            Self::V1 => "v1",
            Self::V2 => "v2",
            Self::Va => "va",
            Self::Vb => "vb",
        }
    }

    /// Every triple product that equals this volume, sign included, in ascending order.
    ///
    /// There are 36 for the volumes that have the direction, 384 for `Va` (section 3 of the paper).
    /// All 13³ triple products of edges and the direction are candidates; those that equal the
    /// volume at several [`Sample`]s are the ones. The comparison also drops the degenerate ones,
    /// those of the opposite sign, those that reach for a point the volume does not have, and those
    /// that have the direction too seldom or too often.
    ///
    /// Of `Vb` they are the 72 that have the triangle's normal as their cross, so that it goes with
    /// that of `Va`.
    ///
    /// ```
    /// # use volumes::Volume;
    /// let products = Volume::V.triple_products();
    /// assert_eq!(products.len(), 36);
    /// assert!(products.iter().any(|product| product.to_string() == "(d × (p2-p0)) · (p1-p0)"));
    /// ```
    pub fn triple_products(self) -> Vec<TripleProduct> {
        let known = self.known();
        let fits = |product: &TripleProduct| agrees(&known, *product);
        match self {
            Self::Vb => candidates_of_b().filter(fits).collect(),
            _ => candidates().filter(fits).collect(),
        }
    }

    /// Whether a triple product equals this volume, sign included.
    pub fn is(self, product: TripleProduct) -> bool {
        agrees(&self.known(), product)
    }

    /// The volume at the samples.
    fn known(self) -> [(Sample, i128); SEEDS.len()] {
        SEEDS.map(|seed| {
            let sample = Sample::random(seed);
            (sample, sample.volume(self))
        })
    }
}

fn agrees(known: &[(Sample, i128)], product: TripleProduct) -> bool {
    let equals = |(sample, volume): &(Sample, i128)| sample.product(product) == *volume;
    known.iter().all(equals)
}

impl fmt::Display for Volume {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::V => "V",
            Self::V0 => "V0",
            Self::V1 => "V1",
            Self::V2 => "V2",
            Self::Va => "Va",
            Self::Vb => "Vb",
        })
    }
}

/// The distinct cross products in the triple products of all volumes, in ascending order.
///
/// There are 144: 120 of two edges and 24 of an edge and the direction.
pub fn crosses() -> Vec<Cross> {
    Volume::ALL
        .into_iter()
        .flat_map(Volume::triple_products)
        .map(|product| product.cross)
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect()
}

/// Seeds of the samples at which candidates are compared.
///
/// One sample lets a wrong candidate pass with a probability below 10⁻⁹, see [`Sample`], and five
/// lists of 2197 candidates with four samples one below 10⁻³².
const SEEDS: [u64; 4] = [1, 2, 3, 4];

/// All triple products of a cross of two of the triangle's edges and an edge from or to `b`, in
/// ascending order, half of them of the opposite sign.
fn candidates_of_b() -> impl Iterator<Item = TripleProduct> {
    let edges = || {
        let all = Edge::all().into_iter();
        all.filter(|edge| !edge.joins(Point::A))
    };
    let crosses = edges().flat_map(move |left| {
        edges().map(move |right| Cross {
            left: left.into(),
            right: right.into(),
        })
    });
    let b = Point::B;
    let of_vertices = Point::VERTICES.map(|to| Edge { to, from: b });
    let of_b = Point::VERTICES.map(|from| Edge { to: b, from });
    let dots = of_vertices.into_iter().chain(of_b);
    crosses.flat_map(move |cross| {
        let product = move |dot: Edge| TripleProduct {
            cross,
            dot: dot.into(),
        };
        dots.clone().map(product)
    })
}

/// All triple products of edges and the direction, in ascending order, most of them useless.
fn candidates() -> impl Iterator<Item = TripleProduct> {
    let vectors = Vector::all();
    vectors.into_iter().flat_map(move |left| {
        vectors.into_iter().flat_map(move |right| {
            let cross = Cross { left, right };
            vectors
                .into_iter()
                .map(move |dot| TripleProduct { cross, dot })
        })
    })
}

//! A formulation: one triple product for each of the four volumes that a test computes directly.

use std::collections::BTreeSet;
use std::fmt;

use crate::{
    Case, Cost, Cross, Edge, Model, Operations, Point, Rate, TripleProduct, Vector, Volume,
};

/// One triple product for each of four volumes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Formulation {
    /// The volumes and how they are computed.
    pub products: [(Volume, TripleProduct); 4],
}

/// A step of a formulation: a subexpression that is computed once, from those before it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Step {
    /// A difference of points.
    Edge(Edge),
    /// A cross product of vectors.
    Cross(Cross),
    /// A volume.
    Volume(Volume, TripleProduct),
}

/// Something that can be stored with a triangle: three floats.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Stored {
    /// A vertex.
    Vertex(Point),
    /// An edge.
    Edge(Edge),
    /// A cross product of edges.
    Cross(Cross),
}

/// Bytes of a vector of three floats.
pub const VECTOR_BYTES: u32 = 12;

impl Formulation {
    /// The volumes of a test that computes `V` directly and derives `V0`, if at all.
    pub const WITH_V: [Volume; 4] = [Volume::V, Volume::Va, Volume::V1, Volume::V2];

    /// The volumes of a test that computes `V0` directly and derives `V`.
    pub const WITH_V0: [Volume; 4] = [Volume::V0, Volume::Va, Volume::V1, Volume::V2];

    /// The volumes of a test that derives `V1`, if at all.
    pub const WITHOUT_V1: [Volume; 4] = [Volume::V, Volume::Va, Volume::V0, Volume::V2];

    /// The volumes of a test that derives `V2`, if at all.
    pub const WITHOUT_V2: [Volume; 4] = [Volume::V, Volume::Va, Volume::V0, Volume::V1];

    /// How a volume is computed, if it is one of the four.
    pub fn product(&self, volume: Volume) -> Option<TripleProduct> {
        self.products
            .iter()
            .find(|(chosen, _)| *chosen == volume)
            .map(|(_, product)| *product)
    }

    /// Its distinct subexpressions: edges, then crosses, then volumes, each after what it is made
    /// of.
    pub fn steps(&self) -> Vec<Step> {
        let products = self.products.map(|(_, product)| product);
        let edges: BTreeSet<Edge> = products.iter().flat_map(|one| one.edges()).collect();
        let crosses: BTreeSet<Cross> = products.iter().map(|product| product.cross).collect();
        let volumes = self.products;
        (edges.into_iter().map(Step::Edge))
            .chain(crosses.into_iter().map(Step::Cross))
            .chain(volumes.map(|(volume, product)| Step::Volume(volume, product)))
            .collect()
    }

    /// What the formulation costs when each distinct subexpression is computed once (section 4 of
    /// the paper).
    pub fn cost(&self, case: Case, model: &Model) -> Cost {
        let steps = self.steps();
        let weighted = steps.iter().map(|step| {
            let weight = case.weight(step.rate(case));
            step.operations(model) * weight
        });
        case.cost(
            model,
            weighted.fold(Operations::default(), |sum, one| sum + one),
        )
    }

    /// What a stored triangle has to bring: whatever of it alone is used together with the ray.
    pub fn stored(&self, case: Case) -> BTreeSet<Stored> {
        let products = self.products.iter();
        products
            .flat_map(|(_, product)| stored(case, *product))
            .collect()
    }

    /// Bytes of a stored triangle.
    pub fn bytes(&self, case: Case) -> u32 {
        VECTOR_BYTES * self.stored(case).len() as u32
    }
}

impl Step {
    /// How often it changes.
    pub const fn rate(self, case: Case) -> Rate {
        match self {
            Self::Edge(edge) => case.rates.of_edge(edge),
            Self::Cross(cross) => case.rates.of_cross(cross),
            Self::Volume(_, product) => case.rates.of_product(product),
        }
    }

    /// What it takes beyond the steps that it is made of.
    pub const fn operations(self, model: &Model) -> Operations {
        match self {
            Self::Edge(_) => model.edge,
            Self::Cross(_) => model.cross,
            Self::Volume(..) => model.dot,
        }
    }
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Edge(edge) => edge.fmt(f),
            Self::Cross(cross) => cross.fmt(f),
            Self::Volume(volume, product) => write!(f, "{volume} = {product}"),
        }
    }
}

/// What a triangle has to bring for one triple product.
pub(crate) fn stored(case: Case, product: TripleProduct) -> Vec<Stored> {
    let is_stored = |rate| case.is_stored(rate);
    let mut stored = Vec::new();
    let mut vector = |vector: Vector| {
        let Vector::Edge(edge) = vector else { return };
        if is_stored(case.rates.of_edge(edge)) {
            stored.push(Stored::Edge(edge));
        } else {
            let ends = [edge.to, edge.from].into_iter();
            let ends = ends.filter(|&point| is_stored(case.rates.of_point(point)));
            stored.extend(ends.map(Stored::Vertex));
        }
    };
    vector(product.dot);
    if is_stored(case.rates.of_cross(product.cross)) {
        stored.push(Stored::Cross(product.cross));
    } else {
        vector(product.cross.left);
        vector(product.cross.right);
    }
    stored
}

impl fmt::Display for Formulation {
    /// One line a volume, equals signs lined up.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (line, (volume, product)) in self.products.iter().enumerate() {
            if line > 0 {
                writeln!(f)?;
            }
            write!(f, "{volume:2} = {product}")?;
        }
        Ok(())
    }
}

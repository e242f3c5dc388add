//! A formulation: one triple product for each of the four volumes that a test computes directly.

use std::collections::BTreeSet;
use std::fmt;

use crate::{Case, Cost, TripleProduct, Volume};

/// One triple product for each of four volumes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Formulation {
    /// The volumes and how they are computed.
    pub products: [(Volume, TripleProduct); 4],
}

impl Formulation {
    /// The volumes of a test that computes `V` directly and derives `V0`, if at all.
    pub const WITH_V: [Volume; 4] = [Volume::V, Volume::Va, Volume::V1, Volume::V2];

    /// The volumes of a test that computes `V0` directly and derives `V`.
    pub const WITH_V0: [Volume; 4] = [Volume::V0, Volume::Va, Volume::V1, Volume::V2];

    /// How a volume is computed, if it is one of the four.
    pub fn product(&self, volume: Volume) -> Option<TripleProduct> {
        self.products
            .iter()
            .find(|(chosen, _)| *chosen == volume)
            .map(|(_, product)| *product)
    }

    /// What the formulation costs when each distinct subexpression is computed once (section 4 of
    /// the paper).
    pub fn cost(&self, case: Case) -> Cost {
        let products: BTreeSet<_> = self.products.iter().map(|(_, product)| *product).collect();
        let crosses: BTreeSet<_> = products.iter().map(|product| product.cross).collect();
        let edges: BTreeSet<_> = products
            .iter()
            .flat_map(|product| product.edges())
            .collect();

        let dots = products.iter().map(|&product| case.dot_price(product));
        let crosses = crosses.iter().map(|&cross| case.cross_price(cross));
        let edges = edges.iter().map(|&edge| case.edge_price(edge));
        Cost {
            units: dots.chain(crosses).chain(edges).sum(),
            packet_size: case.packet_size,
        }
    }
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

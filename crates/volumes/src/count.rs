//! The exhaustive search of the paper's section 4 for the formulations with fewest operations.
//!
//! All combinations of one triple product for each of four volumes are priced, 36·384·36·36 of
//! them. To price one is to set bits: an edge is a bit of 12, whose sets have their price in a
//! table; a cross product is a bit of 144.

use crate::{Case, Cost, Edge, Formulation, TripleProduct, Volume, crosses};

/// What the search found.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Count {
    /// The least cost.
    pub cost: Cost,
    /// How many combinations were priced.
    pub combinations: u64,
    /// Every formulation of that cost, in ascending order.
    pub formulations: Vec<Formulation>,
}

/// Prices every formulation of four volumes and returns the cheapest ones.
///
/// The paper's are [`Formulation::WITH_V`] and [`Formulation::WITH_V0`], 17,915,904 combinations
/// each. [`Formulation::cost`] says the same of a single one, slowly.
///
/// # Panics
///
/// If a volume is there twice.
///
/// ```
/// # use volumes::{Case, Formulation, cheapest};
/// let count = cheapest(Case::SINGLE, Formulation::WITH_V);
/// assert_eq!((count.cost.to_string(), count.formulations.len()), ("47".to_owned(), 6));
/// ```
pub fn cheapest(case: Case, volumes: [Volume; 4]) -> Count {
    for (index, volume) in volumes.iter().enumerate() {
        assert!(
            !volumes[..index].contains(volume),
            "{volume} is there twice"
        );
    }
    let edge_prices = edge_prices(case);
    let [first, second, third, fourth] = volumes.map(|volume| terms(case, volume));

    let mut best = u32::MAX;
    let mut combinations = 0;
    let mut found = Vec::new();
    for one in &first {
        let computed = Computed::default().with(one);
        for two in &second {
            let computed = computed.with(two);
            for three in &third {
                let computed = computed.with(three);
                let price = |four| computed.price_with(four, &edge_prices);

                combinations += fourth.len() as u64;
                let least = fourth.iter().map(price).min().unwrap_or(u32::MAX);
                if least > best {
                    continue;
                }
                if least < best {
                    best = least;
                    found.clear();
                }
                let equals = fourth.iter().filter(|four| price(four) == least);
                found.extend(equals.map(|four| [one, two, three, four].map(|term| term.product)));
            }
        }
    }

    Count {
        cost: Cost {
            units: best,
            packet_size: case.packet_size,
        },
        combinations,
        formulations: found
            .into_iter()
            .map(|products| Formulation {
                products: std::array::from_fn(|index| (volumes[index], products[index])),
            })
            .collect(),
    }
}

/// A triple product, ready to be priced.
struct Term {
    product: TripleProduct,
    /// The edges among its factors.
    edges: EdgeSet,
    /// The number of its cross product.
    cross: u8,
    cross_price: u32,
    dot_price: u32,
}

/// The triple products of a volume, in their order.
fn terms(case: Case, volume: Volume) -> Vec<Term> {
    let crosses = crosses();
    let number_of = |product: TripleProduct| {
        let number = crosses.binary_search(&product.cross);
        let number = number.expect("crosses() has those of every volume");
        u8::try_from(number).expect("there are 144 crosses")
    };
    let term = |product: TripleProduct| Term {
        product,
        edges: edge_set(product.edges()),
        cross: number_of(product),
        cross_price: case.cross_price(product.cross),
        dot_price: case.dot_price(product),
    };
    volume.triple_products().into_iter().map(term).collect()
}

/// Edges as bits, in the order of [`Edge::all`].
type EdgeSet = u16;

/// How many sets of edges there are.
const EDGE_SETS: usize = 1 << 12;

fn edge_set(edges: impl Iterator<Item = Edge>) -> EdgeSet {
    let all = Edge::all();
    let bit = |edge| all.binary_search(&edge).expect("all() has every edge");
    edges.fold(0, |set, edge| set | 1 << bit(edge))
}

/// The price of every set of edges.
fn edge_prices(case: Case) -> [u32; EDGE_SETS] {
    let prices = Edge::all().map(|edge| case.edge_price(edge));
    std::array::from_fn(|set| {
        let bits = prices.iter().zip(0..);
        bits.filter(|(_, bit)| set >> bit & 1 == 1)
            .map(|(price, _)| price)
            .sum()
    })
}

/// What the terms so far have computed.
#[derive(Clone, Copy, Default)]
struct Computed {
    edges: EdgeSet,
    /// Cross products as bits. The fourth word has none, but no index is out of bounds for it.
    crosses: [u64; 4],
    /// Price of the cross products and dot products; that of the edges is in the table.
    price: u32,
}

impl Computed {
    /// The same with one more term.
    fn with(mut self, term: &Term) -> Self {
        self.price = self.price_without_edges(term);
        self.edges |= term.edges;
        self.crosses[usize::from(term.cross >> 6)] |= 1 << (term.cross & 63);
        self
    }

    /// The price of everything with one more term. The search spends its time here: no branches.
    fn price_with(&self, term: &Term, edge_prices: &[u32; EDGE_SETS]) -> u32 {
        let edges = usize::from(self.edges | term.edges);
        self.price_without_edges(term) + edge_prices[edges % EDGE_SETS]
    }

    fn price_without_edges(&self, term: &Term) -> u32 {
        let there = self.crosses[usize::from(term.cross >> 6)] >> (term.cross & 63) & 1;
        self.price + term.dot_price + (1 - there as u32) * term.cross_price
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU16;

    use super::*;

    #[test]
    fn the_search_prices_a_combination_as_its_cost_says() {
        let volumes = Formulation::WITH_V;
        let packet_size = NonZeroU16::new(64).unwrap();
        for case in [
            Case::SINGLE,
            Case::packet(packet_size),
            Case::common_origin(packet_size),
        ] {
            let edge_prices = edge_prices(case);
            let lists = volumes.map(|volume| terms(case, volume));
            let combinations: usize = lists.iter().map(Vec::len).product();
            // A stride without a common factor meets every part of the space.
            for step in 0..20_000 {
                let mut number = step * 900_001 % combinations;
                let chosen = lists.each_ref().map(|list| {
                    let term = &list[number % list.len()];
                    number /= list.len();
                    term
                });

                let computed = Computed::default();
                let computed = chosen[..3]
                    .iter()
                    .fold(computed, |computed, term| computed.with(term));
                let products = std::array::from_fn(|i| (volumes[i], chosen[i].product));
                assert_eq!(
                    computed.price_with(chosen[3], &edge_prices),
                    Formulation { products }.cost(case).units
                );
            }
        }
    }

    #[test]
    #[should_panic(expected = "V1 is there twice")]
    fn a_volume_is_asked_for_once() {
        let _ = cheapest(
            Case::SINGLE,
            [Volume::V, Volume::V1, Volume::Va, Volume::V1],
        );
    }
}

//! The exhaustive search of the paper's section 4 for the formulations with fewest operations.
//!
//! All combinations of one triple product for each of four volumes are covered, 36·384·36·36 of
//! them. To price one is to set bits: an edge is a bit of 12, whose sets have their price in a
//! table; a cross product is a bit of 144. A price is a load for every port of the model, and a
//! cost the greatest of them; no load shrinks when a volume is added, so combinations that begin
//! too dear are passed over together.

use crate::model::MAX_PORTS;
use crate::{Case, Cost, Edge, Formulation, Model, Operations, TripleProduct, Volume, crosses};

/// What the search found.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Count {
    /// The least cost.
    pub cost: Cost,
    /// The least bytes of a stored triangle at that cost; none if the case stores nothing.
    pub bytes: Option<u32>,
    /// How many combinations there are.
    pub combinations: u64,
    /// Every formulation of that cost and of so many bytes, in ascending order.
    pub formulations: Vec<Formulation>,
}

/// Prices the formulations of four volumes and returns the cheapest ones; of those, if the case
/// stores what changes with the triangle only, the ones with fewest bytes.
///
/// The paper's are [`Formulation::WITH_V`] and [`Formulation::WITH_V0`], 17,915,904 combinations
/// each. [`Formulation::cost`] says the same of a single one, slowly.
///
/// # Panics
///
/// If a volume is there twice.
///
/// ```
/// # use volumes::{Case, Formulation, Model, cheapest};
/// let count = cheapest(Case::SINGLE, &Model::paper(), Formulation::WITH_V);
/// assert_eq!((count.cost.to_string(), count.formulations.len()), ("47".to_owned(), 6));
/// ```
pub fn cheapest(case: Case, model: &Model, volumes: [Volume; 4]) -> Count {
    for (index, volume) in volumes.iter().enumerate() {
        assert!(
            !volumes[..index].contains(volume),
            "{volume} is there twice"
        );
    }
    match model.port_count() {
        1 => Search::<1>::new(case, model, volumes).run(),
        2 => Search::<2>::new(case, model, volumes).run(),
        3..=4 => Search::<4>::new(case, model, volumes).run(),
        _ => Search::<MAX_PORTS>::new(case, model, volumes).run(),
    }
}

/// For how many parts each of `P` ports is at work.
type Loads<const P: usize> = [u32; P];

struct Search<const P: usize> {
    case: Case,
    model: Model,
    volumes: [Volume; 4],
    /// The triple products of each volume.
    terms: [Vec<Term<P>>; 4],
    /// The price of every set of edges.
    edge_prices: Vec<Loads<P>>,
    /// What the volumes from each place on add at least: their dot products.
    least_rest: [Loads<P>; 4],
    /// The least cost so far.
    best: u32,
    found: Vec<[TripleProduct; 4]>,
}

/// A triple product, ready to be priced.
struct Term<const P: usize> {
    product: TripleProduct,
    /// The edges among its factors.
    edges: EdgeSet,
    /// The number of its cross product.
    cross: u8,
    cross_price: Loads<P>,
    dot_price: Loads<P>,
}

/// What the terms so far have computed.
#[derive(Clone, Copy)]
struct Computed<const P: usize> {
    edges: EdgeSet,
    /// Cross products as bits. The fourth word has none, but no index is out of bounds for it.
    crosses: [u64; 4],
    /// Price of the cross products and dot products; that of the edges is in the table.
    price: Loads<P>,
}

impl<const P: usize> Search<P> {
    fn new(case: Case, model: &Model, volumes: [Volume; 4]) -> Self {
        let terms = volumes.map(|volume| terms::<P>(case, model, volume));
        let mut least_rest = [[0; P]; 4];
        for place in (0..3).rev() {
            let dots = terms[place + 1].iter().map(|term| term.dot_price);
            let least = dots.reduce(|a, b| std::array::from_fn(|port| a[port].min(b[port])));
            least_rest[place] = sum(least_rest[place + 1], least.unwrap_or([0; P]));
        }
        Self {
            case,
            model: model.clone(),
            volumes,
            edge_prices: edge_prices(case, model),
            least_rest,
            best: u32::MAX,
            found: Vec::new(),
            terms,
        }
    }

    fn run(mut self) -> Count {
        self.best = self.upper_bound();
        let [first, second, third, _] = &self.terms;
        let nothing = Computed::default();
        let mut best = self.best;
        let mut found = Vec::new();
        for one in first {
            let computed = nothing.with(one);
            if self.least(&computed, 0) > best {
                continue;
            }
            for two in second {
                let computed = computed.with(two);
                if self.least(&computed, 1) > best {
                    continue;
                }
                for three in third {
                    let computed = computed.with(three);
                    if self.least(&computed, 2) > best {
                        continue;
                    }
                    let least = self.least_with_fourth(&computed);
                    if least > best {
                        continue;
                    }
                    if least < best {
                        best = least;
                        found.clear();
                    }
                    let equals = self.terms[3].iter();
                    let equals = equals.filter(|four| self.cost_with(&computed, four) == least);
                    found.extend(equals.map(|four| [one, two, three, four].map(|t| t.product)));
                }
            }
        }
        self.best = best;
        self.found = found;
        self.count()
    }

    /// A cost that some combination has: one found by exchanging one triple product after another
    /// for as long as that helps.
    fn upper_bound(&self) -> u32 {
        let mut chosen = [0; 4];
        let cost = |chosen: [usize; 4]| {
            let terms = chosen.into_iter().zip(&self.terms);
            let computed = terms.fold(Computed::default(), |computed, (index, terms)| {
                computed.with(&terms[index])
            });
            self.least(&computed, 3)
        };
        let mut least = cost(chosen);
        loop {
            let before = least;
            for place in 0..4 {
                for index in 0..self.terms[place].len() {
                    let mut other = chosen;
                    other[place] = index;
                    let price = cost(other);
                    if price < least {
                        (least, chosen) = (price, other);
                    }
                }
            }
            if least == before {
                return least;
            }
        }
    }

    /// What any combination costs at least that begins with what is computed, up to a place.
    fn least(&self, computed: &Computed<P>, place: usize) -> u32 {
        let edges = self.edge_prices[usize::from(computed.edges)];
        greatest(sum(sum(computed.price, edges), self.least_rest[place]))
    }

    fn least_with_fourth(&self, computed: &Computed<P>) -> u32 {
        let costs = self.terms[3]
            .iter()
            .map(|four| self.cost_with(computed, four));
        costs.min().unwrap_or(u32::MAX)
    }

    /// The cost with one more term. The search spends its time here: no branches.
    fn cost_with(&self, computed: &Computed<P>, term: &Term<P>) -> u32 {
        let edges = usize::from(computed.edges | term.edges);
        let edges = self.edge_prices[edges % EDGE_SETS];
        greatest(sum(computed.price_without_edges(term), edges))
    }

    fn count(self) -> Count {
        let formulations = self.found.into_iter().map(|products| Formulation {
            products: std::array::from_fn(|index| (self.volumes[index], products[index])),
        });
        let mut formulations: Vec<Formulation> = formulations.collect();
        let mut bytes = None;
        if self.case.stored {
            let of = |formulation: &Formulation| formulation.bytes(self.case);
            bytes = formulations.iter().map(of).min();
            formulations.retain(|formulation| Some(of(formulation)) == bytes);
        }
        Count {
            cost: Cost {
                units: self.best,
                parts: u32::from(self.case.sharers.get()) * self.model.parts(),
            },
            bytes,
            combinations: self.terms.iter().map(|terms| terms.len() as u64).product(),
            formulations,
        }
    }
}

/// The triple products of a volume, in their order.
fn terms<const P: usize>(case: Case, model: &Model, volume: Volume) -> Vec<Term<P>> {
    let crosses = crosses();
    let number_of = |product: TripleProduct| {
        let number = crosses.binary_search(&product.cross);
        let number = number.expect("crosses() has those of every volume");
        u8::try_from(number).expect("there are 144 crosses")
    };
    let price = |operations: Operations, rate| loads(model, operations * case.weight(rate));
    let term = |product: TripleProduct| Term {
        product,
        edges: edge_set(product.edges()),
        cross: number_of(product),
        cross_price: price(model.cross, case.rates.of_cross(product.cross)),
        dot_price: price(model.dot, case.rates.of_product(product)),
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

fn edge_prices<const P: usize>(case: Case, model: &Model) -> Vec<Loads<P>> {
    let price = |edge| loads(model, model.edge * case.weight(case.rates.of_edge(edge)));
    let prices = Edge::all().map(price);
    let of_set = |set: usize| {
        let bits = prices.iter().zip(0..);
        bits.filter(|(_, bit)| set >> bit & 1 == 1)
            .fold([0; P], |total, (price, _)| sum(total, *price))
    };
    (0..EDGE_SETS).map(of_set).collect()
}

fn loads<const P: usize>(model: &Model, operations: Operations) -> Loads<P> {
    let loads = model.loads(operations);
    std::array::from_fn(|port| loads[port])
}

fn sum<const P: usize>(a: Loads<P>, b: Loads<P>) -> Loads<P> {
    std::array::from_fn(|port| a[port] + b[port])
}

fn greatest<const P: usize>(loads: Loads<P>) -> u32 {
    loads.into_iter().fold(0, u32::max)
}

impl<const P: usize> Default for Computed<P> {
    fn default() -> Self {
        Self {
            edges: 0,
            crosses: [0; 4],
            price: [0; P],
        }
    }
}

impl<const P: usize> Computed<P> {
    /// The same with one more term.
    fn with(mut self, term: &Term<P>) -> Self {
        self.price = self.price_without_edges(term);
        self.edges |= term.edges;
        self.crosses[usize::from(term.cross >> 6)] |= 1 << (term.cross & 63);
        self
    }

    fn price_without_edges(&self, term: &Term<P>) -> Loads<P> {
        let there = self.crosses[usize::from(term.cross >> 6)] >> (term.cross & 63) & 1;
        let wanted = 1 - there as u32;
        let price = sum(self.price, term.dot_price);
        std::array::from_fn(|port| price[port] + wanted * term.cross_price[port])
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU16;

    use super::*;
    use crate::{Kind, Port, Rate, Rates};

    /// Every combination priced, none passed over: the cheapest cost, and who has it.
    fn enumerated(case: Case, model: &Model, volumes: [Volume; 4]) -> (u32, Vec<Formulation>) {
        let search = Search::<MAX_PORTS>::new(case, model, volumes);
        let [first, second, third, fourth] = &search.terms;
        let (mut best, mut found) = (u32::MAX, Vec::new());
        for one in first {
            for two in second {
                let computed = Computed::default().with(one).with(two);
                for three in third {
                    let computed = computed.with(three);
                    for four in fourth {
                        let cost = search.cost_with(&computed, four);
                        if cost < best {
                            best = cost;
                            found.clear();
                        }
                        if cost == best {
                            found.push([one, two, three, four].map(|term| term.product));
                        }
                    }
                }
            }
        }
        let formulations = found.into_iter().map(|products| Formulation {
            products: std::array::from_fn(|index| (volumes[index], products[index])),
        });
        (best, formulations.collect())
    }

    fn assert_as_enumerated(case: Case, model: &Model, volumes: [Volume; 4]) {
        let count = cheapest(case, model, volumes);
        let (cost, mut formulations) = enumerated(case, model, volumes);
        if case.stored {
            let bytes = formulations.iter().map(|one| one.bytes(case)).min();
            formulations.retain(|one| Some(one.bytes(case)) == bytes);
            assert_eq!(count.bytes, bytes);
        }
        assert_eq!(count.cost.units, cost, "{case:?} {model:?}");
        assert_eq!(count.formulations, formulations, "{case:?} {model:?}");
    }

    fn paper_cases() -> [Case; 3] {
        let rays = NonZeroU16::new(64).unwrap();
        [Case::SINGLE, Case::packet(rays), Case::common_origin(rays)]
    }

    #[test]
    fn nothing_that_is_passed_over_is_among_the_cheapest_of_the_papers_rows() {
        for case in paper_cases() {
            for volumes in [Formulation::WITH_V, Formulation::WITH_V0] {
                assert_as_enumerated(case, &Model::paper(), volumes);
            }
        }
    }

    /// Numbers from nowhere, the same every time: Knuth's MMIX generator.
    fn numbers(seed: u64) -> impl FnMut(u64) -> u32 {
        let mut state = seed;
        move |below| {
            state = state.wrapping_mul(6_364_136_223_846_793_005);
            state = state.wrapping_add(1_442_695_040_888_963_407);
            u32::try_from((state >> 33) % below).unwrap()
        }
    }

    #[test]
    fn nothing_that_is_passed_over_is_among_the_cheapest_of_random_models() {
        let mut number = numbers(1);
        for round in 0..8_u16 {
            let ports = (0..=number(4)).map(|_| Port {
                takes: Kind::ALL.map(|_| number(3) > 0),
                throughput: (1 + number(4), 1 + number(3)),
            });
            let mut model = Model::ports(ports.collect());
            for operations in [&mut model.edge, &mut model.cross, &mut model.dot] {
                *operations = Operations {
                    counts: std::array::from_fn(|_| number(5)),
                };
            }
            let case = Case {
                rates: if round % 2 == 0 {
                    Rates::GENERAL
                } else {
                    Rates::COMMON_ORIGIN
                },
                shared: Rate::ALL.map(|_| number(2) == 0),
                sharers: NonZeroU16::new(1 + round * 9).unwrap(),
                stored: round % 3 == 2,
            };
            let volumes = [
                Formulation::WITH_V,
                Formulation::WITHOUT_V1,
                Formulation::WITH_V0,
                Formulation::WITHOUT_V2,
            ];
            assert_as_enumerated(case, &model, volumes[usize::from(round) % 4]);
        }
    }

    #[test]
    fn the_search_prices_a_combination_as_its_cost_says() {
        let ports = crate::read_ports("mul+fma=2,add=3,mul+add+fma=4").unwrap();
        for model in [Model::paper(), Model::fma(), Model::ports(ports)] {
            for case in paper_cases() {
                let volumes = Formulation::WITH_V;
                let search = Search::<MAX_PORTS>::new(case, &model, volumes);
                let lists = &search.terms;
                let combinations: usize = lists.iter().map(Vec::len).product();
                // A stride without a common factor meets every part of the space.
                for step in 0..5_000 {
                    let mut number = step * 900_001 % combinations;
                    let chosen = lists.each_ref().map(|list| {
                        let term = &list[number % list.len()];
                        number /= list.len();
                        term
                    });
                    let computed = chosen[..3].iter();
                    let computed = computed.fold(Computed::default(), |all, term| all.with(term));
                    let products = std::array::from_fn(|i| (volumes[i], chosen[i].product));
                    let formulation = Formulation { products };
                    assert_eq!(
                        search.cost_with(&computed, chosen[3]),
                        formulation.cost(case, &model).units
                    );
                }
            }
        }
    }

    #[test]
    #[should_panic(expected = "V1 is there twice")]
    fn a_volume_is_asked_for_once() {
        let _ = cheapest(
            Case::SINGLE,
            &Model::paper(),
            [Volume::V, Volume::V1, Volume::Va, Volume::V1],
        );
    }
}

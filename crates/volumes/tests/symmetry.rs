//! The symmetries of the cheapest formulations: "three of these were symmetric cases of the other
//! three with triangle edges reversed and appropriate adjustments made to preserve signs" (section 4
//! of the paper).

use std::num::NonZeroU16;

use volumes::{
    Case, Cross, Edge, Formulation, Model, Point, TripleProduct, Vector, Volume, cheapest,
};

const RAYS: NonZeroU16 = NonZeroU16::new(64).unwrap();

/// The rows of the table of operation counts: what is asked, and what is found.
fn rows() -> impl Iterator<Item = (Case, Vec<Formulation>)> {
    let cases = [Case::SINGLE, Case::packet(RAYS), Case::common_origin(RAYS)];
    cases.into_iter().flat_map(|case| {
        [Formulation::WITH_V, Formulation::WITH_V0]
            .map(|volumes| (case, cheapest(case, &Model::paper(), volumes).formulations))
    })
}

/// A triple product with every edge replaced.
fn map_edges(product: TripleProduct, replace: impl Fn(Edge) -> Edge) -> TripleProduct {
    let [left, right, dot] = product.vectors().map(|vector| match vector {
        Vector::Edge(edge) => Vector::Edge(replace(edge)),
        Vector::Direction => Vector::Direction,
    });
    TripleProduct {
        cross: Cross { left, right },
        dot,
    }
}

/// The triangle seen from behind: `p1` and `p2` are exchanged, which exchanges `V1` and `V2` and
/// negates every volume, and each cross is swapped, which negates it back.
fn mirrored(formulation: &Formulation) -> Formulation {
    let point = |point| match point {
        Point::P1 => Point::P2,
        Point::P2 => Point::P1,
        Point::A | Point::B | Point::P0 => point,
    };
    let edge = |edge: Edge| Edge {
        to: point(edge.to),
        from: point(edge.from),
    };
    let products = formulation.products.map(|(volume, _)| {
        let source = match volume {
            Volume::V1 => Volume::V2,
            Volume::V2 => Volume::V1,
            Volume::V | Volume::V0 | Volume::Va | Volume::Vb => volume,
        };
        let product = formulation.product(source).expect("it has both V1 and V2");
        (volume, map_edges(product, edge).negated())
    });
    Formulation { products }
}

/// The two edges in the cross of `Va` are reversed wherever they are used, and the cross of a volume
/// that this negates is swapped.
fn reversed(formulation: &Formulation) -> Formulation {
    let va = formulation.product(Volume::Va).expect("it has Va").cross;
    let products = formulation.products.map(|(volume, product)| {
        let is_reversed = |edge: &Edge| [va.left, va.right].contains(&Vector::Edge(*edge));
        let reversals = product.edges().filter(is_reversed).count();
        let product = map_edges(product, |edge| {
            if is_reversed(&edge) {
                edge.reversed()
            } else {
                edge
            }
        });
        (
            volume,
            if reversals % 2 == 1 {
                product.negated()
            } else {
                product
            },
        )
    });
    Formulation { products }
}

#[test]
fn the_mirror_image_of_a_cheapest_formulation_is_one() {
    for (case, formulations) in rows() {
        for formulation in &formulations {
            let image = mirrored(formulation);
            assert_eq!(mirrored(&image), *formulation);
            assert!(
                formulations.contains(&image),
                "{case:?}\n{formulation}\n\n{image}"
            );
        }
    }
}

#[test]
fn with_v_the_cheapest_formulations_are_pairs_with_edges_reversed() {
    for (case, formulations) in rows() {
        for formulation in &formulations {
            if formulation.product(Volume::V).is_none() {
                continue;
            }
            let partner = reversed(formulation);
            assert_eq!(reversed(&partner), *formulation);
            assert_ne!(partner, *formulation);
            assert!(
                formulations.contains(&partner),
                "{case:?}\n{formulation}\n\n{partner}"
            );
        }
    }
}

#[test]
fn with_v0_each_cheapest_formulation_has_a_partner_of_either_kind() {
    for (case, formulations) in rows() {
        for formulation in &formulations {
            if formulation.product(Volume::V0).is_none() {
                continue;
            }
            // A mirror image may be the formulation itself; edges cannot always be reversed without
            // a cross that was shared being needed both ways round.
            let has_partner = [mirrored(formulation), reversed(formulation)]
                .iter()
                .any(|partner| partner != formulation && formulations.contains(partner));
            assert!(has_partner, "{case:?}\n{formulation}");
        }
    }
}

//! The ways to write each volume: how many there are, and that each is exactly one.

use std::collections::BTreeSet;

use volumes::{Edge, Point, Polynomial, Sample, TripleProduct, Vector, Volume, crosses};

/// Samples other than those the lists are derived from.
fn samples() -> impl Iterator<Item = Sample> {
    (1000..1100).map(Sample::random)
}

#[test]
fn twelve_directed_edges_join_four_points() {
    let edges = Edge::all();
    assert!(edges.is_sorted());
    assert_eq!(BTreeSet::from(edges).len(), 12);
    assert!(edges.iter().all(|edge| edge.to != edge.from));
    assert!(edges.iter().all(|edge| edges.contains(&edge.reversed())));
}

#[test]
fn volumes_with_the_direction_have_36_ways_and_va_has_384() {
    for volume in Volume::ALL {
        let expected = if volume == Volume::Va { 384 } else { 36 };
        assert_eq!(volume.triple_products().len(), expected, "{volume}");
    }
}

#[test]
fn vb_has_72_ways_of_which_each_has_the_normal_as_its_cross() {
    let products = Volume::Vb.triple_products();
    assert!(products.is_sorted());
    assert_eq!(products.len(), 72);
    for product in products {
        let [left, right] = [product.cross.left, product.cross.right];
        for vector in [left, right] {
            let edge = vector.edge().unwrap();
            assert!(!edge.joins(Point::A) && !edge.joins(Point::B), "{product}");
        }
        assert!(product.dot.edge().unwrap().joins(Point::B), "{product}");
    }
}

#[test]
fn v_is_what_the_ends_of_a_segment_have_between_them() {
    for sample in samples() {
        let [v, va, vb] = [Volume::V, Volume::Va, Volume::Vb].map(|one| sample.volume(one));
        assert_eq!(v, va - vb);
    }
    let [v, va, vb] = [Volume::V, Volume::Va, Volume::Vb].map(Polynomial::of_volume);
    assert_eq!(v, &va - &vb);
}

#[test]
fn the_triple_products_of_all_volumes_are_528_different_ones() {
    let products = Volume::ALL.map(Volume::triple_products);
    assert!(products.iter().all(|products| products.is_sorted()));
    assert_eq!(products.concat().len(), 528);
    assert_eq!(BTreeSet::from_iter(products.concat()).len(), 528);
}

#[test]
fn crosses_are_120_of_two_edges_and_24_of_an_edge_and_the_direction() {
    let crosses = crosses();
    assert!(crosses.is_sorted_by(|a, b| a < b));
    assert!(
        crosses
            .iter()
            .all(|cross| crosses.contains(&cross.swapped()))
    );

    let with_direction = crosses
        .iter()
        .filter(|cross| [cross.left, cross.right].contains(&Vector::Direction));
    assert_eq!(with_direction.count(), 24);
    assert_eq!(crosses.len(), 120 + 24);
}

#[test]
fn every_way_equals_its_volume_exactly() {
    for volume in Volume::ALL.into_iter().chain([Volume::Vb]) {
        for product in volume.triple_products() {
            for sample in samples() {
                let (value, expected) = (sample.product(product), sample.volume(volume));
                assert_eq!(value, expected, "{volume} = {product} at {sample:?}");
            }
        }
    }
}

#[test]
fn a_way_with_its_cross_swapped_or_an_edge_reversed_is_the_negative_and_not_a_way() {
    for volume in Volume::ALL {
        let products = volume.triple_products();
        for &product in &products {
            assert!(
                !products.contains(&product.negated()),
                "{volume}: {product}"
            );
            assert!(
                samples().all(|sample| sample.product(product.negated()) == -sample.volume(volume))
            );

            let mut reversed = product;
            reversed.dot = match product.dot {
                Vector::Edge(edge) => edge.reversed().into(),
                Vector::Direction => continue,
            };
            assert!(!products.contains(&reversed), "{volume}: {product}");
        }
    }
}

#[test]
fn a_way_uses_only_what_its_volume_has_and_the_direction_once() {
    use Point::{A, B, P0, P1, P2};

    for (volume, points, directions) in [
        (Volume::V, vec![P0, P1, P2], 1),
        (Volume::V0, vec![A, P1, P2], 1),
        (Volume::V1, vec![A, P0, P2], 1),
        (Volume::V2, vec![A, P0, P1], 1),
        (Volume::Va, vec![A, P0, P1, P2], 0),
        (Volume::Vb, vec![B, P0, P1, P2], 0),
    ] {
        for product in volume.triple_products() {
            let used: BTreeSet<_> = product
                .edges()
                .flat_map(|edge| [edge.to, edge.from])
                .collect();
            assert_eq!(
                used,
                BTreeSet::from_iter(points.clone()),
                "{volume}: {product}"
            );
            assert_eq!(
                product.edges().count() + directions,
                3,
                "{volume}: {product}"
            );
        }
    }
}

#[test]
fn v_is_the_sum_of_v0_v1_and_v2() {
    let way = |volume: Volume| volume.triple_products()[0];
    for sample in samples() {
        let [v, v0, v1, v2] = [Volume::V, Volume::V0, Volume::V1, Volume::V2]
            .map(|volume| sample.product(way(volume)));
        assert_eq!(v, v0 + v1 + v2);
    }
}

#[test]
fn volumes_at_a_known_hit_give_its_distance_and_barycentric_coordinates() {
    let sample = Sample {
        points: [[2, 1, -3], [0, 0, 0], [8, 0, 0], [0, 4, 0]],
        direction: [0, 0, 1],
    };
    let [v, v0, v1, v2, va] = Volume::ALL.map(|volume| sample.volume(volume));
    assert_eq!(va, 3 * v, "t is 3");
    assert_eq!(2 * v0, v, "half p0");
    assert_eq!(4 * v1, v, "a quarter p1");
    assert_eq!(4 * v2, v, "a quarter p2");
}

#[test]
fn extreme_coordinates_do_not_overflow() {
    let (low, high) = (i32::MIN, i32::MAX);
    let sample = Sample {
        points: [
            [low; 3],
            [high, low, low],
            [low, high, low],
            [low, low, high],
        ],
        direction: [low; 3],
    };
    for volume in Volume::ALL {
        for product in volume.triple_products() {
            assert_eq!(
                sample.product(product),
                sample.volume(volume),
                "{volume}: {product}"
            );
        }
    }
}

#[test]
fn expressions_are_shown_as_in_the_paper() {
    let shown = |product: &TripleProduct| product.to_string();
    let v = Volume::V.triple_products();
    let texts: Vec<_> = v.iter().map(shown).collect();
    assert!(texts.contains(&"(d × (p2-p0)) · (p1-p0)".to_owned()));
    assert!(texts.contains(&"((p1-p0) × (p0-p2)) · d".to_owned()));
    assert_eq!(v[0].cross.left.to_string(), "p0-p1");
    assert_eq!(Vector::Direction.to_string(), "d");
    assert_eq!(
        Volume::ALL.map(|volume| volume.to_string()),
        ["V", "V0", "V1", "V2", "Va"]
    );
    assert_eq!(Volume::ALL.map(Volume::name), ["v", "v0", "v1", "v2", "va"]);
}

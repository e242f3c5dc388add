//! Rates: a lattice of dependencies, and what follows from those of the inputs.

use volumes::{Rate, Rates, Vector, Volume};

#[test]
fn the_join_is_the_least_upper_bound() {
    let below = |a: Rate, b: Rate| a.join(b) == b;
    for a in Rate::ALL {
        assert_eq!(a.join(a), a);
        assert_eq!(Rate::Constant.join(a), a);
        for b in Rate::ALL {
            let join = a.join(b);
            assert_eq!(join, b.join(a));
            assert!(below(a, join) && below(b, join), "{a} ∨ {b}");
            for bound in Rate::ALL {
                if below(a, bound) && below(b, bound) {
                    assert!(below(join, bound), "{a} ∨ {b} against {bound}");
                }
            }
        }
    }
}

#[test]
fn a_packet_is_known_with_its_ray_and_a_triangle_is_not() {
    assert_eq!(Rate::Triangle.join(Rate::Packet), Rate::PacketTriangle);
    assert_eq!(Rate::Packet.join(Rate::Ray), Rate::Ray);
    assert_eq!(Rate::Triangle.join(Rate::Ray), Rate::RayTriangle);
    assert_eq!(Rate::PacketTriangle.join(Rate::Ray), Rate::RayTriangle);
}

#[test]
fn the_order_agrees_with_the_join() {
    assert!(Rate::ALL.is_sorted());
    for a in Rate::ALL {
        assert!(Rate::ALL.iter().all(|&b| a <= a.join(b)));
    }
}

#[test]
fn a_common_origin_leaves_only_work_with_the_direction_to_the_ray() {
    for volume in Volume::ALL {
        for product in volume.triple_products() {
            let with_direction = product.vectors().contains(&Vector::Direction);
            let rate = Rates::COMMON_ORIGIN.of_product(product);
            assert_eq!(rate.by_ray(), with_direction, "{volume}: {product}");
        }
    }
}

#[test]
fn in_general_only_work_on_the_triangle_is_shared() {
    for product in Volume::V.triple_products() {
        let cross = Rates::GENERAL.of_cross(product.cross);
        let with_direction = [product.cross.left, product.cross.right].contains(&Vector::Direction);
        let expected = if with_direction {
            Rate::RayTriangle
        } else {
            Rate::Triangle
        };
        assert_eq!(cross, expected, "{product}");
        assert_eq!(Rates::GENERAL.of_product(product), Rate::RayTriangle);
    }
}

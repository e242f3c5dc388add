//! What kernels look like: the appendix's, and what every printed kernel has in common.

use emit::{Isa, print_kernel};
use program::{Genome, appendix, kensler_shirley};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use scene::{Regime, SceneModel};

#[test]
fn the_appendix_kernel_reads_like_the_appendix() {
    let graph = kensler_shirley();
    let program = graph.program(&appendix(&graph)).unwrap();
    let scene = packet(Regime::Shrinking);
    let kernel = print_kernel(&program, &scene, Isa::Sse2, "appendix", "");
    expect_test::expect![[r#"
        use super::lanes::*;
        use crate::{Packet, Triangle};

        #[target_feature(enable = "sse2")]
        pub fn appendix<const N: usize>(packet: &mut Packet<N>, triangles: &[Triangle]) {
            align_frame();
            const { assert!(N > 0 && N.is_multiple_of(LANES), "whole vectors of rays") };
            let zero = zeros();
            for triangle in triangles {
                let p1_x = splat(triangle.p1[0]);
                let p1_y = splat(triangle.p1[1]);
                let p1_z = splat(triangle.p1[2]);
                let p0_x = splat(triangle.p0[0]);
                let p0_y = splat(triangle.p0[1]);
                let p0_z = splat(triangle.p0[2]);
                let edge_p1_p0_x = sub(p1_x, p0_x);
                let edge_p1_p0_y = sub(p1_y, p0_y);
                let edge_p1_p0_z = sub(p1_z, p0_z);
                let p2_x = splat(triangle.p2[0]);
                let p2_y = splat(triangle.p2[1]);
                let p2_z = splat(triangle.p2[2]);
                let edge_p0_p2_x = sub(p0_x, p2_x);
                let edge_p0_p2_y = sub(p0_y, p2_y);
                let edge_p0_p2_z = sub(p0_z, p2_z);
                let cross_p1_p0_by_p0_p2_x = sub(mul(edge_p1_p0_y, edge_p0_p2_z), mul(edge_p1_p0_z, edge_p0_p2_y));
                let cross_p1_p0_by_p0_p2_y = sub(mul(edge_p1_p0_z, edge_p0_p2_x), mul(edge_p1_p0_x, edge_p0_p2_z));
                let cross_p1_p0_by_p0_p2_z = sub(mul(edge_p1_p0_x, edge_p0_p2_y), mul(edge_p1_p0_y, edge_p0_p2_x));
                for row in 0..N / LANES {
                    let a_x = load(&packet.ox, row);
                    let a_y = load(&packet.oy, row);
                    let a_z = load(&packet.oz, row);
                    let t_max = load(&packet.t, row);
                    let d_x = load(&packet.dx, row);
                    let d_y = load(&packet.dy, row);
                    let d_z = load(&packet.dz, row);
                    // V = ((p1-p0) × (p0-p2)) · d
                    let volume_v = add(add(mul(cross_p1_p0_by_p0_p2_x, d_x), mul(cross_p1_p0_by_p0_p2_y, d_y)), mul(cross_p1_p0_by_p0_p2_z, d_z));
                    let estimate = estimate_reciprocal(volume_v);
                    let reciprocal = sub(add(estimate, estimate), mul(mul(estimate, estimate), volume_v));
                    let edge_p0_a_x = sub(p0_x, a_x);
                    let edge_p0_a_y = sub(p0_y, a_y);
                    let edge_p0_a_z = sub(p0_z, a_z);
                    // Va = ((p1-p0) × (p0-p2)) · (p0-a)
                    let volume_va = add(add(mul(cross_p1_p0_by_p0_p2_x, edge_p0_a_x), mul(cross_p1_p0_by_p0_p2_y, edge_p0_a_y)), mul(cross_p1_p0_by_p0_p2_z, edge_p0_a_z));
                    let t = mul(volume_va, reciprocal);
                    let mask = all_true();
                    // t < t_max
                    let mask = both(mask, less(t, t_max));
                    // t > 0
                    let mask = both(mask, less(zero, t));
                    if is_empty(mask) {
                        continue;
                    }
                    let packet = afresh(packet);
                    let a_x = load(&packet.ox, row);
                    let a_y = load(&packet.oy, row);
                    let a_z = load(&packet.oz, row);
                    let d_x = load(&packet.dx, row);
                    let d_y = load(&packet.dy, row);
                    let d_z = load(&packet.dz, row);
                    let edge_p0_a_x = sub(p0_x, a_x);
                    let edge_p0_a_y = sub(p0_y, a_y);
                    let edge_p0_a_z = sub(p0_z, a_z);
                    let cross_p0_a_by_d_x = sub(mul(edge_p0_a_y, d_z), mul(edge_p0_a_z, d_y));
                    let cross_p0_a_by_d_y = sub(mul(edge_p0_a_z, d_x), mul(edge_p0_a_x, d_z));
                    let cross_p0_a_by_d_z = sub(mul(edge_p0_a_x, d_y), mul(edge_p0_a_y, d_x));
                    // V1 = ((p0-a) × d) · (p0-p2)
                    let volume_v1 = add(add(mul(cross_p0_a_by_d_x, edge_p0_p2_x), mul(cross_p0_a_by_d_y, edge_p0_p2_y)), mul(cross_p0_a_by_d_z, edge_p0_p2_z));
                    let beta = mul(volume_v1, reciprocal);
                    // beta >= 0
                    let mask = both(mask, at_most(zero, beta));
                    if is_empty(mask) {
                        continue;
                    }
                    // V2 = ((p0-a) × d) · (p1-p0)
                    let volume_v2 = add(add(mul(cross_p0_a_by_d_x, edge_p1_p0_x), mul(cross_p0_a_by_d_y, edge_p1_p0_y)), mul(cross_p0_a_by_d_z, edge_p1_p0_z));
                    let volumes_v1_v2 = add(volume_v1, volume_v2);
                    let v_squared = mul(volume_v, volume_v);
                    // alpha >= 0
                    let mask = both(mask, at_most(mul(volumes_v1_v2, volume_v), v_squared));
                    let gamma = mul(volume_v2, reciprocal);
                    // gamma >= 0
                    let mask = both(mask, at_most(zero, gamma));
                    if is_empty(mask) {
                        continue;
                    }
                    let packet = afresh(packet);
                    let t_max = load(&packet.t, row);
                    store(&mut packet.t, row, select(mask, t, t_max));
                }
            }
        }
    "#]].assert_eq(&kernel.source);
}

#[test]
fn with_a_common_origin_work_on_the_origin_moves_out_of_the_ray_loop() {
    let graph = kensler_shirley();
    let program = graph.program(&appendix(&graph)).unwrap();
    let print = |scene: &str| {
        let (scene, isa) = (SceneModel::preset(scene).unwrap(), Isa::Sse2);
        print_kernel(&program, &scene, isa, "appendix", "").source
    };
    let before_rows = |source: String| source.split("for row").next().unwrap().to_owned();
    let general = before_rows(print("packet"));
    let common = before_rows(print("common-origin"));
    assert!(!general.contains("volume_va") && common.contains("volume_va"));
    assert!(common.contains("let a_x = splat(packet.ox[0]);"));
}

#[test]
fn in_the_fixed_regime_t_is_never_written() {
    let graph = kensler_shirley();
    let program = graph.program(&appendix(&graph)).unwrap();
    let print = |regime| print_kernel(&program, &packet(regime), Isa::Sse2, "k", "").source;
    assert!(print(Regime::Shrinking).contains("store(&mut packet.t, "));
    assert_eq!(print(Regime::Leaf), print(Regime::Shrinking));
    assert!(!print(Regime::Fixed).contains("&mut packet.t,"));
    assert!(print(Regime::Fixed).contains("store(&mut packet.hit_t, "));
}

#[test]
fn every_variable_is_defined_once_in_a_part_but_for_the_mask() {
    let graph = kensler_shirley();
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    for _ in 0..500 {
        let program = graph
            .program(&Genome::random(graph.nodes().len(), &mut rng))
            .unwrap();
        let kernel = print_kernel(&program, &packet(Regime::Fixed), Isa::Sse2, "k", "");
        for part in kernel.source.split("afresh(packet)") {
            let mut names: Vec<&str> = part
                .lines()
                .filter_map(|line| line.trim().strip_prefix("let ")?.split(' ').next())
                .filter(|&name| name != "mask")
                .collect();
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), count);
        }
    }
}

fn packet(regime: Regime) -> SceneModel {
    SceneModel {
        regime,
        ..SceneModel::preset("packet").unwrap()
    }
}

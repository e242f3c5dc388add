//! A kernel has what its scene asks for and nothing else: how the statements of one program differ
//! between models that differ in one field.

use emit::{Isa, print_kernel};
use program::{Program, appendix, kensler_shirley};
use scene::{Culling, Grouping, Output, Query, Range, SceneModel, Stored};
use similar::{ChangeTag, TextDiff};

fn program() -> Program {
    let graph = kensler_shirley();
    graph.program(&appendix(&graph)).unwrap()
}

fn print(scene: &SceneModel) -> String {
    print_kernel(&program(), scene, Isa::Avx2, "k", "").source
}

/// What a change of the plain model changes in the appendix's kernel: lines that go and come.
fn changes(grouping: Grouping, change: impl Fn(&mut SceneModel)) -> String {
    let mut scene = SceneModel::preset("packet").unwrap();
    scene.grouping = grouping;
    let before = print(&scene);
    change(&mut scene);
    let after = print(&scene);
    let diff = TextDiff::from_lines(&before, &after);
    let changes = diff.iter_all_changes();
    let lines = changes.filter_map(|change| match change.tag() {
        ChangeTag::Delete => Some(format!("- {}\n", change.value().trim())),
        ChangeTag::Insert => Some(format!("+ {}\n", change.value().trim())),
        ChangeTag::Equal => None,
    });
    lines.collect()
}

fn of_packet(change: impl Fn(&mut SceneModel)) -> String {
    changes(Grouping::Packet, change)
}

#[test]
fn a_name_changes_nothing() {
    assert_eq!(of_packet(|scene| scene.name = "other".into()), "");
}

#[test]
fn any_hit_stores_no_t_and_leaves_when_all_are_hit() {
    expect_test::expect![[r#"
        - store(&mut packet.t, row, select(mask, t, t_max));
        + store(&mut packet.t, row, select(mask, splat(f32::NEG_INFINITY), t_max));
        + if packet.t.iter().all(|&t| t <= 0.0 || t.is_nan()) {
        + return;
        + }
    "#]]
    .assert_eq(&of_packet(|scene| scene.query = Query::Any));
}

#[test]
fn any_hit_of_one_ray_ends_with_the_first() {
    let change = |scene: &mut SceneModel| scene.query = Query::Any;
    expect_test::expect![[r#"
        - let mut t_max = splat(read(&packet.t[ray]));
        + let t_max = splat(read(&packet.t[ray]));
        - t_max = select(mask, t, t_max);
        - }
        - if is_empty(less(t_max, splat(read(&packet.t[ray])))) {
        + packet.t[ray] = f32::NEG_INFINITY;
        - let t = least(to_array(t_max));
        - packet.t[ray] = t;
    "#]]
    .assert_eq(&changes(Grouping::Single, change));
}

#[test]
fn rays_are_culled_before_the_first_test_that_goes_by_v() {
    expect_test::expect![[r#"
        + // from the front
        + let mask = both(mask, less(zeros(), volume_v));
    "#]]
    .assert_eq(&of_packet(|scene| scene.culling = Culling::Back));
    expect_test::expect![[r#"
        + // from the back
        + let mask = both(mask, less(volume_v, zeros()));
    "#]]
    .assert_eq(&of_packet(|scene| scene.culling = Culling::Front));
}

#[test]
fn a_lower_bound_takes_the_place_of_zero() {
    expect_test::expect![[r#"
        + let t_min = max(zeros(), load(&packet.t_min, row));
        - // t > 0
        - let mask = both(mask, less(zero, t));
        + // t > t_min
        + let mask = both(mask, less(t_min, t));
        + let t_min = max(zeros(), load(&packet.t_min, row));
    "#]]
    .assert_eq(&of_packet(|scene| scene.range = Range::TMinMax));
}

#[test]
fn a_segment_has_its_direction_from_its_ends() {
    expect_test::expect![[r#"
        - let t_max = load(&packet.t, row);
        - let d_x = load(&packet.dx, row);
        - let d_y = load(&packet.dy, row);
        - let d_z = load(&packet.dz, row);
        + let t_max = min(splat(1.0), load(&packet.t, row));
        + let d_x = sub(load(&packet.dx, row), a_x);
        + let d_y = sub(load(&packet.dy, row), a_y);
        + let d_z = sub(load(&packet.dz, row), a_z);
        - let d_x = load(&packet.dx, row);
        - let d_y = load(&packet.dy, row);
        - let d_z = load(&packet.dz, row);
        + let d_x = sub(load(&packet.dx, row), a_x);
        + let d_y = sub(load(&packet.dy, row), a_y);
        + let d_z = sub(load(&packet.dz, row), a_z);
        - let t_max = load(&packet.t, row);
        - store(&mut packet.t, row, select(mask, t, t_max));
        + let t_max = min(splat(1.0), load(&packet.t, row));
        + let t_before = load(&packet.t, row);
        + store(&mut packet.t, row, select(mask, t, t_before));
    "#]]
    .assert_eq(&of_packet(|scene| scene.range = Range::Segment));
}

#[test]
fn outputs_are_stored_where_t_is() {
    let with = |output| of_packet(|scene| scene.outputs = vec![output]);
    assert_eq!(with(Output::T), "", "t goes without saying");
    expect_test::expect![[r#"
        - use crate::{Packet, Triangle};
        + use crate::{Hits, Packet, Triangle};
        - pub fn k<const N: usize>(packet: &mut Packet<N>, triangles: &[Triangle]) {
        + pub fn k<const N: usize>(packet: &mut Packet<N>, hits: &mut Hits<N>, triangles: &[Triangle]) {
        + let u = beta;
        + let v = gamma;
        + let before = load(&hits.u, row);
        + store(&mut hits.u, row, select(mask, u, before));
        + let before = load(&hits.v, row);
        + store(&mut hits.v, row, select(mask, v, before));
    "#]].assert_eq(&with(Output::Uv));
    expect_test::expect![[r#"
        - use crate::{Packet, Triangle};
        + use crate::{Hits, Packet, Triangle};
        - pub fn k<const N: usize>(packet: &mut Packet<N>, triangles: &[Triangle]) {
        + pub fn k<const N: usize>(packet: &mut Packet<N>, hits: &mut Hits<N>, triangles: &[Triangle]) {
        - for triangle in triangles {
        + for (place, triangle) in (0..).zip(triangles) {
        + let number = splat(f32::from_bits(place));
        + let before = load_bits(&hits.triangle, row);
        + store_bits(&mut hits.triangle, row, select(mask, number, before));
    "#]].assert_eq(&with(Output::Triangle));
    expect_test::expect![[r#"
        - use crate::{Packet, Triangle};
        + use crate::{Hits, Packet, Triangle};
        - pub fn k<const N: usize>(packet: &mut Packet<N>, triangles: &[Triangle]) {
        + pub fn k<const N: usize>(packet: &mut Packet<N>, hits: &mut Hits<N>, triangles: &[Triangle]) {
        + let normal_x = sub(zeros(), cross_p1_p0_by_p0_p2_x);
        + let normal_y = sub(zeros(), cross_p1_p0_by_p0_p2_y);
        + let normal_z = sub(zeros(), cross_p1_p0_by_p0_p2_z);
        + let before = load(&hits.normal[0], row);
        + store(&mut hits.normal[0], row, select(mask, normal_x, before));
        + let before = load(&hits.normal[1], row);
        + store(&mut hits.normal[1], row, select(mask, normal_y, before));
        + let before = load(&hits.normal[2], row);
        + store(&mut hits.normal[2], row, select(mask, normal_z, before));
    "#]].assert_eq(&with(Output::Normal));
    expect_test::expect![[r#"
        - use crate::{Packet, Triangle};
        + use crate::{Hits, Packet, Triangle};
        - pub fn k<const N: usize>(packet: &mut Packet<N>, triangles: &[Triangle]) {
        + pub fn k<const N: usize>(packet: &mut Packet<N>, hits: &mut Hits<N>, triangles: &[Triangle]) {
        + let u = beta;
        + let v = gamma;
        + let point_x = add(splat(triangle.p0[0]), add(mul(u, sub(splat(triangle.p1[0]), splat(triangle.p0[0]))), mul(v, sub(splat(triangle.p2[0]), splat(triangle.p0[0])))));
        + let point_y = add(splat(triangle.p0[1]), add(mul(u, sub(splat(triangle.p1[1]), splat(triangle.p0[1]))), mul(v, sub(splat(triangle.p2[1]), splat(triangle.p0[1])))));
        + let point_z = add(splat(triangle.p0[2]), add(mul(u, sub(splat(triangle.p1[2]), splat(triangle.p0[2]))), mul(v, sub(splat(triangle.p2[2]), splat(triangle.p0[2])))));
        + let before = load(&hits.point[0], row);
        + store(&mut hits.point[0], row, select(mask, point_x, before));
        + let before = load(&hits.point[1], row);
        + store(&mut hits.point[1], row, select(mask, point_y, before));
        + let before = load(&hits.point[2], row);
        + store(&mut hits.point[2], row, select(mask, point_z, before));
    "#]].assert_eq(&with(Output::Point));
}

#[test]
fn what_is_stored_is_not_computed() {
    let with = |stored| of_packet(|scene| scene.stored = stored);
    expect_test::expect![[r#"
        - use crate::{Packet, Triangle};
        + use crate::{Packet, TriangleWithNormal};
        - pub fn k<const N: usize>(packet: &mut Packet<N>, triangles: &[Triangle]) {
        + pub fn k<const N: usize>(packet: &mut Packet<N>, triangles: &[TriangleWithNormal]) {
        - let cross_p1_p0_by_p0_p2_x = sub(mul(edge_p1_p0_y, edge_p0_p2_z), mul(edge_p1_p0_z, edge_p0_p2_y));
        - let cross_p1_p0_by_p0_p2_y = sub(mul(edge_p1_p0_z, edge_p0_p2_x), mul(edge_p1_p0_x, edge_p0_p2_z));
        - let cross_p1_p0_by_p0_p2_z = sub(mul(edge_p1_p0_x, edge_p0_p2_y), mul(edge_p1_p0_y, edge_p0_p2_x));
        + let cross_p1_p0_by_p0_p2_x = sub(zeros(), splat(triangle.normal[0]));
        + let cross_p1_p0_by_p0_p2_y = sub(zeros(), splat(triangle.normal[1]));
        + let cross_p1_p0_by_p0_p2_z = sub(zeros(), splat(triangle.normal[2]));
    "#]].assert_eq(&with(Stored::VerticesAndNormal));
}

/// Bounds let programs in that others may not have. A program that both have is the same kernel, and
/// beside it is the check.
#[test]
fn bounds_add_the_check_and_nothing_else() {
    let bounded = |bounds: &str, grouping, change: &dyn Fn(&mut SceneModel)| {
        let bounds = bounds.parse().unwrap();
        changes(grouping, |scene| {
            change(scene);
            scene.bounds = Some(bounds);
        })
    };
    expect_test::expect![[r#"
        + use super::super::bounds::*;
        + 
        + /// Checks that rays and triangles keep to the bounds that [`k`] was made for.
        + ///
        + /// # Errors
        + ///
        + /// What is out of bounds first.
        + pub fn check_k<const N: usize>(packet: &Packet<N>, triangles: &[Triangle]) -> Result<(), OutOfBounds> {
        + let bounds = BoundsCheck { coordinates: 100.0, edge: 0.01, towards: Towards::UnitDirection };
        + for ray in (0..N).filter(|&ray| is_active(packet, ray)) {
        + bounds.origin(packet, ray)?;
        + bounds.direction(packet, ray)?;
        + }
        + for (number, triangle) in triangles.iter().enumerate() {
        + bounds.vertices(number, [triangle.p0, triangle.p1, triangle.p2])?;
        + }
        + Ok(())
        + }
    "#]].assert_eq(&bounded(
        "coordinates=100,edge=0.01,directions=unit",
        Grouping::Packet,
        &|_| {},
    ));
    let single = bounded("coordinates=100,edge=0.01", Grouping::Single, &|_| {});
    let from = single.find("+ for (number").unwrap();
    expect_test::expect![[r#"
        + for (number, block) in blocks.iter().enumerate() {
        + for lane in 0..LANES {
        + let vectors = [block.p0, block.p1, block.p2].map(|vector| vector.map(|axis| axis[lane]));
        + bounds.vertices(number * LANES + lane, vectors)?;
        + }
        + }
        + Ok(())
        + }
    "#]]
    .assert_eq(&single[from..]);
    let common = bounded("coordinates=100,edge=0.01", Grouping::Packet, &|scene| {
        scene.origin = scene::Origin::Common;
        scene.range = Range::Segment;
        scene.stored = Stored::Edges;
    });
    let from = common.find("+ let bounds").unwrap();
    expect_test::expect![[r#"
        + let bounds = BoundsCheck { coordinates: 100.0, edge: 0.01, towards: Towards::End };
        + bounds.origin(packet, 0)?;
        + for ray in 0..N {
        + bounds.direction(packet, ray)?;
        + }
        + for (number, triangle) in triangles.iter().enumerate() {
        + bounds.edges(number, [triangle.p0, triangle.edge1, triangle.edge2])?;
        + }
        + Ok(())
        + }
    "#]]
    .assert_eq(&common[from..]);
}

/// Whatever a scene does with a hit, what a hit is stays: the tests of an any-hit kernel, and what
/// they work on, are word for word those of the closest-hit kernel.
#[test]
fn any_hit_kernels_have_the_tests_of_closest_hit_kernels() {
    use rand::SeedableRng;
    let graph = kensler_shirley();
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
    for _ in 0..300 {
        let genome = program::Genome::random(graph.nodes().len(), &mut rng);
        let program = graph.program(&genome).unwrap();
        for grouping in [Grouping::Packet, Grouping::Single] {
            let mut scene = SceneModel::preset("packet").unwrap();
            scene.grouping = grouping;
            let print = |scene: &SceneModel| print_kernel(&program, scene, Isa::Avx2, "k", "");
            let closest = print(&scene).source;
            scene.query = Query::Any;
            let any = print(&scene).source;
            let assignments = |source: &str| -> Vec<String> {
                let lines = source.lines().map(str::trim);
                let lines = lines.filter(|line| line.starts_with("let ") && !line.contains("mut "));
                lines.map(String::from).collect()
            };
            let closest = assignments(&closest);
            for line in assignments(&any) {
                let bound = line.starts_with("let t_max = ");
                assert!(closest.contains(&line) || bound, "{line}");
            }
        }
    }
}

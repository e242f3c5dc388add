//! A mesh with a hierarchy of boxes from obvhs, its triangles in the order of the leaves.

use std::ops::Range;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::rt_triangle::RtTriangle;
use raybreed::{Block, Triangle};

use crate::mesh::Mesh;

/// Triangles of a leaf, at most: they fill one block.
pub const LEAF: usize = 8;

/// What rays are traced through.
pub struct Geometry {
    /// The triangles, those of a leaf one after another.
    pub mesh: Mesh,
    /// The hierarchy. `meta1` of a leaf is the number of its block.
    pub bvh: Bvh2,
    /// The triangles of each leaf, for one ray.
    pub blocks: Vec<Block<LEAF>>,
    /// The triangles as obvhs tests them, in the same order.
    pub rivals: Vec<RtTriangle>,
}

impl Geometry {
    /// Builds the hierarchy, for rays that start within `reach` of everything.
    pub fn new(mesh: Mesh, reach: f32) -> Geometry {
        let rival = |index: usize| mesh.corners(index).map(Vec3A::from);
        let triangles: Vec<_> = (0..mesh.triangles.len())
            .map(rival)
            .map(|[v0, v1, v2]| obvhs::triangle::Triangle { v0, v1, v2 })
            .collect();
        let mut parameters = BvhBuildParams::medium_build();
        parameters.max_prims_per_leaf = LEAF as u32;
        let mut bvh = build_bvh2_from_tris(&triangles, parameters, &mut Default::default());

        let order = || bvh.primitive_indices.iter().map(|&index| index as usize);
        let mesh = Mesh {
            triangles: order().map(|index| mesh.triangles[index]).collect(),
            paints: order().map(|index| mesh.paints[index]).collect(),
        };
        let rivals = order()
            .map(|index| RtTriangle::from(&triangles[index]))
            .collect();
        let blocks = blocks(&mut bvh, &mesh.triangles);
        widen(&mut bvh, reach);
        Geometry {
            mesh,
            bvh,
            blocks,
            rivals,
        }
    }
}

/// The triangles of a leaf.
pub fn leaf(node: &Bvh2Node) -> Range<usize> {
    let first = node.first_index as usize;
    first..first + node.prim_count as usize
}

/// A block for every leaf, whose number the leaf is told.
fn blocks(bvh: &mut Bvh2, triangles: &[Triangle]) -> Vec<Block<LEAF>> {
    let mut blocks = Vec::new();
    for node in bvh.nodes.iter_mut().filter(|node| node.is_leaf()) {
        node.meta1 = blocks.len() as u32;
        blocks.push(Triangle::block(&triangles[leaf(node)]));
    }
    blocks
}

/// Widens the boxes by more than the rounding of a test against them: a picture has holes if rays miss the box of
/// what they hit, however tight the test of triangles is.
fn widen(bvh: &mut Bvh2, reach: f32) {
    let margin = Vec3A::splat(8.0 * f32::EPSILON * reach);
    for node in &mut bvh.nodes {
        node.aabb.min -= margin;
        node.aabb.max += margin;
    }
}

//! The two that trace the same rays through the same hierarchy: raybreed's kernels, and obvhs by itself.

use std::slice;

use obvhs::fast_stack;
use obvhs::ray::RayHit;
use raybreed::{Entry, Hits, Intersector, Packet, Ray};

use crate::geometry::{Geometry, LEAF, leaf};
use crate::packets::{RAYS, traverse};
use crate::scenes::{Occlusion, Primary, Shadow};

/// raybreed's kernels: packets for rays that go together, blocks for single rays.
pub struct Kernels<'a> {
    geometry: &'a Geometry,
    primary: Intersector<Primary>,
    shadow: Intersector<Shadow>,
    occlusion: Intersector<Occlusion>,
}

impl<'a> Kernels<'a> {
    /// The kernels for this processor.
    pub fn new(geometry: &'a Geometry) -> Self {
        Kernels {
            geometry,
            primary: Intersector::new(),
            shadow: Intersector::new(),
            occlusion: Intersector::new(),
        }
    }

    /// Which they are: for primary and shadow rays, and for those around a point.
    pub fn entries(&self) -> [&'static Entry; 3] {
        [
            self.primary.packet_kernel::<RAYS>(),
            self.shadow.packet_kernel::<RAYS>(),
            self.occlusion.ray_kernel::<LEAF>(),
        ]
    }

    /// Finds the closest hits, with numbers of triangles in all of the mesh.
    pub fn closest(&self, packet: &mut Packet<RAYS>, hits: &mut Hits<RAYS>) {
        traverse(&self.geometry.bvh, packet, |node, packet| {
            hits.first = node.first_index;
            let triangles = &self.geometry.mesh.triangles[leaf(node)];
            self.primary.closest_hits(packet, hits, triangles);
        });
    }

    /// Lowers `t` of the rays that are blocked.
    pub fn block(&self, packet: &mut Packet<RAYS>) {
        traverse(&self.geometry.bvh, packet, |node, packet| {
            self.shadow
                .any(packet, &self.geometry.mesh.triangles[leaf(node)]);
        });
    }

    /// Whether a ray hits anything, in obvhs's own traversal: the test in its leaves is all that differs.
    pub fn is_occluded(&self, ray: &Ray) -> bool {
        let bvh = &self.geometry.bvh;
        let mut is_hit = false;
        fast_stack!(u32, (96, 192), bvh.max_depth, stack, {
            bvh.ray_traverse_dynamic(
                &mut stack,
                convert(ray),
                &mut RayHit::none(),
                |node, _, _| {
                    let block = &self.geometry.blocks[node.meta1 as usize];
                    is_hit = self.occlusion.ray_any(ray, slice::from_ref(block));
                    !is_hit
                },
            );
        });
        is_hit
    }
}

/// obvhs: its traversal of single rays, its own test of a triangle.
pub struct Obvhs<'a>(pub &'a Geometry);

impl Obvhs<'_> {
    /// Whether a ray hits anything, found by its closest hit.
    pub fn has_closest(&self, ray: &Ray) -> bool {
        let Obvhs(Geometry { bvh, rivals, .. }) = self;
        let mut hit = RayHit::none();
        ray.t > 0.0
            && bvh.ray_traverse(convert(ray), &mut hit, |ray, index| {
                rivals[index].intersect(ray)
            })
    }

    /// Whether a ray hits anything.
    pub fn has_any(&self, ray: &Ray) -> bool {
        let Obvhs(Geometry { bvh, rivals, .. }) = self;
        ray.t > 0.0
            && !bvh.ray_traverse_miss(convert(ray), |ray, index| rivals[index].intersect(ray))
    }
}

/// A ray as obvhs has it.
fn convert(ray: &Ray) -> obvhs::ray::Ray {
    obvhs::ray::Ray::new(ray.origin.into(), ray.direction.into(), ray.t_min, ray.t)
}

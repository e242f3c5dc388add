//! Rays from inside a closed surface, through its edges and its vertices.

use raybreed::{Ray, Triangle, Watertight};

use crate::kernels::{Kernel, RAYS, kernels};
use crate::worlds::{Random, World, minus};

#[test]
fn no_ray_slips_through_an_edge_that_two_triangles_share() {
    none_gets_out(Watertight::Edges, |random, [p, q, _]| {
        // Clear of the ends, which are vertices.
        let weight = 0.5 + 0.4 * random.number();
        [0, 1, 2].map(|axis| p[axis] + weight * (q[axis] - p[axis]))
    });
}

#[test]
fn no_ray_slips_through_a_vertex_if_none_may() {
    none_gets_out(Watertight::Full, |_, [p, _, _]| p);
}

#[test]
fn no_ray_slips_through_near_a_vertex_if_none_may() {
    none_gets_out(Watertight::Full, |random, [p, q, _]| {
        let weight = 1e-7 * (1.0 + random.number());
        [0, 1, 2].map(|axis| p[axis] + weight * (q[axis] - p[axis]))
    });
}

/// Sends rays from inside octahedra of any shape to points of their triangles; kernels that are so tight, or
/// tighter, see them all hit.
fn none_gets_out(tight: Watertight, target: fn(&mut Random, [[f32; 3]; 3]) -> [f32; 3]) {
    let mut random = Random(5);
    let kernels: Vec<&Kernel> = kernels()
        .iter()
        .filter(|kernel| kernel.family.watertight >= tight)
        .collect();
    for _ in 0..200 {
        let triangles = octahedron(&mut random);
        let origin = random.point().map(|x| 0.1 * x);
        let rays = (0..RAYS).map(|i| {
            let Triangle { p0, p1, p2 } = triangles[i % 8];
            let corners = [[p0, p1, p2], [p1, p2, p0], [p2, p0, p1]][i % 3];
            Ray::new(origin, minus(target(&mut random, corners), origin))
        });
        let world = World {
            rays: rays.collect(),
            triangles,
        };
        for kernel in &kernels {
            let before = world.packet(kernel.family.calls);
            let after = kernel.closest(&before, &world.triangles);
            for i in 0..RAYS {
                assert!(
                    after.t[i].is_finite(),
                    "{kernel}: {:?} of {:?}",
                    before.ray(i),
                    world.triangles
                );
            }
        }
    }
}

/// A closed surface around zero: corners near those of an octahedron, each the same numbers in four triangles.
fn octahedron(random: &mut Random) -> Vec<Triangle> {
    let corners = [0, 1, 2].map(|axis| {
        [-1.0, 1.0].map(|side| {
            let mut corner = random.point().map(|x| 0.2 * x);
            corner[axis] += side;
            corner
        })
    });
    let [x, y, z] = corners;
    let mut triangles = Vec::new();
    for (i, x) in x.into_iter().enumerate() {
        for (j, y) in y.into_iter().enumerate() {
            for (k, z) in z.into_iter().enumerate() {
                // Which of them is first shall not matter, nor which way round they go.
                let corners = [[x, y, z], [y, z, x], [z, x, y], [z, y, x]][(i + 2 * j + 3 * k) % 4];
                triangles.push(Triangle {
                    p0: corners[0],
                    p1: corners[1],
                    p2: corners[2],
                });
            }
        }
    }
    triangles
}

//! The extreme cases in which kernels are known to leak, in blocks of rays.

use std::fmt;

use rand::{Rng, RngExt};
use rand_chacha::ChaCha8Rng;
use scene::{INITIAL_T, Ray, Triangle};
use serde::{Deserialize, Serialize};

use crate::fans::{Fan, Shape};
use crate::lattice;
use crate::meshes::Mesh;
use crate::patch::{Patch, starting_at};
use crate::placement::Placement;
use crate::random::{block_rng, log_uniform, unit_vector};
use crate::rays::{Aim, Length, above, aimed, along_axis};
use crate::vector::{Vector, between, narrow, scale, wide};

/// Rays of a block.
pub const BLOCK_RAYS: usize = 256;

/// A kind of closed surface and of rays that must hit it.
///
/// Directions are as often raw, from the origin to the target, as of unit length. Surfaces are about
/// 2 across, turned at random and at random distances up to 1.7 from the world's origin, and seen
/// from 0.5 to 20 away, if nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Case {
    /// Fans of 4 to 64 triangles, flat or folded: half of the rays at the centre, half at spokes.
    Fan,
    /// Fans of 65 to 1024 triangles.
    LargeFan,
    /// Fans of 8 to 64 triangles, most of which have angles down to 10^-6 at the centre.
    SliverFan,
    /// Fans whose coordinates are small integers: rays along an axis, with zeros of either sign, or
    /// along a lattice direction, exactly at the centre and exactly at points of spokes.
    Lattice,
    /// Fans of 4 to 64 triangles, rays exactly along an axis of the world, zeros of either sign.
    AxisAligned,
    /// Two triangles with a common side: rays at its points.
    SharedEdge,
    /// Fans of 4 to 64 triangles at 1e3, at 1e5 and at (148376, 1234, −223423), rays beside them.
    FarFan,
    /// Fans of 4 to 64 triangles, everything times 2^k for a k from -20 to 20.
    ScaledFan,
    /// Jittered spheres of 16 by 16 to 24 by 24 quads, from inside: a third of the rays each at
    /// vertices, at edges and anywhere.
    MeshInside,
    /// The same spheres at the far offsets of [`Case::FarFan`].
    FarMeshInside,
    /// The same spheres from outside, rays at vertices and edges: some triangle around the vertex
    /// must be hit, and the ray must leave as well as enter.
    MeshOutside,
}

/// A ray that must hit.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The ray.
    pub ray: Ray,
    /// What it is aimed at.
    pub aim: Aim,
    /// How often it crosses the surface: triangles that it sees counterclockwise less those that it
    /// sees clockwise. Not zero.
    pub winding: i32,
    /// If the ray goes through a whole mesh, the numbers of the triangles that it crosses `winding`
    /// times, all others making up for that; else they are all triangles of the block.
    pub among: Option<Vec<u32>>,
}

/// A surface and rays that are certain to hit it: by [`Patch::winding`], or because they begin
/// inside a closed mesh ([`Mesh::winding`]).
#[derive(Clone)]
pub struct Block {
    /// The surface.
    pub triangles: Vec<Triangle>,
    /// The rays, [`BLOCK_RAYS`] or fewer.
    pub shots: Vec<Shot>,
}

impl Case {
    /// All cases, in the order in which tables print them.
    pub const ALL: [Self; 11] = [
        Self::Fan,
        Self::LargeFan,
        Self::SliverFan,
        Self::Lattice,
        Self::AxisAligned,
        Self::SharedEdge,
        Self::FarFan,
        Self::ScaledFan,
        Self::MeshInside,
        Self::FarMeshInside,
        Self::MeshOutside,
    ];

    /// Its name in reports, `[a-z-]`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fan => "fan",
            Self::LargeFan => "large-fan",
            Self::SliverFan => "sliver-fan",
            Self::Lattice => "lattice",
            Self::AxisAligned => "axis-aligned",
            Self::SharedEdge => "shared-edge",
            Self::FarFan => "far-fan",
            Self::ScaledFan => "scaled-fan",
            Self::MeshInside => "mesh-inside",
            Self::FarMeshInside => "far-mesh-inside",
            Self::MeshOutside => "mesh-outside",
        }
    }

    /// Block `number` of this case: the same for the same seed, whatever other blocks are made.
    pub fn block(self, seed: u64, number: u64) -> Block {
        let rng = &mut block_rng(seed, self as u16, number);
        match self {
            Self::Fan => fan(rng, 4..65, Shape::Even, Placement::near),
            Self::LargeFan => fan(rng, 65..1025, Shape::Even, Placement::near),
            Self::SliverFan => fan(rng, 8..65, Shape::Slivers, Placement::near),
            Self::Lattice => {
                let fan = lattice::fan(rng);
                let shots = collect(|| {
                    let (ray, aim) = lattice::shot(rng, &fan);
                    certain(&fan.patch, ray, aim)
                });
                Block {
                    triangles: fan.patch.triangles,
                    shots,
                }
            }
            Self::AxisAligned => axis_aligned(rng),
            Self::SharedEdge => shared_edge(rng),
            Self::FarFan => fan(rng, 4..65, Shape::Even, Placement::far),
            Self::ScaledFan => fan(rng, 4..65, Shape::Even, |rng| {
                let exponent = rng.random_range(-20..21);
                Placement::scaled(rng, exponent)
            }),
            Self::MeshInside => mesh_inside(rng, Placement::near),
            Self::FarMeshInside => mesh_inside(rng, Placement::far),
            Self::MeshOutside => mesh_outside(rng),
        }
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Draws until there are [`BLOCK_RAYS`] shots, or four times as many draws.
fn collect(mut draw: impl FnMut() -> Option<Shot>) -> Vec<Shot> {
    let draws = (0..4 * BLOCK_RAYS).filter_map(|_| draw());
    draws.take(BLOCK_RAYS).collect()
}

fn certain(patch: &Patch, ray: Ray, aim: Aim) -> Option<Shot> {
    let winding = patch.winding(&ray).filter(|&winding| winding != 0)?;
    let aim = match aim {
        Aim::Edge if patch.is_at_several_sides(&ray) => Aim::Vertex,
        aim => aim,
    };
    Some(Shot {
        ray,
        aim,
        winding,
        among: None,
    })
}

fn either(rng: &mut impl Rng) -> Aim {
    if rng.random() { Aim::Vertex } else { Aim::Edge }
}

fn fan(
    rng: &mut ChaCha8Rng,
    counts: std::ops::Range<usize>,
    shape: Shape,
    place: impl FnOnce(&mut ChaCha8Rng) -> Placement,
) -> Block {
    let placement = place(rng);
    let count = log_uniform(rng, counts.start as f64..counts.end as f64) as usize;
    let fan = Fan::random(rng, count, shape, &placement);
    let shots = collect(|| {
        let aim = either(rng);
        let target = fan.target(rng, aim);
        let origin = above(rng, [0.0; 3], &placement);
        let ray = aimed(origin, target, Length::either(rng), placement.factor());
        certain(&fan.patch, ray, aim)
    });
    Block {
        triangles: fan.patch.triangles,
        shots,
    }
}

fn axis_aligned(rng: &mut ChaCha8Rng) -> Block {
    let placement = Placement::near(rng);
    let count = log_uniform(rng, 4.0..65.0) as usize;
    let fan = Fan::random(rng, count, Shape::Even, &placement);
    let shots = collect(|| {
        let aim = either(rng);
        let target = narrow(fan.target(rng, aim));
        certain(&fan.patch, along_axis(rng, target), aim)
    });
    Block {
        triangles: fan.patch.triangles,
        shots,
    }
}

/// Two triangles on either side of a side on the first axis, each other vertex anywhere on its half
/// of a square, one or both of them lifted.
fn shared_edge(rng: &mut ChaCha8Rng) -> Block {
    let placement = Placement::near(rng);
    let apex = |rng: &mut ChaCha8Rng, side: f64| {
        let point = [
            rng.random_range(-1.0..1.0),
            side * log_uniform(rng, 1e-2..1.0),
            rng.random_range(-0.3..0.3),
        ];
        placement.point(point)
    };
    let [p, q] = [-1.0, 1.0].map(|x| placement.point([x, 0.0, 0.0]));
    let [left, right] = [apex(rng, 1.0), apex(rng, -1.0)];
    let patch = Patch {
        triangles: vec![
            starting_at(rng.random_range(0..3), [p, q, left]),
            starting_at(rng.random_range(0..3), [q, p, right]),
        ],
        border: vec![q, left, p, right],
        inner: Vec::new(),
    };
    let shots = collect(|| {
        let target = between(wide(p), wide(q), rng.random_range(0.1..0.9));
        let origin = above(rng, [0.0; 3], &placement);
        certain(
            &patch,
            aimed(origin, target, Length::either(rng), 1.0),
            Aim::Edge,
        )
    });
    Block {
        triangles: patch.triangles,
        shots,
    }
}

fn sphere(rng: &mut ChaCha8Rng, placement: &Placement) -> Mesh {
    let [rings, columns] = [(); 2].map(|()| rng.random_range(16..25));
    let mesh = Mesh::jittered_sphere(rng, rings, columns, placement);
    debug_assert!(mesh.is_closed());
    mesh
}

fn mesh_inside(rng: &mut ChaCha8Rng, place: impl FnOnce(&mut ChaCha8Rng) -> Placement) -> Block {
    let placement = place(rng);
    let mesh = sphere(rng, &placement);
    let origin = placement.point(scale(unit_vector(rng), rng.random_range(0.0..0.5)));
    let winding = (0..16).find_map(|_| {
        let direction = narrow(unit_vector(rng));
        let ray = Ray {
            origin,
            direction,
            t_min: 0.0,
            t_max: INITIAL_T,
        };
        mesh.winding(&ray)
    });
    let winding = winding.filter(|&winding| winding != 0);
    let shots = collect(|| {
        let aim = [Aim::Vertex, Aim::Edge, Aim::Elsewhere][rng.random_range(0..3)];
        let face = mesh.faces[rng.random_range(0..mesh.faces.len())];
        let [p, q, _] = face.map(|vertex| wide(mesh.vertices[vertex as usize]));
        let target: Vector = match aim {
            Aim::Vertex => p,
            Aim::Edge => between(p, q, rng.random_range(0.1..0.9)),
            Aim::Elsewhere => placement.vector(unit_vector(rng)),
        };
        let ray = match aim {
            Aim::Elsewhere => Ray {
                origin,
                direction: narrow(target),
                t_min: 0.0,
                t_max: INITIAL_T,
            },
            _ => aimed(origin, target, Length::either(rng), 1.0),
        };
        winding.map(|winding| Shot {
            ray,
            aim,
            winding,
            among: None,
        })
    });
    Block {
        triangles: mesh.triangles(),
        shots,
    }
}

fn mesh_outside(rng: &mut ChaCha8Rng) -> Block {
    let placement = Placement::near(rng);
    let mesh = sphere(rng, &placement);
    let stars: Vec<_> = [(); 16]
        .iter()
        .filter_map(|()| mesh.star(rng.random_range(0..mesh.vertices.len() as u32)))
        .collect();
    let shots = collect(|| {
        let star = &stars[rng.random_range(0..stars.len())];
        let aim = either(rng);
        let target = star.fan.target(rng, aim);
        let distance = log_uniform(rng, 1.5..20.0);
        let origin = placement.point(scale(unit_vector(rng), distance));
        let ray = aimed(origin, target, Length::either(rng), 1.0);
        let shot = certain(&star.fan.patch, ray, aim)?;
        let among = Some(star.faces.clone());
        Some(Shot { among, ..shot })
    });
    Block {
        triangles: mesh.triangles(),
        shots,
    }
}

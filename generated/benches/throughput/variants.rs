//! What it costs to ask for more than the closest hit, or for less: one requirement, and the widest instructions that
//! the processor has.

use std::hint::black_box;

use raybreed::{Culling, Hits, Intersector, Packet, Ray, Scene, Triangle, TriangleWithNormal};
use scene::{PACKET_SIZE, Query, Regime, Task};

use crate::bench::Bench;
use crate::library::{block, triangle};

/// Which triangle is hit, and where in it.
enum Placed {}

impl Scene for Placed {
    const TRIANGLE: bool = true;
    const UV: bool = true;
}

/// Triangles that have no back.
enum Culled {}

impl Scene for Culled {
    const CULLING: Culling = Culling::Back;
}

/// Triangles in a block.
const WIDTH: usize = 8;

type Rays = Packet<PACKET_SIZE>;
type OneByOne = [Ray; PACKET_SIZE];

/// Times packets, and rays against blocks of eight.
pub fn bench(bench: &mut Bench<'_>) {
    let closest = Task::from(Regime::Leaf);
    closest_of_packets(bench);
    closest_of_rays(bench);

    bench.ask(Task {
        query: Query::Any,
        ..closest
    });
    let test = Intersector::<()>::new();
    bench.time("packet-any", 1, one, |packet: &mut Rays, triangles| {
        test.any(packet, triangles);
    });
    bench.time(
        "ray-any",
        WIDTH,
        block::<WIDTH>,
        |rays: &mut OneByOne, blocks| {
            for ray in rays {
                // As packets tell of it.
                if test.ray_any(ray, blocks) {
                    ray.t = f32::NEG_INFINITY;
                }
            }
        },
    );

    bench.ask(Task {
        culling: scene::Culling::Back,
        ..closest
    });
    let test = Intersector::<Culled>::new();
    bench.time("packet-culled", 1, one, |packet: &mut Rays, triangles| {
        test.closest(packet, triangles);
    });
    bench.time(
        "ray-culled",
        WIDTH,
        block::<WIDTH>,
        |rays: &mut OneByOne, blocks| {
            for ray in rays {
                test.ray_closest(ray, blocks);
            }
        },
    );
}

fn closest_of_packets(bench: &mut Bench<'_>) {
    let test = Intersector::<()>::new();
    bench.time("packet", 1, one, |packet: &mut Rays, triangles| {
        test.closest(packet, triangles);
    });
    let with_normal = |list: &[scene::Triangle]| TriangleWithNormal::from(one(list));
    bench.time(
        "packet-normal-stored",
        1,
        with_normal,
        |packet: &mut Rays, triangles| {
            test.closest(packet, triangles);
        },
    );
    let (test, mut hits) = (Intersector::<Placed>::new(), Hits::new());
    bench.time(
        "packet-triangle-uv",
        1,
        one,
        |packet: &mut Rays, triangles| {
            test.closest_hits(packet, &mut hits, triangles);
        },
    );
}

fn closest_of_rays(bench: &mut Bench<'_>) {
    let test = Intersector::<()>::new();
    bench.time(
        "ray",
        WIDTH,
        block::<WIDTH>,
        |rays: &mut OneByOne, blocks| {
            for ray in rays {
                test.ray_closest(ray, blocks);
            }
        },
    );
    let with_normal = |list: &[scene::Triangle]| {
        let triangles: Vec<_> = list.iter().map(triangle).map(Into::into).collect();
        TriangleWithNormal::<[f32; WIDTH]>::block(&triangles)
    };
    bench.time(
        "ray-normal-stored",
        WIDTH,
        with_normal,
        |rays: &mut OneByOne, blocks| {
            for ray in rays {
                test.ray_closest(ray, blocks);
            }
        },
    );
    let test = Intersector::<Placed>::new();
    bench.time(
        "ray-triangle-uv",
        WIDTH,
        block::<WIDTH>,
        |rays: &mut OneByOne, blocks| {
            for ray in rays {
                black_box(test.ray_closest_hit(ray, blocks));
            }
        },
    );
}

/// The triangle of a list of one.
fn one(list: &[scene::Triangle]) -> Triangle {
    triangle(&list[0])
}

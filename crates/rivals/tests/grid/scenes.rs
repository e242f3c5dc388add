//! Scenes in the cube from -1 to 1, and packets that look into it.

use std::f64::consts::{PI, TAU};

use scene::{Drand48, Generator, RayPacket, Triangle};

use super::{Scene, Vec3, cross, dot};

/// What is seen in a scene's picture along each side, in half sides of the cube.
const VIEW: f64 = 1.2;

/// A sphere of triangles that are as high as wide, one of slivers, and triangles of all directions all over
/// the cube; as many in each as in `quads` by `quads` quads. Their pictures have `tiles` by `tiles` packets.
pub fn all(quads: usize, tiles: usize) -> [Scene; 3] {
    let packets = packets(tiles);
    [
        ("sphere", sphere(quads, quads)),
        ("slivers", sphere(quads / 8, quads * 8)),
        ("soup", soup(2 * quads * quads)),
    ]
    .map(|(name, triangles)| Scene::new(name, triangles, packets.clone()))
}

/// A sphere of `rings` by `columns` quads, in triangles, whose vertices have been moved by up to a fifth of
/// a quad.
fn sphere(rings: usize, columns: usize) -> Vec<Triangle> {
    let mut random = Drand48::new(1);
    let mut jitter = || 0.2 * random.difference();
    let vertices: Vec<Vec<[f32; 3]>> = (0..=rings)
        .map(|ring| {
            let vertex = |column| {
                let polar = (ring as f64 + jitter()) * PI / rings as f64;
                let turn = (column as f64 + jitter()) * TAU / columns as f64;
                let (flat, height) = (0.9 * polar.sin(), 0.9 * polar.cos());
                [flat * turn.cos(), flat * turn.sin(), height].map(|x| x as f32)
            };
            (0..columns).map(vertex).collect()
        })
        .collect();
    let quads = (0..rings).flat_map(|ring| (0..columns).map(move |column| (ring, column)));
    quads
        .flat_map(|(ring, column)| {
            let after = (column + 1) % columns;
            let [a, b] = [vertices[ring][column], vertices[ring][after]];
            let [c, d] = [vertices[ring + 1][column], vertices[ring + 1][after]];
            [[a, c, d], [a, d, b]].map(|[p0, p1, p2]| Triangle { p0, p1, p2 })
        })
        .collect()
}

/// The triangles of the paper's workload, about two cells large and moved all over the cube.
fn soup(triangles: usize) -> Vec<Triangle> {
    let mut random = Drand48::new(2);
    let generator = Generator {
        triangles,
        packets: 0,
        ..Generator::default()
    };
    let size = 2.0 * 2.0 / (4.0 * triangles as f32).cbrt();
    let moved = |Triangle { p0, p1, p2 }: Triangle| {
        // No vertex of the workload is farther than this from its triangle's middle.
        let room = 1.0 - 4.0 / 3.0 * size;
        let center = [0; 3].map(|_| (2.0 * random.draw() - 1.0) as f32 * room);
        let [p0, p1, p2] =
            [p0, p1, p2].map(|p| [0, 1, 2].map(|axis| center[axis] + size * p[axis]));
        Triangle { p0, p1, p2 }
    };
    generator
        .generate()
        .triangles
        .into_iter()
        .map(moved)
        .collect()
}

/// The packets of a picture, each 8 by 8 neighbouring primary rays, from a point before the cube on whichever
/// axis they go along.
fn packets(tiles: usize) -> Vec<RayPacket> {
    let eye = [-2.9, 1.7, 2.3];
    let scaled = |a: Vec3, factor: f64| a.map(|x| factor * x);
    let unit = |a: Vec3| scaled(a, dot(a, a).sqrt().recip());
    let right = unit(cross(eye, [0.0, 0.0, 1.0]));
    let up = unit(cross(right, eye));
    let blank = Generator {
        triangles: 0,
        packets: 1,
        ..Generator::default()
    };
    let blank = blank.generate().packets.remove(0);
    let packet = |tile: usize| {
        let mut packet = blank.clone();
        (packet.ox, packet.oy, packet.oz) = (
            [eye[0] as f32; 64],
            [eye[1] as f32; 64],
            [eye[2] as f32; 64],
        );
        for ray in 0..64 {
            let pixel = [tile % tiles * 8 + ray % 8, tile / tiles * 8 + ray / 8];
            let [x, y] = pixel.map(|at| (at as f64 + 0.5) / (8 * tiles) as f64 * 2.0 - 1.0);
            let (right, up) = (scaled(right, VIEW * x), scaled(up, VIEW * y));
            let direction = [0, 1, 2].map(|axis| (right[axis] + up[axis] - eye[axis]) as f32);
            [packet.dx[ray], packet.dy[ray], packet.dz[ray]] = direction;
        }
        packet
    };
    (0..tiles * tiles).map(packet).collect()
}

//! The scene without a file: closed surfaces, of small triangles and of long thin ones, where a leak would show.

use std::f32::consts::TAU;

use glam::Vec3;

use crate::mesh::{Mesh, Paint};

/// A knot, a tower of slivers, and spheres.
pub fn scene() -> Mesh {
    let mut mesh = Mesh::default();
    sphere(
        &mut mesh,
        Vec3::new(2.1, 1.0, -0.2),
        1.0,
        5,
        [0.72, 0.2, 0.16],
    );
    knot(&mut mesh, Vec3::new(0.05, 1.32, -1.1), [0.2, 0.42, 0.62]);
    tower(&mut mesh, Vec3::new(-2.1, 0.0, -0.2), [0.82, 0.62, 0.22]);
    for i in 0..7 {
        let angle = (0.14 + 0.12 * i as f32) * TAU / 2.0;
        let radius = 0.2 + 0.05 * (i % 3) as f32;
        let centre = Vec3::new(-3.0 * angle.cos(), radius, -0.2 + 2.0 * angle.sin());
        let colour = [[0.34, 0.52, 0.26], [0.78, 0.74, 0.68], [0.5, 0.3, 0.5]][i % 3];
        sphere(&mut mesh, centre, radius, 3, colour);
    }
    mesh
}

/// An icosahedron whose faces are divided in four so many times.
fn sphere(mesh: &mut Mesh, centre: Vec3, radius: f32, divisions: u32, colour: [f32; 3]) {
    let ratio = (1.0 + 5.0f32.sqrt()) / 2.0;
    let corner = |index: usize| {
        let (one, long) = ([-1.0, 1.0][index & 1], [-ratio, ratio][index >> 1 & 1]);
        let axes = [[0.0, one, long], [one, long, 0.0], [long, 0.0, one]];
        Vec3::from(axes[index >> 2]).normalize()
    };
    let is_face = |[a, b, c]: [Vec3; 3]| {
        [a.dot(b), b.dot(c), c.dot(a)]
            .iter()
            .all(|cosine| *cosine > 0.4)
            && a.cross(b).dot(c) > 0.0
    };
    for a in 0..12 {
        for b in a + 1..12 {
            for c in a + 1..12 {
                let face = [a, b, c].map(corner);
                if b != c && is_face(face) {
                    divide(face, divisions, &mut |small: [Vec3; 3]| {
                        let placed = small.map(|vertex| centre + radius * vertex);
                        mesh.push(placed, Paint::Plain(colour.into()));
                    });
                }
            }
        }
    }
}

/// Divides a triangle of the unit sphere. Neighbours find the same numbers for a vertex that they share: a sum does
/// not depend on the order of two.
fn divide([a, b, c]: [Vec3; 3], divisions: u32, found: &mut impl FnMut([Vec3; 3])) {
    if divisions == 0 {
        return found([a, b, c]);
    }
    let [ab, bc, ca] = [a + b, b + c, c + a].map(Vec3::normalize);
    for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
        divide(part, divisions - 1, found);
    }
}

/// A tube along a knot on a torus.
fn knot(mesh: &mut Mesh, centre: Vec3, colour: [f32; 3]) {
    const ALONG: usize = 600;
    const AROUND: usize = 32;
    let middle = |row: usize| {
        let angle = 2.0 * TAU * row as f32 / ALONG as f32;
        let out = 0.82 + 0.34 * (1.5 * angle).cos();
        Vec3::new(
            out * angle.cos(),
            out * angle.sin(),
            0.42 * (1.5 * angle).sin(),
        )
    };
    let ring = |row: usize| -> Vec<Vec3> {
        let (here, next) = (middle(row), middle(row + 1));
        let across = (next - here).cross(next + here).normalize();
        let outward = across.cross(next - here).normalize();
        let spoke = |angle: f32| across * angle.cos() + outward * angle.sin();
        let angles = (0..AROUND).map(|column| TAU * column as f32 / AROUND as f32);
        angles
            .map(|angle| centre + here + 0.17 * spoke(angle))
            .collect()
    };
    let rings: Vec<_> = (0..ALONG).map(ring).collect();
    for row in 0..ALONG {
        band(mesh, &rings[row], &rings[(row + 1) % ALONG], colour);
    }
}

/// A tower of slivers from the bottom to the top; its ends are of slivers, too.
fn tower(mesh: &mut Mesh, base: Vec3, colour: [f32; 3]) {
    const AROUND: usize = 720;
    const HEIGHT: f32 = 2.6;
    let ring = |radius: f32, height: f32| -> Vec<Vec3> {
        let angles = (0..AROUND).map(|column| TAU * column as f32 / AROUND as f32);
        let spoke = |angle: f32| Vec3::new(radius * angle.cos(), height, radius * angle.sin());
        angles.map(|angle| base + spoke(angle)).collect()
    };
    let (bottom, top) = (ring(0.75, 0.0), ring(0.3, HEIGHT));
    band(mesh, &bottom, &top, colour);
    band(mesh, &[base], &bottom, colour);
    band(mesh, &top, &[base + HEIGHT * Vec3::Y], colour);
}

/// Triangles between two closed rings of as many vertices, of which one may be a point.
fn band(mesh: &mut Mesh, one: &[Vec3], other: &[Vec3], colour: [f32; 3]) {
    for column in 0..one.len().max(other.len()) {
        let of = |ring: &[Vec3], column: usize| ring[column % ring.len()];
        let (a, b) = (of(one, column), of(one, column + 1));
        let (c, d) = (of(other, column), of(other, column + 1));
        for face in [[a, b, d], [a, d, c]] {
            if face[0] != face[1] && face[1] != face[2] && face[2] != face[0] {
                mesh.push(face, Paint::Plain(colour.into()));
            }
        }
    }
}

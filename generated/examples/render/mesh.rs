//! Triangles and their colours, from an OBJ file or from code.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use glam::Vec3;
use raybreed::Triangle;

/// What a triangle looks like.
#[derive(Clone, Copy)]
pub enum Paint {
    /// One colour.
    Plain(Vec3),
    /// Two, in squares of this size on the plane of x and z.
    Checks(Vec3, Vec3, f32),
}

impl Paint {
    /// The colour at a point.
    pub fn at(self, point: Vec3) -> Vec3 {
        match self {
            Paint::Plain(colour) => colour,
            Paint::Checks(one, other, size) => {
                let square = (point / size).floor();
                let is_odd = (square.x + square.z).rem_euclid(2.0) == 1.0;
                if is_odd { other } else { one }
            }
        }
    }
}

/// Triangles, each with its paint.
#[derive(Default)]
pub struct Mesh {
    /// The triangles.
    pub triangles: Vec<Triangle>,
    /// What each of them looks like.
    pub paints: Vec<Paint>,
}

impl Mesh {
    /// Reads an OBJ file.
    pub fn load(path: &Path) -> Result<Mesh> {
        let file = File::open(path).with_context(|| format!("cannot open {}", path.display()))?;
        let options = tobj::LoadOptions {
            triangulate: true,
            ignore_points: true,
            ignore_lines: true,
            ..Default::default()
        };
        let no_materials = |_: &Path| Ok(Default::default());
        let (models, _) = tobj::load_obj_buf(&mut BufReader::new(file), &options, no_materials)
            .with_context(|| format!("{} is not an OBJ file that can be read", path.display()))?;

        let mut mesh = Mesh::default();
        for tobj::Model { mesh: part, .. } in models {
            let vertex = |index: u32| Vec3::from_slice(&part.positions[3 * index as usize..]);
            for corners in part.indices.as_chunks().0 {
                mesh.push(
                    corners.map(vertex),
                    Paint::Plain(Vec3::new(0.6, 0.52, 0.44)),
                );
            }
        }
        ensure!(
            !mesh.triangles.is_empty(),
            "{} has no triangles",
            path.display()
        );
        let (low, high) = mesh.bounds();
        let extent = (high - low).length();
        ensure!(
            mesh.vertices().all(|vertex| vertex.is_finite()) && extent.is_finite(),
            "{} has a vertex that is not finite, or too far away",
            path.display()
        );
        ensure!(extent > 0.0, "{} is a single point", path.display());
        Ok(mesh)
    }

    /// Adds a triangle.
    pub fn push(&mut self, [p0, p1, p2]: [Vec3; 3], paint: Paint) {
        self.triangles.push(Triangle::new(p0, p1, p2));
        self.paints.push(paint);
    }

    /// Adds a square on the floor.
    pub fn push_floor(&mut self, centre: Vec3, half: f32, paint: Paint) {
        let corner = |x, z| centre + half * Vec3::new(x, 0.0, z);
        let [a, b, c, d] =
            [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(x, z)| corner(x, z));
        self.push([a, b, c], paint);
        self.push([a, c, d], paint);
    }

    /// The least and the greatest coordinates.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.vertices().fold(
            (Vec3::INFINITY, Vec3::NEG_INFINITY),
            |(low, high), vertex| (low.min(vertex), high.max(vertex)),
        )
    }

    /// The vertices of all triangles.
    fn vertices(&self) -> impl Iterator<Item = Vec3> {
        (0..self.triangles.len()).flat_map(|index| self.corners(index))
    }

    /// A point of a triangle by its barycentric coordinates. It is nearer to the surface than a point along the ray.
    pub fn point(&self, triangle: usize, u: f32, v: f32) -> Vec3 {
        let [p0, p1, p2] = self.corners(triangle);
        (1.0 - u - v) * p0 + u * p1 + v * p2
    }

    /// The normal of a triangle, of unit length.
    pub fn normal(&self, triangle: usize) -> Vec3 {
        let [p0, p1, p2] = self.corners(triangle);
        (p1 - p0).cross(p2 - p0).normalize_or(Vec3::Y)
    }

    /// The vertices of a triangle.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        let Triangle { p0, p1, p2 } = self.triangles[triangle];
        [p0, p1, p2].map(Vec3::from)
    }
}

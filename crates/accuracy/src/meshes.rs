//! Closed meshes.

use std::collections::{BTreeMap, BTreeSet};

use rand::{Rng, RngExt};
use scene::{Ray, Triangle};

use crate::exact::{Class, Exact};
use crate::fans::Fan;
use crate::patch::starting_at;
use crate::placement::Placement;

/// An indexed mesh.
#[derive(Clone)]
pub struct Mesh {
    /// Its vertices.
    pub vertices: Vec<[f32; 3]>,
    /// Its triangles, each by three different vertices.
    pub faces: Vec<[u32; 3]>,
}

/// The triangles of a mesh around one of its vertices.
#[derive(Clone)]
pub struct Star {
    /// They, as a fan around that vertex.
    pub fan: Fan,
    /// Their numbers in the mesh, in the fan's order.
    pub faces: Vec<u32>,
}

impl Mesh {
    /// A sphere of radius 1 around zero before it is placed, of `rings` by `columns` quads, in
    /// triangles, whose vertices have been moved by up to a fifth of a quad. Those at the poles meet
    /// `columns` triangles, the others six.
    pub(crate) fn jittered_sphere(
        rng: &mut impl Rng,
        rings: u32,
        columns: u32,
        placement: &Placement,
    ) -> Self {
        let (ring_height, column_width) = (
            std::f64::consts::PI / f64::from(rings),
            std::f64::consts::TAU / f64::from(columns),
        );
        let mut vertices = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
        for ring in 1..rings {
            for column in 0..columns {
                let mut jitter = || rng.random_range(-0.2..0.2);
                let (polar, turn, radius) = (
                    (f64::from(ring) + jitter()) * ring_height,
                    (f64::from(column) + jitter()) * column_width,
                    1.0 + jitter() * ring_height,
                );
                let flat = radius * polar.sin();
                vertices.push([flat * turn.cos(), flat * turn.sin(), radius * polar.cos()]);
            }
        }
        let at = |ring: u32, column: u32| match ring {
            0 => 0,
            ring if ring == rings => 1,
            ring => 2 + (ring - 1) * columns + column % columns,
        };
        let mut faces = Vec::new();
        for ring in 0..rings {
            for column in 0..columns {
                let [a, b] = [at(ring, column), at(ring, column + 1)];
                let [c, d] = [at(ring + 1, column), at(ring + 1, column + 1)];
                // At the poles one of the two has no area.
                for face in [[a, c, d], [a, d, b]] {
                    let distinct: BTreeSet<u32> = face.into_iter().collect();
                    if distinct.len() == 3 {
                        let mut face = face;
                        face.rotate_left(rng.random_range(0..3));
                        faces.push(face);
                    }
                }
            }
        }
        Self {
            vertices: vertices.into_iter().map(|p| placement.point(p)).collect(),
            faces,
        }
    }

    /// Triangle `face` begins with its first vertex.
    pub fn triangles(&self) -> Vec<Triangle> {
        let vertices = |face: &[u32; 3]| face.map(|vertex| self.vertices[vertex as usize]);
        let triangles = self.faces.iter().map(vertices);
        triangles.map(|face| starting_at(0, face)).collect()
    }

    /// Whether it has no border: for every side of a triangle there is exactly one triangle with the
    /// same side the other way round.
    pub fn is_closed(&self) -> bool {
        let sides = || {
            let of_face = |&[a, b, c]: &[u32; 3]| [(a, b), (b, c), (c, a)];
            self.faces.iter().flat_map(of_face)
        };
        let distinct: BTreeSet<(u32, u32)> = sides().collect();
        distinct.len() == 3 * self.faces.len() && sides().all(|(a, b)| distinct.contains(&(b, a)))
    }

    /// The triangles around `vertex`. `None` if they are no closed fan.
    pub fn star(&self, vertex: u32) -> Option<Star> {
        // From each vertex of the border: the next one, the face, and where `vertex` is in it.
        let mut next = BTreeMap::new();
        for (number, face) in self.faces.iter().enumerate() {
            if let Some(place) = face.iter().position(|&v| v == vertex) {
                let [from, to] = [face[(place + 1) % 3], face[(place + 2) % 3]];
                next.insert(from, (to, number as u32, place));
            }
        }
        let (&first, _) = next.first_key_value()?;
        let (mut border, mut faces, mut starts) = (Vec::new(), Vec::new(), Vec::new());
        let mut at = first;
        while let Some((to, face, place)) = next.remove(&at) {
            border.push(self.vertices[at as usize]);
            faces.push(face);
            starts.push((3 - place) % 3);
            at = to;
        }
        let is_one_loop = at == first && next.is_empty();
        is_one_loop.then(|| Star {
            fan: Fan::new(self.vertices[vertex as usize], border, |number| {
                starts[number]
            }),
            faces,
        })
    }

    /// How often `ray` crosses the mesh, exactly: triangles that it sees counterclockwise less those
    /// that it sees clockwise. `None` if the ray touches a side or a vertex, or begins on the mesh.
    ///
    /// If the mesh is closed, that is a property of the ray's origin: how often the mesh winds around
    /// it. If it is not zero, every ray from there has to hit.
    ///
    /// A triangle that is parallel to the ray does not count: if the ray touches it, it touches a
    /// side of one that is not.
    pub fn winding(&self, ray: &Ray) -> Option<i32> {
        let mut winding = 0;
        for triangle in self.triangles() {
            let exact = Exact::new(ray, &triangle)?;
            match exact.class() {
                Class::Interior => winding += exact.facing() as i32,
                Class::Exterior | Class::Parallel => {}
                Class::Edge(_) | Class::Vertex(_) | Class::TBoundary => return None,
            }
        }
        Some(winding)
    }
}

#[cfg(test)]
mod tests {
    use scene::Ray;

    use super::Mesh;
    use crate::placement::Placement;
    use crate::random::block_rng;

    fn sphere() -> Mesh {
        let mut rng = block_rng(1, 0, 0);
        let placement = Placement::near(&mut rng);
        Mesh::jittered_sphere(&mut rng, 16, 17, &placement)
    }

    #[test]
    fn a_sphere_is_closed_and_with_a_face_less_or_turned_it_is_not() {
        let mesh = sphere();
        assert_eq!(mesh.faces.len(), 2 * 17 * 15);
        assert_eq!(mesh.vertices.len(), 2 + 17 * 15);
        assert!(mesh.is_closed());

        let mut open = mesh.clone();
        open.faces.pop();
        assert!(!open.is_closed());
        let mut turned = mesh;
        turned.faces[7].reverse();
        assert!(!turned.is_closed());
    }

    #[test]
    fn faces_begin_anywhere() {
        let mesh = sphere();
        let at_the_pole = mesh.faces.iter().filter(|face| face.contains(&0));
        let places = at_the_pole.map(|face| face.iter().position(|&vertex| vertex == 0));
        let places: std::collections::BTreeSet<_> = places.collect();
        assert_eq!(places.len(), 3);
    }

    #[test]
    fn a_star_has_all_triangles_of_its_vertex_as_they_are_in_the_mesh() {
        let mesh = sphere();
        let triangles = mesh.triangles();
        for vertex in 0..mesh.vertices.len() as u32 {
            let star = mesh.star(vertex).unwrap();
            let meets = mesh
                .faces
                .iter()
                .filter(|face| face.contains(&vertex))
                .count();
            assert_eq!(star.faces.len(), meets);
            for (face, triangle) in star.faces.iter().zip(&star.fan.patch.triangles) {
                let of_mesh = &triangles[*face as usize];
                assert_eq!(
                    [triangle.p0, triangle.p1, triangle.p2],
                    [of_mesh.p0, of_mesh.p1, of_mesh.p2]
                );
            }
        }
        let mut open = mesh;
        let torn = open.faces.pop().unwrap()[0];
        assert!(open.star(torn).is_none(), "no closed fan");
    }

    #[test]
    fn a_mesh_winds_once_around_what_is_in_it_and_not_around_what_is_not() {
        let mut rng = block_rng(1, 0, 0);
        let placement = Placement::near(&mut rng);
        let mesh = Mesh::jittered_sphere(&mut rng, 16, 17, &placement);
        let winding = |point| {
            let ray = Ray {
                origin: placement.point(point),
                direction: [0.31, -0.27, 0.83],
                t_min: 0.0,
                t_max: 1e6,
            };
            mesh.winding(&ray).unwrap().abs()
        };
        assert_eq!(winding([0.1, 0.2, -0.3]), 1);
        assert_eq!(winding([0.0, 0.5, 0.5]), 1);
        assert_eq!(winding([0.0, 1.5, 0.5]), 0);
        assert_eq!(winding([0.0, 0.0, -7.0]), 0);
    }
}

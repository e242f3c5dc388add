//! Closed fans: triangles around a centre, each side of the centre shared by two.

use rand::{Rng, RngExt};

use crate::patch::{Patch, starting_at};
use crate::placement::Placement;
use crate::random::log_uniform;
use crate::rays::Aim;
use crate::vector::{Vector, between, wide};

/// Triangles around a centre.
///
/// If each began with the centre, every spoke would be an edge from the same vertex, and kernels
/// whose volumes of such an edge are antisymmetric by luck would show no leak. So each begins with
/// a vertex of its own.
#[derive(Clone)]
pub struct Fan {
    /// The triangles; the centre is its one inner vertex.
    pub patch: Patch,
    /// The vertex that all triangles share.
    pub centre: [f32; 3],
}

/// What a fan's triangles look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Of similar angles, flat or folded.
    Even,
    /// Most of them with an angle down to 10^-6 at the centre.
    Slivers,
}

impl Fan {
    /// Joins a centre to a border. Triangle `number` has the centre, `border[number]` and the next
    /// of the border, and begins with that one of the three which `start(number)` says, 0 to 2.
    pub fn new(centre: [f32; 3], border: Vec<[f32; 3]>, start: impl Fn(usize) -> usize) -> Self {
        let next = border.iter().cycle().skip(1);
        let triangles = border.iter().zip(next).enumerate();
        let triangles = triangles
            .map(|(number, (&p, &q))| starting_at(start(number), [centre, p, q]))
            .collect();
        let patch = Patch {
            triangles,
            border,
            inner: vec![centre],
        };
        Self { patch, centre }
    }

    /// A fan of `count` triangles, its centre at zero and about in the plane of the first two axes
    /// before it is placed.
    pub(crate) fn random(
        rng: &mut impl Rng,
        count: usize,
        shape: Shape,
        placement: &Placement,
    ) -> Self {
        let fold = if rng.random() { 0.0 } else { 0.2 };
        let border = angles(rng, count, shape)
            .into_iter()
            .map(|angle| {
                let (radius, height) = match shape {
                    Shape::Even => (rng.random_range(0.8..1.2), rng.random_range(-1.0..1.0)),
                    Shape::Slivers => (1.0, rng.random_range(-0.01..0.01)),
                };
                placement.point([radius * angle.cos(), radius * angle.sin(), fold * height])
            })
            .collect();
        let starts: Vec<usize> = (0..count).map(|_| rng.random_range(0..3)).collect();
        Self::new(placement.point([0.0; 3]), border, |number| starts[number])
    }

    /// The centre, or a point of a spoke.
    pub(crate) fn target(&self, rng: &mut impl Rng, aim: Aim) -> Vector {
        let border = &self.patch.border;
        let s = match aim {
            Aim::Vertex => 0.0,
            Aim::Edge | Aim::Elsewhere => rng.random_range(0.1..0.9),
        };
        let end = border[rng.random_range(0..border.len())];
        between(wide(self.centre), wide(end), s)
    }
}

/// Ascending, less than 120 degrees apart.
fn angles(rng: &mut impl Rng, count: usize, shape: Shape) -> Vec<f64> {
    let mut weight = || match shape {
        Shape::Even => rng.random_range(0.7..1.3),
        Shape::Slivers => log_uniform(rng, 1e-6..1.0),
    };
    let mut gaps: Vec<f64> = (0..count).map(|_| weight()).collect();
    if shape == Shape::Slivers {
        // Four spread over the circle are large, so that no gap is near to 180 degrees.
        for large in 0..4 {
            gaps[large * count / 4] = rng.random_range(4.0..5.0) * count as f64 / 4.0;
        }
    }
    let full: f64 = gaps.iter().sum();
    let mut angle = rng.random_range(0.0..std::f64::consts::TAU);
    gaps.into_iter()
        .map(|gap| {
            angle += gap / full * std::f64::consts::TAU;
            angle
        })
        .collect()
}

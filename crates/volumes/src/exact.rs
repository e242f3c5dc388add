//! Exact evaluation of triple products and volumes at integer points.

use crate::{Cross, Edge, Point, TripleProduct, Vector, Volume};

/// Integer coordinates for the four points and the direction.
///
/// Two triple products, or a triple product and a volume, are polynomials of degree 3 in the
/// coordinates. If they differ, then they agree at a sample whose coordinates are drawn from all
/// 2³² values with a probability of at most 3/2³² (lemma of Schwartz and Zippel): a few samples
/// prove an equation beyond doubt.
///
/// Nothing overflows: the coordinates of an edge are below 2³³ in magnitude, those of a cross
/// product below 2⁶⁷, a triple product is below 2¹⁰², and `V0`, a difference of three of
/// these, below 2¹⁰⁴.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Sample {
    /// The corners, in the order of [`Point::ALL`].
    pub points: [[i32; 3]; 4],
    /// The direction, which is independent of the points.
    pub direction: [i32; 3],
}

impl Sample {
    /// A sample drawn from all values that the coordinates can have: the same for the same seed.
    pub fn random(seed: u64) -> Self {
        let mut state = seed;
        let mut vector = || std::array::from_fn(|_| split_mix(&mut state));
        Self {
            points: std::array::from_fn(|_| vector()),
            direction: vector(),
        }
    }

    /// The vector's coordinates.
    pub fn vector(&self, vector: Vector) -> [i128; 3] {
        match vector {
            Vector::Edge(Edge { to, from }) => self.difference(to, from),
            Vector::Direction => self.direction.map(i128::from),
        }
    }

    /// The cross product's coordinates.
    pub fn cross(&self, cross: Cross) -> [i128; 3] {
        let [lx, ly, lz] = self.vector(cross.left);
        let [rx, ry, rz] = self.vector(cross.right);
        [ly * rz - lz * ry, lz * rx - lx * rz, lx * ry - ly * rx]
    }

    /// The triple product, computed as it is written: cross product, then dot product.
    pub fn product(&self, product: TripleProduct) -> i128 {
        let [cx, cy, cz] = self.cross(product.cross);
        let [x, y, z] = self.vector(product.dot);
        cx * x + cy * y + cz * z
    }

    /// The volume by its definition: the determinants behind the paper's equations 2, and
    /// `V0 = V - V1 - V2`.
    pub fn volume(&self, volume: Volume) -> i128 {
        use Point::{A, P0, P1, P2};

        let d = self.vector(Vector::Direction);
        let [origin, first, second] = [A, P1, P2].map(|point| self.difference(point, P0));
        match volume {
            Volume::V => determinant([d, second, first]),
            Volume::V0 => {
                self.volume(Volume::V) - self.volume(Volume::V1) - self.volume(Volume::V2)
            }
            Volume::V1 => determinant([d, second, origin]),
            Volume::V2 => determinant([origin, first, d]),
            Volume::Va => determinant([origin, first, second]),
            Volume::Vb => determinant([self.difference(Point::B, P0), first, second]),
        }
    }

    fn difference(&self, to: Point, from: Point) -> [i128; 3] {
        let [to, from] = [to, from].map(|point| self.point(point));
        std::array::from_fn(|axis| to[axis] - from[axis])
    }

    fn point(&self, point: Point) -> [i128; 3] {
        match point {
            Point::B => {
                let [a, d] = [self.points[Point::A as usize], self.direction];
                std::array::from_fn(|axis| i128::from(a[axis]) + i128::from(d[axis]))
            }
            corner => self.points[corner as usize].map(i128::from),
        }
    }
}

/// The determinant of three rows by Leibniz' formula, a path of its own beside the triple product.
fn determinant([a, b, c]: [[i128; 3]; 3]) -> i128 {
    let even = a[0] * b[1] * c[2] + a[1] * b[2] * c[0] + a[2] * b[0] * c[1];
    let odd = a[0] * b[2] * c[1] + a[1] * b[0] * c[2] + a[2] * b[1] * c[0];
    even - odd
}

/// The next 32 bits of Steele, Lea and Flood's SplitMix64 (2014), as a signed integer.
fn split_mix(state: &mut u64) -> i32 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut bits = *state;
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    (bits >> 32).cast_signed() as i32
}

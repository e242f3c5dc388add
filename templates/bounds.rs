//! The check that a scene keeps to the bounds that a kernel was made for.
//!
//! This text is compiled into timed libraries and, as `scene::bounds`, part of the process that breeds them.

use core::fmt;

use crate::Packet;

/// What a ray has beside its origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Towards {
    /// A direction of any length.
    Direction,
    /// A direction of length one.
    UnitDirection,
    /// The other end of a segment.
    End,
}

/// Bounds that rays and triangles are checked against. NaN is within all bounds, since no kernel has a
/// hit where it meets one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundsCheck {
    /// No coordinate of an origin, of the other end of a segment or of a vertex is greater in magnitude.
    pub coordinates: f32,
    /// No side of a triangle is shorter.
    pub edge: f32,
    /// What a ray has beside its origin.
    pub towards: Towards,
}

/// What is out of bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutOfBounds {
    /// The origin of this ray.
    Origin(usize),
    /// The other end of this segment.
    End(usize),
    /// The direction of this ray, which is not of length one.
    Direction(usize),
    /// A vertex of this triangle.
    Vertex(usize),
    /// A side of this triangle, which is too short.
    Edge(usize),
}

impl fmt::Display for OutOfBounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OutOfBounds::Origin(ray) => write!(f, "the origin of ray {ray} is out of bounds"),
            OutOfBounds::End(ray) => write!(f, "the end of segment {ray} is out of bounds"),
            OutOfBounds::Direction(ray) => {
                write!(f, "the direction of ray {ray} is not of length one")
            }
            OutOfBounds::Vertex(triangle) => {
                write!(f, "a vertex of triangle {triangle} is out of bounds")
            }
            OutOfBounds::Edge(triangle) => {
                write!(f, "a side of triangle {triangle} is too short")
            }
        }
    }
}

impl core::error::Error for OutOfBounds {}

impl BoundsCheck {
    /// By how much the square of a direction's length may differ from one.
    pub const SLACK: f32 = 1.0 / 4096.0;

    /// Checks where ray `ray` of a packet starts.
    pub fn origin<const N: usize>(
        &self,
        packet: &Packet<N>,
        ray: usize,
    ) -> Result<(), OutOfBounds> {
        let origin = [packet.ox[ray], packet.oy[ray], packet.oz[ray]];
        within(self.holds(origin), OutOfBounds::Origin(ray))
    }

    /// Checks where it goes, if it is active.
    pub fn direction<const N: usize>(
        &self,
        packet: &Packet<N>,
        ray: usize,
    ) -> Result<(), OutOfBounds> {
        if !is_active(packet, ray) {
            return Ok(());
        }
        let direction = [packet.dx[ray], packet.dy[ray], packet.dz[ray]];
        match self.towards {
            Towards::Direction => Ok(()),
            Towards::UnitDirection => {
                let is_off = (square(direction) - 1.0).abs() > Self::SLACK;
                within(!is_off, OutOfBounds::Direction(ray))
            }
            Towards::End => within(self.holds(direction), OutOfBounds::End(ray)),
        }
    }

    /// Checks a triangle by its vertices.
    pub fn vertices(&self, triangle: usize, points: [[f32; 3]; 3]) -> Result<(), OutOfBounds> {
        let [p0, p1, p2] = points;
        within(
            points.iter().all(|&point| self.holds(point)),
            OutOfBounds::Vertex(triangle),
        )?;
        let sides = [minus(p1, p0), minus(p2, p0), minus(p2, p1)];
        self.sides(triangle, sides)
    }

    /// Checks a triangle by its first vertex and the edges from there.
    pub fn edges(
        &self,
        triangle: usize,
        [p0, edge1, edge2]: [[f32; 3]; 3],
    ) -> Result<(), OutOfBounds> {
        let points = [p0, plus(p0, edge1), plus(p0, edge2)];
        within(
            points.iter().all(|&point| self.holds(point)),
            OutOfBounds::Vertex(triangle),
        )?;
        self.sides(triangle, [edge1, edge2, minus(edge2, edge1)])
    }

    fn holds(&self, point: [f32; 3]) -> bool {
        // Written so that NaN is within.
        !point.iter().any(|x| x.abs() > self.coordinates)
    }

    fn sides(&self, triangle: usize, sides: [[f32; 3]; 3]) -> Result<(), OutOfBounds> {
        // In units of the bound, lest the square of a short side be zero.
        let is_short = |side: [f32; 3]| square(side.map(|x| x / self.edge)) < 1.0;
        within(
            !sides.into_iter().any(is_short),
            OutOfBounds::Edge(triangle),
        )
    }
}

/// Whether ray `ray` of a packet is active.
pub fn is_active<const N: usize>(packet: &Packet<N>, ray: usize) -> bool {
    packet.t[ray] > 0.0
}

fn within(is: bool, what: OutOfBounds) -> Result<(), OutOfBounds> {
    match is {
        true => Ok(()),
        false => Err(what),
    }
}

fn square([x, y, z]: [f32; 3]) -> f32 {
    x * x + y * y + z * z
}

fn plus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

//! What triple products are made of: points, the edges between them, the ray's direction.

use std::array;
use std::fmt;

/// A corner of the tetrahedron that the ray's origin and the triangle span.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Point {
    /// The ray's origin.
    A,
    /// The triangle's first vertex.
    P0,
    /// The triangle's second vertex.
    P1,
    /// The triangle's third vertex.
    P2,
    /// The other end of a segment, `a + d`. It is no corner of the tetrahedron, and not in
    /// [`ALL`](Self::ALL).
    B,
}

impl Point {
    /// The four corners, in ascending order.
    pub const ALL: [Self; 4] = [Self::A, Self::P0, Self::P1, Self::P2];

    /// The triangle's vertices, in order.
    pub const VERTICES: [Self; 3] = [Self::P0, Self::P1, Self::P2];
}

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::A => "a",
            Self::P0 => "p0",
            Self::P1 => "p1",
            Self::P2 => "p2",
            Self::B => "b",
        })
    }
}

/// A directed edge: the vector `to - from`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Edge {
    /// Where the vector ends.
    pub to: Point,
    /// Where the vector starts, another point than `to`.
    pub from: Point,
}

impl Edge {
    /// The 12 directed edges between different points, in ascending order.
    pub fn all() -> [Self; 12] {
        array::from_fn(|index| {
            let (to, other) = (index / 3, index % 3);
            let from = if other < to { other } else { other + 1 };
            Self {
                to: Point::ALL[to],
                from: Point::ALL[from],
            }
        })
    }

    /// Whether a point is one of its ends.
    pub fn joins(self, point: Point) -> bool {
        self.to == point || self.from == point
    }

    /// The same edge walked the other way, which is the negated vector.
    #[must_use]
    pub const fn reversed(self) -> Self {
        Self {
            to: self.from,
            from: self.to,
        }
    }
}

impl fmt::Display for Edge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}", self.to, self.from)
    }
}

/// A factor of a triple product.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Vector {
    /// A difference of two points, to be computed.
    Edge(Edge),
    /// The ray's direction `d`, which is given: it is no difference of points, and costs nothing.
    Direction,
}

impl Vector {
    /// The 12 edges and the direction, in ascending order.
    pub fn all() -> [Self; 13] {
        let edges = Edge::all();
        array::from_fn(|index| {
            edges
                .get(index)
                .map_or(Self::Direction, |&edge| Self::Edge(edge))
        })
    }

    /// The edge, unless this is the direction.
    pub const fn edge(self) -> Option<Edge> {
        match self {
            Self::Edge(edge) => Some(edge),
            Self::Direction => None,
        }
    }
}

impl From<Edge> for Vector {
    fn from(edge: Edge) -> Self {
        Self::Edge(edge)
    }
}

impl fmt::Display for Vector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Edge(edge) => edge.fmt(f),
            Self::Direction => f.write_str("d"),
        }
    }
}

//! How often a value changes, which decides the loop it is computed in and what it costs.

use std::fmt;

use crate::{Cross, Edge, Point, TripleProduct, Vector};

/// How often a value changes when packets of rays meet triangles.
///
/// A rate is what the value depends on: on the triangle or not, and on nothing, the packet or the
/// ray (a ray's packet is known with the ray). `Ord` is a linear extension of [`Rate::join`]'s
/// order: `a <= a.join(b)`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Rate {
    /// Never.
    Constant,
    /// With the triangle.
    Triangle,
    /// With the packet.
    Packet,
    /// With the packet and the triangle.
    PacketTriangle,
    /// With the ray.
    Ray,
    /// With the ray and the triangle.
    RayTriangle,
}

impl Rate {
    /// The rates, in ascending order.
    pub const ALL: [Self; 6] = [
        Self::Constant,
        Self::Triangle,
        Self::Packet,
        Self::PacketTriangle,
        Self::Ray,
        Self::RayTriangle,
    ];

    /// The rate of a value that is computed from values of these two: their least upper bound.
    ///
    /// ```
    /// # use volumes::Rate;
    /// assert_eq!(Rate::Triangle.join(Rate::Packet), Rate::PacketTriangle);
    /// assert_eq!(Rate::Packet.join(Rate::Ray), Rate::Ray);
    /// ```
    #[must_use]
    pub const fn join(self, other: Self) -> Self {
        let ray = self.by_ray() || other.by_ray();
        let packet = self.by_packet() || other.by_packet();
        let triangle = self.by_triangle() || other.by_triangle();
        match (ray, packet, triangle) {
            (false, false, false) => Self::Constant,
            (false, false, true) => Self::Triangle,
            (false, true, false) => Self::Packet,
            (false, true, true) => Self::PacketTriangle,
            (true, _, false) => Self::Ray,
            (true, _, true) => Self::RayTriangle,
        }
    }

    /// Whether the value changes with the triangle.
    pub const fn by_triangle(self) -> bool {
        matches!(
            self,
            Self::Triangle | Self::PacketTriangle | Self::RayTriangle
        )
    }

    /// Whether the value changes with the packet. What changes with the ray does.
    pub const fn by_packet(self) -> bool {
        matches!(self, Self::Packet | Self::PacketTriangle) || self.by_ray()
    }

    /// Whether the value changes with the ray, and is computed for each ray of a packet.
    pub const fn by_ray(self) -> bool {
        matches!(self, Self::Ray | Self::RayTriangle)
    }
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Constant => "constant",
            Self::Triangle => "triangle",
            Self::Packet => "packet",
            Self::PacketTriangle => "packet×triangle",
            Self::Ray => "ray",
            Self::RayTriangle => "ray×triangle",
        })
    }
}

/// How often the inputs of a test change; the rate of everything else follows.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Rates {
    /// Of the triangle's vertices `p0`, `p1`, `p2`.
    pub vertices: Rate,
    /// Of the ray's origin `a`.
    pub origin: Rate,
    /// Of the ray's direction `d`.
    pub direction: Rate,
}

impl Rates {
    /// Rays that have nothing in common, in packets or alone.
    pub const GENERAL: Self = Self {
        vertices: Rate::Triangle,
        origin: Rate::Ray,
        direction: Rate::Ray,
    };

    /// Packets of rays from one origin: primary rays, shadow rays of a point light.
    pub const COMMON_ORIGIN: Self = Self {
        vertices: Rate::Triangle,
        origin: Rate::Packet,
        direction: Rate::Ray,
    };

    /// The rate of a vector.
    pub const fn of(self, vector: Vector) -> Rate {
        match vector {
            Vector::Edge(edge) => self.of_edge(edge),
            Vector::Direction => self.direction,
        }
    }

    /// The rate of a point.
    pub const fn of_point(self, point: Point) -> Rate {
        match point {
            Point::A => self.origin,
            Point::P0 | Point::P1 | Point::P2 => self.vertices,
            Point::B => self.origin.join(self.direction),
        }
    }

    /// The rate of an edge.
    pub const fn of_edge(self, edge: Edge) -> Rate {
        self.of_point(edge.to).join(self.of_point(edge.from))
    }

    /// The rate of a cross product.
    pub const fn of_cross(self, cross: Cross) -> Rate {
        self.of(cross.left).join(self.of(cross.right))
    }

    /// The rate of a triple product.
    pub const fn of_product(self, product: TripleProduct) -> Rate {
        self.of_cross(product.cross).join(self.of(product.dot))
    }
}

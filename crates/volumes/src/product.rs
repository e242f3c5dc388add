//! Cross products and triple products of vectors, as expressions: which factors, in which order.

use std::fmt;

use crate::{Edge, Vector};

/// The cross product `left × right`.
///
/// `e × f` and `f × e` are different expressions with opposite values.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Cross {
    /// The first factor.
    pub left: Vector,
    /// The second factor.
    pub right: Vector,
}

impl Cross {
    /// The factors in the other order, which is the negated vector.
    #[must_use]
    pub const fn swapped(self) -> Self {
        Self {
            left: self.right,
            right: self.left,
        }
    }
}

impl fmt::Display for Cross {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} × {}", Factor(self.left), Factor(self.right))
    }
}

/// The triple product `(left × right) · dot`: six times the signed volume of a tetrahedron
/// (section 2 of the paper).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct TripleProduct {
    /// The cross product.
    pub cross: Cross,
    /// What it is multiplied with.
    pub dot: Vector,
}

impl TripleProduct {
    /// The three factors as written, from left to right.
    pub const fn vectors(self) -> [Vector; 3] {
        [self.cross.left, self.cross.right, self.dot]
    }

    /// The edges among the factors, from left to right: two or three, the direction is none.
    pub fn edges(self) -> impl Iterator<Item = Edge> {
        self.vectors().into_iter().filter_map(Vector::edge)
    }

    /// The same factors with the cross product's swapped, which is the negated volume.
    #[must_use]
    pub const fn negated(self) -> Self {
        Self {
            cross: self.cross.swapped(),
            dot: self.dot,
        }
    }
}

impl fmt::Display for TripleProduct {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}) · {}", self.cross, Factor(self.dot))
    }
}

/// Shows a vector as a factor: edges in parentheses.
struct Factor(Vector);

impl fmt::Display for Factor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Vector::Edge(edge) => write!(f, "({edge})"),
            Vector::Direction => f.write_str("d"),
        }
    }
}

//! The operations of the watertight test of Woop, Benthin and Wald (2013): a shear that makes the
//! ray the third axis, and edge functions of what is left of the vertices.
//!
//! A ray sees every vertex as a point of a plane, and sees it in the same place whatever triangle
//! asks: the same numbers go through the same operations. So the triangles around a vertex are a
//! map without gaps, and a side's volume with the right sign says on which side of an edge of the
//! map the ray is. Nothing can slip through, at vertices either.
//!
//! With `k` the axis along which the direction `d` is longest, the rows of the shear are
//!
//! ```text
//! x = ±(e_k+1 - d_k+1 / d_k · e_k)    y = e_k+2 - d_k+2 / d_k · e_k    z = 1 / d_k · e_k
//! ```
//!
//! where the sign is that of `d_k`, so that the volumes keep theirs: the two-dimensional edge
//! functions are the volumes of the sides divided by `|d_k|`, and what comes of them, `t` and the
//! barycentric coordinates, is ratios. Woop renames the axes instead, which takes more operations
//! if every ray of a vector has other names; multiplications by 0 and by 1 round nothing, so the
//! places are the same.

use std::fmt;

use crate::definition::{Binary, Definition, Expr, Ternary, binary, product, ternary};
use crate::op::Side;

/// A coordinate, of the scene or of the sheared frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third; in the sheared frame, the one along the ray.
    Z,
}

impl Axis {
    /// All three, in order.
    pub const ALL: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
}

/// How a sum of products is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Rounding {
    /// Every product and every sum by itself.
    Each,
    /// A product with the sum that it is added to.
    Fused,
}

impl Rounding {
    /// Both.
    pub const ALL: [Rounding; 2] = [Rounding::Each, Rounding::Fused];
}

/// How the difference of two products is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ProductDifference {
    /// Of the rounded products. Rounding keeps order, so it never has the wrong sign, but may be zero
    /// where the exact one is not.
    Rounded,
    /// In twice the precision, which holds a product as it is. The sign is right for all finite
    /// coordinates, but for a difference so small that it becomes a zero.
    Wide,
    /// By Kahan's algorithm: what the second product lost by rounding is added back. Both steps are
    /// fused operations, and on an instruction set without them nothing is gained. The error is
    /// below 1.5 ulp (Jeannerod, Louvet and Muller 2013), so the sign is right, unless what is lost
    /// is too small for a number: of products above 2^-100 it is not.
    Kahan,
}

impl ProductDifference {
    /// All.
    pub const ALL: [ProductDifference; 3] = [
        ProductDifference::Rounded,
        ProductDifference::Wide,
        ProductDifference::Kahan,
    ];

    /// Whether the sign is that of the exact difference.
    pub fn has_exact_sign(self) -> bool {
        self != ProductDifference::Rounded
    }
}

/// An operation of the sheared test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Shear {
    /// The magnitudes of the direction's components.
    Magnitudes,
    /// Whether the direction is longest along this axis; of equally long ones the first counts.
    Along(Axis),
    /// The component along that axis.
    Longest,
    /// A row of the shear.
    Row(Axis),
    /// A coordinate of a vertex in the sheared frame, from its edge to the ray's origin.
    Coordinate(Axis, Rounding),
    /// A side's volume as a difference of rounded products, for a first test.
    Rounded(Side),
    /// A side's volume.
    Volume(Side, ProductDifference),
    /// `Va` as the sum of the vertices' depths, each by the volume of the side opposite to it.
    Depths(Rounding),
}

impl Shear {
    /// Every operation.
    pub(crate) fn all() -> impl Iterator<Item = Shear> {
        let along = Axis::ALL.map(Shear::Along);
        let rows = Axis::ALL.map(Shear::Row);
        let coordinates = Axis::ALL
            .into_iter()
            .flat_map(|axis| Rounding::ALL.map(|rounding| Shear::Coordinate(axis, rounding)));
        let rounded = Side::ALL.map(Shear::Rounded);
        let volumes = Side::ALL
            .into_iter()
            .flat_map(|side| ProductDifference::ALL.map(|how| Shear::Volume(side, how)));
        [Shear::Magnitudes, Shear::Longest]
            .into_iter()
            .chain(along)
            .chain(rows)
            .chain(coordinates)
            .chain(rounded)
            .chain(volumes)
            .chain(Rounding::ALL.map(Shear::Depths))
    }

    /// Whether a multiplication is fused with an addition.
    pub(crate) fn is_fused(self) -> bool {
        matches!(
            self,
            Shear::Coordinate(_, Rounding::Fused)
                | Shear::Volume(_, ProductDifference::Kahan)
                | Shear::Depths(Rounding::Fused)
        )
    }

    /// The same where a product cannot be fused with a sum: what Kahan's algorithm adds back is zero then.
    pub(crate) fn unfused(self) -> Shear {
        match self {
            Shear::Coordinate(axis, _) => Shear::Coordinate(axis, Rounding::Each),
            Shear::Volume(side, ProductDifference::Kahan) => {
                Shear::Volume(side, ProductDifference::Rounded)
            }
            Shear::Depths(_) => Shear::Depths(Rounding::Each),
            _ => self,
        }
    }

    /// The arithmetic; operands are numbered as in [`Op::quantity`](crate::Op::quantity).
    pub(crate) fn definition(self) -> Definition {
        use Binary::{Add, Max, Sub};
        match self {
            Shear::Magnitudes => {
                let zero = Expr::Operand(1);
                Definition::Vector([0, 1, 2].map(|axis| {
                    let component = Expr::Component(0, axis);
                    let opposite = binary(Sub, zero.clone(), component.clone());
                    binary(Max, component, opposite)
                }))
            }
            Shear::Along(axis) => Definition::Scalar(is_longest(axis)),
            Shear::Longest => {
                let [x, y] = [0, 1].map(Expr::Operand);
                let [dx, dy, dz] = [0, 1, 2].map(|axis| Expr::Component(2, axis));
                Definition::Scalar(select(x, dx, select(y, dy, dz)))
            }
            Shear::Row(axis) => Definition::Vector([0, 1, 2].map(|of| row(axis, of))),
            Shear::Coordinate(_, rounding) => {
                let factors = [0, 1, 2].map(|axis| [0, 1].map(|one| Expr::Component(one, axis)));
                Definition::Scalar(sum(factors, rounding))
            }
            Shear::Rounded(_) | Shear::Volume(_, ProductDifference::Rounded) => {
                let [a, b, c, d] = [0, 1, 2, 3].map(Expr::Operand);
                Definition::Scalar(binary(Sub, product([a, b]), product([c, d])))
            }
            Shear::Volume(_, ProductDifference::Wide) => {
                let operands = [0, 1, 2, 3].map(Expr::Operand);
                Definition::Scalar(Expr::ExactDifference(Box::new(operands)))
            }
            Shear::Volume(_, ProductDifference::Kahan) => {
                let [a, b, c, d] = [0, 1, 2, 3].map(Expr::Operand);
                let rounded = || Expr::Intermediate;
                let difference = ternary(Ternary::MulSub, [a, b], rounded());
                let lost = ternary(Ternary::NegMulAdd, [c.clone(), d.clone()], rounded());
                Definition::ScalarVia {
                    intermediate: product([c, d]),
                    result: binary(Add, difference, lost),
                }
            }
            Shear::Depths(rounding) => {
                let factors = [0, 1, 2].map(|side| [2 * side, 2 * side + 1].map(Expr::Operand));
                Definition::Scalar(sum(factors, rounding))
            }
        }
    }
}

/// Whether the magnitudes, operand 0, are greatest along an axis.
fn is_longest(axis: Axis) -> Expr {
    use Binary::{AtMost, Both, Less};
    let [x, y, z] = [0, 1, 2].map(|axis| Expr::Component(0, axis));
    let (first, second) = match axis {
        Axis::X => (binary(AtMost, y, x.clone()), binary(AtMost, z, x)),
        Axis::Y => (binary(Less, x, y.clone()), binary(AtMost, z, y)),
        Axis::Z => (binary(Less, x, z.clone()), binary(Less, y, z)),
    };
    binary(Both, first, second)
}

/// The component `of` of a row. Operands 0, 1, 2 say along which axis the direction is longest, 3 is
/// the direction, 4 its longest component, 5 is zero; for the last row 6 is one.
fn row(row: Axis, of: usize) -> Expr {
    use Binary::{Div, Min, Sub};
    let [longest, zero] = [4, 5].map(Expr::Operand);
    let after = |axis: usize, steps: usize| (axis + steps) % 3;
    let opposite = binary(Sub, zero.clone(), longest.clone());
    // The row's own axis is so many after the longest: there the component is ±1.
    let (own, divisor) = match row {
        Axis::X => (1, binary(Min, longest, opposite.clone())),
        Axis::Y => (2, opposite.clone()),
        Axis::Z => {
            let one = Expr::Operand(6);
            let component = select(Expr::Operand(of), one, zero);
            return binary(Div, component, longest);
        }
    };
    let along_ray = Expr::Component(3, after(of, own));
    let along_own = select(Expr::Operand(after(of, 3 - own)), opposite, zero);
    binary(
        Div,
        select(Expr::Operand(of), along_ray, along_own),
        divisor,
    )
}

fn select(mask: Expr, one: Expr, other: Expr) -> Expr {
    Expr::Select(Box::new([mask, one, other]))
}

/// The sum of three products.
fn sum([x, y, z]: [[Expr; 2]; 3], rounding: Rounding) -> Expr {
    match rounding {
        Rounding::Each => {
            let first = binary(Binary::Add, product(x), product(y));
            binary(Binary::Add, first, product(z))
        }
        Rounding::Fused => {
            let first = ternary(Ternary::MulAdd, y, product(x));
            ternary(Ternary::MulAdd, z, first)
        }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(["x", "y", "z"][*self as usize])
    }
}

impl fmt::Display for Shear {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let fused = |rounding| match rounding {
            Rounding::Each => "",
            Rounding::Fused => ".fused",
        };
        match *self {
            Shear::Magnitudes => write!(f, "magnitudes.d"),
            Shear::Along(axis) => write!(f, "along.{axis}"),
            Shear::Longest => write!(f, "longest.d"),
            Shear::Row(axis) => write!(f, "shear.{axis}"),
            Shear::Coordinate(axis, rounding) => write!(f, "sheared.{axis}{}", fused(rounding)),
            Shear::Rounded(side) => write!(f, "rounded.{}", side.volume().name()),
            Shear::Volume(side, difference) => {
                let how = match difference {
                    ProductDifference::Rounded => "rounded",
                    ProductDifference::Wide => "wide",
                    ProductDifference::Kahan => "kahan",
                };
                write!(f, "difference.{}.{how}", side.volume().name())
            }
            Shear::Depths(rounding) => write!(f, "depths.va{}", fused(rounding)),
        }
    }
}

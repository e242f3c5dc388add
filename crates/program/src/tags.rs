//! Tags: what is known of a program from its statements alone, before anything is compiled or run.

use std::ops::RangeInclusive;

use crate::dimension::{Degree, Dimensions};
use crate::op::Op;
use crate::quantity::Quantity;
use crate::rules::Watertight;
use crate::shear::{Axis, Shear};
use crate::statements::Program;

/// What is known of a program from its statements alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tags {
    /// Which rays cannot slip between the triangles of a closed surface, within the safe scales.
    ///
    /// The class whose [rules](crate::Rules) every statement keeps to, with the *x* and *y* of all sheared vertices
    /// rounded alike. The rules are sufficient, and not all of them necessary: a program that breaks
    /// only those against other crosses in `Va` ([`Watertight::Edges`]), or tests
    /// the sides' own volumes by products or quotients with `V`, does not leak at edges either.
    /// What [`Watertight::Full`] adds to sheared volumes is that they are exact in sign. Rounded ones, which are
    /// never of the wrong sign, lose no ray at a vertex, but more rays hit twice there.
    pub watertight: Watertight,
    /// Whether coordinates are used by their differences alone, so that only the rounding of
    /// the scene itself tells where the world's origin is.
    pub translation_safe: bool,
    dimensions: Dimensions,
}

/// Each factor of a number of the scene adds so many bits to what it may be, see [`Tags::safe_scales`].
const FACTOR_BITS: i32 = 5;

/// A rounded product is off by less than this many bits of it less.
const REMAINDER_BITS: i32 = 24;

/// The normal numbers of `f32` are `2^LEAST` or more in magnitude,
const LEAST: i32 = f32::MIN_EXP - 1;

/// and up to twice `2^MOST`.
const MOST: i32 = f32::MAX_EXP - 1;

impl Program {
    /// What its statements say of it, on an instruction set that has fused operations or, if not `fuses`,
    /// rounds products before it adds them.
    ///
    /// ```
    /// use program::{Degree, Watertight, kensler_shirley, moller_trumbore_volumes};
    ///
    /// let graph = kensler_shirley();
    /// let tags = graph.program(&moller_trumbore_volumes(&graph)).unwrap().tags(false);
    /// assert_eq!(tags.watertight, Watertight::No);
    /// assert!(tags.translation_safe);
    /// assert_eq!(tags.safe_scales(Degree::EVERYTHING), -37..=37);
    /// ```
    pub fn tags(&self, fuses: bool) -> Tags {
        let dimensions = Dimensions::of(self);
        let mut classes = [Watertight::Full, Watertight::Edges].into_iter();
        let watertight = classes.find(|&class| !dimensions.are_mixed && self.keeps(class, fuses));
        Tags {
            watertight: watertight.unwrap_or(Watertight::No),
            translation_safe: !dimensions.use_places,
            dimensions,
        }
    }

    /// Whether all statements are of those of a class, and the two coordinates that tell sides apart are those
    /// of one map of all vertices.
    fn keeps(&self, class: Watertight, fuses: bool) -> bool {
        let as_run = |op: Op| if fuses { op } else { op.unfused() };
        let statements: Vec<(Op, Vec<Quantity>)> = self
            .ops_with_operands()
            .map(|(op, operands)| (as_run(op), operands))
            .collect();
        let mut all = statements.iter();
        let is_one_map = [Axis::X, Axis::Y].into_iter().all(|axis| {
            let mut roundings = statements.iter().filter_map(|(op, _)| match op {
                Op::Shear(Shear::Coordinate(of, rounding)) if *of == axis => Some(*rounding),
                _ => None,
            });
            let first = roundings.next();
            roundings.all(|rounding| Some(rounding) == first)
        });
        is_one_map && all.all(|(op, operands)| class.allows(*op, operands))
    }
}

impl Tags {
    /// The exponents `k` for which a scene whose positions are multiplied by `2^(k · weights.positions)`, whose
    /// directions by `2^(k · weights.directions)`, and whose `t_max` by the quotient of the two, gives the
    /// same verdicts, and the same `t` but for that quotient.
    ///
    /// Multiplication by a power of two rounds nothing while numbers stay normal. So this is where
    /// all numbers that the program reads or computes do, which grow with the powers of the
    /// factors that their [`Degree`]s say, if without scaling they are zero or within `2^-5n..2^5n`, a number of
    /// the degrees `i` and `j` having `n = |i| + |j|` factors, up to the sums that make it. So much is
    /// meant for scenes like ordinary triangles, 1 across: rays start at most 20 away, so that edges and
    /// directions are below 2^5; and a volume that has 2^-9 of the triangle's or more, seen at 15 degrees from
    /// half a length away, is above 2^-15.
    ///
    /// What is less, as beside a side, may lose bits by becoming subnormal, but keeps its sign for
    /// another 23 binary orders of magnitude. It is there that rounding has made it what it is. `t_max` may
    /// be anything up to infinity: where its product with `V²` is infinite, it is greater.
    ///
    /// Only `0` if numbers of different degrees are compared or added.
    pub fn safe_scales(&self, weights: Degree) -> RangeInclusive<i32> {
        let Dimensions {
            degrees,
            remainders,
            are_mixed,
            ..
        } = &self.dimensions;
        if *are_mixed {
            return 0..=0;
        }
        let normal = degrees.iter().map(|&degree| (degree, 0));
        let small = remainders.iter().map(|&degree| (degree, REMAINDER_BITS));
        let (mut least, mut most) = (i32::MIN, i32::MAX);
        for (degree, less) in normal.chain(small) {
            let Degree {
                positions,
                directions,
            } = degree;
            let bits = FACTOR_BITS * (positions.abs() + directions.abs());
            let (down, up) = (LEAST + bits + less, MOST - bits);
            let each = positions * weights.positions + directions * weights.directions;
            let (down, up) = match each {
                0 => continue,
                1.. => (down, up),
                _ => (-up, -down),
            };
            least = least.max(down / each.abs());
            most = most.min(up / each.abs());
        }
        least.min(0)..=most.max(0)
    }
}

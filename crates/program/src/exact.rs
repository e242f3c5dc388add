//! Exact numbers to run programs on, and the proof that one program answers like another.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use num_rational::Ratio;
use rand::{Rng, RngExt};
use volumes::Polynomial;

use crate::interpret::{Ray, Real, Triangle};
use crate::listing::Formula;
use crate::op::Op;
use crate::quantity::Quantity;
use crate::statements::Program;

/// A fraction, or nothing where there is none: what is divided by zero, and all that comes of it.
/// Comparisons with nothing are false, as those with NaN are.
///
/// The numerator and the denominator have 127 bits: enough for programs on coordinates of up to
/// eight bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exact(Option<Ratio<i128>>);

impl Exact {
    /// A whole number.
    pub fn whole(number: i32) -> Exact {
        Exact(Some(Ratio::from_integer(number.into())))
    }

    fn both(
        self,
        other: Exact,
        operation: impl FnOnce(Ratio<i128>, Ratio<i128>) -> Ratio<i128>,
    ) -> Exact {
        Exact(self.0.zip(other.0).map(|(a, b)| operation(a, b)))
    }

    /// A number with this sign.
    fn signed(is_negative: bool) -> Exact {
        Exact::whole(if is_negative { -1 } else { 1 })
    }

    fn is_negative(self) -> bool {
        self.0.is_some_and(|number| number < Ratio::from_integer(0))
    }
}

impl From<u8> for Exact {
    fn from(number: u8) -> Exact {
        Exact::whole(number.into())
    }
}

impl PartialOrd for Exact {
    fn partial_cmp(&self, other: &Exact) -> Option<Ordering> {
        let (a, b) = self.0.zip(other.0)?;
        Some(a.cmp(&b))
    }
}

impl Add for Exact {
    type Output = Exact;

    fn add(self, other: Exact) -> Exact {
        self.both(other, |a, b| a + b)
    }
}

impl Sub for Exact {
    type Output = Exact;

    fn sub(self, other: Exact) -> Exact {
        self.both(other, |a, b| a - b)
    }
}

impl Mul for Exact {
    type Output = Exact;

    fn mul(self, other: Exact) -> Exact {
        self.both(other, |a, b| a * b)
    }
}

impl Div for Exact {
    type Output = Exact;

    fn div(self, other: Exact) -> Exact {
        match other.0 {
            Some(divisor) if divisor != Ratio::from_integer(0) => self.both(other, |a, b| a / b),
            _ => Exact(None),
        }
    }
}

impl Neg for Exact {
    type Output = Exact;

    fn neg(self) -> Exact {
        Exact(self.0.map(|number| -number))
    }
}

impl Real for Exact {
    fn mul_add(self, factor: Exact, addend: Exact) -> Exact {
        self * factor + addend
    }

    fn estimate_reciprocal(self) -> Exact {
        Exact::whole(1) / self
    }

    fn sign_is_clear(self) -> bool {
        !self.is_negative()
    }

    fn bit_xor(self, other: Exact) -> Exact {
        Exact::signed(self.is_negative() != other.is_negative())
    }

    fn bit_or(self, other: Exact) -> Exact {
        Exact::signed(self.is_negative() || other.is_negative())
    }

    fn exact_difference(self, b: Exact, c: Exact, d: Exact) -> Exact {
        self * b - c * d
    }
}

/// Why a program does not do what another does.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Difference {
    /// A formula that is not its volume.
    #[error("{0} is not what its formula says")]
    Volume(volumes::Volume),
    /// Other tests, divisions, exits, or others of their operands.
    #[error("the tests are others: {0}")]
    Tests(String),
    /// Another answer to the same ray and triangle.
    #[error("they answer {0:?} and {1:?} to the same ray and triangle: {2}")]
    Answer(Option<Exact>, Option<Exact>, String),
}

/// Coordinates of random inputs are at most so great.
const REACH: i32 = 20;

impl Program {
    /// Proves that a program does what another does: its volumes are equal as polynomials, all
    /// that is done with them is the same in the same order, and it gives the same answers to
    /// `samples` rays and triangles in exact arithmetic, half of them at a tie: through an edge or
    /// a vertex, with the hit at `t_max`, or from a point in the triangle's plane.
    ///
    /// # Errors
    ///
    /// The first [`Difference`].
    pub fn equals(
        &self,
        other: &Program,
        samples: usize,
        rng: &mut impl Rng,
    ) -> Result<(), Difference> {
        for program in [self, other] {
            for (volume, formula) in program.formulas() {
                if polynomial(formula) != Polynomial::of_volume(volume) {
                    return Err(Difference::Volume(volume));
                }
            }
        }
        let (ours, theirs) = (self.structure(), other.structure());
        if let Some(place) =
            (0..ours.len().max(theirs.len())).find(|&i| ours.get(i) != theirs.get(i))
        {
            let line = |lines: &[String]| lines.get(place).cloned().unwrap_or("nothing".into());
            let difference = format!("{}, and {}", line(&ours), line(&theirs));
            return Err(Difference::Tests(difference));
        }
        for sample in 0..samples {
            let (ray, triangle) = match sample % 2 {
                0 => random_input(rng),
                _ => tied_input(rng),
            };
            let [a, b] = [self, other].map(|program| program.run(&ray, &triangle));
            if a != b {
                let input = format!("{ray:?}, {triangle:?}");
                return Err(Difference::Answer(a, b, input));
            }
        }
        Ok(())
    }

    /// What is done with the volumes, in order: the lines of all statements but vectors and
    /// volumes, without what is said of the mask before a test.
    fn structure(&self) -> Vec<String> {
        let lines = self.listing().into_iter().zip(self.quantities());
        let lines = lines.zip(self.statements());
        let lines = lines.filter(|((_, quantity), statement)| {
            !quantity.is_vector()
                && !matches!(quantity, Quantity::Volume(_))
                && !matches!(statement.op, Op::Mask | Op::Zero | Op::One | Op::LoadTMax)
        });
        lines
            .map(|((line, _), _)| line.replace("mask and ", ""))
            .collect()
    }
}

fn polynomial(formula: Formula) -> Polynomial {
    use volumes::Volume;
    let of = Polynomial::of_volume;
    match formula {
        Formula::Product(product) => Polynomial::of_product(product),
        Formula::SumOfSides => &(&of(Volume::V0) + &of(Volume::V1)) + &of(Volume::V2),
        Formula::DifferenceOfEnds => &of(Volume::Va) - &of(Volume::Vb),
        Formula::Rest(side) => {
            let [j, k] = side.others().map(|other| of(other.volume()));
            &(&of(Volume::V) - &j) - &k
        }
    }
}

type Input = (Ray<Exact>, Triangle<Exact>);

fn random_point(rng: &mut impl Rng) -> [i32; 3] {
    std::array::from_fn(|_| rng.random_range(-REACH..=REACH))
}

fn exact(point: [i32; 3]) -> [Exact; 3] {
    point.map(Exact::whole)
}

fn random_input(rng: &mut impl Rng) -> Input {
    let [a, d, p0, p1, p2] = [(); 5].map(|()| exact(random_point(rng)));
    let t_max = Exact::whole(rng.random_range(1..=4)) / Exact::whole(rng.random_range(1..=4));
    (Ray { a, d, t_max }, Triangle { p0, p1, p2 })
}

/// A ray through a point of the triangle's plane with small whole weights, some of them zero. The
/// direction is so long that it gets there at `t = 1 / (w0 + w1 + w2)`, which may be `t_max`; or
/// the ray starts in the plane.
fn tied_input(rng: &mut impl Rng) -> Input {
    let vertices: [[i32; 3]; 3] = std::array::from_fn(|_| random_point(rng));
    let weights: [i32; 3] = std::array::from_fn(|_| rng.random_range(-1..=2));
    let weight = weights.iter().sum::<i32>();
    let weighted = |axis: usize| (0..3).map(|i| weights[i] * vertices[i][axis]).sum::<i32>();
    let target: [i32; 3] = std::array::from_fn(weighted);
    let (a, d) = if rng.random_range(0..4) == 0 {
        // Weights that sum to one: a point of the plane.
        let [p0, p1, p2] = vertices;
        let a = std::array::from_fn(|axis| p0[axis] + weights[1] * (p1[axis] - p2[axis]));
        (a, random_point(rng))
    } else {
        let a = random_point(rng);
        (
            a,
            std::array::from_fn(|axis| target[axis] - weight * a[axis]),
        )
    };
    let hit = Exact::whole(1) / Exact::whole(weight.max(1));
    let t_max = hit * Exact::whole(rng.random_range(1..=2));
    let (a, d) = (exact(a), exact(d));
    let [p0, p1, p2] = vertices.map(exact);
    (Ray { a, d, t_max }, Triangle { p0, p1, p2 })
}

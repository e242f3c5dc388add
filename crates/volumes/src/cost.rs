//! What a subexpression costs in a case: how often it is computed, and what it takes.

use std::fmt;
use std::num::NonZeroU16;

use crate::model::{Model, Operations};
use crate::rate::{Rate, Rates};

/// For whom operations are counted: how often the inputs change, and who shares work.
///
/// Costs are per ray and triangle. Work that is shared weighs one part in as many as share it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Case {
    /// How often the inputs change.
    pub rates: Rates,
    /// The rates at which work is shared, in the order of [`Rate::ALL`].
    pub shared: [bool; Rate::ALL.len()],
    /// How many share it: the rays of a packet, or the triangles that a ray meets.
    pub sharers: NonZeroU16,
    /// Whether what changes with the triangle only is stored with it, and costs nothing but bytes.
    pub stored: bool,
}

impl Case {
    /// Rays alone, which share nothing.
    pub const SINGLE: Self = Self::packet(NonZeroU16::MIN);

    /// Packets of rays that share work on the triangle: all but what changes with the ray.
    pub const fn packet(rays: NonZeroU16) -> Self {
        Self {
            rates: Rates::GENERAL,
            shared: [true, true, true, true, false, false],
            sharers: rays,
            stored: false,
        }
    }

    /// Packets of rays that share work on the triangle and their origin: all work without `d`.
    pub const fn common_origin(rays: NonZeroU16) -> Self {
        Self {
            rates: Rates::COMMON_ORIGIN,
            ..Self::packet(rays)
        }
    }

    /// One ray that meets triangles, which share work on the ray: all but what changes with the
    /// triangle.
    pub const fn triangles(triangles: NonZeroU16) -> Self {
        Self {
            rates: Rates::GENERAL,
            shared: [true, false, true, false, true, false],
            sharers: triangles,
            stored: false,
        }
    }

    /// The weight of an operation at this rate, in units of one part in [`Case::sharers`].
    pub const fn weight(self, rate: Rate) -> u32 {
        if self.stored && self.is_stored(rate) {
            0
        } else if self.shared[rate as usize] {
            1
        } else {
            self.sharers.get() as u32
        }
    }

    /// Whether a value of this rate is known as soon as the triangle is.
    pub const fn is_stored(self, rate: Rate) -> bool {
        matches!(rate, Rate::Constant | Rate::Triangle)
    }

    /// The cost of operations that already have their weight.
    pub fn cost(self, model: &Model, weighted: Operations) -> Cost {
        let loads = model.loads(weighted);
        Cost {
            units: loads.into_iter().max().unwrap_or(0),
            parts: u32::from(self.sharers.get()) * model.parts(),
        }
    }
}

/// Operations, or cycles, per ray and triangle, exactly.
///
/// Shown as a whole number and a rest: `32 + 15/64`.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Cost {
    /// In units of one part.
    pub units: u32,
    /// How many parts one operation has.
    pub parts: u32,
}

impl Cost {
    /// The operations as a number, rounded.
    pub fn operations(self) -> f64 {
        f64::from(self.units) / f64::from(self.parts)
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { units, parts } = *self;
        let text = match (units / parts, units % parts) {
            (whole, 0) => whole.to_string(),
            (0, rest) => format!("{rest}/{parts}"),
            (whole, rest) => format!("{whole} + {rest}/{parts}"),
        };
        f.pad(&text)
    }
}

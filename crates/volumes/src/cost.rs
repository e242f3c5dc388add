//! The cost model of the paper's section 4: what a subexpression costs, and how much it weighs.

use std::fmt;
use std::num::NonZeroU16;

use crate::{Cross, Edge, Rate, Rates, TripleProduct};

/// Operations of an edge: 3 subtractions.
pub const EDGE_OPERATIONS: u32 = 3;

/// Operations of a cross product whose factors are there: 6 multiplications, 3 subtractions.
pub const CROSS_OPERATIONS: u32 = 9;

/// Operations of a triple product whose cross product is there: 3 multiplications, 2 additions.
pub const DOT_OPERATIONS: u32 = 5;

/// For whom operations are counted: how often the inputs change and how many rays share work.
///
/// Costs are per ray and triangle. What changes with the ray weighs 1, all else is shared by a
/// packet and weighs `1 / packet_size`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Case {
    /// How often the inputs change.
    pub rates: Rates,
    /// Rays in a packet.
    pub packet_size: NonZeroU16,
}

impl Case {
    /// Rays alone: packets of one, which share nothing.
    pub const SINGLE: Self = Self {
        rates: Rates::GENERAL,
        packet_size: NonZeroU16::MIN,
    };

    /// Packets of rays that share work on the triangle.
    pub const fn packet(packet_size: NonZeroU16) -> Self {
        Self {
            rates: Rates::GENERAL,
            packet_size,
        }
    }

    /// Packets of rays that share work on the triangle and their origin: all work without `d`.
    pub const fn common_origin(packet_size: NonZeroU16) -> Self {
        Self {
            rates: Rates::COMMON_ORIGIN,
            packet_size,
        }
    }

    /// The weight of an operation at this rate, in units of `1 / packet_size`.
    pub const fn weight(self, rate: Rate) -> u32 {
        if rate.by_ray() {
            self.packet_size.get() as u32
        } else {
            1
        }
    }

    /// What an edge adds to a cost, in units of `1 / packet_size`.
    pub const fn edge_price(self, edge: Edge) -> u32 {
        EDGE_OPERATIONS * self.weight(self.rates.of_edge(edge))
    }

    /// What a cross product adds to a cost beyond its factors, in units of `1 / packet_size`.
    pub const fn cross_price(self, cross: Cross) -> u32 {
        CROSS_OPERATIONS * self.weight(self.rates.of_cross(cross))
    }

    /// What a triple product adds to a cost beyond its cross product and its last factor, in units
    /// of `1 / packet_size`.
    pub const fn dot_price(self, product: TripleProduct) -> u32 {
        DOT_OPERATIONS * self.weight(self.rates.of_product(product))
    }
}

/// Floating-point operations per ray and triangle, exactly.
///
/// Shown as the work of each ray and that of the packet: `32 + 15/64`.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Cost {
    /// Operations in units of `1 / packet_size`.
    pub units: u32,
    /// Rays in a packet.
    pub packet_size: NonZeroU16,
}

impl Cost {
    /// The operations as a number, rounded.
    pub fn operations(self) -> f64 {
        f64::from(self.units) / f64::from(self.packet_size.get())
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = u32::from(self.packet_size.get());
        let text = match (self.units / size, self.units % size) {
            (whole, 0) => whole.to_string(),
            (0, rest) => format!("{rest}/{size}"),
            (whole, rest) => format!("{whole} + {rest}/{size}"),
        };
        f.pad(&text)
    }
}

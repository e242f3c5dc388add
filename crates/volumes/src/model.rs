//! Cost models: how many operations an expression takes, and what so many cost.

use std::fmt;
use std::ops::{Add, AddAssign, Mul};
use std::str::FromStr;

/// A kind of operation that a processor has a throughput for.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Kind {
    /// A multiplication.
    Multiply,
    /// An addition or a subtraction.
    Add,
    /// A multiplication with the addition behind it, rounded once.
    Fused,
    /// A division, or an estimate of a reciprocal.
    Divide,
    /// A comparison, a minimum, or an operation on bits or masks.
    Test,
}

impl Kind {
    /// The kinds, in ascending order.
    pub const ALL: [Self; 5] = [
        Self::Multiply,
        Self::Add,
        Self::Fused,
        Self::Divide,
        Self::Test,
    ];

    /// The word for it in a table of ports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Multiply => "mul",
            Self::Add => "add",
            Self::Fused => "fma",
            Self::Divide => "div",
            Self::Test => "test",
        }
    }
}

/// How many operations of each kind.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct Operations {
    /// By kind, in the order of [`Kind::ALL`].
    pub counts: [u32; Kind::ALL.len()],
}

impl Operations {
    /// Of one kind.
    pub const fn of(kind: Kind, count: u32) -> Self {
        let mut counts = [0; Kind::ALL.len()];
        counts[kind as usize] = count;
        Self { counts }
    }

    /// How many there are of a kind.
    pub const fn count(self, kind: Kind) -> u32 {
        self.counts[kind as usize]
    }

    /// How many there are of all kinds.
    pub fn total(self) -> u32 {
        self.counts.iter().sum()
    }
}

impl Add for Operations {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            counts: std::array::from_fn(|kind| self.counts[kind] + other.counts[kind]),
        }
    }
}

impl AddAssign for Operations {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Mul<u32> for Operations {
    type Output = Self;

    fn mul(self, factor: u32) -> Self {
        Self {
            counts: self.counts.map(|count| count * factor),
        }
    }
}

/// Part of a processor that does operations of some kinds.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Port {
    /// The kinds, in the order of [`Kind::ALL`].
    pub takes: [bool; Kind::ALL.len()],
    /// How many it does in so many cycles: `(2, 1)` are two a cycle, `(1, 5)` one in five.
    pub throughput: (u32, u32),
}

/// The most ports that a model has.
pub const MAX_PORTS: usize = 8;

/// What a model's ports may do in a cycle, or how many cycles one operation may take.
const MAX_THROUGHPUT: u32 = 16;

/// What vectors and volumes take, and what operations cost: as much as the port that is longest at
/// work with them.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Model {
    /// Operations of a difference of points.
    pub edge: Operations,
    /// Operations of a cross product whose factors are there.
    pub cross: Operations,
    /// Operations of a triple product whose cross product is there.
    pub dot: Operations,
    /// Whether a multiplication and the addition behind it are one operation.
    pub fused: bool,
    /// At least one and at most [`MAX_PORTS`].
    ports: Vec<Port>,
}

/// A table of ports that cannot be read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum BadPorts {
    /// An entry that is not of the form `mul+add=2` or `div=1/5`.
    Entry(String),
    /// More than [`MAX_PORTS`] entries.
    Many,
}

impl std::error::Error for BadPorts {}

impl fmt::Display for BadPorts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Entry(entry) => write!(
                f,
                "{entry:?} does not say what a port does in a cycle; write kinds ({}) and a number \
                 up to {MAX_THROUGHPUT}, like mul+add=2 or div=1/5",
                Kind::ALL.map(Kind::name).join(", ")
            ),
            Self::Many => write!(f, "more than {MAX_PORTS} ports"),
        }
    }
}

impl Model {
    /// The paper's: every operation counts one.
    pub fn paper() -> Self {
        Self::new(false, vec![Port::ANYTHING])
    }

    /// The same, where a multiplication and the addition behind it are one operation.
    pub fn fma() -> Self {
        Self::new(true, vec![Port::ANYTHING])
    }

    /// Cycles on ports: fused multiplications and additions if one of the ports takes them.
    ///
    /// # Panics
    ///
    /// If there are none or more than [`MAX_PORTS`].
    pub fn ports(ports: Vec<Port>) -> Self {
        let fused = ports.iter().any(|port| port.takes[Kind::Fused as usize]);
        Self::new(fused, ports)
    }

    fn new(fused: bool, ports: Vec<Port>) -> Self {
        assert!((1..=MAX_PORTS).contains(&ports.len()), "a port or some");
        let of = Operations::of;
        let (cross, dot) = if fused {
            (
                of(Kind::Multiply, 3) + of(Kind::Fused, 3),
                of(Kind::Multiply, 1) + of(Kind::Fused, 2),
            )
        } else {
            (
                of(Kind::Multiply, 6) + of(Kind::Add, 3),
                of(Kind::Multiply, 3) + of(Kind::Add, 2),
            )
        };
        Self {
            edge: of(Kind::Add, 3),
            cross,
            dot,
            fused,
            ports,
        }
    }

    /// How many ports there are.
    pub(crate) const fn port_count(&self) -> usize {
        self.ports.len()
    }

    /// Into how many parts a cycle, or an operation of the paper's model, is divided so that all
    /// costs are whole numbers.
    pub fn parts(&self) -> u32 {
        let numerators = self.ports.iter().map(|port| port.throughput.0);
        numerators.fold(1, lcm)
    }

    /// For how many parts each port is at work.
    pub fn loads(&self, operations: Operations) -> [u32; MAX_PORTS] {
        let parts = self.parts();
        let mut loads = [0; MAX_PORTS];
        for (load, port) in loads.iter_mut().zip(&self.ports) {
            let taken = std::iter::zip(operations.counts, port.takes);
            let count: u32 = taken.map(|(count, takes)| count * u32::from(takes)).sum();
            *load = count * port.throughput.1 * (parts / port.throughput.0);
        }
        loads
    }
}

impl Port {
    /// One operation of any kind a cycle.
    pub const ANYTHING: Self = Self {
        takes: [true; Kind::ALL.len()],
        throughput: (1, 1),
    };
}

impl FromStr for Port {
    type Err = BadPorts;

    fn from_str(entry: &str) -> Result<Self, BadPorts> {
        let bad = || BadPorts::Entry(entry.chars().take(40).collect());
        let (kinds, throughput) = entry.split_once('=').ok_or_else(bad)?;
        let mut takes = [false; Kind::ALL.len()];
        for name in kinds.split('+') {
            let kind = Kind::ALL.into_iter().find(|kind| kind.name() == name);
            takes[kind.ok_or_else(bad)? as usize] = true;
        }
        let number = |text: &str| match text.parse() {
            Ok(number @ 1..=MAX_THROUGHPUT) => Ok(number),
            _ => Err(bad()),
        };
        let (count, cycles) = throughput.split_once('/').unwrap_or((throughput, "1"));
        Ok(Self {
            takes,
            throughput: (number(count)?, number(cycles)?),
        })
    }
}

/// Reads a table of ports: `mul=2,add=2` are two multiplications and two additions a cycle.
///
/// # Errors
///
/// [`BadPorts`] names the first entry that is none.
pub fn read_ports(table: &str) -> Result<Vec<Port>, BadPorts> {
    let ports: Vec<Port> = table.split(',').map(str::parse).collect::<Result<_, _>>()?;
    if ports.len() > MAX_PORTS {
        return Err(BadPorts::Many);
    }
    Ok(ports)
}

fn lcm(a: u32, b: u32) -> u32 {
    let (mut divisor, mut rest) = (a, b);
    while rest > 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    a / divisor * b
}

//! How a batch of kernels is timed.

use std::ops::Range;

use crate::judge::Look;
use crate::protocol::Race;

/// How kernels are timed.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The packets of each round.
    pub rounds: Vec<Range<usize>>,
    /// Each kernel in a library of its own, so that its place among others plays no part.
    pub separate: bool,
    /// Whom kernels race against, so that no more is timed than must be.
    pub race: Option<Race>,
    /// How many kernels race, the first ones. The others are timed to the end.
    pub racers: usize,
    /// How many cores may time at once. There may be fewer.
    pub cores: usize,
    /// What each of them gets.
    pub deal: Deal,
    /// Whether the reference takes part as a kernel like others, which shows what difference
    /// between equals is due to noise. It is timed against a copy of its code at another place in memory.
    pub noise_floor: bool,
    /// Whether kernels that are still in the race at its end are run with stack and packets at every place of a page, for
    /// the worst [memory layout](crate::Sweep).
    pub sweep: bool,
    /// By which rays the accuracy lab tries kernels before they are timed: a [`Trial`](accuracy::Trial), whose
    /// outcome is in their [`Accuracy`](crate::Accuracy).
    pub trial: Option<Look>,
}

impl Plan {
    /// So many rounds of everybody on one core.
    pub(crate) fn once(rounds: Vec<Range<usize>>) -> Plan {
        Plan {
            rounds,
            separate: true,
            race: None,
            racers: 0,
            cores: 1,
            deal: Deal::Kernels,
            noise_floor: false,
            sweep: false,
            trial: None,
        }
    }
}

/// What every core gets, beside a reference of its own.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Deal {
    /// Some of the kernels, in all rounds.
    Kernels,
    /// All kernels, in some of the rounds, so that those that are compared in a round run on one
    /// core. There are no races then.
    Rounds,
}

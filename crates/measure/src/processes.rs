//! Processes in which everything is slow: a worker may be so for its whole life, by where the system has put its stack.
//!
//! How fast the reference is in fresh processes is measured once. A worker in which it is slower by more than [`LIMIT`]
//! is replaced by a fresh one, and what it timed is timed again. If the reference is as slow there, it is the machine
//! that has become slow, and what was timed is believed.

use std::collections::BTreeMap;
use std::ops::{Add, AddAssign};

use serde::{Deserialize, Serialize};

use crate::statistics::median;

/// How many times as slow as before the reference is in a process that is not believed.
pub const LIMIT: f64 = 1.25;

/// How much of the last batch there is in what is expected of the next, if it was slower and if it was faster: what is
/// slower is doubted for longer.
const NEW: (f64, f64) = (0.25, 0.5);

/// What became of processes in which the reference was slow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Processes {
    /// Those that were replaced by a fresh one, in which it was as fast as before; what they had timed was not believed.
    pub replaced: u64,
    /// Those that were replaced by one in which it was as slow: the machine had become slow, and was believed.
    pub slowed: u64,
}

impl Add for Processes {
    type Output = Processes;

    fn add(self, other: Processes) -> Processes {
        Processes {
            replaced: self.replaced + other.replaced,
            slowed: self.slowed + other.slowed,
        }
    }
}

impl AddAssign for Processes {
    fn add_assign(&mut self, other: Processes) {
        *self = *self + other;
    }
}

/// How fast the reference is in fresh processes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Calibration {
    /// Millions of tests a second, by the first packet of a round: of several processes the middle one's.
    speeds: BTreeMap<usize, f64>,
}

impl Calibration {
    /// Of what the reference had in each of some processes.
    pub fn of(processes: &[Vec<(usize, f64)>]) -> Calibration {
        let mut of_packets: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for of_process in processes {
            for &(packet, speed) in of_process {
                of_packets.entry(packet).or_default().push(speed);
            }
        }
        let speeds = of_packets
            .into_iter()
            .map(|(packet, speeds)| (packet, median(&speeds)))
            .collect();
        Calibration { speeds }
    }

    /// How fast the reference was in a process, as a multiple of that; none if it ran on none of the same packets.
    pub fn state(&self, of_process: &[(usize, f64)]) -> Option<f64> {
        let known = of_process.iter().filter_map(|(packet, speed)| {
            let usual = self.speeds.get(packet)?;
            Some(speed / usual)
        });
        let known: Vec<f64> = known.collect();
        (!known.is_empty()).then(|| median(&known))
    }
}

/// The state of one worker after another on a core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Level(f64);

impl Default for Level {
    /// That of fresh processes.
    fn default() -> Level {
        Level(1.0)
    }
}

impl Level {
    /// Whether a process in this state is not believed.
    pub fn doubts(self, state: f64) -> bool {
        state * LIMIT < self.0
    }

    /// Expects states as this one from now on.
    pub fn follow(&mut self, state: f64) {
        let new = match state < self.0 {
            _ if self.doubts(state) => 1.0,
            true => NEW.0,
            false => NEW.1,
        };
        self.0 += new * (state - self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_is_told_packet_by_packet() {
        let processes = [
            vec![(0, 100.0), (4, 300.0)],
            vec![(0, 110.0), (4, 310.0)],
            // One of three may be bad.
            vec![(0, 40.0), (4, 100.0)],
        ];
        let calibration = Calibration::of(&processes);
        assert_eq!(calibration.state(&[(4, 150.0)]), Some(0.5));
        assert_eq!(
            calibration.state(&[(0, 100.0), (0, 100.0), (4, 30.0)]),
            Some(1.0)
        );
        assert_eq!(calibration.state(&[(9, 1.0)]), None);
        assert_eq!(Calibration::default().state(&[(0, 1.0)]), None);
    }

    #[test]
    fn a_process_is_doubted_that_is_slower_than_those_before_by_the_limit() {
        let mut level = Level::default();
        assert!(level.doubts(0.79) && !level.doubts(0.81));
        // Slowly as may be.
        for _ in 0..40 {
            level.follow(0.85);
        }
        assert!(!level.doubts(0.7) && level.doubts(0.67));
        // What turned out to be the machine is expected at once.
        level.follow(0.3);
        assert!(!level.doubts(0.25));
        level.follow(1.0);
        level.follow(1.0);
        assert!(level.doubts(0.5));
    }
}

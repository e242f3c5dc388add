//! How a search divides the cores. A single population has all of them compile and then all of them time; of several,
//! which take turns, one is compiled on some cores while another is timed on the rest, and no core does both.

use measure::{Machine, timing_cores};

/// How many cores time candidates at once unless somebody says how many: all that can, or half of them.
pub fn timing(islands: usize) -> usize {
    let all = most();
    match islands {
        1 => all,
        _ => (all / 2).max(1),
    }
}

/// How many cores can time candidates at once.
pub fn most() -> usize {
    timing_cores().len().max(1)
}

/// How many cores compile, if so many time.
pub fn compiling(machine: &Machine, islands: usize, timing: usize) -> usize {
    match islands {
        1 => machine.cores,
        _ => machine.cores.saturating_sub(timing).max(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn machine(cores: usize) -> Machine {
        Machine {
            cores,
            ..Machine::here()
        }
    }

    #[test]
    fn a_single_population_has_all_cores_for_everything() {
        assert_eq!(timing(1), most());
        assert_eq!(compiling(&machine(8), 1, 8), 8);
    }

    #[test]
    fn of_several_no_core_compiles_and_times_where_there_are_two() {
        for cores in 2..20 {
            for timing in 1..cores {
                assert_eq!(compiling(&machine(cores), 2, timing) + timing, cores);
            }
        }
        assert_eq!(compiling(&machine(1), 2, 1), 1);
        assert!((1..=most()).contains(&timing(2)));
    }
}

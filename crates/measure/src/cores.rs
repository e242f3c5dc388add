//! The cores that time kernels.

use std::collections::HashSet;
use std::path::Path;

/// Where Linux tells of its processors.
const DEVICES: &str = "/sys/devices";

/// Cores that may time kernels at once, by their numbers, those that the system is least busy with
/// first: one hardware thread of each, since two threads of a core slow each other down, and all
/// of one kind, since a ratio of one kind says little of another.
///
/// Where the system does not say which threads share a core, it is one core; where it does not
/// let a process choose, none.
pub fn timing_cores() -> Vec<usize> {
    let allowed = core_affinity::get_core_ids().unwrap_or_default();
    let allowed: Vec<usize> = allowed.into_iter().map(|core| core.id).collect();
    choose(&allowed, Path::new(DEVICES))
}

fn choose(allowed: &[usize], devices: &Path) -> Vec<usize> {
    let read = |path: String| std::fs::read_to_string(devices.join(path)).ok();
    let efficient = read("cpu_atom/cpus".into()).map_or_else(Vec::new, |list| numbers(&list));
    // Interrupts mostly go to the first ones.
    let mut cores: Vec<usize> = allowed.iter().rev().copied().collect();
    if cores.iter().any(|core| !efficient.contains(core)) {
        cores.retain(|core| !efficient.contains(core));
    }
    let mut taken = HashSet::new();
    cores.retain(|core| {
        let threads = format!("system/cpu/cpu{core}/topology/thread_siblings_list");
        taken.insert(read(threads))
    });
    cores
}

/// The numbers of a list like `0-3,8`.
fn numbers(list: &str) -> Vec<usize> {
    let ranges = list.trim().split(',').filter_map(|range| {
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        Some(first.parse().ok()?..=last.parse().ok()?)
    });
    ranges.flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a Linux says of processors: the threads of each one's core, and which are efficient.
    fn devices(siblings: &[&str], efficient: Option<&str>) -> tempfile::TempDir {
        let devices = tempfile::tempdir().unwrap();
        for (number, siblings) in siblings.iter().enumerate() {
            let topology = format!("system/cpu/cpu{number}/topology");
            let topology = devices.path().join(topology);
            std::fs::create_dir_all(&topology).unwrap();
            std::fs::write(topology.join("thread_siblings_list"), siblings).unwrap();
        }
        if let Some(efficient) = efficient {
            let atoms = devices.path().join("cpu_atom");
            std::fs::create_dir(&atoms).unwrap();
            std::fs::write(atoms.join("cpus"), efficient).unwrap();
        }
        devices
    }

    #[test]
    fn cores_of_one_thread_all_time() {
        let devices = devices(&["0\n", "1\n", "2\n"], None);
        assert_eq!(choose(&[0, 1, 2], devices.path()), [2, 1, 0]);
        assert_eq!(choose(&[0, 2], devices.path()), [2, 0]);
    }

    #[test]
    fn of_two_threads_of_a_core_one_times() {
        let neighbours = devices(&["0-1\n", "0-1\n", "2-3\n", "2-3\n"], None);
        assert_eq!(choose(&[0, 1, 2, 3], neighbours.path()), [3, 1]);
        let apart = devices(&["0,2\n", "1,3\n", "0,2\n", "1,3\n"], None);
        assert_eq!(choose(&[0, 1, 2, 3], apart.path()), [3, 2]);
    }

    #[test]
    fn efficient_cores_time_only_if_there_are_no_others() {
        let devices = devices(&["0-1\n", "0-1\n", "2\n", "3\n"], Some("2-3\n"));
        assert_eq!(choose(&[0, 1, 2, 3], devices.path()), [1]);
        assert_eq!(choose(&[2, 3], devices.path()), [3, 2]);
    }

    #[test]
    fn if_nothing_is_known_one_core_times() {
        let devices = devices(&[], None);
        assert_eq!(choose(&[0, 1, 2, 3], devices.path()), [3]);
        assert!(choose(&[], devices.path()).is_empty());
    }

    #[test]
    fn this_machine_has_a_core_that_times_unless_it_cannot_be_chosen() {
        let allowed = core_affinity::get_core_ids().unwrap_or_default();
        let cores = timing_cores();
        assert_eq!(cores.is_empty(), allowed.is_empty());
        assert!(
            cores
                .iter()
                .all(|id| allowed.iter().any(|one| one.id == *id))
        );
    }
}

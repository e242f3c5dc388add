//! A mailbox knows the last triangles that were tested and no other, and costs no hit.
#![cfg(target_arch = "x86_64")]

use std::collections::{HashSet, VecDeque};

use proptest::collection::vec;
use proptest::prelude::*;
use rivals::Mailbox;
use scene::INITIAL_T;

mod grid;

/// Numbers of which some come again soon, and the one that is never remembered.
fn triangle() -> impl Strategy<Value = u32> {
    prop_oneof![8 => 0u32..40, 1 => any::<u32>(), 1 => Just(u32::MAX)]
}

/// Asks of each number, and compares with a list of the last `N` answers that were no.
fn knows_the_last<const N: usize>(triangles: &[u32]) {
    let mut mailbox = Mailbox::<N>::new();
    let mut last = VecDeque::from([u32::MAX; N]);
    for &triangle in triangles {
        let expected = triangle != u32::MAX && last.contains(&triangle);
        assert_eq!(
            mailbox.has_seen(triangle),
            expected,
            "{triangle} of {last:?}"
        );
        if !expected {
            last.push_back(triangle);
            last.pop_front();
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn it_knows_the_last_numbers_that_were_new_and_no_other(triangles in vec(triangle(), 0..300)) {
        knows_the_last::<0>(&triangles);
        knows_the_last::<4>(&triangles);
        knows_the_last::<8>(&triangles);
        knows_the_last::<12>(&triangles);
        knows_the_last::<32>(&triangles);
    }

    #[test]
    fn it_never_claims_what_it_was_not_asked(
        triangles in vec(triangle(), 0..300),
        clear_at in 0..300_usize,
    ) {
        let (mut mailbox, mut asked) = (Mailbox::<16>::new(), HashSet::new());
        for (place, triangle) in triangles.into_iter().enumerate() {
            if place == clear_at {
                mailbox.clear();
                asked.clear();
            }
            let has_seen = mailbox.has_seen(triangle);
            prop_assert!(!has_seen || asked.contains(&triangle));
            asked.insert(triangle);
        }
    }

    #[test]
    fn the_last_distinct_numbers_are_known_wherever_the_ring_stands(
        before in vec(0u32..100, 0..40),
        first in 100..u32::MAX - 8,
    ) {
        let mut mailbox = Mailbox::<8>::new();
        for triangle in before {
            mailbox.has_seen(triangle);
        }
        for triangle in first..first + 8 {
            mailbox.has_seen(triangle);
        }
        for triangle in first..first + 8 {
            prop_assert!(mailbox.has_seen(triangle));
        }
    }
}

#[test]
fn a_new_one_is_empty_and_a_cleared_one_is_as_new() {
    let mut mailbox = Mailbox::<4>::new();
    for _ in 0..2 {
        for triangle in [0, 1, u32::MAX - 1, u32::MAX] {
            assert!(!mailbox.has_seen(triangle));
        }
        assert!(mailbox.has_seen(0) && !mailbox.has_seen(u32::MAX));
        mailbox.clear();
    }
}

#[test]
fn it_is_a_few_vectors() {
    assert_eq!(size_of::<Mailbox<4>>(), 32);
    assert_eq!(size_of::<Mailbox<8>>(), 48);
    assert_eq!(align_of::<Mailbox<8>>(), 16);
}

#[test]
fn no_mailbox_changes_a_hit_and_the_grid_finds_all() {
    for scene in grid::scenes(16, 4) {
        let mut packets = scene.packets.clone();
        for packet in &mut packets {
            for record in &scene.records {
                grid::test(packet, record);
            }
        }
        let expected = packets.iter().flat_map(|packet| packet.t);
        let hits = expected.clone().filter(|&t| t < INITIAL_T).count();
        assert!(hits > 200, "{}: the test is empty", scene.name);
        for (memory, traced) in grid::traces(&scene) {
            let is_same = expected.clone().map(f32::to_bits).eq(traced.hits);
            assert!(is_same, "{}, {memory}", scene.name);
        }
    }
}

/// A ring need not avoid more if it is larger (Bélády 1969); on these scenes it does. One that holds all
/// triangles forgets none, so it makes the tests of the memory that forgets nothing.
#[test]
fn a_larger_mailbox_avoids_more_until_no_test_is_made_again() {
    for scene in grid::scenes(16, 4) {
        let all = scene.trace(grid::mailbox::<512>).tests;
        assert!(scene.triangles.len() <= 512);
        let tests = grid::traces(&scene).map(|(_, traced)| traced.tests);
        let (mailboxes, ideal) = (&tests[..6], tests[8]);
        assert!(
            mailboxes[0] > 2 * ideal,
            "{}: no leaves share triangles",
            scene.name
        );
        assert!(mailboxes.is_sorted_by(|few, many| few > many), "{tests:?}");
        assert!(tests.iter().all(|&tests| tests >= ideal), "{tests:?}");
        assert_eq!(all, ideal, "{}", scene.name);
    }
}

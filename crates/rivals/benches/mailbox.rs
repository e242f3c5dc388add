//! What a mailbox saves and what it costs: `cargo bench --package rivals --bench mailbox`.
//!
//! For every scene, first what walks make: tests of a packet, the share of tests made again that is avoided,
//! and the time of look-ups and tests over that without a mailbox. Then what one look-up costs.
//!
//! All that is compared runs in turn in every round, and a figure is the median of the rounds' ratios, for
//! machines on which others work, too. The harness is our own since what there is times one after another.

use std::hint::black_box;
use std::slice::from_ref;
use std::time::Instant;

use rivals::methods::shevtsov::{self, Record};
use scene::RayPacket;

#[path = "../tests/grid/mod.rs"]
mod grid;

/// A packet and the triangles that its walk names.
struct Walk {
    packet: RayPacket,
    triangles: Vec<u32>,
}

/// Tests what a memory does not know, for each walk with a new one.
type Run = fn(&[Walk], &[Record]);

/// Mailboxes by their sizes, and hashed ones, as in [`grid::traces`].
const RUNS: [(&str, Run); 8] = [
    ("none", |walks, of| run(walks, of, grid::mailbox::<0>)),
    ("4", |walks, of| run(walks, of, grid::mailbox::<4>)),
    ("8", |walks, of| run(walks, of, grid::mailbox::<8>)),
    ("16", |walks, of| run(walks, of, grid::mailbox::<16>)),
    ("32", |walks, of| run(walks, of, grid::mailbox::<32>)),
    ("64", |walks, of| run(walks, of, grid::mailbox::<64>)),
    ("64, low bits", |walks, of| {
        run(walks, of, grid::hashed::<{ grid::LOW_BITS }>)
    }),
    ("64, hashed", |walks, of| {
        run(walks, of, grid::hashed::<{ grid::GOLDEN }>)
    }),
];

fn main() {
    // Without the flag, which `cargo bench` sets, this is a test.
    let is_timed = std::env::args().any(|argument| argument == "--bench");
    let (quads, tiles, rounds) = if is_timed { (64, 16, 101) } else { (16, 4, 1) };
    for scene in grid::scenes(quads, tiles) {
        let traces = grid::traces(&scene);
        let walks: Vec<Walk> = scene
            .packets
            .iter()
            .map(|packet| walk(&scene, packet))
            .collect();
        let times = ratios(
            &RUNS.map(|(_, run)| (run, &walks[..])),
            &scene.records,
            rounds,
        );
        let (none, ideal) = (traces[0].1.tests, traces[8].1.tests);
        println!(
            "\n{}: {} triangles, {} packets\nmemory              tests  duplicates avoided   time",
            scene.name,
            scene.triangles.len(),
            scene.packets.len(),
        );
        let times = times.into_iter().map(Some).chain([None]);
        for ((memory, traced), time) in traces.iter().zip(times) {
            assert_eq!(traced.hits, traces[0].1.hits, "{memory}");
            let avoided = 100.0 * (none - traced.tests) as f64 / (none - ideal) as f64;
            let time = time.map_or(String::new(), |time| format!("{time:.3}"));
            println!("{memory:<14}{:>11}{avoided:>19.1}%{time:>7}", traced.tests);
        }
        look_ups(&scene, rounds);
    }
}

/// Prints what it costs to ask of a number that is new, and of one that was the last, in tests of a packet.
fn look_ups(scene: &grid::Scene, rounds: usize) {
    // The middle of the picture.
    let packet = &scene.packets[scene.packets.len() * 33 / 64];
    let numbers = 0..scene.triangles.len() as u32;
    let once = [Walk {
        packet: packet.clone(),
        triangles: numbers.clone().collect(),
    }];
    let twice = [Walk {
        packet: packet.clone(),
        triangles: numbers.flat_map(|number| [number; 2]).collect(),
    }];
    let (none, others) = RUNS.split_first().expect("there are several");
    let each = |&(_, run): &(_, Run)| [(run, &once[..]), (run, &twice[..])];
    let cases: Vec<_> = others.iter().flat_map(each).collect();
    let cases = [&[(none.1, &once[..])], &cases[..]].concat();
    let times = ratios(&cases, &scene.records, rounds);
    println!("memory            new, of a test   known");
    for ((memory, _), time) in others.iter().zip(times[1..].as_chunks().0) {
        let [once, twice] = time;
        let (new, known) = (100.0 * (once - 1.0), 100.0 * (twice - once));
        println!("{memory:<14}{new:>17.1}%{known:>7.1}%");
    }
}

/// The triangles that a packet's walk names.
fn walk(scene: &grid::Scene, packet: &RayPacket) -> Walk {
    let mut triangles = Vec::new();
    scene.walk(&mut packet.clone(), |packet, triangle| {
        triangles.push(triangle);
        grid::test(packet, &scene.records[triangle as usize]);
    });
    Walk {
        packet: packet.clone(),
        triangles,
    }
}

/// Walks once more, with Shevtsov's own order of tests.
fn run<Seen: FnMut(u32) -> bool>(walks: &[Walk], records: &[Record], memory: fn() -> Seen) {
    for walk in walks {
        let (mut packet, mut has_seen) = (walk.packet.clone(), memory());
        for &triangle in &walk.triangles {
            if !has_seen(triangle) {
                test(&mut packet, &records[triangle as usize]);
            }
        }
        black_box(&packet.t);
    }
}

/// The same machine code for all: taken into each `run`, it differed by more than a look-up costs.
#[inline(never)]
fn test(packet: &mut RayPacket, record: &Record) {
    // SAFETY: every x86-64 CPU has SSE2.
    unsafe { shevtsov::packet::<64, false>(packet, from_ref(record)) }
}

/// The time of each case over that of the first.
fn ratios(cases: &[(Run, &[Walk])], records: &[Record], rounds: usize) -> Vec<f64> {
    let mut rounds: Vec<Vec<f64>> = (0..rounds)
        .map(|round| {
            let mut times = vec![0.0; cases.len()];
            for place in 0..cases.len() {
                // Another one begins each round.
                let case = (place + round) % cases.len();
                let (run, walks) = cases[case];
                let start = Instant::now();
                run(black_box(walks), records);
                times[case] = start.elapsed().as_secs_f64();
            }
            times.iter().map(|time| time / times[0]).collect()
        })
        .collect();
    let median = |case: usize| {
        rounds.sort_by(|a, b| a[case].total_cmp(&b[case]));
        rounds[rounds.len() / 2][case]
    };
    (0..cases.len()).map(median).collect()
}

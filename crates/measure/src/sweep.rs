//! How a kernel's time depends on where things lie in memory: one of them is moved at a time, over a whole page.

use std::time::Instant;

use scene::{DEPTHS, LEAF_TRIANGLES, Workload};

use crate::memory_layout::{MemoryLayout, Sweep};
use crate::placed::LINES;
use crate::statistics::median;
use crate::track::{Numbered, Track};

/// How often a kernel runs in every layout. The least time counts: all else is the machine's.
const PASSES: usize = 3;

/// How often it runs again where it looks slow.
const AGAIN: usize = 12;

/// How many times as slow as usual a kernel looks where it runs again.
const SLOW: f64 = 1.1;

/// Seconds that a sweep of slow kernels may take, about; they leave out depths.
const LONG: f64 = 3e-3;

/// Sweeps a kernel, which tests one list of eight triangles with each ray of the packets from this one on.
pub(crate) fn sweep(workload: &Workload, kernel: Numbered, packet: usize) -> Sweep {
    let together = kernel.loaded.together();
    let packets = packet..(packet + together).min(workload.packets.len());
    let leaf = &workload.triangles[..LEAF_TRIANGLES.min(workload.triangles.len())];
    let lists = std::iter::once(leaf);
    let mut track = Track::new(workload, lists, &[kernel], together);
    let mut seconds = |at: MemoryLayout, passes: usize| {
        let time = |_| {
            let (seconds, _) = track.run(kernel, at, &packets, |run| {
                let start = Instant::now();
                run();
                start.elapsed().as_secs_f64()
            });
            seconds
        };
        (0..passes).map(time).fold(f64::INFINITY, f64::min)
    };
    // The first run is no measure of anything.
    seconds(MemoryLayout::default(), 1);
    let once = seconds(MemoryLayout::default(), PASSES).max(f64::MIN_POSITIVE);
    let all = once * (PASSES * DEPTHS) as f64;
    let step = ((all / LONG).ceil() as usize).clamp(1, DEPTHS / LINES);
    let depths = (0..DEPTHS).step_by(step).map(|depth| MemoryLayout {
        depth,
        ..MemoryLayout::default()
    });
    let rays = (0..LINES).map(|rays| MemoryLayout {
        rays,
        ..MemoryLayout::default()
    });
    let hits = (0..LINES).map(|hits| MemoryLayout {
        hits,
        ..MemoryLayout::default()
    });
    let layouts: [Vec<MemoryLayout>; 3] = [depths.collect(), rays.collect(), hits.collect()];
    let mut least: [Vec<f64>; 3] = layouts.each_ref().map(|of| vec![f64::INFINITY; of.len()]);
    // All are passed through before any is again, so that no moment of the machine is a layout's.
    for _ in 0..PASSES {
        for (layouts, least) in layouts.iter().zip(&mut least) {
            for (&at, least) in layouts.iter().zip(least) {
                *least = least.min(seconds(at, 1));
            }
        }
    }
    let usual = median(&least.concat()).max(f64::MIN_POSITIVE);
    for (layouts, least) in layouts.iter().zip(&mut least) {
        for (&at, least) in layouts.iter().zip(least) {
            if *least > SLOW * usual {
                *least = least.min(seconds(at, AGAIN));
            }
            // A thousandth is less than any of it is sure of.
            *least = (*least / usual * 1e3).round() / 1e3;
        }
    }
    let [depths, rays, hits] = least;
    Sweep { depths, rays, hits }
}

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

/// Sweeps a kernel, which tests one list of eight triangles with each ray of the packets from about this one on; gives
/// nothing if there are not as many packets as it takes at once.
pub(crate) fn sweep(workload: &Workload, kernel: Numbered, packet: usize) -> Sweep {
    let together = kernel.loaded.together();
    let Some(last) = workload.packets.len().checked_sub(together) else {
        return Sweep::default();
    };
    let first = packet.min(last);
    let packets = first..first + together;
    let leaf = &workload.triangles[..LEAF_TRIANGLES.min(workload.triangles.len())];
    let lists = std::iter::once(leaf);
    let mut track = Track::new(workload, lists, &[kernel], together);
    let mut seconds = |at: MemoryLayout, runs: usize| {
        let time = |_| {
            let (seconds, _) = track.run(kernel, at, &packets, |run| {
                let start = Instant::now();
                run();
                start.elapsed().as_secs_f64()
            });
            seconds
        };
        (0..runs).map(time).fold(f64::INFINITY, f64::min)
    };
    // The first run is no measure of anything.
    seconds(MemoryLayout::default(), 1);
    let once = seconds(MemoryLayout::default(), PASSES).max(f64::MIN_POSITIVE);
    let all = once * (PASSES * DEPTHS) as f64;
    let step = ((all / LONG).ceil() as usize).clamp(1, DEPTHS / LINES);
    let depths: Vec<MemoryLayout> = (0..DEPTHS)
        .step_by(step)
        .map(|depth| MemoryLayout {
            depth,
            ..MemoryLayout::default()
        })
        .collect();
    let times = least(&depths, &mut seconds);
    // Usual is what most depths take. All else is moved at a depth that is so: were it a slow one, all of its layouts
    // were slow, and would pass for usual.
    let usual = median(&times).max(f64::MIN_POSITIVE);
    let distance = |place: &usize| (times[*place] - usual).abs();
    let places = 0..depths.len();
    let place = places.min_by(|one, other| distance(one).total_cmp(&distance(other)));
    let at = depths[place.expect("there are depths")];
    let rays: Vec<MemoryLayout> = (0..LINES).map(|rays| MemoryLayout { rays, ..at }).collect();
    let hits: Vec<MemoryLayout> = (0..LINES).map(|hits| MemoryLayout { hits, ..at }).collect();
    let [of_rays, of_hits] = [&rays, &hits].map(|layouts| least(layouts, &mut seconds));
    let mut relative = |layouts: &[MemoryLayout], times: Vec<f64>| -> Vec<f64> {
        let again = layouts.iter().zip(times).map(|(&at, time)| {
            let time = match time > SLOW * usual {
                true => time.min(seconds(at, AGAIN)),
                false => time,
            };
            // A thousandth is less than any of it is sure of.
            (time / usual * 1e3).round() / 1e3
        });
        again.collect()
    };
    Sweep {
        depths: relative(&depths, times),
        rays: relative(&rays, of_rays),
        hits: relative(&hits, of_hits),
    }
}

/// The least time of some passes in each layout. All layouts are passed through before any is again, so that no moment
/// of the machine is a layout's.
fn least(
    layouts: &[MemoryLayout],
    seconds: &mut impl FnMut(MemoryLayout, usize) -> f64,
) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; layouts.len()];
    for _ in 0..PASSES {
        for (&at, least) in layouts.iter().zip(&mut least) {
            *least = least.min(seconds(at, 1));
        }
    }
    least
}

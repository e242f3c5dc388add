//! A chosen depth of the stack: it decides which of a kernel's values straddle a line of the cache, or a page.

use std::hint::black_box;
use std::mem::MaybeUninit;

/// Bytes from one depth to the next: what the ABIs of x86-64 and aarch64 align frames to.
pub const DEPTH_STEP: usize = 16;

/// Depths that there are in a page of 4096 bytes. Deeper ones are the same again.
pub const DEPTHS: usize = 4096 / DEPTH_STEP;

/// Runs `run` with its frame at a chosen place in a page of memory: place `depth`, of [`DEPTHS`], is `depth` times
/// [`DEPTH_STEP`] below place 0. Neither the caller's own depth nor the address of the stack changes that.
pub fn at_depth<T>(depth: usize, run: impl FnOnce() -> T) -> T {
    let mut run = Some(run);
    let mut result = None;
    at_place(depth, &mut || {
        let run = run.take().expect("called once");
        result = Some(run());
    });
    result.expect("it was called")
}

/// Goes down to the place from wherever this frame is.
#[inline(never)]
fn at_place(depth: usize, run: &mut dyn FnMut()) {
    let here = MaybeUninit::<Step>::uninit();
    let above = black_box(&raw const here).addr() / DEPTH_STEP;
    below((above + depth) % DEPTHS, 0, run);
}

/// A frame for each bit of the depth, larger by that if it is set; then `run`.
#[inline(never)]
fn below(depth: usize, bit: usize, run: &mut dyn FnMut()) {
    const FRAMES: [[Frame; 2]; DEPTHS.ilog2() as usize] = [
        [frame::<0>, frame::<1>],
        [frame::<0>, frame::<2>],
        [frame::<0>, frame::<4>],
        [frame::<0>, frame::<8>],
        [frame::<0>, frame::<16>],
        [frame::<0>, frame::<32>],
        [frame::<0>, frame::<64>],
        [frame::<0>, frame::<128>],
    ];
    match FRAMES.get(bit) {
        Some(frames) => frames[depth >> bit & 1](depth, bit + 1, run),
        None => run(),
    }
}

type Step = MaybeUninit<[u8; DEPTH_STEP]>;

type Frame = fn(usize, usize, &mut dyn FnMut());

/// A frame with room for so many steps.
#[inline(never)]
fn frame<const STEPS: usize>(depth: usize, bit: usize, run: &mut dyn FnMut()) {
    // One step in any case: a frame with a variable differs from one without by more than its size.
    let mut room = ([Step::uninit(); STEPS], Step::uninit());
    black_box(&mut room);
    below(depth, bit, run);
    // Needed until here, so the call before is no jump.
    black_box(&mut room);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a variable of the function lies.
    #[inline(never)]
    fn place() -> usize {
        let here = 0_u8;
        black_box(&raw const here).addr()
    }

    /// Calls with a frame of its own above.
    #[inline(never)]
    fn from_below<const ROOM: usize>(depth: usize) -> usize {
        let mut room = [0_u8; ROOM];
        black_box(&mut room);
        let there = at_depth(depth, place);
        black_box(&mut room);
        there
    }

    #[test]
    fn each_depth_is_a_step_below_the_one_before_from_every_caller() {
        let first = at_depth(0, place) % 4096;
        for depth in 0..2 * DEPTHS {
            let expected = (first + 4096 - depth % DEPTHS * DEPTH_STEP) % 4096;
            let callers = [from_below::<16>, from_below::<80>, from_below::<1008>];
            for caller in callers {
                assert_eq!(caller(depth) % 4096, expected, "depth {depth}");
            }
        }
    }

    #[test]
    fn what_is_run_gives_its_result() {
        assert_eq!(at_depth(77, || "result"), "result");
    }
}

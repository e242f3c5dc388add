//! A chosen depth of the stack: it decides which of a kernel's values straddle a line of the cache, or a page.

use std::hint::black_box;
use std::mem::MaybeUninit;

/// Bytes from one depth to the next: what the ABIs of x86-64 and aarch64 align frames to.
pub const DEPTH_STEP: usize = 16;

/// Depths that there are in a page of 4096 bytes. Deeper ones are the same again.
pub const DEPTHS: usize = 4096 / DEPTH_STEP;

/// Runs `run` with its frame deeper by `depth` times [`DEPTH_STEP`] than with a depth of zero, called from the same
/// place. Depths repeat after [`DEPTHS`].
pub fn at_depth<T>(depth: usize, run: impl FnOnce() -> T) -> T {
    let mut run = Some(run);
    let mut result = None;
    below(depth % DEPTHS, 0, &mut || {
        let run = run.take().expect("called once");
        result = Some(run());
    });
    result.expect("it was called")
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

    #[test]
    fn each_depth_is_a_step_below_the_one_before() {
        let depths = || 0..2 * DEPTHS;
        let places: Vec<usize> = depths().map(|depth| at_depth(depth, place)).collect();
        let steps = places.iter().map(|here| places[0] - here);
        assert!(steps.eq(depths().map(|depth| depth % DEPTHS * DEPTH_STEP)));
    }

    #[test]
    fn what_is_run_gives_its_result() {
        assert_eq!(at_depth(77, || "result"), "result");
    }
}

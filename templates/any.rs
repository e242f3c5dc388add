//! Words that are the same for every instruction set: what is done with lanes one by one. They follow
//! those of the set's own template.

/// A number of each ray of a packet, from the beginning of a line of the cache.
#[repr(align(64))]
pub struct OfRays<const N: usize>(pub [f32; N]);

/// A number, read by itself.
///
/// A compiler may read neighbours together. Of numbers that were written one by one, or in other groups, a processor
/// then waits until they have left its store buffer: a ray in whose `t` the last leaf has left a hit, or that was made
/// just now, would cost twice the time of a test.
#[inline]
pub fn read(number: &f32) -> f32 {
    // SAFETY: a reference is valid for reads.
    unsafe { core::ptr::read_volatile(number) }
}

/// The least of numbers, none of them NaN.
#[inline]
pub fn least<const LANES: usize>(mut lanes: [f32; LANES]) -> f32 {
    let mut half = LANES / 2;
    while half > 0 {
        for lane in 0..half {
            let (one, other) = (lanes[lane], lanes[lane + half]);
            lanes[lane] = if other < one { other } else { one };
        }
        half /= 2;
    }
    lanes[0]
}

/// The first lane of those in `among`, one at least, that has the least number.
#[inline]
pub fn first_of_least<const LANES: usize>(numbers: [u32; LANES], mut among: u32) -> usize {
    // The remainder is the lane itself, which a compiler that looks for bounds does not know.
    let mut first = among.trailing_zeros() as usize % LANES;
    // Hardly ever are two lanes equally close.
    while among & among.wrapping_sub(1) != 0 {
        among &= among.wrapping_sub(1);
        let other = among.trailing_zeros() as usize % LANES;
        if numbers[other] < numbers[first] {
            first = other;
        }
    }
    first
}

/// The last lane that has the greatest number.
#[inline]
pub fn last_of_most<const LANES: usize>(numbers: [u32; LANES]) -> usize {
    let mut last = 0;
    for lane in 1..LANES {
        if numbers[lane] >= numbers[last] {
            last = lane;
        }
    }
    last
}

/// The axes in another order, the one along which a direction is longest last; which of the two
/// others is first is such that volumes keep their signs though all are divided by that component.
#[inline]
pub fn axes_along(direction: [f32; 3]) -> [usize; 3] {
    let [x, y, z] = direction.map(f32::abs);
    let last = if y <= x && z <= x {
        0
    } else if z <= y {
        1
    } else {
        2
    };
    // The remainders are what a compiler that looks for bounds does not know.
    let (first, second) = ((last + 1) % 3, (last + 2) % 3);
    if direction[last] < 0.0 {
        [second, first, last]
    } else {
        [first, second, last]
    }
}

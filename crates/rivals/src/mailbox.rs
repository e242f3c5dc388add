//! Which triangles a packet has been tested against lately: what Shevtsov, Soupikov and Kapustin 2007 have
//! instead of mailboxing, "Ray-triangle intersection algorithm for modern CPU architectures", abstract and
//! section 1.
//!
//! A spatial subdivision names a triangle in every leaf that it reaches into, so a packet meets some triangles
//! more than once. Mailboxing stores the last ray with each triangle: memory for every triangle, and of no use
//! to several threads. Theirs is compact, is one vector compare, and belongs to whoever traverses. Their text
//! beyond that is not followed here: the ring, what an empty place holds and the sizes are ours.

/// The numbers of the last `N` triangles that a packet was tested against; `N` is a multiple of 4, the lanes
/// of the narrowest vectors, or 0, which remembers nothing.
///
/// It is good for one packet and one list of triangles, while `t` only shrinks: a test that has been made
/// would find nothing new. What is forgotten is tested again, which costs time and no hit; a triangle that was
/// not tested is never taken for one that was.
///
/// A packet of 64 rays that walks a grid wants 32: fewer forget too early, and to look through them costs a
/// fiftieth of a test (`benches/mailbox.rs`).
///
/// ```
/// let mut mailbox = rivals::Mailbox::<8>::new();
/// let mut leaves = [[3, 5], [5, 7], [3, 7]].concat();
/// leaves.retain(|&triangle| !mailbox.has_seen(triangle));
/// assert_eq!(leaves, [3, 5, 7], "what is to be tested");
/// ```
#[derive(Clone, Debug)]
// The numbers come first, so no vector of them lies in two lines of the cache.
#[repr(C, align(16))]
pub struct Mailbox<const N: usize> {
    numbers: [u32; N],
    /// The place after that of the newest number, up to `N`.
    next: usize,
}

/// What an empty place holds. As a triangle's number it is allowed, but never remembered, so an empty place
/// need not be told from one that holds it.
const EMPTY: u32 = u32::MAX;

impl<const N: usize> Mailbox<N> {
    /// One that has seen nothing.
    pub const fn new() -> Self {
        const { assert!(N.is_multiple_of(4), "vectors are compared whole") };
        Self {
            numbers: [EMPTY; N],
            next: 0,
        }
    }

    /// Whether `triangle` is among the last `N` for which this was false. If not, it is now, in place of the
    /// oldest: the caller is to test it. `u32::MAX` is never among them.
    ///
    /// A number that is recognised does not become newer. So the ring is written to only beside a test.
    #[inline]
    pub fn has_seen(&mut self, triangle: u32) -> bool {
        if N == 0 {
            return false;
        }
        // Without an early exit this becomes vectors, as wide as the caller's instruction set has them: for
        // eight numbers two compares on SSE2, one on AVX2.
        let numbers = self.numbers.iter();
        let is_there = numbers.fold(false, |seen, &number| seen | (number == triangle));
        let has_seen = is_there & (triangle != EMPTY);
        if !has_seen {
            let place = self.next % N;
            self.numbers[place] = triangle;
            self.next = place + 1;
        }
        has_seen
    }

    /// Forgets everything, for the next packet.
    pub fn clear(&mut self) {
        *self = Self::new();
    }
}

impl<const N: usize> Default for Mailbox<N> {
    fn default() -> Self {
        Self::new()
    }
}

//! Values at a chosen line of a page.

use std::mem::MaybeUninit;

/// Bytes of a line of the cache.
const LINE: usize = 64;

/// Bytes of a page.
const PAGE: usize = 4096;

/// Lines in a page.
pub(crate) const LINES: usize = PAGE / LINE;

#[derive(Clone, Copy)]
#[repr(align(64))]
struct Line(#[expect(dead_code, reason = "room")] MaybeUninit<[u8; LINE]>);

/// Room for values that begin at whichever line of a page is wanted.
pub(crate) struct Placed<T> {
    room: Vec<Line>,
    most: usize,
    values: std::marker::PhantomData<T>,
}

impl<T: Clone> Placed<T> {
    /// Room for so many values.
    pub fn new(most: usize) -> Placed<T> {
        const {
            assert!(align_of::<T>() <= LINE && !std::mem::needs_drop::<T>());
        }
        let lines = (most * size_of::<T>()).div_ceil(LINE);
        Placed {
            room: vec![Line(MaybeUninit::uninit()); lines + 2 * LINES],
            most,
            values: std::marker::PhantomData,
        }
    }

    /// Copies of `values` that begin at this line of a page, of which there are [`LINES`].
    ///
    /// # Panics
    ///
    /// If they are more than there is room for.
    pub fn at(&mut self, line: usize, values: &[T]) -> &mut [T] {
        assert!(values.len() <= self.most, "room for all");
        let page = self.room.as_ptr().align_offset(PAGE);
        let first = page.min(LINES) + line % LINES;
        let place = self.room[first..].as_mut_ptr().cast::<MaybeUninit<T>>();
        // SAFETY: there are `most` values' lines from `first` on, which is at most two pages behind the beginning of
        // the room; lines are aligned enough, and nothing else refers to them.
        let place = unsafe { std::slice::from_raw_parts_mut(place, values.len()) };
        for (place, value) in place.iter_mut().zip(values) {
            place.write(value.clone());
        }
        // SAFETY: all of them have just been written.
        unsafe { &mut *(&raw mut *place as *mut [T]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_where_they_are_wanted_and_what_they_were() {
        let values: Vec<[f32; 20]> = (0..7).map(|value| [value as f32; 20]).collect();
        let mut placed = Placed::new(7);
        for line in (0..2 * LINES).rev() {
            let there = placed.at(line, &values);
            assert_eq!(there.as_ptr().addr() % PAGE, line % LINES * LINE);
            assert_eq!(there, values);
        }
        assert!(placed.at(0, &[]).is_empty());
    }
}

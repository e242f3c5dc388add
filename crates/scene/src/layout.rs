//! How triangles lie in memory: what is stored of each, alone or in blocks.

use serde::{Deserialize, Serialize};

use crate::oracle::{cross, sub};
use crate::{Stored, Triangle};

/// What is kept of a triangle for a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Record {
    /// What a scene says: vectors of three numbers.
    Stored(Stored),
    /// What the kernel's own precomputation makes of a triangle.
    Own {
        /// How many numbers that is.
        numbers: usize,
        /// Which precomputation it is: different ones have different numbers here.
        of: u64,
    },
}

/// How a kernel has its triangles in memory. A record is one triangle, or a block of `lanes`: one
/// number after another, and in a block of every number its lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Layout {
    /// What is kept of each triangle.
    pub record: Record,
    /// Triangles in a block; 1 if there are none.
    pub lanes: usize,
}

/// Lists of triangles in a layout.
#[derive(Debug)]
pub struct Lists {
    /// The numbers of all lists from `start` on, and room to begin them at another line of a page.
    numbers: Vec<f32>,
    start: usize,
    /// Of every list the first number after `start`, and the records.
    lists: Vec<(usize, usize)>,
    layout: Layout,
}

/// A list as a kernel takes it.
#[derive(Clone, Copy, Debug)]
pub struct List<'a> {
    /// The numbers of its records, one record after another.
    pub numbers: &'a [f32],
    /// How many records there are.
    pub records: usize,
}

/// Numbers in a line of a cache.
const LINE: usize = 16;

/// Lines in a page of memory.
const PAGE: usize = 64;

impl Layout {
    /// Vertices, one triangle after another: what `[Triangle]` is.
    pub const VERTICES: Layout = Layout {
        record: Record::Stored(Stored::Vertices),
        lanes: 1,
    };

    /// Numbers in a record, or in a block of them.
    pub fn numbers(self) -> usize {
        self.record.numbers() * self.lanes
    }

    /// Lays out lists of triangles, of each what `of` makes of it. Each list is from the beginning of a line of the cache. The last block
    /// of a list is filled up with NaN, which no kernel hits. A triangle without area would not do:
    /// fused products of equal vectors are not zero, so some kernels see a volume there.
    ///
    /// # Panics
    ///
    /// If `of` makes another count of numbers than the record has.
    pub fn lists_of<'a>(
        self,
        lists: impl Iterator<Item = &'a [Triangle]> + Clone,
        mut of: impl FnMut(&Triangle) -> Vec<f32>,
    ) -> Lists {
        let room = |list: &[Triangle]| {
            let numbers = list.len().div_ceil(self.lanes) * self.numbers();
            numbers.next_multiple_of(LINE)
        };
        let length: usize = lists.clone().map(room).sum();
        let mut numbers: Vec<f32> = vec![f32::NAN; length + 2 * PAGE * LINE];
        let first = first_of_page(&numbers);
        let mut start = 0;
        let mut places = Vec::new();
        for list in lists {
            let blocks = list.chunks(self.lanes);
            places.push((start, blocks.len()));
            for (block, place) in blocks.zip((first + start..).step_by(self.numbers())) {
                for (lane, triangle) in block.iter().enumerate() {
                    let of_triangle = of(triangle);
                    assert_eq!(of_triangle.len(), self.record.numbers(), "a whole record");
                    for (number, place) in of_triangle
                        .into_iter()
                        .zip((place + lane..).step_by(self.lanes))
                    {
                        numbers[place] = number;
                    }
                }
            }
            start += room(list);
        }
        Lists {
            numbers,
            start: first,
            lists: places,
            layout: self,
        }
    }
}

/// The first number that begins a page; numbers are at least as many as a page has.
fn first_of_page(numbers: &[f32]) -> usize {
    let page = PAGE * LINE * size_of::<f32>();
    numbers.as_ptr().align_offset(page).min(PAGE * LINE)
}

impl Layout {
    /// Lays out lists of triangles as a scene stores them.
    ///
    /// # Panics
    ///
    /// If the record is a kernel's own.
    pub fn lists<'a>(self, lists: impl Iterator<Item = &'a [Triangle]> + Clone) -> Lists {
        let Record::Stored(stored) = self.record else {
            panic!("only its kernel knows what is in a record of its own");
        };
        self.lists_of(lists, |triangle| stored.of(triangle).concat())
    }
}

impl Record {
    /// Numbers in it.
    pub fn numbers(self) -> usize {
        match self {
            Record::Stored(stored) => 3 * stored.vectors(),
            Record::Own { numbers, .. } => numbers,
        }
    }

    /// Bytes that are kept of a triangle.
    pub fn bytes(self) -> usize {
        size_of::<f32>() * self.numbers()
    }
}

impl Lists {
    /// Every list, in order.
    pub fn iter(&self) -> impl Iterator<Item = List<'_>> + Clone {
        let of_record = self.layout.numbers();
        self.lists.iter().map(move |&(start, records)| List {
            numbers: &self.numbers[self.start + start..][..records * of_record],
            records,
        })
    }

    /// Moves all lists, so that the first one begins at this line of a page, of which there are 64.
    pub fn move_to(&mut self, line: usize) {
        let start = first_of_page(&self.numbers) + line % PAGE * LINE;
        let length = self.numbers.len() - 2 * PAGE * LINE;
        self.numbers
            .copy_within(self.start..self.start + length, start);
        self.start = start;
    }
}

impl Stored {
    /// How many vectors are stored of a triangle.
    pub fn vectors(self) -> usize {
        match self {
            Stored::Vertices | Stored::Edges => 3,
            Stored::VerticesAndNormal | Stored::EdgesAndNormal => 4,
        }
    }

    /// Bytes that are stored of a triangle.
    pub fn bytes(self) -> usize {
        3 * size_of::<f32>() * self.vectors()
    }

    /// The precomputation, in `f32`: edges as differences, the normal as their cross product.
    pub fn of(self, triangle: &Triangle) -> Vec<[f32; 3]> {
        let Triangle { p0, p1, p2 } = *triangle;
        let edges = [sub(p1, p0), sub(p2, p0)];
        let normal = cross(edges[0], edges[1]);
        match self {
            Stored::Vertices => vec![p0, p1, p2],
            Stored::VerticesAndNormal => vec![p0, p1, p2, normal],
            Stored::Edges => vec![p0, edges[0], edges[1]],
            Stored::EdgesAndNormal => vec![p0, edges[0], edges[1], normal],
        }
    }

    /// The name of its type in the kernels' ABI.
    pub fn type_name(self) -> &'static str {
        match self {
            Stored::Vertices => "Triangle",
            Stored::VerticesAndNormal => "TriangleWithNormal",
            Stored::Edges => "Edges",
            Stored::EdgesAndNormal => "EdgesWithNormal",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Generator;

    #[test]
    fn blocks_have_the_lanes_of_a_number_together_and_begin_a_line() {
        let generator = Generator {
            triangles: 20,
            packets: 0,
            ..Generator::default()
        };
        let triangles = generator.generate().triangles;
        for lanes in [1, 4, 8, 16] {
            for &stored in Stored::ALL {
                let layout = Layout {
                    record: Record::Stored(stored),
                    lanes,
                };
                let lists = layout.lists(triangles.chunks(9));
                assert_eq!(lists.iter().count(), 3);
                for (list, triangles) in lists.iter().zip(triangles.chunks(9)) {
                    assert_eq!(list.numbers.as_ptr().align_offset(64), 0);
                    assert_eq!(list.records, triangles.len().div_ceil(lanes));
                    assert_eq!(list.numbers.len(), list.records * layout.numbers());
                    for (place, triangle) in triangles.iter().enumerate() {
                        let (block, lane) = (place / lanes, place % lanes);
                        let block = &list.numbers[block * layout.numbers()..];
                        let expected = stored.of(triangle).concat();
                        let found = (0..expected.len()).map(|number| block[number * lanes + lane]);
                        assert!(found.eq(expected), "{stored}, {lanes} lanes, {place}");
                    }
                }
            }
        }
    }

    #[test]
    fn lists_stay_the_same_wherever_they_are_moved() {
        let generator = Generator {
            triangles: 20,
            packets: 0,
            ..Generator::default()
        };
        let triangles = generator.generate().triangles;
        let layout = Layout {
            lanes: 4,
            ..Layout::VERTICES
        };
        let [mut lists, unmoved] = [0, 1].map(|_| layout.lists(triangles.chunks(9)));
        for line in [63, 0, 17, 64] {
            lists.move_to(line);
            let first = lists.iter().next().unwrap().numbers.as_ptr().addr();
            assert_eq!(first % 4096, line % 64 * 64);
            for (list, unmoved) in lists.iter().zip(unmoved.iter()) {
                let bits = |list: List<'_>| -> Vec<u32> {
                    list.numbers.iter().map(|number| number.to_bits()).collect()
                };
                assert_eq!(bits(list), bits(unmoved), "line {line}");
            }
        }
    }

    #[test]
    fn a_block_is_filled_up_with_what_nothing_hits() {
        let triangle = Triangle {
            p0: [1.0; 3],
            p1: [2.0; 3],
            p2: [3.0; 3],
        };
        let layout = Layout {
            lanes: 4,
            ..Layout::VERTICES
        };
        let lists = layout.lists([&[triangle][..]].into_iter());
        let list = lists.iter().next().unwrap();
        let filled = list.numbers.iter().filter(|number| !number.is_nan());
        assert_eq!((filled.count(), list.numbers.len()), (9, 36));
    }
}

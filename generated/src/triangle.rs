//! What rays are tested against: triangles, one by one or in blocks, by what is stored of them.

use robust::{Coord, orient2d};

/// A triangle by its vertices, 36 bytes.
///
/// With arrays for numbers it is a block of `W` triangles, one array a component: see [`Block`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Triangle<T = f32> {
    /// First vertex.
    pub p0: [T; 3],
    /// Second vertex.
    pub p1: [T; 3],
    /// Third vertex.
    pub p2: [T; 3],
}

/// A triangle by its vertices and its normal, 48 bytes: for scenes that report normals, and for rays one by one,
/// which it may save a cross product for every triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct TriangleWithNormal<T = f32> {
    /// First vertex.
    pub p0: [T; 3],
    /// Second vertex.
    pub p1: [T; 3],
    /// Third vertex.
    pub p2: [T; 3],
    /// `(p1-p0) × (p2-p0)`. Whether a ray hits goes by it.
    pub normal: [T; 3],
}

/// A triangle by a vertex and two edges, 36 bytes.
///
/// The other two vertices are computed, so triangles that share them may be a rounding apart: no scene that is
/// watertight takes these.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Edges<T = f32> {
    /// First vertex.
    pub p0: [T; 3],
    /// `p1-p0`.
    pub edge1: [T; 3],
    /// `p2-p0`.
    pub edge2: [T; 3],
}

/// A triangle by a vertex, two edges and its normal, 48 bytes. What is said of [`Edges`] holds here, too.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct EdgesWithNormal<T = f32> {
    /// First vertex.
    pub p0: [T; 3],
    /// `p1-p0`.
    pub edge1: [T; 3],
    /// `p2-p0`.
    pub edge2: [T; 3],
    /// `edge1 × edge2`. Whether a ray hits goes by it.
    pub normal: [T; 3],
}

/// `W` triangles for one ray, one array a component: 4, 8 and 16 are the widths of vectors.
///
/// A block takes as long half full as full. So `W` is rather what a leaf holds than what the processor has: for leaves
/// of up to eight triangles, `Block<8>` is faster than `Block<16>` on AVX-512, too.
pub type Block<const W: usize> = Triangle<[f32; W]>;

impl Triangle {
    /// A triangle by its vertices.
    pub fn new(
        p0: impl Into<[f32; 3]>,
        p1: impl Into<[f32; 3]>,
        p2: impl Into<[f32; 3]>,
    ) -> Triangle {
        Triangle {
            p0: p0.into(),
            p1: p1.into(),
            p2: p2.into(),
        }
    }
}

/// Whether a triangle, as it is stored, has no area: its vertices are on a line, or not three. Rounding might give such
/// a triangle a volume.
#[inline]
pub(crate) fn is_degenerate<T: Record<f32>>(triangle: &T) -> bool {
    let vertices = match T::EDGES {
        true => [&[0.0; 3], triangle.edge1(), triangle.edge2()],
        false => [triangle.p0(), triangle.p1(), triangle.p2()],
    };
    !PLANES.iter().any(|&plane| surely_has_area(vertices, plane)) && has_no_area(vertices)
}

/// The planes of two axes. A triangle has an area if what is seen of it in one of them has.
const PLANES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Whether the area in a plane is more than rounding may have made it: of products of two differences, and of their
/// difference, four roundings of half an ulp, or 2^-149 where they are subnormal. Of infinite products it is not known.
#[inline]
fn surely_has_area([a, b, c]: [&[f32; 3]; 3], [x, y]: [usize; 2]) -> bool {
    let left = (b[x] - a[x]) * (c[y] - a[y]);
    let right = (b[y] - a[y]) * (c[x] - a[x]);
    let rounding = 2.0 * f32::EPSILON * (left.abs() + right.abs());
    (left - right).abs() > rounding + f32::MIN_POSITIVE
}

/// Whether the area in every plane is zero, by exact arithmetic; of numbers that are not finite it is not.
#[cold]
fn has_no_area(vertices: [&[f32; 3]; 3]) -> bool {
    PLANES.into_iter().all(|[x, y]| {
        let [a, b, c] = vertices.map(|p| Coord { x: p[x], y: p[y] });
        orient2d(a, b, c) == 0.0
    })
}

/// `a - b`
fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a × b`
fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl From<Triangle> for Edges {
    fn from(Triangle { p0, p1, p2 }: Triangle) -> Edges {
        Edges {
            p0,
            edge1: minus(p1, p0),
            edge2: minus(p2, p0),
        }
    }
}

impl From<Triangle> for TriangleWithNormal {
    fn from(Triangle { p0, p1, p2 }: Triangle) -> TriangleWithNormal {
        TriangleWithNormal {
            p0,
            p1,
            p2,
            normal: cross(minus(p1, p0), minus(p2, p0)),
        }
    }
}

impl From<Triangle> for EdgesWithNormal {
    fn from(triangle: Triangle) -> EdgesWithNormal {
        let Edges { p0, edge1, edge2 } = Edges::from(triangle);
        EdgesWithNormal {
            p0,
            edge1,
            edge2,
            normal: cross(edge1, edge2),
        }
    }
}

/// What is stored of a triangle, or, with arrays for numbers, of each of a block.
///
/// The types of this module are all that implement it. Which of the vectors are there, two constants say; to ask for
/// another is a mistake of whoever wrote the kernel, and panics.
pub trait Record<T>: sealed::Sealed {
    /// Whether two edges are stored, instead of the second and third vertex.
    const EDGES: bool;
    /// Whether the normal is stored.
    const NORMAL: bool;
    /// First vertex.
    fn p0(&self) -> &[T; 3];
    /// Second vertex, where edges are not stored.
    fn p1(&self) -> &[T; 3] {
        unreachable!("a vertex that is not stored")
    }
    /// Third vertex, where edges are not stored.
    fn p2(&self) -> &[T; 3] {
        unreachable!("a vertex that is not stored")
    }
    /// `p1-p0`, where edges are stored.
    fn edge1(&self) -> &[T; 3] {
        unreachable!("an edge that is not stored")
    }
    /// `p2-p0`, where edges are stored.
    fn edge2(&self) -> &[T; 3] {
        unreachable!("an edge that is not stored")
    }
    /// The normal, where it is stored.
    fn normal(&self) -> &[T; 3] {
        unreachable!("a normal that is not stored")
    }
}

mod sealed {
    pub trait Sealed {}
}

/// The records, by what they have beside their first vertex; and blocks of them.
macro_rules! records {
    ($($record:ident: EDGES $edges:literal, NORMAL $normal:literal, $($field:ident),+;)+) => {$(
        impl<T> sealed::Sealed for $record<T> {}

        impl<T> Record<T> for $record<T> {
            const EDGES: bool = $edges;
            const NORMAL: bool = $normal;

            #[inline]
            fn p0(&self) -> &[T; 3] {
                &self.p0
            }

            $(
                #[inline]
                fn $field(&self) -> &[T; 3] {
                    &self.$field
                }
            )+
        }

        impl<const W: usize> $record<[f32; W]> {
            /// A block of up to `W` triangles. Places that are left over are filled with NaN, which no ray hits; and
            /// so are those of triangles without area.
            ///
            /// # Panics
            ///
            /// If there are more than `W`.
            pub fn block(triangles: &[$record]) -> Self {
                assert!(triangles.len() <= W, "a block has room for {W} triangles");
                let lane_of = |lane| triangles.get(lane).filter(|&one| !is_degenerate(one));
                let lanes = |of: fn(&$record) -> &[f32; 3]| {
                    [0, 1, 2].map(|axis| {
                        core::array::from_fn(|lane| lane_of(lane).map_or(f32::NAN, |one| of(one)[axis]))
                    })
                };
                $record {
                    p0: lanes(|one| &one.p0),
                    $($field: lanes(|one| &one.$field),)+
                }
            }

            /// All of `triangles` in blocks, in their order: number `i` of a hit is `triangles[i]`.
            pub fn blocks(triangles: &[$record]) -> impl Iterator<Item = Self> + Clone {
                triangles.chunks(W).map(Self::block)
            }
        }
    )+};
}

records! {
    Triangle: EDGES false, NORMAL false, p1, p2;
    TriangleWithNormal: EDGES false, NORMAL true, p1, p2, normal;
    Edges: EDGES true, NORMAL false, edge1, edge2;
    EdgesWithNormal: EDGES true, NORMAL true, edge1, edge2, normal;
}

/// Views of slices of numbers as triangles, and the other way, without a copy.
#[cfg(feature = "bytemuck")]
mod plain {
    use super::{Edges, EdgesWithNormal, Triangle, TriangleWithNormal};

    macro_rules! plain {
        ($($record:ident)+) => {$(
            // SAFETY: arrays of zeros are numbers, and so are their elements.
            unsafe impl<T: bytemuck::Zeroable> bytemuck::Zeroable for $record<T> {}

            // SAFETY: arrays of one plain type, `repr(C)`: no padding, and any bits are numbers.
            unsafe impl<T: bytemuck::Pod> bytemuck::Pod for $record<T> {}
        )+};
    }

    plain!(Triangle TriangleWithNormal Edges EdgesWithNormal);
}

#[cfg(feature = "glam")]
mod of_vectors {
    use super::Triangle;

    impl From<[glam::Vec3; 3]> for Triangle {
        fn from([p0, p1, p2]: [glam::Vec3; 3]) -> Triangle {
            Triangle::new(p0, p1, p2)
        }
    }

    impl From<[glam::Vec3A; 3]> for Triangle {
        fn from([p0, p1, p2]: [glam::Vec3A; 3]) -> Triangle {
            Triangle::new(p0, p1, p2)
        }
    }
}

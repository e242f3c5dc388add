//! What a scene requires of a test. The code of a kernel contains nothing else.

/// What a scene requires. Everything has a default; write down what is different:
///
/// ```
/// use raybreed::{Origin, Scene, Watertight};
///
/// /// Rays from the eye, at meshes without holes; which triangle, and where in it.
/// struct Primary;
///
/// impl Scene for Primary {
///     const ORIGIN: Origin = Origin::Common;
///     const WATERTIGHT: Watertight = Watertight::Edges;
///     const TRIANGLE: bool = true;
///     const UV: bool = true;
/// }
/// ```
///
/// `()` is the scene of all defaults. What is required is known when the program is compiled, so a test has no code
/// for anything else.
pub trait Scene {
    /// What the arithmetic may be.
    const NUMERIC: Numeric = Numeric::Fast;
    /// Which rays must not slip between the triangles of a closed surface.
    const WATERTIGHT: Watertight = Watertight::No;
    /// How long lists of triangles are.
    const LISTS: Lists = Lists::Short;
    /// Where the rays of a packet start. One ray is not asked.
    const ORIGIN: Origin = Origin::General;
    /// Which side of a triangle is not there.
    const CULLING: Culling = Culling::None;
    /// Whether rays have a lower bound of `t`, beside zero.
    const T_MIN: bool = false;
    /// Whether the barycentric coordinates of a hit are reported.
    const UV: bool = false;
    /// Whether the number of the triangle is reported.
    const TRIANGLE: bool = false;
    /// Whether its normal is reported, of any length.
    const NORMAL: bool = false;
    /// Whether the point that is hit is reported.
    const POINT: bool = false;
}

impl Scene for () {}

/// Which side of a triangle is not there. The front is where its vertices are seen counterclockwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Culling {
    /// Neither: triangles are seen from both sides.
    #[default]
    None,
    /// Rays pass through a triangle from its back.
    Back,
    /// Rays pass through a triangle from its front.
    Front,
}

/// What the arithmetic of a kernel may be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Numeric {
    /// Estimates of reciprocals too, with a Newton step, and fused operations. Instruction sets differ in the last
    /// bits of `t`, and about rays that are at an edge within rounding.
    #[default]
    Fast,
    /// Only what every processor rounds alike: the same answers, to the last bit, with every instruction set.
    Portable,
}

/// Which rays cannot slip between the triangles of a closed surface whose vertices are the same numbers in all of
/// its triangles, each of which has an area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Watertight {
    /// Any may: of rays that are at an edge within rounding some percent do.
    #[default]
    No,
    /// Those through an edge that two triangles share do not.
    Edges,
    /// None does, at a vertex either.
    Full,
}

/// How long lists of triangles are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Lists {
    /// Some triangles, of which many are candidates, as in a leaf of a hierarchy.
    #[default]
    Short,
    /// Thousands, of which nearly all are behind what has been hit.
    Long,
}

/// Where the rays of a packet start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Origin {
    /// Each where it likes.
    #[default]
    General,
    /// All in one point, as rays from the eye or from a point light: every ray of the packet, inactive ones too, has
    /// the same origin. If one has another, its answers are of one of the two.
    Common,
}

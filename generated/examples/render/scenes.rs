//! What each kind of ray requires of its test. This is all that a renderer has to tell raybreed.

use raybreed::{Origin, Scene, Watertight};

/// Whether rays may slip through edges that two triangles share, which leaves holes in a picture: of all three alike.
const WATERTIGHT: Watertight = Watertight::Edges;

/// Packets of rays from the eye: the closest hit of each, in which triangle, and where in it.
pub struct Primary;

impl Scene for Primary {
    const ORIGIN: Origin = Origin::Common;
    const WATERTIGHT: Watertight = WATERTIGHT;
    const TRIANGLE: bool = true;
    const UV: bool = true;
}

/// Packets of rays from what the eye sees to the light: whether anything is between.
///
/// They start at the surface and leave it out by a lower bound of `t`. From the light they would have one origin, but
/// have to end just before the surface, and `t` of small triangles far away is not that exact.
pub struct Shadow;

impl Scene for Shadow {
    const WATERTIGHT: Watertight = WATERTIGHT;
    const T_MIN: bool = true;
}

/// Single rays from a surface into its surroundings: whether anything is near. They leave out the surface itself.
pub struct Occlusion;

impl Scene for Occlusion {
    const WATERTIGHT: Watertight = WATERTIGHT;
    const T_MIN: bool = true;
}

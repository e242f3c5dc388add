//! A piece of surface and the closed polygon around it, and which rays must hit it.

use scene::{Ray, Triangle};

use crate::vector::{dot, length, perpendicular, sub, wide};

/// A piece of surface, and its border.
///
/// Triangles wind the same way round as the border. Between them every inner side belongs to two,
/// once in each direction, so the border is what is left of the triangles' sides.
#[derive(Clone)]
pub struct Patch {
    /// The triangles. Which of its vertices each begins with has nothing to do with its place.
    pub triangles: Vec<Triangle>,
    /// The vertices of the border, in order; the last is joined to the first.
    pub border: Vec<[f32; 3]>,
    /// The vertices that are not on the border.
    pub inner: Vec<[f32; 3]>,
}

/// How near, in terms of the farthest vertex from the ray's origin, a ray may pass by the border
/// and still be certain to hit.
///
/// That is 2^10 roundings of `f32`: a kernel that moves vertices by some roundings each, the same
/// in every triangle, has the ray on the same side of the border.
const MARGIN: f64 = 1.0 / (1 << 14) as f64;

/// How near two sides may pass by a ray for it to be as at a vertex: 2^4 roundings of a volume that is the triple
/// product of the direction and the vectors from the origin to the ends of the side. Such a volume is the side's
/// length times its distance, and is rounded as the squares of those vectors are: the shorter the side and the
/// farther away, the less it says.
const AT_ONCE: f64 = 1.0 / (1 << 20) as f64;

impl Patch {
    /// How often `ray`, `t_max` apart, crosses the patch: triangles that it sees counterclockwise
    /// less those that it sees clockwise. `None` if that is not certain. If it is not zero, the ray
    /// has to hit.
    ///
    /// It is certain if the patch is in front of the origin and the border, seen along the ray, is
    /// not too near. Then that is how often the border winds around the ray, whatever triangles fill
    /// it; and a point that it winds around is in the closure of at least one that is not seen
    /// edge-on. Nothing is decided within 2^-14 of zero, which is 2^30 times the rounding of the
    /// `f64` used here, so what is certain here is certain in exact arithmetic.
    pub fn winding(&self, ray: &Ray) -> Option<i32> {
        let (origin, direction) = (wide(ray.origin), wide(ray.direction));
        let unit = length(direction);
        if unit == 0.0 {
            return None;
        }
        let border = self.border.iter().map(|&p| sub(wide(p), origin));
        let inner = self.inner.iter().map(|&p| sub(wide(p), origin));
        let mut farthest: f64 = 0.0;
        for to_vertex in border.clone().chain(inner) {
            let distance = length(to_vertex);
            farthest = farthest.max(distance);
            if dot(to_vertex, direction) <= MARGIN * distance * unit {
                return None;
            }
        }
        let [x, y] = perpendicular(direction);
        let flat: Vec<[f64; 2]> = border
            .map(|to_vertex| [dot(to_vertex, x), dot(to_vertex, y)])
            .collect();
        // Seen along the ray, the second axis is on the left of the first one.
        winding_around_zero(&flat, MARGIN * farthest).map(|counterclockwise| -counterclockwise)
    }
}

impl Patch {
    /// Whether two sides of the triangles or more are so near to the ray that a kernel which takes
    /// each of them for itself may have it on sides that no one point is on, as at a vertex.
    pub fn is_at_several_sides(&self, ray: &Ray) -> bool {
        let (origin, direction) = (wide(ray.origin), wide(ray.direction));
        let [x, y] = perpendicular(direction);
        let flat = |vertex: [f32; 3]| {
            let to_vertex = sub(wide(vertex), origin);
            let point = [dot(to_vertex, x), dot(to_vertex, y)];
            (point, length(to_vertex))
        };
        let mut near: Option<[[f32; 3]; 2]> = None;
        for Triangle { p0, p1, p2 } in &self.triangles {
            for [p, q] in [[*p0, *p1], [*p1, *p2], [*p2, *p0]] {
                let ((from, near_end), (to, far_end)) = (flat(p), flat(q));
                let farthest = near_end.max(far_end);
                let side = length(sub(wide(q), wide(p)));
                // Of a side without length nothing is said.
                let rounding = farthest * (farthest / side).max(1.0);
                if distance_to_zero(from, to) > AT_ONCE * rounding {
                    continue;
                }
                match near {
                    Some(other) if other != [q, p] && other != [p, q] => return true,
                    _ => near = Some([p, q]),
                }
            }
        }
        false
    }
}

/// How far a segment is from zero.
fn distance_to_zero(p: [f64; 2], q: [f64; 2]) -> f64 {
    let side = [q[0] - p[0], q[1] - p[1]];
    let squared = side[0] * side[0] + side[1] * side[1];
    let along = (-(p[0] * side[0] + p[1] * side[1]) / squared).clamp(0.0, 1.0);
    let nearest = if squared > 0.0 {
        [p[0] + along * side[0], p[1] + along * side[1]]
    } else {
        p
    };
    nearest[0].hypot(nearest[1])
}

/// How often a closed polygon winds around zero, counterclockwise, if it keeps a distance of `margin`
/// to it.
fn winding_around_zero(polygon: &[[f64; 2]], margin: f64) -> Option<i32> {
    let mut winding = 0;
    for (p, q) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        if distance_to_zero(*p, *q) < margin {
            return None;
        }
        // Crossings of the positive half of the first axis.
        let left = p[0] * q[1] - p[1] * q[0];
        if p[1] <= 0.0 && q[1] > 0.0 && left > 0.0 {
            winding += 1;
        } else if p[1] > 0.0 && q[1] <= 0.0 && left < 0.0 {
            winding -= 1;
        }
    }
    Some(winding)
}

/// A triangle that begins with vertex `start`, 0 to 2, of those given, the same way round.
pub(crate) fn starting_at(start: usize, mut vertices: [[f32; 3]; 3]) -> Triangle {
    vertices.rotate_left(start);
    let [p0, p1, p2] = vertices;
    Triangle { p0, p1, p2 }
}

#[cfg(test)]
mod tests {
    use super::winding_around_zero;

    #[test]
    fn a_polygon_winds_around_what_it_encloses() {
        let square = |x: f64, y: f64| {
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[i, j]| [i - x, j - y])
        };
        let mut backwards = square(0.5, 0.5);
        backwards.reverse();
        let twice = [square(0.5, 0.5), square(0.5, 0.5)].concat();
        assert_eq!(winding_around_zero(&square(0.5, 0.5), 0.4), Some(1));
        assert_eq!(winding_around_zero(&backwards, 0.4), Some(-1));
        assert_eq!(winding_around_zero(&twice, 0.4), Some(2));
        assert_eq!(winding_around_zero(&square(1.5, 0.0), 0.1), Some(0));
        assert_eq!(winding_around_zero(&square(-1.5, 1.0), 0.1), Some(0));
        assert_eq!(
            winding_around_zero(&square(0.5, 0.5), 0.6),
            None,
            "too near"
        );
    }

    #[test]
    fn there_and_back_is_no_winding() {
        let way = [
            [1.0, -1.0],
            [1.0, 1.0],
            [-1.0, 0.0],
            [1.0, 1.0],
            [1.0, -1.0],
            [-1.0, 0.0],
        ];
        assert_eq!(winding_around_zero(&way, 0.1), Some(0));
    }
}

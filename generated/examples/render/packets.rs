//! A packet of rays through a hierarchy: its boxes are tested by the first rays that may enter them, its leaves by all.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::ray::safe_inverse;
use raybreed::Packet;

/// Rays of a packet along a side of its tile.
pub const SIDE: usize = 8;
/// Rays of a packet.
pub const RAYS: usize = SIDE * SIDE;
/// Rays that are tested against a box at a time.
const GROUP: usize = 8;

/// Calls `test` with every leaf that some ray enters before its `t`, near ones first, mostly.
pub fn traverse(
    bvh: &Bvh2,
    packet: &mut Packet<RAYS>,
    mut test: impl FnMut(&Bvh2Node, &mut Packet<RAYS>),
) {
    let slopes = Slopes::of(packet);
    let mut stack = Vec::with_capacity(bvh.max_depth);
    stack.push((0, 0));
    while let Some((index, first)) = stack.pop() {
        let node: &Bvh2Node = &bvh.nodes[index];
        let Some(first) = slopes.first_group(&node.aabb, &packet.t, first) else {
            continue;
        };
        if node.is_leaf() {
            test(node, packet);
            continue;
        }
        let left = node.first_index as usize;
        let apart = bvh.nodes[left + 1].aabb.center() - bvh.nodes[left].aabb.center();
        let ray = first * GROUP;
        let along = apart.x * packet.dx[ray] + apart.y * packet.dy[ray] + apart.z * packet.dz[ray];
        let (near, far) = if along < 0.0 {
            (left + 1, left)
        } else {
            (left, left + 1)
        };
        stack.extend([(far, first), (near, first)]);
    }
}

/// The rays by groups, as boxes see them: where `x` is between `low` and `high`, `t` is between `low * inverse - start`
/// and `high * inverse - start`.
struct Slopes {
    inverse: [[[f32; GROUP]; 3]; RAYS / GROUP],
    start: [[[f32; GROUP]; 3]; RAYS / GROUP],
}

impl Slopes {
    fn of(packet: &Packet<RAYS>) -> Slopes {
        let origins = [&packet.ox, &packet.oy, &packet.oz];
        let directions = [&packet.dx, &packet.dy, &packet.dz];
        let mut slopes = Slopes {
            inverse: Default::default(),
            start: Default::default(),
        };
        for ray in 0..RAYS {
            let (group, lane) = (ray / GROUP, ray % GROUP);
            for axis in 0..3 {
                let inverse = safe_inverse(directions[axis][ray]);
                slopes.inverse[group][axis][lane] = inverse;
                slopes.start[group][axis][lane] = origins[axis][ray] * inverse;
            }
        }
        slopes
    }

    /// The first group, from this one on, of which some ray enters the box before its `t`. Groups before it have
    /// missed what is around the box.
    #[inline]
    fn first_group(&self, aabb: &Aabb, t: &[f32; RAYS], from: usize) -> Option<usize> {
        let (low, high) = (aabb.min.to_array(), aabb.max.to_array());
        let (t, _) = t.as_chunks::<GROUP>();
        (from..RAYS / GROUP).find(|&group| {
            let (inverses, starts) = (&self.inverse[group], &self.start[group]);
            let mut is_entered = false;
            for (ray, &t) in t[group].iter().enumerate() {
                let (mut near, mut far) = (0.0, t);
                for axis in 0..3 {
                    let (inverse, start) = (inverses[axis][ray], starts[axis][ray]);
                    let (a, b) = (low[axis] * inverse - start, high[axis] * inverse - start);
                    near = larger(near, smaller(a, b));
                    far = smaller(far, larger(a, b));
                }
                is_entered |= near < far;
            }
            is_entered
        })
    }
}

/// The smaller of two numbers: one instruction, as NaN does not occur.
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two numbers.
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

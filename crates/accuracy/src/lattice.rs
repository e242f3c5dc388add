//! Fans and rays of small integers: every volume is exact in `f32`, and ties are exact ties.

use rand::{Rng, RngExt};
use scene::{INITIAL_T, Ray};

use crate::fans::Fan;
use crate::rays::Aim;

/// Steps from the centre to the border in the fan's plane: 16 even ones around it.
const AROUND: [[i8; 2]; 16] = [
    [4, 0],
    [4, 2],
    [4, 4],
    [2, 4],
    [0, 4],
    [-2, 4],
    [-4, 4],
    [-4, 2],
    [-4, 0],
    [-4, -2],
    [-4, -4],
    [-2, -4],
    [0, -4],
    [2, -4],
    [4, -4],
    [4, -2],
];

/// A fan in a plane across an axis or tilted by 45 degrees to it, of 4, 8 or 16 triangles.
pub(crate) fn fan(rng: &mut impl Rng) -> Fan {
    let centre = std::array::from_fn(|_| rng.random_range(-8_i8..9));
    let axis = rng.random_range(0..3);
    let tilt = rng.random_range(-1..2);
    let step = [1, 2, 4][rng.random_range(0..3)];
    let border = AROUND.iter().step_by(step);
    let border = border.map(|&[x, y]| point(centre, in_plane(axis, [x, y, tilt * x])));
    let starts: Vec<usize> = (0..AROUND.len()).map(|_| rng.random_range(0..3)).collect();
    Fan::new(centre.map(f32::from), border.collect(), |number| {
        starts[number]
    })
}

/// A ray exactly at the centre, or exactly at the middle of a spoke.
pub(crate) fn shot(rng: &mut impl Rng, fan: &Fan) -> (Ray, Aim) {
    let border = &fan.patch.border;
    let (aim, target): (_, [f32; 3]) = if rng.random() {
        (Aim::Vertex, fan.centre)
    } else {
        let end = border[rng.random_range(0..border.len())];
        let middle = std::array::from_fn(|axis| (fan.centre[axis] + end[axis]) / 2.0);
        (Aim::Edge, middle)
    };
    let zero = |rng: &mut _| if RngExt::random(rng) { 0.0 } else { -0.0 };
    let along = rng.random_range(0..3);
    let is_on_axis: bool = rng.random();
    let direction: [f32; 3] = std::array::from_fn(|axis| match rng.random_range(-3_i8..4) {
        0 => zero(rng),
        step if axis == along || !is_on_axis => f32::from(step),
        _ => zero(rng),
    });
    let steps = f32::from(rng.random_range(1_i8..9));
    let ray = Ray {
        origin: std::array::from_fn(|axis| target[axis] - steps * direction[axis]),
        direction,
        t_min: 0.0,
        t_max: INITIAL_T,
    };
    (ray, aim)
}

/// Components in the plane and across `axis`, in the order of the world's axes.
fn in_plane(axis: usize, [x, y, across]: [i8; 3]) -> [i8; 3] {
    let mut components = [0; 3];
    components[axis] = across;
    components[(axis + 1) % 3] = x;
    components[(axis + 2) % 3] = y;
    components
}

fn point(centre: [i8; 3], step: [i8; 3]) -> [f32; 3] {
    std::array::from_fn(|axis| f32::from(centre[axis] + step[axis]))
}

//! Vectors in `f64`, for making cases.

/// Three components.
pub(crate) type Vector = [f64; 3];

pub(crate) fn wide(vector: [f32; 3]) -> Vector {
    vector.map(f64::from)
}

/// Each component to the nearest `f32`.
pub(crate) fn narrow(vector: Vector) -> [f32; 3] {
    vector.map(|x| x as f32)
}

pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

pub(crate) fn sub(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

pub(crate) fn scale(a: Vector, factor: f64) -> Vector {
    a.map(|x| x * factor)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

pub(crate) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// `(1-s) a + s b`.
pub(crate) fn between(a: Vector, b: Vector, s: f64) -> Vector {
    add(scale(a, 1.0 - s), scale(b, s))
}

/// Two vectors of unit length that are perpendicular to `a` and to each other, `a` not zero.
pub(crate) fn perpendicular(a: Vector) -> [Vector; 2] {
    let magnitudes = a.map(f64::abs);
    let least = magnitudes.into_iter().fold(f64::INFINITY, f64::min);
    let mut axis = [0.0; 3];
    axis[magnitudes.iter().position(|&x| x == least).unwrap_or(0)] = 1.0;
    let first = cross(a, axis);
    let first = scale(first, 1.0 / length(first));
    let second = cross(a, first);
    [first, scale(second, 1.0 / length(second))]
}

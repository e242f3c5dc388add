//! The right answer as a kernel: what a harness must find nothing wrong with.

use accuracy::{Class, Exact};
use scene::{Ray, Triangle};

/// The right answer, ties counting as hits, `t` rounded to the nearest `f32`.
pub fn right(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    let exact = Exact::new(ray, triangle).unwrap();
    let is_hit = matches!(
        exact.class(),
        Class::Interior | Class::Edge(_) | Class::Vertex(_)
    );
    is_hit.then(|| exact.t().unwrap() as f32)
}

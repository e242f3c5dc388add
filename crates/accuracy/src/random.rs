//! Draws: streams that do not depend on the number of threads, and directions.

use std::ops::Range;

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::vector::{Vector, dot, scale};

/// The generator of block `block` of stream `stream`: no two blocks share one.
pub(crate) fn block_rng(seed: u64, stream: u16, block: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(u64::from(stream) << 48 | block);
    rng
}

/// A direction of unit length, uniform on the sphere.
pub(crate) fn unit_vector(rng: &mut impl Rng) -> Vector {
    loop {
        let vector = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let squared = dot(vector, vector);
        if (1e-4..=1.0).contains(&squared) {
            return scale(vector, 1.0 / squared.sqrt());
        }
    }
}

/// Uniform in the logarithm.
pub(crate) fn log_uniform(rng: &mut impl Rng, range: Range<f64>) -> f64 {
    rng.random_range(range.start.ln()..range.end.ln()).exp()
}

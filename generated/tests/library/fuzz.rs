//! A fuzz target: bytes are rays and triangles, and nothing may surprise.
//!
//! As a test it takes some hundred random inputs. It goes on for a minute with
//! `BOLERO_RANDOM_TEST_TIME_MS=60000 BOLERO_RANDOM_ITERATIONS=1000000 cargo test -p raybreed fuzz`; led by coverage,
//! if cargo-bolero is installed, with `cargo bolero test -p raybreed fuzz::no_bytes_surprise`. What it finds it
//! shrinks and prints with its seed, which `BOLERO_RANDOM_SEED` repeats. So do the promises, of which proptest tries
//! `PROPTEST_CASES`.

use raybreed::Triangle;

use crate::checks;
use crate::kernels::kernels;
use crate::worlds::Bytes;

#[test]
fn no_bytes_surprise() {
    bolero::check!()
        .with_iterations(200)
        .with_max_len(4096)
        .for_each(|bytes: &[u8]| {
            let world = Bytes::new(bytes).world();
            checks::nothing_surprises(&world);
            let collapsed = world
                .triangles
                .iter()
                .map(|&Triangle { p0, p1, .. }| Triangle::new(p0, p1, p1));
            let collapsed: Vec<Triangle> = collapsed.collect();
            if !collapsed.is_empty() {
                for kernel in kernels() {
                    checks::what_is_no_triangle_is_missed(kernel, &world, &collapsed);
                }
            }
        });
}

//! Prints what a verdict of the exact oracle takes, on ordinary rays and on rays through the
//! triangle's sides: `cargo run --release -p accuracy --example oracle_speed`.

use std::hint::black_box;
use std::time::Instant;

use accuracy::Exact;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use scene::{Ray, Triangle};

/// Verdicts of each kind.
const SAMPLES: usize = 200_000;

fn main() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let point = |rng: &mut ChaCha8Rng| std::array::from_fn(|_| rng.random_range(-1.0..1.0));
    let mut ordinary = Vec::new();
    let mut ties = Vec::new();
    for _ in 0..SAMPLES {
        let [p0, p1, p2] = std::array::from_fn(|_| point(&mut rng));
        let [origin, direction] = std::array::from_fn(|_| point(&mut rng));
        let ray = Ray {
            origin,
            direction,
            t_min: 0.0,
            t_max: f32::INFINITY,
        };
        ordinary.push((ray, Triangle { p0, p1, p2 }));
        // The origin on the line of a side: two volumes are zero.
        let p2 = std::array::from_fn(|axis| 2.0 * p1[axis] - origin[axis]);
        ties.push((ray, Triangle { p0, p1, p2 }));
    }
    for (name, samples) in [("ordinary", ordinary), ("ties", ties)] {
        let start = Instant::now();
        for (ray, triangle) in &samples {
            let exact = Exact::new(ray, triangle).expect("finite");
            black_box((exact.class(), exact.t()));
        }
        let nanoseconds = start.elapsed().as_secs_f64() * 1e9 / SAMPLES as f64;
        println!("{name}: {nanoseconds:.0} ns");
    }
}

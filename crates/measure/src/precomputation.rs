//! What it costs to make the records of kernels that have their own.

use std::hint::black_box;

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use scene::Triangle;

use crate::stopwatch::Stopwatch;
use crate::timing::Sample;
use crate::track::Numbered;

/// Times the precomputations of `kernels` in so many passes over all triangles, those that have one. In every
/// pass they take turns in random order; beside them the vertices are copied, the records of whoever needs
/// nothing else.
pub(crate) fn precompute(
    triangles: &[Triangle],
    kernels: &[Numbered],
    passes: usize,
    order: u64,
) -> Vec<Sample> {
    let mut samples = Vec::new();
    let mut rng = ChaCha8Rng::seed_from_u64(order);
    let mut turns: Vec<Option<Numbered>> = kernels.iter().copied().map(Some).collect();
    turns.retain(|turn| turn.is_some_and(|kernel| kernel.loaded.prepares()));
    turns.push(None);
    let most = kernels
        .iter()
        .map(|kernel| kernel.layout.record.numbers())
        .max();
    // Written once before, so that no page of it is new to the first who is timed.
    let mut records = vec![f32::NAN; most.unwrap_or(0) * triangles.len()];
    let mut copies = triangles.to_vec();
    for _ in 0..passes {
        turns.shuffle(&mut rng);
        let mut beside = f64::NAN;
        let mut times = Vec::with_capacity(turns.len());
        for turn in &turns {
            let watch = Stopwatch::start();
            match turn {
                Some(kernel) => kernel.loaded.prepare_all(triangles, &mut records),
                None => copies.copy_from_slice(black_box(triangles)),
            }
            let seconds = watch.seconds();
            black_box((&mut records, &mut copies));
            match turn {
                Some(kernel) => times.push((kernel.number, seconds)),
                None => beside = seconds,
            }
        }
        for (kernel, seconds) in times {
            samples.push(Sample {
                kernel,
                packet: 0,
                seconds,
                reference: beside,
                tests: triangles.len() as u64,
            });
        }
    }
    samples
}

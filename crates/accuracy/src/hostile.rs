//! Inputs that are no rays or no triangles, one at a time among ones that are.

use rand::{Rng, RngExt};
use scene::{Ray, Triangle};
use serde::{Deserialize, Serialize};

use crate::pairs::{PairCase, TRIANGLE_RAYS};
use crate::random::block_rng;
use crate::rate::Rate;
use crate::subject::{Subject, for_each_hit};

/// What a subject makes of such inputs. Nothing here should ever happen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hostile {
    /// Rays with a NaN or an infinity in origin or direction that are reported as hits.
    pub ray_hit: Rate,
    /// Rays at a triangle with a NaN or an infinity that are reported as hits.
    pub triangle_hit: Rate,
    /// Rays whose `t_max` is zero, negative or NaN that are reported as hits.
    pub inactive_hit: Rate,
    /// Other rays of the same call whose answer is not the same, bit by bit, as without that ray.
    pub disturbed: Rate,
}

impl Hostile {
    /// All of it.
    pub fn all(&self) -> Rate {
        let rates = [
            self.ray_hit,
            self.triangle_hit,
            self.inactive_hit,
            self.disturbed,
        ];
        rates.into_iter().sum()
    }
}

const NOT_FINITE: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
const INACTIVE: [f32; 6] = [0.0, -0.0, -1.0, -1e-45, f32::NEG_INFINITY, f32::NAN];

/// The stream of random numbers, which nothing else has.
const STREAM: u16 = 0x200;

/// Spoils one ray, then one `t_max`, then one vertex, in each of the calls that `rays` rays at
/// ordinary triangles make.
pub fn hostile(subject: &mut impl Subject, rays: u64, seed: u64) -> Hostile {
    let mut result = Hostile::default();
    for number in 0..rays.div_ceil(TRIANGLE_RAYS as u64) {
        let rng = &mut block_rng(seed, STREAM, number);
        let block = PairCase::Ordinary.block(seed, number);
        let undisturbed = answers(subject, &block.rays, &block.triangle);

        let spoiled = rng.random_range(0..block.rays.len());
        let bad_value = NOT_FINITE[rng.random_range(0..NOT_FINITE.len())];
        let mut bad_ray = block.rays[spoiled];
        *any_component(rng, [&mut bad_ray.origin, &mut bad_ray.direction]) = bad_value;
        let inactive = Ray {
            t_max: INACTIVE[rng.random_range(0..INACTIVE.len())],
            ..block.rays[spoiled]
        };
        for (ray, hit) in [
            (bad_ray, &mut result.ray_hit),
            (inactive, &mut result.inactive_hit),
        ] {
            let mut rays = block.rays.clone();
            rays[spoiled] = ray;
            let answers = answers(subject, &rays, &block.triangle);
            hit.count(answers[spoiled].is_some());
            for (other, (before, after)) in undisturbed.iter().zip(&answers).enumerate() {
                if other != spoiled {
                    result.disturbed.count(before != after);
                }
            }
        }

        let mut triangle = block.triangle;
        let Triangle { p0, p1, p2 } = &mut triangle;
        *any_component(rng, [p0, p1, p2]) = bad_value;
        for answer in answers(subject, &block.rays, &triangle) {
            result.triangle_hit.count(answer.is_some());
        }
    }
    result
}

fn any_component<'a, const N: usize>(
    rng: &mut impl Rng,
    vectors: [&'a mut [f32; 3]; N],
) -> &'a mut f32 {
    let chosen = rng.random_range(0..N);
    let vector = vectors.into_iter().nth(chosen).expect("one of them");
    &mut vector[rng.random_range(0..3)]
}

/// The bits of each ray's `t`, if it is reported.
fn answers(subject: &mut impl Subject, rays: &[Ray], triangle: &Triangle) -> Vec<Option<u32>> {
    let mut answers = vec![None; rays.len()];
    for_each_hit(
        subject,
        rays,
        std::slice::from_ref(triangle),
        |ray, _, hit| {
            answers[ray] = Some(hit.t.to_bits());
        },
    );
    answers
}

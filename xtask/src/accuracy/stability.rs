//! What a recipe keeps of the accuracy lab.

use accuracy::{PairCase, Rate};
use emit::{Recipe, Share, Stability};
use measure::{Interrupt, Judged, Look, Rustc};
use scene::Output;

use super::{HELD_OUT, bench};
use crate::arena::Arena;
use crate::isas::Isas;

/// Rays of each case: enough that none of them bounds a share to 10^-5.
const SAMPLES: u64 = 100_000;

/// Takes the kernels of a recipe to the accuracy lab, reporting `u` and `v`, and keeps the worst of what is found
/// on its instruction sets. None if the lab does not know what its scene asks for.
///
/// # Errors
///
/// If the machine lacks an instruction set, or a kernel fails.
pub fn of(recipe: &Recipe, interrupt: &Interrupt) -> anyhow::Result<Option<Stability>> {
    let arena = Arena::of(recipe).reporting(vec![Output::Uv]);
    if !arena.is_for_lab() {
        return Ok(None);
    }
    let look = Look {
        samples: SAMPLES,
        seed: HELD_OUT,
    };
    let mut worst: Option<Stability> = None;
    for &isa in &recipe.isas {
        let arena = Arena {
            isas: Isas(vec![isa]),
            ..arena.clone()
        };
        arena.check()?;
        let kernel = arena.kernels(&recipe.program).remove(0);
        let mut bench = bench(&arena, &Rustc::of_this_build()?, interrupt, look)?;
        let built = bench.build(&[&kernel], true)?;
        let judged = bench.judge(&built, look)?.remove(0);
        let judged = judged.map_err(|verdict| {
            anyhow::anyhow!(
                "{} on {isa} cannot be judged: {}",
                recipe.name,
                verdict.name()
            )
        })?;
        let found = stability(&judged, look);
        worst = Some(worst.map_or(found, |worst| worse(worst, found)));
    }
    Ok(worst)
}

fn stability(judged: &Judged, look: Look) -> Stability {
    let profile = judged.profile(PairCase::Ordinary);
    let t_errors = profile.and_then(|profile| profile.relative_error);
    let uv_errors = profile.and_then(|profile| profile.uv_error);
    let (least, most) = judged.scale_range().unwrap_or_default();
    Stability {
        samples: look.samples,
        seed: look.seed,
        edge_leak: share(judged.edge_leak()),
        vertex_leak: share(judged.vertex_leak()),
        double: share(judged.double()),
        t_p9999: t_errors.map_or(0.0, |errors| errors.p9999),
        uv_p9999: uv_errors.map(|errors| errors.p9999),
        scale: [least, most],
    }
}

fn share(Rate { events, samples }: Rate) -> Share {
    Share { events, samples }
}

/// The worse of each.
fn worse(one: Stability, other: Stability) -> Stability {
    let worse = |a: Share, b: Share| if b.events > a.events { b } else { a };
    Stability {
        edge_leak: worse(one.edge_leak, other.edge_leak),
        vertex_leak: worse(one.vertex_leak, other.vertex_leak),
        double: worse(one.double, other.double),
        t_p9999: one.t_p9999.max(other.t_p9999),
        uv_p9999: [one, other]
            .into_iter()
            .filter_map(|one| one.uv_p9999)
            .reduce(f64::max),
        scale: [
            one.scale[0].max(other.scale[0]),
            one.scale[1].min(other.scale[1]),
        ],
        ..one
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_several_instruction_sets_the_worst_counts() {
        let found = |events, t_p9999, scale| {
            let share = Share {
                events,
                samples: 100,
            };
            Stability {
                samples: 10,
                seed: 7,
                edge_leak: share,
                vertex_leak: share,
                double: share,
                t_p9999,
                uv_p9999: Some(2.0 * t_p9999),
                scale,
            }
        };
        let worst = worse(found(1, 3e-7, [-40, 20]), found(2, 1e-7, [-19, 41]));
        assert_eq!(worst, found(2, 3e-7, [-19, 20]));
    }
}

//! What the statements of programs say of them, against what the accuracy lab finds of their kernels,
//! compiled for every instruction set.

mod loaded;

use std::ops::RangeInclusive;
use std::sync::LazyLock;

use accuracy::{
    Case, PairCase, Rate, Scalar, Scaling, Subject, profiles, scale_range, watertightness,
};
use emit::{Isa, print_kernel};
use loaded::{Compiled, isas, recipes};
use program::{
    CheckedIn, Degree, Genome, Graph, Program, Rules, Tags, Watertight, appendix,
    moller_trumbore_volumes,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use scene::{Ray, SceneModel, Triangle};

/// Random programs of what each of the rules leaves of each graph.
const RANDOM_PROGRAMS: usize = 2;

/// Rays of each case.
const RAYS: u64 = 512;

/// Programs, with their names, in kernels of one instruction set.
struct OnIsa {
    isa: Isa,
    programs: Vec<(String, Program)>,
    kernels: Compiled,
}

static KERNELS: LazyLock<Vec<OnIsa>> = LazyLock::new(|| {
    let scene = SceneModel::preset("packet").unwrap();
    let on_isa = |isa| {
        let programs: Vec<_> = programs().into_iter().chain(of_library(isa)).collect();
        let print = |(_, program): &(_, _)| print_kernel(program, &scene, isa, "kernel", "");
        let kernels = Compiled::new(programs.iter().map(print).collect(), scene.regime);
        OnIsa {
            isa,
            programs,
            kernels,
        }
    };
    isas().into_iter().map(on_isa).collect()
});

/// The programs of the library, each on the narrowest instruction set that it was bred for.
fn of_library(isa: Isa) -> impl Iterator<Item = (String, Program)> {
    let recipes = recipes().into_iter();
    let of_isa = recipes.filter(move |recipe| recipe.isas.iter().min() == Some(&isa));
    of_isa.map(|recipe| (recipe.name.to_string(), recipe.program))
}

/// Programs with their names: of every graph, of what each watertight class leaves of it, and the paper's two.
/// The lab has no segments, so no program has their other ends.
fn programs() -> Vec<(String, Program)> {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let mut programs = Vec::new();
    for graph in CheckedIn::ALL {
        for (watertight, fused) in [
            (Watertight::No, true),
            (Watertight::Edges, false),
            (Watertight::Full, false),
            (Watertight::Full, true),
        ] {
            let rules = Rules {
                watertight,
                fused,
                ends: false,
                ..Rules::ORDINARY
            };
            // Only one graph has programs of the last class.
            let Ok(left) = graph.graph().restricted(&rules) else {
                continue;
            };
            for number in 0..RANDOM_PROGRAMS {
                let genome = Genome::random(left.nodes().len(), &mut rng);
                let name = format!("{}, {watertight:?}, {number}", graph.name());
                programs.push((name, left.program(&genome).unwrap()));
            }
        }
    }
    let paper = CheckedIn::KenslerShirley.graph();
    let of_paper = |of: fn(&Graph) -> Genome| paper.program(&of(&paper)).unwrap();
    programs.push(("appendix".into(), of_paper(appendix)));
    programs.push(("Möller-Trumbore".into(), of_paper(moller_trumbore_volumes)));
    programs
}

/// Calls `check` with every kernel: what it is, its program's tags there, and its number in the library.
fn for_all(mut check: impl FnMut(&str, &Tags, &OnIsa, usize)) {
    for on_isa in KERNELS.iter() {
        for (number, (name, program)) in on_isa.programs.iter().enumerate() {
            let tags = program.tags(on_isa.isa.fuses());
            check(&format!("{name}, {}", on_isa.isa), &tags, on_isa, number);
        }
    }
}

/// The safe exponents of one of the lab's scalings.
fn safe(tags: &Tags, scaling: Scaling) -> RangeInclusive<i32> {
    tags.safe_scales(match scaling {
        Scaling::Everything => Degree::EVERYTHING,
        Scaling::Positions => Degree::POSITIONS,
        Scaling::Directions => Degree::DIRECTIONS,
    })
}

/// Whether a case is within the safe scales.
fn is_safe(tags: &Tags, case: Case) -> bool {
    let safe = safe(tags, Scaling::Everything);
    case != Case::ScaledFan || safe.contains(&-20) && safe.contains(&20)
}

/// Those without a tag are caught, too: of the random ones none is tight for a reason that the rules do not have.
#[test]
fn what_is_tagged_watertight_does_not_leak_and_what_is_not_does() {
    let mut found = [0; 3];
    for_all(|name, tags, on_isa, number| {
        let cases: Vec<Case> = Case::ALL
            .into_iter()
            .filter(|&case| is_safe(tags, case))
            .collect();
        let leaks = watertightness(|| on_isa.kernels.subject(number), &cases, RAYS, 5);
        let edge: Rate = leaks.iter().map(|one| one.leaks.edge.leak).sum();
        let vertex: Rate = leaks.iter().map(|one| one.leaks.vertex.leak).sum();
        // What is far away has its vertices on top of each other.
        let near = leaks
            .iter()
            .filter(|one| matches!(one.case, Case::Fan | Case::SharedEdge));
        let double: Rate = near.map(|one| one.leaks.edge.double).sum();
        let all = format!(
            "{name}: {:?}, {edge:?}, {vertex:?}, {double:?}",
            tags.watertight
        );
        match tags.watertight {
            Watertight::No => assert!(edge.events > 0, "{all}"),
            Watertight::Edges => {
                assert_eq!(edge.events, 0, "{all}");
                assert!(vertex.events + double.events > 0, "{all}");
            }
            Watertight::Full => {
                assert_eq!(edge.events + vertex.events + double.events, 0, "{all}");
            }
        }
        found[tags.watertight as usize] += 1;
    });
    assert!(
        found.iter().all(|&count| count >= RANDOM_PROGRAMS),
        "{found:?}"
    );
}

/// The lab looks at verdicts alone, which at one of the two ends often outlive `t`.
#[test]
fn verdicts_stay_over_the_safe_scales_and_not_much_longer() {
    for_all(|name, tags, on_isa, number| {
        for scaling in Scaling::ALL {
            let safe = safe(tags, scaling);
            let found = scale_range(&mut on_isa.kernels.subject(number), scaling, RAYS, 6);
            let ends = [(-safe.start(), -found.start()), (*safe.end(), *found.end())];
            let all = format!("{name}, {scaling:?}: {safe:?} is safe, {found:?} found");
            for (safe, found) in ends {
                assert!(safe.min(LAB_EXPONENT) <= found, "{all}");
            }
            assert!(
                ends.iter().any(|(safe, found)| 2 * found <= 3 * safe),
                "{all}"
            );
        }
    });
}

/// The lab does not look farther.
const LAB_EXPONENT: i32 = 100;

/// The 99th percentile of the relative error of `t` near the world's origin and far from it.
fn errors<S: Subject>(subjects: impl Fn() -> S + Sync) -> [f64; 2] {
    let cases = [PairCase::Ordinary, PairCase::Far];
    let profiles = profiles(subjects, &cases, 2 * RAYS, 7);
    [0, 1].map(|case| profiles[case].profile.relative_error.unwrap().p99)
}

#[test]
fn what_is_translation_safe_is_as_exact_far_away() {
    for_all(|name, tags, on_isa, number| {
        assert!(tags.translation_safe, "{name}");
        let [near, far] = errors(|| on_isa.kernels.subject(number));
        assert!(far < 3.0 * near, "{name}: {near:e}, {far:e}");
    });
}

/// What no operation does: a plane by its distance from the world's origin.
#[test]
fn what_is_not_would_be_caught() {
    let [near, far] = errors(|| {
        Scalar(|ray: &Ray, &Triangle { p0, p1, p2 }: &Triangle| {
            let sub = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|axis| a[axis] - b[axis]);
            let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let (e, f) = (sub(p1, p0), sub(p2, p0));
            let normal = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| e[j] * f[k] - e[k] * f[j]);
            Some((dot(normal, p0) - dot(normal, ray.origin)) / dot(normal, ray.direction))
        })
    });
    assert!(far > 100.0 * near, "{near:e}, {far:e}");
}

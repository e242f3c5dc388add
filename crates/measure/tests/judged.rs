//! Kernels in the accuracy lab, by way of the bench: those known to leak are caught, on every instruction set, and
//! one that is watertight passes.

mod loaded;

use accuracy::{PairCase, Sweep};
use emit::{Isa, Kernel};
use loaded::{isas, small_bench};
use measure::{Judged, Look, Verdict};
use scene::SceneModel;

const LOOK: Look = Look {
    samples: 2_000,
    seed: 11,
};

/// What is found of rivals, by their names.
fn judged(scene: &SceneModel, isa: Isa, names: &[&str]) -> Vec<Result<Judged, Verdict>> {
    let kernel = |name: &&str| {
        let rival = rivals::find(name, scene.grouping).unwrap();
        rival.kernel(isa, scene.regime)
    };
    let kernels: Vec<Kernel> = names.iter().map(kernel).collect();
    let mut bench = small_bench(scene, kernel(&"moller-trumbore"), 1000);
    let kernels: Vec<&Kernel> = kernels.iter().collect();
    let built = bench.build(&kernels, false).unwrap();
    bench.judge(&built, LOOK).unwrap()
}

#[test]
fn leaks_are_found_on_every_isa_and_where_there_are_none_none() {
    for scene in ["packet", "single"] {
        let scene = SceneModel::preset(scene).unwrap();
        for isa in isas() {
            let names = ["woop", "moller-trumbore", "kensler-shirley", "havel-herout"];
            let all = judged(&scene, isa, &names);
            let [woop, others @ ..] = all.as_slice() else {
                panic!("a verdict each");
            };
            let woop = woop.as_ref().unwrap();
            assert_eq!((woop.edge_leak().events, woop.vertex_leak().events), (0, 0));
            assert!(woop.edge_leak().samples > 5_000, "{isa}: the test is empty");
            for (name, leaky) in names[1..].iter().zip(others) {
                let share = leaky.as_ref().unwrap().edge_leak().share();
                assert!(share > 0.02, "{name}, {}, {isa}: {share}", scene.name);
            }
        }
    }
}

/// A kernel that takes all rays from the first one's origin is given them one by one.
#[test]
fn a_common_origin_is_the_rays_own() {
    let scene = SceneModel::preset("common-origin").unwrap();
    let all = judged(&scene, Isa::Sse2, &["benthin"]);
    let benthin = all[0].as_ref().unwrap();
    let missed = benthin.profile(PairCase::Ordinary).unwrap().counts.missed;
    assert!(missed.samples > 50 && missed.share() < 0.05, "{missed:?}");
    // Its sides are the same from either triangle.
    assert_eq!(benthin.edge_leak().events, 0);
}

/// Where a plane's constant belongs to the world's origin, distance spoils it; where only differences count, it does
/// not.
#[test]
fn sweeps_show_who_depends_on_the_distance_from_the_origin() {
    let scene = SceneModel::preset("packet").unwrap();
    let all = judged(&scene, Isa::Sse2, &["wald", "kensler-shirley"]);
    let worst = |judged: &Result<Judged, Verdict>| {
        let sweeps = &judged.as_ref().unwrap().sweeps;
        let distance = sweeps.iter().find(|one| one.sweep == Sweep::Distance);
        let points = distance.unwrap().points.iter();
        let errors = points.filter_map(|point| point.relative_error);
        errors.map(|errors| errors.median).fold(0.0, f64::max)
    };
    let [wald, kensler_shirley] = [worst(&all[0]), worst(&all[1])];
    assert!(wald > 1e-2, "{wald}");
    assert!(kensler_shirley < 1e-6, "{kensler_shirley}");
}

/// Whoever fails has its verdict, and the others are judged all the same.
#[test]
fn a_kernel_that_cannot_be_judged_says_why() {
    let scene = SceneModel::preset("packet").unwrap();
    let rival = rivals::find("moller-trumbore", scene.grouping).unwrap();
    let right = rival.kernel(Isa::Sse2, scene.regime);
    let broken = Kernel {
        source: "this is no Rust".into(),
        ..right.clone()
    };
    let mut bench = small_bench(&scene, right.clone(), 1000);
    let built = bench.build(&[&broken, &right], true).unwrap();
    let all = bench.judge(&built, LOOK).unwrap();
    assert!(matches!(all[0], Err(Verdict::BuildFailed { .. })));
    assert!(all[1].as_ref().unwrap().edge_leak().events > 0);
}

//! Rivals by hand are right on every instruction set that the machine has, by way of the bench: with their
//! vertices, or with records that their own precomputation makes.

mod loaded;

use emit::{Isa, Kernel};
use loaded::{isas, plan, small_bench};
use measure::{Bench, Verdict};
use rivals::Rival;
use scene::{Grouping, Regime, SceneModel};

#[test]
fn rivals_are_right_on_every_isa() {
    for (scene, regime) in [
        ("packet", Regime::Leaf),
        ("packet", Regime::Fixed),
        ("common-origin", Regime::Shrinking),
        ("single", Regime::Leaf),
        ("single", Regime::Fixed),
    ] {
        let mut scene = SceneModel::preset(scene).unwrap();
        scene.regime = regime;
        for isa in isas() {
            let rivals = rivals::of(scene.grouping, scene.origin);
            let rivals: Vec<&Rival> = rivals.filter(|rival| rival.is_for(isa)).collect();
            let kernels = rivals.iter().map(|rival| rival.kernel(isa, regime));
            let kernels: Vec<Kernel> = kernels.collect();
            let kernels: Vec<&Kernel> = kernels.iter().collect();
            let verdicts = bench(&scene, isa).measure(&kernels, &plan()).unwrap();
            for (rival, verdict) in rivals.iter().zip(&verdicts[1..]) {
                let right = matches!(verdict, Verdict::Timed { .. });
                assert!(right, "{}, {isa}, {regime}: {verdict:?}", rival.name);
            }
        }
    }
}

/// The figure of a precomputation is the rival's own: whoever takes vertices has none.
#[test]
fn precomputations_are_timed_where_there_are_any() {
    let scene = SceneModel::preset("packet").unwrap();
    let rivals = ["wald", "kensler-shirley"];
    let rivals = rivals.map(|name| rivals::find(name, Grouping::Packet).unwrap());
    let kernels = rivals.map(|rival| rival.kernel(Isa::Sse2, scene.regime));
    let kernels: Vec<&Kernel> = kernels.iter().collect();
    let mut bench = bench(&scene, Isa::Sse2);
    let built = bench.build(&kernels, true).unwrap();
    let verdicts = bench.time_precomputations(&built, 5).unwrap();
    let passes = |verdict: &Verdict| match verdict {
        Verdict::Timed { speeds, .. } => speeds.len(),
        other => panic!("{other:?}"),
    };
    let passes: Vec<usize> = verdicts.iter().map(passes).collect();
    assert_eq!(passes, [0, 5, 0]);
}

#[test]
fn a_record_has_as_many_numbers_as_its_rival_says() {
    for rival in rivals::all() {
        let scene = SceneModel::preset("packet").unwrap();
        let layout = rival.kernel(Isa::Sse2, scene.regime).signature.layout;
        let numbers = rival.precomputation.map_or(9, |one| one.numbers);
        assert_eq!(layout.record.numbers(), numbers, "{}", rival.name);
    }
}

/// A method that divides first divides once for every vector of rays and triangle; one that puts the division
/// off, only where every other test is passed. And no kernel answers otherwise when it is counted.
#[test]
fn words_are_counted_exactly() {
    let scene = SceneModel::preset("packet").unwrap();
    let scene = SceneModel {
        regime: Regime::Fixed,
        ..scene
    };
    let div = emit::COUNTED_WORDS.iter().position(|word| *word == "div");
    let div = div.unwrap();
    for isa in isas() {
        let names = ["havel-herout-divided", "havel-herout"];
        let rivals = names.map(|name| rivals::find(name, Grouping::Packet).unwrap());
        let kernels = rivals.map(|rival| rival.kernel(isa, scene.regime));
        let kernels: Vec<&Kernel> = kernels.iter().collect();
        let mut bench = bench(&scene, isa);
        let counts = bench.count(&kernels, vec![0..2, 2..4]).unwrap();
        let [first, deferred] = [0, 1].map(|place| counts[place].clone().unwrap());
        let rows = (4 * scene::PACKET_SIZE * 1000 / isa.lane_count()) as u64;
        assert_eq!(first.tests, rows * isa.lane_count() as u64);
        assert_eq!(first.words[div], rows, "{isa}");
        assert!(
            0 < deferred.words[div] && deferred.words[div] < rows,
            "{isa}"
        );
    }
}

/// They are cut from packets of the usual size or put together of several; what they answer is theirs all the
/// same.
#[test]
fn packets_of_other_sizes_are_right() {
    for (scene, regime) in [
        ("packet", Regime::Shrinking),
        ("common-origin", Regime::Fixed),
    ] {
        let scene = SceneModel {
            regime,
            ..SceneModel::preset(scene).unwrap()
        };
        for isa in isas() {
            let rival = rivals::find("kensler-shirley", scene.grouping).unwrap();
            let sizes = [isa.lane_count(), 32, 128, 256];
            let kernels = sizes.map(|rays| rival.kernel(isa, regime).of_packets(rays));
            let kernels: Vec<&Kernel> = kernels.iter().collect();
            let plan = measure::Plan {
                rounds: std::iter::once(0..4).collect(),
                ..plan()
            };
            let verdicts = bench(&scene, isa).measure(&kernels, &plan).unwrap();
            for (rays, verdict) in sizes.iter().zip(&verdicts[1..]) {
                let right = matches!(verdict, Verdict::Timed { ratios, .. } if ratios.len() == 1);
                assert!(right, "{rays} rays, {isa}, {regime}: {verdict:?}");
            }
        }
    }
}

/// A record is what the kernel's own function makes: with another one answers are wrong.
#[test]
fn a_rival_with_a_wrong_precomputation_is_caught() {
    let scene = SceneModel::preset("packet").unwrap();
    let rival = rivals::find("havel-herout", Grouping::Packet).unwrap();
    let right = rival.kernel(Isa::Sse2, scene.regime);
    let source = right.source.replace("-dot3(n1, a)", "dot3(n1, a)");
    assert_ne!(source, right.source);
    let wrong = Kernel::by_hand(right.isa, rival.grouping, source, right.function.clone());
    let wrong = wrong.preparing(12, "prepare");
    let verdicts = bench(&scene, Isa::Sse2).measure(&[&right, &wrong], &plan());
    let verdicts = verdicts.unwrap();
    assert!(
        matches!(verdicts[1], Verdict::Timed { .. }),
        "{:?}",
        verdicts[1]
    );
    let is_wrong = matches!(verdicts[2], Verdict::WrongAnswer { .. });
    assert!(is_wrong, "{:?}", verdicts[2]);
}

fn bench(scene: &SceneModel, isa: Isa) -> Bench {
    let reference = rivals::find("moller-trumbore", scene.grouping).unwrap();
    small_bench(scene, reference.kernel(isa, scene.regime), 1000)
}

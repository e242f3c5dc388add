//! Kernels that are the same machine code are known as such, and others never are.

mod bench;

use std::collections::HashMap;

use bench::*;
use emit::{Isa, Kernel, print_kernel};
use measure::{Interrupt, Verdict};
use program::{Genome, kensler_shirley};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use scene::SceneModel;

fn codes(kernels: &[Kernel], separate: bool) -> Vec<Option<String>> {
    let kernels: Vec<&Kernel> = kernels.iter().collect();
    let built = bench(Interrupt::default())
        .build(&kernels, separate)
        .unwrap();
    built.codes().map(|code| code.map(str::to_owned)).collect()
}

/// Kernels of random programs, each twice by another name.
fn random_twins(isa: Isa, seed: u64) -> Vec<Kernel> {
    let graph = kensler_shirley();
    let scene = SceneModel::preset("packet").unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let programs = (0..8).map(|_| {
        let genome = Genome::random(graph.nodes().len(), &mut rng);
        graph.program(&genome).unwrap()
    });
    let twice = programs.enumerate().flat_map(|(number, program)| {
        ["a", "another_with_a_longer_name"]
            .map(|name| print_kernel(&program, &scene, isa, &format!("{name}_{number}"), ""))
    });
    twice.collect()
}

#[test]
fn a_kernel_is_its_own_twin_wherever_it_is_and_no_other_kernels() {
    for isa in [Isa::Sse2, Isa::Avx2] {
        let kernels = random_twins(isa, 1);
        let together = codes(&kernels, false);
        assert_eq!(together, codes(&kernels, true), "{isa}");
        let mut owners: HashMap<&String, usize> = HashMap::new();
        for (place, code) in together.iter().enumerate() {
            let program = *owners.entry(code.as_ref().unwrap()).or_insert(place / 2);
            assert_eq!(program, place / 2, "{isa}: {place}");
        }
    }
}

#[test]
fn a_comment_is_no_difference_and_another_constant_is() {
    let half = broken;
    let [one, same, other] = [
        half("packet.t[0] *= 0.5;"),
        half("packet.t[0] *= 0.5; /* so be it */"),
        half("packet.t[0] *= 0.25;"),
    ];
    let [one, same, other] = codes(&[one, same, other], false).try_into().unwrap();
    assert_eq!(one, same);
    assert_ne!(one, other);
}

#[test]
fn what_cannot_be_built_is_nobodys_twin() {
    assert_eq!(
        codes(&[broken("nonsense;"), broken("nonsense;")], false),
        [None, None]
    );
}

#[test]
fn who_is_left_out_is_not_timed_and_the_others_move_up() {
    let mut bench = bench(Interrupt::default());
    let (good, bad) = (good(), broken("nonsense;"));
    let mut built = bench.build(&[&bad, &good, &bad, &good], false).unwrap();
    built.retain(&[false, true, true, false]);
    let verdicts = bench.time(&built, &plan()).unwrap();
    let [_, first, second] = &verdicts[..] else {
        panic!("{verdicts:?}")
    };
    assert!(matches!(first, Verdict::Timed { .. }));
    assert!(matches!(second, Verdict::BuildFailed { .. }));
}

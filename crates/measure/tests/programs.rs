//! What is printed is what rustc takes and the oracle accepts: in every scene and regime, on every
//! instruction set that the machine has.

use std::time::Duration;

use emit::{Isa, Kernel, lower, print_kernel};
use measure::{
    Accuracy, Bench, Deal, Interrupt, Plan, Rustc, Verdict, WorkerCommand, WorkloadSpec,
};
use program::{Genome, Program, appendix, kensler_shirley, moller_trumbore_volumes};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use scene::{Numeric, Regime, SceneModel};

const RANDOM_PROGRAMS: usize = 12;

/// Those that this machine has. The others are named as skipped.
fn isas() -> Vec<Isa> {
    let (here, missing): (Vec<Isa>, Vec<Isa>) =
        Isa::ALL.into_iter().partition(|isa| isa.is_available());
    for isa in missing {
        println!("skipped: {isa}, which this machine lacks");
    }
    here
}

#[test]
fn programs_of_the_graph_are_right_in_every_scene_and_regime_on_every_isa() {
    for isa in isas() {
        for scene in scenes(Numeric::Fast) {
            for regime in Regime::ALL {
                let verdicts = verdicts(&programs(), &scene, regime, isa);
                for (index, verdict) in verdicts.into_iter().enumerate() {
                    let right = match verdict {
                        Verdict::Timed { .. } => true,
                        // A formulation may be worse than the policy allows, but not wrong.
                        Verdict::Inaccurate { .. } => index >= 2,
                        _ => false,
                    };
                    let scene = &scene.name;
                    assert!(
                        right,
                        "{isa}, {scene}, {regime}, program {index}: {verdict:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn portable_programs_are_as_accurate_to_the_last_bit_on_every_isa() {
    for scene in scenes(Numeric::Portable) {
        for regime in Regime::ALL {
            let accuracies = |isa| -> Vec<Option<Accuracy>> {
                let verdicts = verdicts(&programs(), &scene, regime, isa);
                let accuracies = verdicts.into_iter().map(|verdict| match verdict {
                    Verdict::Timed { accuracy, .. } => Some(accuracy),
                    Verdict::Inaccurate { accuracy } => Some(accuracy),
                    _ => None,
                });
                accuracies.collect()
            };
            let scalar = accuracies(Isa::Scalar);
            assert!(scalar.iter().all(Option::is_some));
            for isa in isas() {
                assert_eq!(accuracies(isa), scalar, "{}, {regime}, {isa}", scene.name);
            }
        }
    }
}

/// The presets of a numeric policy.
fn scenes(numeric: Numeric) -> impl Iterator<Item = SceneModel> {
    let presets = SceneModel::PRESETS.into_iter();
    let presets = presets.map(|name| SceneModel::preset(name).unwrap());
    presets.filter(move |scene| scene.numeric == numeric)
}

/// What becomes of programs.
fn verdicts(programs: &[Program], scene: &SceneModel, regime: Regime, isa: Isa) -> Vec<Verdict> {
    let print = |program: &Program| {
        let program = lower(program, scene);
        print_kernel(&program, scene.rates(), regime, isa, "kernel", "")
    };
    let kernels: Vec<Kernel> = programs.iter().map(print).collect();
    let kernels: Vec<&Kernel> = kernels.iter().collect();
    let mut verdicts = bench(scene, regime, isa)
        .measure(&kernels, &plan())
        .unwrap();
    // The first one is the reference's.
    verdicts.split_off(1)
}

/// The appendix's, Möller-Trumbore's, and random ones.
fn programs() -> Vec<Program> {
    let graph = kensler_shirley();
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut genomes = vec![appendix(&graph), moller_trumbore_volumes(&graph)];
    let random = (0..RANDOM_PROGRAMS).map(|_| Genome::random(graph.nodes().len(), &mut rng));
    genomes.extend(random);
    genomes
        .iter()
        .map(|genome| graph.program(genome).unwrap())
        .collect()
}

fn bench(scene: &SceneModel, regime: Regime, isa: Isa) -> Bench {
    let rival = rivals::find("moller-trumbore").unwrap();
    let fixed = regime == Regime::Fixed;
    let reference = Kernel {
        isa,
        source: rival.source(&isa.attribute()),
        function: format!("{}::<{}, {fixed}>", rival.function, scene::PACKET_SIZE),
    };
    let worker = WorkerCommand {
        program: env!("CARGO_BIN_EXE_measure-worker").into(),
        arguments: Vec::new(),
        patience: Duration::from_secs(20),
    };
    let workload = WorkloadSpec {
        seed: 3,
        triangles: 2000,
        packets: 4,
        origin: scene.origin,
        regime,
    };
    let rustc = Rustc::of_this_build().unwrap();
    Bench::new(rustc, worker, workload, reference, Interrupt::default())
}

fn plan() -> Plan {
    Plan {
        rounds: vec![0..2, 2..4],
        separate: false,
        race: None,
        racers: 0,
        cores: 1,
        deal: Deal::Kernels,
        noise_floor: true,
    }
}

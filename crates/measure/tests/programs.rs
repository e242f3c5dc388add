//! What is printed is what rustc takes and the oracle accepts: in every scene and regime.

use std::time::Duration;

use emit::{Isa, Kernel, print_kernel};
use measure::{Bench, Deal, Interrupt, Plan, Rustc, Verdict, WorkerCommand, WorkloadSpec};
use program::{Genome, Program, appendix, kensler_shirley, moller_trumbore_volumes};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use scene::{Regime, SceneModel};

const RANDOM_PROGRAMS: usize = 12;

#[test]
fn programs_of_the_graph_are_right_in_every_scene_and_regime() {
    for scene in SceneModel::PRESETS.map(|name| SceneModel::preset(name).unwrap()) {
        for regime in Regime::ALL {
            let print = |program: &Program| {
                print_kernel(program, scene.rates(), regime, Isa::Sse2, "kernel", "")
            };
            let kernels: Vec<Kernel> = programs().iter().map(print).collect();
            let kernels: Vec<&Kernel> = kernels.iter().collect();
            let verdicts = bench(&scene, regime).measure(&kernels, &plan()).unwrap();
            for (index, verdict) in verdicts.into_iter().skip(1).enumerate() {
                let right = match verdict {
                    Verdict::Timed { .. } => true,
                    // A formulation may be worse than the policy allows, but not wrong.
                    Verdict::Inaccurate { .. } => index >= 2,
                    _ => false,
                };
                let scene = &scene.name;
                assert!(right, "{scene}, {regime}, program {index}: {verdict:?}");
            }
        }
    }
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

fn bench(scene: &SceneModel, regime: Regime) -> Bench {
    let rival = rivals::find("moller-trumbore").unwrap();
    let fixed = regime == Regime::Fixed;
    let reference = Kernel {
        isa: Isa::Sse2,
        source: rival.source.to_owned(),
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

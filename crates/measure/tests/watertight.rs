//! What is called watertight lets no ray through: programs of the watertight classes, compiled for
//! every instruction set, against closed fans and meshes of which every ray must hit something.
//!
//! `RAYBREED_LEAK_RAYS` says how many rays every case gets, for a longer look than a test's:
//!
//! ```sh
//! RAYBREED_LEAK_RAYS=10000000 cargo test --release --package measure --test watertight -- --nocapture
//! ```

mod loaded;

use accuracy::{Case, CaseLeaks, Rate, watertightness};
use emit::{Isa, Kernel, graph, print_kernel};
use loaded::{Compiled, isas};
use program::{Genome, Program, kensler_shirley, moller_trumbore_volumes};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use scene::{SceneModel, Watertight};

/// Rays of every case, if nothing else is said.
const RAYS: u64 = 20_000;

#[test]
fn no_ray_leaks_at_an_edge_of_what_is_tight_at_edges() {
    no_leaks(&["packet-edges", "single-edges"], &Case::ALL, |leaks| {
        vec![leaks.leaks.edge.leak]
    });
}

#[test]
fn no_ray_leaks_at_all_of_what_is_watertight() {
    let scenes = ["packet-watertight", "single-watertight"];
    no_leaks(&scenes, &Case::ALL, |leaks| {
        vec![leaks.leaks.edge.leak, leaks.leaks.vertex.leak]
    });
}

/// The harness sees through these kernels what it is to see through none of the others.
#[test]
fn a_program_of_no_class_is_caught() {
    let graph = kensler_shirley();
    let program = graph.program(&moller_trumbore_volumes(&graph)).unwrap();
    for scene in ["packet", "single"] {
        let scene = SceneModel::preset(scene).unwrap();
        let leaks = leaks(
            std::slice::from_ref(&program),
            &scene,
            Isa::Sse2,
            &[Case::Fan],
            10_000,
        );
        let leaks = leaks[0][0].leaks;
        assert!(leaks.edge.leak.share() > 0.02, "{leaks:?}");
        assert!(leaks.vertex.leak.share() > 0.02, "{leaks:?}");
    }
}

fn no_leaks(scenes: &[&str], cases: &[Case], rates: impl Fn(&CaseLeaks) -> Vec<Rate>) {
    let rays = std::env::var("RAYBREED_LEAK_RAYS").ok();
    let rays = rays.map_or(RAYS, |rays| {
        rays.parse().expect("RAYBREED_LEAK_RAYS: a number")
    });
    for isa in isas() {
        for scene in scenes {
            let scene = SceneModel::preset(scene).unwrap();
            let programs = random_programs(&scene, isa);
            let share = rays / programs.len() as u64;
            let reports = leaks(&programs, &scene, isa, cases, share);
            for (place, case) in cases.iter().enumerate() {
                let (mut events, mut samples) = (0, 0);
                for (report, program) in reports.iter().zip(&programs) {
                    for rate in rates(&report[place]) {
                        events += rate.events;
                        samples += rate.samples;
                    }
                    let listing = || program.listing().join("\n");
                    assert_eq!(events, 0, "{}, {isa}, {case}: {}", scene.name, listing());
                }
                println!("{}, {isa}, {case}: {events} of {samples}", scene.name);
            }
        }
    }
}

/// Random programs of what the scene leaves of its graph.
fn random_programs(scene: &SceneModel, isa: Isa) -> Vec<Program> {
    assert_ne!(scene.watertight, Watertight::None);
    let graph = graph(scene, &[isa]);
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let random = (0..4).map(|_| Genome::random(graph.nodes().len(), &mut rng));
    random
        .map(|genome| graph.program(&genome).unwrap())
        .collect()
}

/// What leaks through every program's kernel.
fn leaks(
    programs: &[Program],
    scene: &SceneModel,
    isa: Isa,
    cases: &[Case],
    rays: u64,
) -> Vec<Vec<CaseLeaks>> {
    let print = |program| print_kernel(program, scene, isa, "kernel", "");
    let kernels: Vec<Kernel> = programs.iter().map(print).collect();
    let compiled = Compiled::new(kernels, scene.regime);
    let numbers = 0..programs.len();
    // Every program of every scene and instruction set has rays of its own.
    let seed = |number: usize| {
        let text = format!("{} {isa} {number}", scene.name);
        text.bytes()
            .fold(5, |seed, byte| 31 * seed % (1 << 40) + u64::from(byte))
    };
    let of_kernel = numbers
        .map(|number| watertightness(|| compiled.subject(number), cases, rays, seed(number)));
    of_kernel.collect()
}

//! Programs of a scene, and kernels compiled and loaded into the test itself, which a test may do.

#![allow(dead_code, reason = "not every test file uses all")]

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use accuracy::{Packets, Subject};
use emit::{Isa, Kernel, Recipe, checked_in, entry_symbol, graph, library};
use libloading::Library;
use measure::{Bench, Deal, FLAGS, Interrupt, Plan, Rustc, WorkerCommand, WorkloadSpec};
use program::{CheckedIn, Genome, Program, appendix, moller_trumbore_volumes};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use scene::{KernelFn, PACKET_SIZE, RayHits, RayPacket, Regime, SceneModel, Triangle};

/// The instruction sets that this machine has. The others are named as skipped.
pub fn isas() -> Vec<Isa> {
    let (here, missing): (Vec<Isa>, Vec<Isa>) =
        Isa::ALL.into_iter().partition(|isa| isa.is_available());
    for isa in missing {
        println!("skipped: {isa}, which this machine lacks");
    }
    here
}

/// The appendix's, Möller-Trumbore's, or what of them the scene allows, and random ones.
pub fn programs(scene: &SceneModel, isas: &[Isa], random: usize) -> Vec<Program> {
    let graph = graph(scene, isas);
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut genomes = match checked_in(scene, isas) {
        // None of both is sheared.
        CheckedIn::Watertight => Vec::new(),
        _ => vec![appendix(&graph), moller_trumbore_volumes(&graph)],
    };
    let random = (0..random).map(|_| Genome::random(graph.nodes().len(), &mut rng));
    genomes.extend(random);
    let programs = genomes.iter().map(|genome| graph.program(genome).unwrap());
    programs.collect()
}

/// The recipes of the published library.
pub fn recipes() -> Vec<Recipe> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../generated/recipes");
    let files = std::fs::read_dir(directory).unwrap();
    let mut paths: Vec<_> = files.map(|file| file.unwrap().path()).collect();
    paths.sort();
    let texts = paths
        .iter()
        .map(|path| std::fs::read_to_string(path).unwrap());
    texts
        .map(|text| Recipe::from_json(&text).unwrap())
        .collect()
}

/// A library of kernels, built as candidates are. Its source is kept beside `path`.
pub fn compile(kernels: &[Kernel], path: &Path) -> Library {
    let source = path.with_extension("rs");
    let output = path.with_extension(std::env::consts::DLL_EXTENSION);
    std::fs::write(&source, library(kernels)).unwrap();
    let status = Command::new(env!("RAYBREED_RUSTC"))
        .args(FLAGS)
        .args(["--crate-name", "loaded", "-o"])
        .args([&output, &source])
        .status();
    assert!(status.unwrap().success());
    // SAFETY: the library is ours and has no initialisers.
    unsafe { Library::new(output).unwrap() }
}

/// Kernels that take triangles by their vertices or edges, compiled and loaded.
pub struct Compiled {
    kernels: Vec<Kernel>,
    regime: Regime,
    library: Library,
    _directory: tempfile::TempDir,
}

impl Compiled {
    /// Compiles kernels of a regime, for instruction sets that the machine has.
    pub fn new(kernels: Vec<Kernel>, regime: Regime) -> Compiled {
        let directory = tempfile::tempdir().unwrap();
        Compiled {
            library: compile(&kernels, &directory.path().join("kernels")),
            kernels,
            regime,
            _directory: directory,
        }
    }

    /// One of them, as the accuracy lab takes it.
    pub fn subject(&self, number: usize) -> impl Subject + use<'_> {
        let layout = self.kernels[number].signature.layout;
        let symbol = entry_symbol(number);
        // SAFETY: the library exports this symbol with this signature.
        let function = unsafe { *self.library.get::<KernelFn>(symbol.as_bytes()).unwrap() };
        Packets::<PACKET_SIZE, _>::new(
            self.regime,
            move |packet: &mut RayPacket, hits: &mut RayHits, list: &[Triangle]| {
                let lists = layout.lists([list].into_iter());
                for list in lists.iter() {
                    // SAFETY: the function is of a library that is still there, for an instruction set
                    // that the machine has; all that it is given is valid.
                    unsafe {
                        function(packet, hits, list.numbers.as_ptr(), list.records);
                    }
                }
            },
        )
    }
}

/// A bench on a few packets and so many triangles.
pub fn small_bench(scene: &SceneModel, reference: Kernel, triangles: usize) -> Bench {
    let worker = WorkerCommand {
        program: env!("CARGO_BIN_EXE_measure-worker").into(),
        arguments: Vec::new(),
        patience: Duration::from_secs(20),
    };
    let workload = WorkloadSpec {
        seed: 3,
        triangles,
        packets: 4,
        target_range: None,
        scene: scene.clone(),
    };
    let rustc = Rustc::of_this_build().unwrap();
    Bench::new(rustc, worker, workload, reference, Interrupt::default())
}

/// Two rounds on one core, without a race.
pub fn plan() -> Plan {
    Plan {
        rounds: vec![0..2, 2..4],
        separate: false,
        race: None,
        racers: 0,
        cores: 1,
        deal: Deal::Kernels,
        noise_floor: true,
        sweep: false,
        trial: None,
    }
}

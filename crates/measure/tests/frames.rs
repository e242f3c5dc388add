//! Vectors that a kernel keeps on the stack lie in one line of the cache each, at whatever depth of the stack it runs.

use emit::{Isa, Kernel, print_kernel};
use measure::{Rustc, kernel_assembly};
use program::Genome;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use scene::{Grouping, Origin, Regime, SceneModel};

/// Random programs of each scene.
const PROGRAMS: usize = 2;

/// Kernels of random programs, and the rivals.
fn kernels(isa: Isa) -> Vec<Kernel> {
    let mut rng = ChaCha8Rng::seed_from_u64(22);
    let mut kernels = Vec::new();
    for preset in ["packet", "common-origin", "single", "single-watertight"] {
        let scene = SceneModel::preset(preset).unwrap();
        let graph = emit::graph(&scene, &[isa]);
        for _ in 0..PROGRAMS {
            let genome = Genome::random(graph.nodes().len(), &mut rng);
            let program = graph.program(&genome).unwrap();
            kernels.push(print_kernel(&program, &scene, isa, "kernel", ""));
        }
    }
    for grouping in [Grouping::Packet, Grouping::Single] {
        let rivals = rivals::of(grouping, Origin::General);
        let rivals = rivals.filter(|rival| rival.is_for(isa));
        kernels.extend(rivals.map(|rival| rival.kernel(isa, Regime::Leaf)));
    }
    kernels
}

/// The instructions that move a vector to or from the stack and do without alignment.
fn unaligned(kernels: &[Kernel]) -> Vec<String> {
    let rustc = Rustc::of_this_build().unwrap();
    let of_kernel = |kernel: &Kernel| -> Vec<String> {
        let assembly = kernel_assembly(&rustc, kernel).expect("a kernel compiles");
        let lines = assembly.lines().map(str::trim).filter(|line| {
            let moves = ["vmovup", "vmovdqu"].iter().any(|at| line.starts_with(at));
            let wide = line.contains("%ymm") || line.contains("%zmm");
            moves && wide && ["(%rsp", "(%rbp"].iter().any(|base| line.contains(base))
        });
        lines.map(str::to_owned).collect()
    };
    let halves = kernels.chunks(kernels.len().div_ceil(2));
    std::thread::scope(|scope| {
        let of_halves: Vec<_> = halves
            .map(|half| scope.spawn(move || half.iter().flat_map(of_kernel).collect::<Vec<_>>()))
            .collect();
        let of_halves = of_halves.into_iter();
        of_halves.flat_map(|half| half.join().unwrap()).collect()
    })
}

#[test]
fn vectors_on_the_stack_are_aligned() {
    for isa in [Isa::Avx2, Isa::Avx512] {
        let kernels = kernels(isa);
        assert_eq!(unaligned(&kernels), Vec::<String>::new(), "{isa}");
    }
}

#[test]
fn without_the_word_for_it_some_are_not() {
    let mut kernels = kernels(Isa::Avx2);
    for kernel in &mut kernels {
        kernel.source = kernel.source.replace("align_frame();", "");
    }
    assert_ne!(unaligned(&kernels), Vec::<String>::new());
}

//! Answers that must be alike to the last bit, on the paper's workload and where arithmetic is at its
//! worst: those of portable kernels on every instruction set that the machine has, and those of a
//! query for any hit and of one for the closest.

mod loaded;

use emit::{Kernel, entry_symbol, print_kernel};
use libloading::Library;
use loaded::{compile, isas, programs};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use scene::{
    Generator, KernelFn, NO_HITS, Output, Query, RayPacket, Regime, SceneModel, Triangle,
    Watertight, rays_mut,
};

const RANDOM_PROGRAMS: usize = 10;

/// Triangles in a list.
const LIST: usize = 16;

#[test]
fn portable_kernels_answer_alike_to_the_last_bit_on_every_isa() {
    let isas = isas();
    let directory = tempfile::tempdir().unwrap();
    for (scene, watertight) in [
        ("packet-portable", Watertight::None),
        ("common-origin-portable", Watertight::None),
        ("single-portable", Watertight::None),
        ("packet-portable", Watertight::Full),
        ("single-portable", Watertight::Full),
    ] {
        let mut scene = SceneModel::preset(scene).unwrap();
        scene.outputs = Output::ALL.to_vec();
        scene.watertight = watertight;
        for regime in [Regime::Shrinking, Regime::Fixed] {
            scene.regime = regime;
            let programs = programs(&scene, &isas, RANDOM_PROGRAMS);
            let kernels: Vec<Kernel> = programs
                .iter()
                .flat_map(|program| isas.iter().map(move |&isa| (program, isa)))
                .map(|(program, isa)| print_kernel(program, &scene, isa, "kernel", ""))
                .collect();
            let path = directory
                .path()
                .join(format!("{}-{watertight}-{regime}", scene.name));
            let compiled = compile(&kernels, &path);
            let mut hits = 0;
            for (place, input) in inputs().iter().enumerate() {
                for program in 0..programs.len() {
                    let answers = isas.iter().enumerate().map(|(number, isa)| {
                        let kernel = program * isas.len() + number;
                        (isa, run(&compiled, &kernels[kernel], kernel, input))
                    });
                    let answers: Vec<_> = answers.collect();
                    for (isa, answer) in &answers {
                        assert!(
                            *answer == answers[0].1,
                            "{}, {regime}, program {program}, input {place}: {isa} and {}",
                            scene.name,
                            answers[0].0
                        );
                    }
                    hits += usize::from(!answers[0].1.starts_with(&bits(&input.0)));
                }
            }
            assert!(hits > 100, "{hits}");
        }
    }
}

/// A ray has any hit where it has a closest one, ties and all, whatever the program.
#[test]
fn there_is_any_hit_where_there_is_a_closest() {
    let directory = tempfile::tempdir().unwrap();
    for (place, scene) in ["packet", "common-origin", "single"].iter().enumerate() {
        let closest = SceneModel::preset(scene).unwrap();
        let any = SceneModel {
            query: Query::Any,
            ..closest.clone()
        };
        let isas = isas();
        let isa = isas[isas.len() - 1 - place % isas.len()];
        let programs = programs(&closest, &[isa], RANDOM_PROGRAMS);
        let print = |scene| {
            let print = move |program| print_kernel(program, scene, isa, "kernel", "");
            programs.iter().map(print)
        };
        let kernels: Vec<Kernel> = print(&closest).chain(print(&any)).collect();
        let compiled = compile(&kernels, &directory.path().join(scene));
        let mut hits = 0;
        for (place, input) in inputs().iter().enumerate() {
            for program in 0..programs.len() {
                let t = |kernel: usize| run(&compiled, &kernels[kernel], kernel, input);
                let (closest, any) = (t(program), t(programs.len() + program));
                for ray in 0..64 {
                    let before = input.0.t[ray].to_bits();
                    let is_hit = closest[ray] != before;
                    let answer = if is_hit {
                        f32::NEG_INFINITY.to_bits()
                    } else {
                        before
                    };
                    assert_eq!(
                        any[ray], answer,
                        "{isa}, {scene}, {place}, {program}, {ray}"
                    );
                    hits += usize::from(is_hit);
                }
            }
        }
        assert!(hits > 1000, "{hits}");
    }
}

/// Runs a kernel, and gives the bits of all that it may write to.
fn run(library: &Library, kernel: &Kernel, number: usize, input: &Input) -> Vec<u32> {
    let (mut packet, mut hits) = (input.0.clone(), NO_HITS);
    let symbol = entry_symbol(number);
    let lists = kernel.signature.layout.lists([&input.1[..]].into_iter());
    let list = lists.iter().next().unwrap();
    // SAFETY: the library exports this symbol with this signature, for instruction sets that the
    // machine has; it reads the list and reads and writes packet and hits, all of which are valid.
    unsafe {
        let function = library.get::<KernelFn>(symbol.as_bytes()).unwrap();
        function(&mut packet, &mut hits, list.numbers.as_ptr(), list.records);
    }
    let mut bits = bits(&packet);
    let numbers = [hits.u, hits.v].into_iter();
    let numbers = numbers.chain(hits.normal).chain(hits.point).flatten();
    bits.extend(numbers.map(f32::to_bits).chain(hits.triangle));
    bits
}

fn bits(packet: &RayPacket) -> Vec<u32> {
    let values = packet.t.iter().chain(&packet.hit_t);
    values.copied().map(f32::to_bits).collect()
}

/// A packet and a list.
type Input = (RayPacket, Vec<Triangle>);

/// Packets and lists: the workload's, and worse ones made of them.
fn inputs() -> Vec<Input> {
    let workload = Generator {
        triangles: 64 * LIST,
        packets: 4,
        ..Generator::default()
    }
    .generate();
    let lists: Vec<&[Triangle]> = workload.triangles.chunks(LIST).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut inputs = Vec::new();
    for packet in &workload.packets {
        for (number, list) in lists.iter().enumerate() {
            let mut packet = packet.clone();
            let mut list = list.to_vec();
            match number % 5 {
                0 => {}
                // Far too large and far too small for what volumes multiply.
                1 => scale(
                    &mut packet,
                    &mut list,
                    2.0_f32.powi(rng.random_range(-50..=50)),
                ),
                // Rays through vertices, and others that start in one.
                2 => aim(&mut packet, &list),
                // Slivers: a vertex nearly on the edge between the others.
                3 => list.iter_mut().for_each(flatten),
                _ => spoil(&mut packet, &mut list, &mut rng),
            }
            inputs.push((packet, list));
        }
    }
    inputs
}

fn numbers<'a>(
    packet: &'a mut RayPacket,
    list: &'a mut [Triangle],
) -> impl Iterator<Item = &'a mut f32> {
    let rays = rays_mut(packet).into_iter().flatten();
    let vertices = list.iter_mut().flat_map(|one| {
        let Triangle { p0, p1, p2 } = one;
        p0.iter_mut().chain(p1).chain(p2)
    });
    rays.chain(vertices)
}

fn scale(packet: &mut RayPacket, list: &mut [Triangle], factor: f32) {
    numbers(packet, list).for_each(|number| *number *= factor);
}

fn aim(packet: &mut RayPacket, list: &[Triangle]) {
    for ray in 0..packet.t.len() {
        let [x, y, z] = list[ray % list.len()].p1;
        packet.dx[ray] = x - packet.ox[ray];
        packet.dy[ray] = y - packet.oy[ray];
        packet.dz[ray] = z - packet.oz[ray];
        if ray % 8 == 0 {
            (packet.ox[ray], packet.oy[ray], packet.oz[ray]) = (x, y, z);
        }
    }
}

fn flatten(triangle: &mut Triangle) {
    let Triangle { p0, p1, p2 } = triangle;
    for axis in 0..3 {
        p2[axis] = (p0[axis] + p1[axis]) / 2.0;
    }
    p2[0] = p2[0].next_up();
}

/// A number here and there becomes one that nobody asked for.
fn spoil(packet: &mut RayPacket, list: &mut [Triangle], rng: &mut ChaCha8Rng) {
    const ODD: [f32; 8] = [
        0.0,
        -0.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN_POSITIVE,
        1e-45,
    ];
    for number in numbers(packet, list) {
        if rng.random_range(0..40) == 0 {
            *number = ODD[rng.random_range(0..ODD.len())];
        }
    }
}

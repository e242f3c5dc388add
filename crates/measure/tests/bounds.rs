//! Bounds of scenes: the check that is emitted with a kernel refuses what is out of them, and within them
//! kernels are right, at both ends.

mod loaded;

use emit::{Isa, Kernel, entry_symbol, print_kernel};
use libloading::Library;
use loaded::{compile, isas, programs};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use scene::{
    Bounds, Directions, Generator, Grouping, KernelFn, NO_HITS, Origin, Range, Ray, RayPacket,
    SceneModel, Stored, Triangle, Verdict, Workload, judge, rays_mut,
};

const BOUNDS: &str = "coordinates=4,edge=0.001,directions=unit";

fn bounded(bounds: &str, change: impl Fn(&mut SceneModel)) -> SceneModel {
    let mut scene = SceneModel::preset("packet").unwrap();
    scene.bounds = Some(bounds.parse().unwrap());
    change(&mut scene);
    assert_eq!(scene.check(), Ok(()));
    scene
}

fn workload(scene: &SceneModel) -> Workload {
    Generator {
        seed: 2,
        triangles: 40,
        packets: 1,
        origin: scene.origin,
        range: scene.range,
        directions: scene.bounds.unwrap().directions,
        ..Generator::default()
    }
    .generate()
}

/// A kernel that marks all rays of a packet if the check refuses them or the triangles.
fn probe(scene: &SceneModel, isa: Isa) -> Kernel {
    let program = &programs(scene, &[isa], 1)[0];
    let mut kernel = print_kernel(program, scene, isa, "k", "");
    let (parameters, arguments) = match scene.grouping {
        Grouping::Packet => ("", "packet, records"),
        Grouping::Single | Grouping::Scalar => ("ray: usize, ", "packet, ray, records"),
    };
    let stored = scene.stored.type_name();
    let record = match scene.grouping {
        Grouping::Packet => stored.to_owned(),
        Grouping::Single | Grouping::Scalar => format!("{stored}<[f32; LANES]>"),
    };
    kernel.source += &format!(
        "pub fn probe<const N: usize>(packet: &mut Packet<N>, {parameters}records: &[{record}]) {{
             if check_k({arguments}).is_err() {{ packet.t = [f32::NEG_INFINITY; N]; }}
         }}"
    );
    kernel.function = format!("probe::<{}>", scene::PACKET_SIZE);
    kernel
}

/// A change that is out of bounds.
type Spoil = fn(&mut RayPacket, &mut [Triangle]);

#[test]
fn the_check_refuses_what_is_out_of_bounds_and_nothing_else() {
    let scenes = [
        bounded(BOUNDS, |_| {}),
        bounded(BOUNDS, |scene| scene.origin = Origin::Common),
        bounded(BOUNDS, |scene| scene.grouping = Grouping::Single),
        bounded(BOUNDS, |scene| scene.stored = Stored::EdgesAndNormal),
        bounded("coordinates=4,edge=0.001", |scene| {
            scene.range = Range::Segment;
            scene.grouping = Grouping::Single;
            scene.stored = Stored::Edges;
        }),
    ];
    let spoils: [(&str, Spoil); 7] = [
        ("nothing", |_, _| {}),
        ("an origin", |packet, _| packet.oy[0] = -4.5),
        ("where a ray goes", |packet, _| packet.dz[63] = 4.5),
        ("an infinite direction", |packet, _| {
            packet.dx[9] = f32::INFINITY
        }),
        ("a vertex", |_, triangles| triangles[39].p1[2] = 5.0),
        ("a side", |_, triangles| {
            triangles[7].p2 = triangles[7].p0.map(|x| x + 0.0001);
        }),
        ("another side", |_, triangles| {
            triangles[7].p2 = triangles[7].p1
        }),
    ];
    let directory = tempfile::tempdir().unwrap();
    for (place, scene) in scenes.iter().enumerate() {
        for isa in isas() {
            let kernel = probe(scene, isa);
            let path = directory.path().join(format!("probe-{place}-{isa}"));
            let compiled = compile(std::slice::from_ref(&kernel), &path);
            for (what, spoil) in spoils {
                let mut workload = workload(scene);
                let Workload { packets, triangles } = &mut workload;
                spoil(&mut packets[0], triangles);
                let mut packet = packets[0].clone();
                run(&compiled, &kernel, 0, &mut packet, triangles);
                let refused = packet.t[5] == f32::NEG_INFINITY;
                assert_eq!(refused, what != "nothing", "{place}, {isa}: {what}");
            }
            // Rays that are inactive may be anything, and NaN is never hit.
            let mut workload = workload(scene);
            let packet = &mut workload.packets[0];
            (packet.t[3], packet.dx[3]) = (0.0, 100.0);
            packet.dx[4] = f32::NAN;
            workload.triangles[0].p0[0] = f32::NAN;
            run(&compiled, &kernel, 0, packet, &workload.triangles);
            assert!(packet.t[5] > 0.0, "{place}, {isa}");
        }
    }
}

/// Scenes of the least and the greatest size that bounds can hold.
#[test]
fn within_their_bounds_kernels_are_right_at_any_scale() {
    let scenes = [
        (
            "coordinates=1e-9,edge=1e-13,directions=unit",
            2f32.powi(-32),
        ),
        ("coordinates=1e11,edge=1e5,directions=unit", 2f32.powi(34)),
        ("coordinates=1e11,edge=1e5", 2f32.powi(34)),
    ];
    let directory = tempfile::tempdir().unwrap();
    for (place, (bounds, scale)) in scenes.into_iter().enumerate() {
        let mut hits = 0;
        let scene = bounded(bounds, |scene| {
            if scene.bounds.unwrap().directions == Directions::Any {
                scene.range = Range::Segment;
            }
        });
        let Bounds { directions, .. } = scene.bounds.unwrap();
        for isa in isas() {
            let programs = programs(&scene, &[isa], 24);
            let print = |program| print_kernel(program, &scene, isa, "kernel", "");
            let kernels: Vec<Kernel> = programs.iter().map(print).collect();
            let path = directory.path().join(format!("scale-{place}-{isa}"));
            let compiled = compile(&kernels, &path);
            let mut rng = ChaCha8Rng::seed_from_u64(4);
            for (number, kernel) in kernels.iter().enumerate() {
                let mut workload = workload(&scene);
                larger(&mut workload, scale, directions);
                let triangles = &workload.triangles;
                let triangle = &triangles[rng.random_range(0..triangles.len())];
                let before = &workload.packets[0];
                let mut after = before.clone();
                run(
                    &compiled,
                    kernel,
                    number,
                    &mut after,
                    std::slice::from_ref(triangle),
                );
                for number_of_ray in 0..scene::PACKET_SIZE {
                    let ray = Ray::of(before, number_of_ray, scene.range);
                    let hit = after.t[number_of_ray].to_bits() != before.t[number_of_ray].to_bits();
                    let verdict = judge(&ray, triangle);
                    let right = match verdict {
                        Verdict::Hit { .. } => hit,
                        Verdict::Miss => !hit,
                        Verdict::Unsure { .. } => true,
                    };
                    hits += usize::from(hit);
                    let listing = || programs[number].listing().join("\n");
                    assert!(
                        right,
                        "{bounds}, {isa}: {ray:?}, {verdict:?}\n{}",
                        listing()
                    );
                }
            }
        }
        assert!(hits > 100, "{bounds}: {hits} hits");
    }
}

/// Makes all of a workload larger by a factor; directions of length one stay as they are.
fn larger(workload: &mut Workload, factor: f32, directions: Directions) {
    let vectors = match directions {
        Directions::Unit => 3,
        Directions::Any => 6,
    };
    for packet in &mut workload.packets {
        for component in rays_mut(packet).into_iter().take(vectors) {
            component.iter_mut().for_each(|x| *x *= factor);
        }
        packet.t = [f32::INFINITY; 64];
    }
    for Triangle { p0, p1, p2 } in &mut workload.triangles {
        for point in [p0, p1, p2] {
            *point = point.map(|x| x * factor);
        }
    }
}

/// Runs kernel `number` of a library over triangles.
fn run(
    compiled: &Library,
    kernel: &Kernel,
    number: usize,
    packet: &mut RayPacket,
    triangles: &[Triangle],
) {
    let symbol = entry_symbol(number);
    let lists = kernel
        .signature
        .layout
        .lists(triangles.chunks(triangles.len()));
    let mut hits = NO_HITS;
    for list in lists.iter() {
        // SAFETY: the library exports this symbol with this signature, for an instruction set that the
        // machine has; all that it is given is valid.
        unsafe {
            let function = *compiled.get::<KernelFn>(symbol.as_bytes()).unwrap();
            function(packet, &mut hits, list.numbers.as_ptr(), list.records);
        }
    }
}

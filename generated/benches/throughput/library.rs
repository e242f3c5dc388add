//! The library's tests: all that can be required of them, with every instruction set that there is.

use raybreed::{
    Block, Entry, Grouping, Intersector, Isa, Lists, Numeric, Origin, Packet, Ray, Scene, Triangle,
    Watertight, catalogue,
};
use scene::PACKET_SIZE;

use crate::bench::Bench;

/// Calls `time` for each scene of such lists and origins: all that can be required of arithmetic and edges.
macro_rules! of_each_requirement {
    ($time:ident($bench:expr), $lists:ident, $origin:ident) => {
        of_each_requirement!(
            @each $time($bench), $lists, $origin:
            Fast No, Fast Edges, Fast Full, Portable No, Portable Edges, Portable Full
        )
    };
    (
        @each $time:ident($bench:expr), $lists:ident, $origin:ident:
        $($numeric:ident $watertight:ident),+
    ) => {{$({
        enum Required {}

        impl Scene for Required {
            const NUMERIC: Numeric = Numeric::$numeric;
            const WATERTIGHT: Watertight = Watertight::$watertight;
            const LISTS: Lists = Lists::$lists;
            const ORIGIN: Origin = Origin::$origin;
        }

        $time::<Required>($bench);
    })+}};
}

/// Times packets of rays.
pub fn packets(bench: &mut Bench<'_>, lists: Lists) {
    match lists {
        Lists::Short => of_each_requirement!(time_packets(bench), Short, General),
        Lists::Long => of_each_requirement!(time_packets(bench), Long, General),
    }
}

/// Times packets of rays that start in one point.
pub fn common_origin(bench: &mut Bench<'_>, lists: Lists) {
    match lists {
        Lists::Short => of_each_requirement!(time_packets(bench), Short, Common),
        Lists::Long => of_each_requirement!(time_packets(bench), Long, Common),
    }
}

/// Times rays one by one against blocks as wide as vectors are.
pub fn rays(bench: &mut Bench<'_>, lists: Lists) {
    match lists {
        Lists::Short => of_each_requirement!(time_rays(bench), Short, General),
        Lists::Long => of_each_requirement!(time_rays(bench), Long, General),
    }
}

/// Times rays one by one against blocks of eight, whatever vectors there are: a leaf is one.
pub fn rays_in_eights(bench: &mut Bench<'_>) {
    of_each_requirement!(time_rays_in_eights(bench), Short, General);
}

fn time_packets<S: Scene>(bench: &mut Bench<'_>) {
    for (name, test) in tests::<S>(Grouping::Packet) {
        bench.time(
            &name,
            1,
            |one| triangle(&one[0]),
            |packet: &mut Packet<PACKET_SIZE>, triangles| test.closest(packet, triangles),
        );
    }
}

fn time_rays<S: Scene>(bench: &mut Bench<'_>) {
    for (name, test) in tests::<S>(Grouping::Ray) {
        match test.isa().lanes() {
            1 => time_blocks::<1, S>(bench, &name, test),
            4 => time_blocks::<4, S>(bench, &name, test),
            8 => time_blocks::<8, S>(bench, &name, test),
            16 => time_blocks::<16, S>(bench, &name, test),
            lanes => panic!("{name}: blocks of {lanes} are not timed"),
        }
    }
}

fn time_rays_in_eights<S: Scene>(bench: &mut Bench<'_>) {
    for (name, test) in tests::<S>(Grouping::Ray) {
        time_blocks::<8, S>(bench, &name, test);
    }
}

/// Times a test of one ray against blocks of `W` triangles.
fn time_blocks<const W: usize, S: Scene>(bench: &mut Bench<'_>, name: &str, test: Intersector<S>) {
    bench.time(
        name,
        W,
        block::<W>,
        |rays: &mut [Ray; PACKET_SIZE], blocks| {
            for ray in rays {
                test.ray_closest(ray, blocks);
            }
        },
    );
}

/// The test for a scene, with every instruction set that the processor has; and what it is called in a group. There
/// are none while the catalogue has nothing of the grouping.
///
/// # Panics
///
/// The catalogue has kernels of the grouping, but for some instruction set none for such a scene.
fn tests<S: Scene>(grouping: Grouping) -> Vec<(String, Intersector<S>)> {
    let kernels = catalogue()
        .iter()
        .filter(|kernel| kernel.grouping == grouping);
    let kernels: Vec<&Entry> = kernels.collect();
    if kernels.is_empty() {
        eprintln!("skipped: {grouping:?}, of which the catalogue has nothing");
        return Vec::new();
    }
    let mut tests = Vec::new();
    for isa in Isa::ALL {
        let name = format!("{}-{isa}", requirement::<S>());
        assert!(
            kernels.iter().any(|kernel| serves::<S>(kernel, isa)),
            "{name}: the catalogue has no such kernel of {grouping:?}"
        );
        if let Some(test) = Intersector::with_isa(isa) {
            tests.push((name, test));
        }
    }
    tests
}

/// Whether a kernel keeps what a scene requires, on processors that have no more than this instruction set.
fn serves<S: Scene>(kernel: &Entry, isa: Isa) -> bool {
    kernel.isa <= isa
        && kernel.tags.watertight >= S::WATERTIGHT
        && [S::NUMERIC, Numeric::Portable].contains(&kernel.numeric)
        && [S::ORIGIN, Origin::General].contains(&kernel.origin)
}

/// What a scene requires of arithmetic and edges, in a word.
fn requirement<S: Scene>() -> &'static str {
    match (S::NUMERIC, S::WATERTIGHT) {
        (Numeric::Fast, Watertight::No) => "fast",
        (Numeric::Fast, Watertight::Edges) => "fast-edges",
        (Numeric::Fast, Watertight::Full) => "fast-full",
        (Numeric::Portable, Watertight::No) => "portable",
        (Numeric::Portable, Watertight::Edges) => "portable-edges",
        (Numeric::Portable, Watertight::Full) => "portable-full",
    }
}

/// A triangle as the library has it.
pub fn triangle(&scene::Triangle { p0, p1, p2 }: &scene::Triangle) -> Triangle {
    Triangle { p0, p1, p2 }
}

/// A block of triangles.
pub fn block<const W: usize>(triangles: &[scene::Triangle]) -> Block<W> {
    let triangles: Vec<Triangle> = triangles.iter().map(triangle).collect();
    Block::block(&triangles)
}

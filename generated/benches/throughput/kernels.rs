//! Which kernels are timed: all of the library's, and the rivals that they are mostly compared with.

use ::rivals::methods::kensler_shirley::common_origin;
use ::rivals::methods::{havel_herout, wald};
use ::rivals::packet::kensler_shirley::kensler_shirley;
use ::rivals::packet::moller_trumbore::moller_trumbore;
use raybreed::kernels::sse2;
use raybreed::{CATALOGUE, Entry, Packet};
use scene::{INITIAL_T, Origin, PACKET_SIZE, RayPacket, Triangle};

use crate::regimes::{Bench, Rays, Test};

/// The function of a kernel of the catalogue, which has none itself: kernels are for packets of any size,
/// and a pointer is to one of them.
///
/// # Panics
///
/// It is missing here.
fn function(entry: &Entry) -> Test<Packet<PACKET_SIZE>, raybreed::Triangle> {
    match (entry.name, entry.isa) {
        ("common-origin-shrinking", "sse2") => sse2::common_origin_shrinking,
        ("packet-shrinking", "sse2") => sse2::packet_shrinking,
        (name, isa) => {
            panic!("benches/throughput/kernels.rs lacks the function of {name} for {isa}")
        }
    }
}

/// Whether this processor has an instruction set of the catalogue.
fn has(isa: &str) -> bool {
    match isa {
        "scalar" | "sse2" => true,
        "sse4.1" => is_x86_feature_detected!("sse4.1"),
        "avx2" => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
        "avx512" => {
            is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl")
        }
        _ => false,
    }
}

/// Times the library's kernels that take such origins.
pub fn library(bench: &mut Bench<'_>, origin: Origin) {
    for entry in CATALOGUE {
        // That one is missing is said wherever the bench runs.
        let test = function(entry);
        if entry.origin == raybreed::Origin::Common && origin == Origin::General {
            continue;
        }
        let name = format!("raybreed-{}-{}", entry.name, entry.isa);
        if !has(entry.isa) {
            eprintln!("skipped: {name}, for this processor lacks {}", entry.isa);
            continue;
        }
        let vertices = |&Triangle { p0, p1, p2 }: &Triangle| raybreed::Triangle { p0, p1, p2 };
        // SAFETY: the processor has the instruction set.
        unsafe { bench.time(&name, vertices, test) }
    }
}

/// Times the rivals that take such origins.
pub fn rivals(bench: &mut Bench<'_>, origin: Origin) {
    const N: usize = PACKET_SIZE;
    let vertices = Triangle::clone;
    // SAFETY: every x86-64 processor has SSE2, which is all that they need in their crate.
    unsafe {
        bench.time(
            "moller-trumbore-sse2",
            vertices,
            moller_trumbore::<N, false>,
        );
        bench.time(
            "kensler-shirley-sse2",
            vertices,
            kensler_shirley::<N, false>,
        );
        if origin == Origin::Common {
            bench.time(
                "kensler-shirley-common-sse2",
                vertices,
                common_origin::<N, false>,
            );
        }
        bench.time("wald-sse2", wald::prepare, wald::packet::<N, false>);
        bench.time(
            "havel-herout-sse2",
            havel_herout::prepare,
            havel_herout::packet::<N, false>,
        );
    }
}

impl Rays for RayPacket {
    fn of(packet: &RayPacket) -> Self {
        packet.clone()
    }

    fn t(&mut self) -> &mut [f32; PACKET_SIZE] {
        &mut self.t
    }
}

impl Rays for Packet<PACKET_SIZE> {
    fn of(packet: &RayPacket) -> Self {
        let mut rays = Packet::new();
        for i in 0..PACKET_SIZE {
            let origin = [packet.ox[i], packet.oy[i], packet.oz[i]];
            let direction = [packet.dx[i], packet.dy[i], packet.dz[i]];
            rays.set_ray(i, origin, direction, INITIAL_T);
        }
        rays
    }

    fn t(&mut self) -> &mut [f32; PACKET_SIZE] {
        &mut self.t
    }
}

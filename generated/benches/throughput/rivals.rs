//! The rivals that kernels are mostly compared with, on SSE2: every x86-64 processor has it, and their crate compiles
//! them for nothing else.

use ::rivals::lanes::LANES;
use ::rivals::methods::{havel_herout, kensler_shirley, wald, woop};
use ::rivals::{packet, single};
use raybreed::Block;
use scene::{PACKET_SIZE, RayPacket, Triangle};

use crate::bench::Bench;
use crate::library::block;

/// Times the tests of packets.
pub fn packets(bench: &mut Bench<'_>) {
    /// A test by its path, and what it makes of a triangle.
    macro_rules! time {
        ($name:literal, $prepare:path, $($test:ident)::+) => {
            bench.time(
                $name,
                1,
                |one| $prepare(&one[0]),
                // SAFETY: the processor has SSE2.
                |packet: &mut RayPacket, triangles| unsafe {
                    $($test)::+::<PACKET_SIZE, false>(packet, triangles)
                },
            )
        };
    }
    time!(
        "moller-trumbore-sse2",
        Triangle::clone,
        packet::moller_trumbore::moller_trumbore
    );
    time!(
        "kensler-shirley-sse2",
        Triangle::clone,
        packet::kensler_shirley::kensler_shirley
    );
    time!("woop-sse2", Triangle::clone, woop::packet);
    time!("wald-sse2", wald::prepare, wald::packet);
    time!(
        "havel-herout-sse2",
        havel_herout::prepare,
        havel_herout::packet
    );
}

/// Times those that need a common origin.
pub fn common_origin(bench: &mut Bench<'_>) {
    bench.time(
        "kensler-shirley-common-sse2",
        1,
        |one| one[0],
        // SAFETY: the processor has SSE2.
        |packet: &mut RayPacket, triangles| unsafe {
            kensler_shirley::common_origin::<PACKET_SIZE, false>(packet, triangles)
        },
    );
}

/// Times the tests of one ray against blocks.
pub fn rays(bench: &mut Bench<'_>) {
    /// A test by its path, and what it makes of triangles.
    macro_rules! time {
        ($name:literal, $prepare:expr, $($test:ident)::+) => {
            bench.time(
                $name,
                LANES,
                $prepare,
                |packet: &mut RayPacket, blocks| {
                    for ray in 0..PACKET_SIZE {
                        // SAFETY: the processor has SSE2.
                        unsafe { $($test)::+::<PACKET_SIZE, false>(packet, ray, blocks) };
                    }
                },
            )
        };
    }
    time!(
        "moller-trumbore-sse2",
        vertices,
        single::moller_trumbore::moller_trumbore
    );
    time!(
        "kensler-shirley-sse2",
        vertices,
        single::kensler_shirley::kensler_shirley
    );
    time!("woop-sse2", vertices, woop::single);
    time!(
        "wald-sse2",
        |block| lanes(block, wald::prepare),
        wald::single
    );
    time!(
        "havel-herout-sse2",
        |block| lanes(block, havel_herout::prepare),
        havel_herout::single
    );
}

/// A block of triangles by their vertices.
fn vertices(triangles: &[Triangle]) -> Triangle<[f32; LANES]> {
    let Block { p0, p1, p2 } = block::<LANES>(triangles);
    Triangle { p0, p1, p2 }
}

/// A block of what a method makes of triangles, filled up with NaN.
fn lanes<const NUMBERS: usize>(
    triangles: &[Triangle],
    prepare: fn(&Triangle) -> [f32; NUMBERS],
) -> [[f32; LANES]; NUMBERS] {
    let mut block = [[f32::NAN; LANES]; NUMBERS];
    for (lane, triangle) in triangles.iter().enumerate() {
        for (lanes, number) in block.iter_mut().zip(prepare(triangle)) {
            lanes[lane] = number;
        }
    }
    block
}

//! The library in ten lines: `cargo run --release --package raybreed --example closest`.

use raybreed::{Packet, Triangle, closest_hits};

fn main() {
    let floor = |z| Triangle {
        p0: [-4.0, -4.0, z],
        p1: [4.0, -4.0, z],
        p2: [0.0, 4.0, z],
    };
    let mut packet = Packet::<64>::new();
    for ray in 0..64 {
        let x = ray as f32 / 32.0 - 1.0;
        packet.set_ray(ray, [0.0, 0.0, 0.0], [x, 0.0, 1.0], f32::INFINITY);
    }
    closest_hits(&mut packet, &[floor(7.0), floor(2.0), floor(3.0)]);
    println!("{:?}", packet.t);
}

//! The library in ten lines: `cargo run --release --package raybreed --example closest`.

use raybreed::{Intersector, Packet, Ray, Triangle};

fn main() {
    let floor = |z| Triangle::new([-4.0, -4.0, z], [4.0, -4.0, z], [0.0, 4.0, z]);
    let ray = |i| Ray::new([0.0; 3], [i as f32 / 32.0 - 1.0, 0.0, 1.0]);
    let mut packet = Packet::<64>::of(&std::array::from_fn(ray));
    Intersector::<()>::new().closest(&mut packet, &[floor(7.0), floor(2.0), floor(3.0)]);
    println!("{:?}", packet.t);
}

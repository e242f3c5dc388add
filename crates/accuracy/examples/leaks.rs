//! tmp
#[path = "../tests/kernels/mod.rs"]
mod kernels;
use accuracy::*;
fn main() {
    let n: u64 = std::env::args().nth(1).unwrap().parse().unwrap();
    type K = fn(&scene::Ray, &scene::Triangle) -> Option<f32>;
    for (name, k) in [
        ("mt", kernels::moller_trumbore as K),
        ("ks", kernels::kensler_shirley),
        ("3v", kernels::three_volumes),
        ("woop", kernels::woop),
    ] {
        for case in Case::ALL {
            let s = std::time::Instant::now();
            let r = watertightness(|| Scalar(k), &[case], n, 1)[0].leaks;
            println!(
                "{name:5} {case:16} edge {}/{} {:.2}% vertex {}/{} {:.2}% else {}/{} double {:.2}% {} unpaired {}/{} {:?}",
                r.edge.events,
                r.edge.samples,
                100. * r.edge.share(),
                r.vertex.events,
                r.vertex.samples,
                100. * r.vertex.share(),
                r.elsewhere.events,
                r.elsewhere.samples,
                100. * r.double.share(),
                r.double.events,
                r.unpaired.events,
                r.unpaired.samples,
                s.elapsed()
            );
        }
    }
}

//! Ray-triangle tests a second of all that the library can be asked for, and of some rivals:
//! `cargo bench --package raybreed`.

mod bench;
mod library;
#[cfg(target_arch = "x86_64")]
mod rivals;
mod variants;

use std::time::Duration;

use criterion::Criterion;
use raybreed::{Isa, Lists};
use scene::{Generator, Origin, Regime, Workload};

use crate::bench::Bench;

/// Packets that are run over in turn. One differs from another by a fifth. They make a million branches, more than a
/// processor learns by heart.
const PACKETS: usize = 4;

fn main() {
    // There are hundreds to time, so each is timed shortly: ten runs of the slowest.
    let mut criterion = Criterion::default()
        .without_plots()
        .sample_size(10)
        .nresamples(2000)
        .warm_up_time(Duration::from_millis(50))
        .measurement_time(Duration::from_millis(600))
        .configure_from_args();
    for isa in Isa::ALL.into_iter().filter(|isa| !isa.is_available()) {
        eprintln!("skipped: {isa}, which this processor lacks");
    }
    bench(&mut criterion);
    criterion.final_summary();
}

/// Times everything, a group for each regime and what is tested.
fn bench(criterion: &mut Criterion) {
    let (general, common) = (workload(Origin::General), workload(Origin::Common));
    for (regime, lists) in [
        (Regime::Leaf, Lists::Short),
        (Regime::Shrinking, Lists::Long),
    ] {
        let name = |what| format!("{regime}/{what}");
        packets(
            Bench::new(criterion, &name("packet"), regime, &general),
            lists,
        );
        common_origin(
            Bench::new(criterion, &name("common-origin"), regime, &common),
            lists,
        );
        rays(Bench::new(criterion, &name("ray"), regime, &general), lists);
    }
    let leaf = Regime::Leaf;
    library::rays_in_eights(&mut Bench::new(
        criterion,
        "leaf/ray-in-eights",
        leaf,
        &general,
    ));
    variants::bench(&mut Bench::new(criterion, "variants", leaf, &general));
}

/// Times packets of rays.
fn packets(mut bench: Bench<'_>, lists: Lists) {
    library::packets(&mut bench, lists);
    #[cfg(target_arch = "x86_64")]
    rivals::packets(&mut bench);
}

/// Times packets of rays that start in one point.
fn common_origin(mut bench: Bench<'_>, lists: Lists) {
    library::common_origin(&mut bench, lists);
    #[cfg(target_arch = "x86_64")]
    {
        rivals::packets(&mut bench);
        rivals::common_origin(&mut bench);
    }
}

/// Times rays one by one.
fn rays(mut bench: Bench<'_>, lists: Lists) {
    library::rays(&mut bench, lists);
    #[cfg(target_arch = "x86_64")]
    rivals::rays(&mut bench);
}

/// The rays and triangles of the paper.
fn workload(origin: Origin) -> Workload {
    Generator {
        packets: PACKETS,
        origin,
        ..Generator::default()
    }
    .generate()
}

//! Ray-triangle tests a second of the library's kernels and of some rivals:
//! `cargo bench --package raybreed`.

#[cfg(target_arch = "x86_64")]
mod kernels;
#[cfg(target_arch = "x86_64")]
mod regimes;

#[cfg(target_arch = "x86_64")]
fn main() {
    use std::time::Duration;

    let mut criterion = criterion::Criterion::default()
        .without_plots()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    regimes::bench(&mut criterion);
    criterion.final_summary();
}

#[cfg(not(target_arch = "x86_64"))]
fn main() {
    eprintln!("skipped: all kernels and rivals are for x86-64");
}

//! A worker by itself, for the tests of this crate; commands run themselves as one.

fn main() -> std::io::Result<()> {
    measure::run_worker()
}

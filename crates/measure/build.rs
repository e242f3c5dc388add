//! Remembers which rustc builds this crate: it is the one that will compile the candidates.

use std::process::Command;

fn main() {
    let rustc = std::env::var("RUSTC").expect("cargo names its rustc");
    let output = Command::new(&rustc)
        .arg("--version")
        .output()
        .expect("the rustc that cargo runs can be run");
    let version = String::from_utf8_lossy(&output.stdout);
    println!("cargo::rustc-env=RAYBREED_RUSTC={rustc}");
    println!("cargo::rustc-env=RAYBREED_RUSTC_VERSION={}", version.trim());
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=RUSTC");
}

//! Kernels compiled and loaded into the test itself, which a test may do.

#![allow(dead_code, reason = "not every test file uses all")]

use std::path::Path;
use std::process::Command;

use emit::{Isa, Kernel, library};
use libloading::Library;
use measure::FLAGS;

/// The instruction sets that this machine has. The others are named as skipped.
pub fn isas() -> Vec<Isa> {
    let (here, missing): (Vec<Isa>, Vec<Isa>) =
        Isa::ALL.into_iter().partition(|isa| isa.is_available());
    for isa in missing {
        println!("skipped: {isa}, which this machine lacks");
    }
    here
}

/// A library of kernels, built as candidates are. Its source is kept beside `path`.
pub fn compile(kernels: &[Kernel], path: &Path) -> Library {
    let source = path.with_extension("rs");
    let output = path.with_extension(std::env::consts::DLL_EXTENSION);
    std::fs::write(&source, library(kernels)).unwrap();
    let status = Command::new(env!("RAYBREED_RUSTC"))
        .args(FLAGS)
        .args(["--crate-name", "loaded", "-o"])
        .args([&output, &source])
        .status();
    assert!(status.unwrap().success());
    // SAFETY: the library is ours and has no initialisers.
    unsafe { Library::new(output).unwrap() }
}

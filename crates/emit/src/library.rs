//! Many kernels as one library that can be loaded and called: the timed binary.

use std::fmt::Write;

use crate::isa::Isa;
use crate::kernel::Kernel;

const ABI: &str = include_str!("../../../templates/abi.rs");

/// The symbol under which a library exports its kernel number `index`.
pub fn entry_symbol(index: usize) -> String {
    format!("raybreed_kernel_{index}")
}

/// The source of a `no_std` `cdylib` with all of `kernels`.
///
/// Each is exported as [`entry_symbol`] of its place, with the signature
/// [`scene::KernelFn`]: a packet, the triangles and their number. The packet is
/// taken by reference, for with a pointer the compiler would not know its alignment.
pub fn library(kernels: &[Kernel]) -> String {
    let mut text = String::from("#![no_std]\n#![allow(warnings)]\n\n");
    let _ = write!(text, "mod abi {{\n{ABI}}}\npub use abi::*;\n");
    for isa in Isa::ALL {
        let of_isa = || {
            let numbered = kernels.iter().enumerate();
            numbered.filter(move |(_, kernel)| kernel.isa == isa)
        };
        if of_isa().next().is_none() {
            continue;
        }
        let (lanes, module) = (isa.lanes(), isa.module());
        let _ = write!(text, "\nmod {module} {{\npub mod lanes {{\n{lanes}}}\n");
        for (index, kernel) in of_isa() {
            let _ = write!(text, "\npub mod kernel_{index} {{\n{}}}\n", kernel.source);
        }
        text += "}\n";
    }
    let size = scene::PACKET_SIZE;
    for (index, kernel) in kernels.iter().enumerate() {
        let (module, function, symbol) =
            (kernel.isa.module(), &kernel.function, entry_symbol(index));
        let _ = write!(
            text,
            "\n#[unsafe(no_mangle)]\n\
             pub unsafe extern \"C\" fn {symbol}(\n    \
                 packet: &mut Packet<{size}>,\n    \
                 triangles: *const Triangle,\n    \
                 count: usize,\n\
             ) {{\n    \
                 unsafe {{\n        \
                     let triangles = core::slice::from_raw_parts(triangles, count);\n        \
                     {module}::kernel_{index}::{function}(packet, triangles);\n    \
                 }}\n\
             }}\n"
        );
    }
    text += "\n#[panic_handler]\nfn panic(_: &core::panic::PanicInfo) -> ! {\n    loop {}\n}\n";
    text
}

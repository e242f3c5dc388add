//! Many kernels as one library that can be loaded and called: the timed binary.

use std::fmt::Write;

use scene::{Grouping, Record};

use crate::isa::Isa;
use crate::kernel::{Kernel, Signature};

/// The text of the checks of bounds.
pub(crate) const BOUNDS: &str = include_str!("../../../templates/bounds.rs");

const COUNTED: &str = include_str!("../../../templates/counted.rs");

const ABI: &str = include_str!("../../../templates/abi.rs");

/// The symbol under which a library exports its kernel number `index`.
pub fn entry_symbol(index: usize) -> String {
    format!("raybreed_kernel_{index}")
}

/// The symbol under which a library exports the precomputation of its kernel number `index`, if that has
/// one: a [`scene::PrepareFn`].
pub fn prepare_symbol(index: usize) -> String {
    format!("raybreed_prepare_{index}")
}

/// The words that a [`counted_library`] counts, in the order of its counts.
pub const COUNTED_WORDS: [&str; 20] = [
    "add",
    "sub",
    "mul",
    "mul_add",
    "mul_sub",
    "neg_mul_add",
    "div",
    "estimate_reciprocal",
    "min",
    "max",
    "less",
    "at_most",
    "both",
    "either",
    "select",
    "flip_sign",
    "sign_is_clear",
    "bit_or",
    "bit_xor",
    "exact_difference",
];

/// The symbol under which a [`counted_library`] exports where its counts for an instruction set are: a
/// function without parameters that gives a pointer to as many `u64` as there are [`COUNTED_WORDS`].
pub fn counts_symbol(isa: Isa) -> String {
    format!("raybreed_counts_{}", isa.module())
}

/// The source of a `no_std` `cdylib` with all of `kernels`.
///
/// Each is exported as [`entry_symbol`] of its place, with the signature [`scene::KernelFn`]; a
/// kernel of one ray is called for every ray of the packet. Packet and hits are taken by reference,
/// for with a pointer the compiler would not know their alignment.
pub fn library(kernels: &[Kernel]) -> String {
    library_of(kernels, |isa| {
        format!("pub mod lanes {{\n{}}}\n", isa.lanes())
    })
}

/// The same, with words that count how often they are used.
pub fn counted_library(kernels: &[Kernel]) -> String {
    let mut text = library_of(kernels, |isa| {
        let counted = COUNTED.replace(
            "        #[target_feature(enable = \"counted\")]\n",
            &isa.attribute(),
        );
        let lanes = isa.lanes();
        format!("pub mod spelled {{\n{lanes}}}\npub mod lanes {{\n{counted}}}\n")
    });
    for isa in Isa::ALL {
        if kernels.iter().any(|kernel| kernel.isa == isa) {
            let (module, symbol) = (isa.module(), counts_symbol(isa));
            let _ = write!(
                text,
                "\n#[unsafe(no_mangle)]\n\
                 pub extern \"C\" fn {symbol}() -> *mut [u64; {}] {{\n    \
                     &raw mut {module}::lanes::COUNTS\n\
                 }}\n",
                COUNTED_WORDS.len()
            );
        }
    }
    text
}

/// A library of kernels whose lanes, for an instruction set, are what `lanes` says.
fn library_of(kernels: &[Kernel], lanes: impl Fn(Isa) -> String) -> String {
    let mut text = String::from("#![no_std]\n#![allow(warnings)]\n\n");
    let _ = write!(text, "mod abi {{\n{ABI}}}\npub use abi::*;\n");
    if kernels.iter().any(|kernel| kernel.is_bounded) {
        let _ = write!(text, "\npub mod bounds {{\n{BOUNDS}}}\n");
    }
    for isa in Isa::ALL {
        let of_isa = || {
            let numbered = kernels.iter().enumerate();
            numbered.filter(move |(_, kernel)| kernel.isa == isa)
        };
        if of_isa().next().is_none() {
            continue;
        }
        let (lanes, module) = (lanes(isa), isa.module());
        let _ = write!(text, "\nmod {module} {{\n{lanes}");
        for (index, kernel) in of_isa() {
            let _ = write!(text, "\npub mod kernel_{index} {{\n{}}}\n", kernel.source);
        }
        text += "}\n";
    }
    for (index, kernel) in kernels.iter().enumerate() {
        text += &entry(index, kernel);
    }
    text += "\n#[panic_handler]\nfn panic(_: &core::panic::PanicInfo) -> ! {\n    loop {}\n}\n";
    text
}

/// The call of a kernel for packets of other than the usual size, which are cut from a usual one, or put together
/// of as many as follow one another.
fn other_packets(rays: usize, function: &str) -> String {
    let size = scene::PACKET_SIZE;
    let copies = |from_usual: bool| -> String {
        let components = ["ox", "oy", "oz", "dx", "dy", "dz", "t", "hit_t", "t_min"];
        let of_other = |name: &str| format!("(&raw mut other.{name}).cast::<f32>().add(to)");
        let of_usual = |name: &str| format!("(&raw mut (*usual).{name}).cast::<f32>().add(from)");
        let copied = components
            .into_iter()
            .filter(|name| from_usual || name.contains('t'));
        let copy = |name: &str| {
            let (usual, other) = (of_usual(name), of_other(name));
            let (source, target) = if from_usual {
                (usual, other)
            } else {
                (other, usual)
            };
            format!("core::ptr::copy_nonoverlapping({source}, {target}, count);\n")
        };
        copied.map(copy).collect()
    };
    let together = rays.div_ceil(size);
    format!(
        "let first: *mut Packet<{size}> = packet;\n\
         let count = {count};\n\
         for start in (0..{all}).step_by({rays}) {{\n\
             let mut other: Packet<{rays}> = core::mem::zeroed();\n\
             for to in (0..{rays}).step_by(count) {{\n\
                 let (usual, from) = (first.add((start + to) / {size}), (start + to) % {size});\n\
                 {there}\
             }}\n\
             {function}(&mut other, records);\n\
             for to in (0..{rays}).step_by(count) {{\n\
                 let (usual, from) = (first.add((start + to) / {size}), (start + to) % {size});\n\
                 {back}\
             }}\n\
         }}",
        count = rays.min(size),
        all = together * size,
        there = copies(true),
        back = copies(false),
    )
}

/// The exported function of a kernel.
fn entry(index: usize, kernel: &Kernel) -> String {
    let size = scene::PACKET_SIZE;
    let (module, function, symbol) = (kernel.isa.module(), &kernel.function, entry_symbol(index));
    let Signature {
        grouping,
        rays,
        hits,
        layout,
    } = kernel.signature;
    let hits = if hits { "hits, " } else { "" };
    let lanes = layout.lanes;
    let function = format!("{module}::kernel_{index}::{function}");
    let (number, call) = match grouping {
        Grouping::Packet => (
            "f32".to_owned(),
            match rays == size {
                true => format!("{function}(packet, {hits}records);"),
                false => other_packets(rays, &function),
            },
        ),
        Grouping::Single | Grouping::Scalar => (
            format!("[f32; {lanes}]"),
            format!("for ray in 0..{size} {{ {function}(packet, {hits}ray, records); }}"),
        ),
    };
    let record = match layout.record {
        Record::Stored(stored) => format!("{}<{number}>", stored.type_name()),
        Record::Own { numbers, .. } => format!("[{number}; {numbers}]"),
    };
    let numbers = layout.record.numbers();
    let prepare = kernel.prepare.as_ref().map_or(String::new(), |prepare| {
        let symbol = prepare_symbol(index);
        format!(
            "\n#[unsafe(no_mangle)]\n\
             pub unsafe extern \"C\" fn {symbol}(\n    \
                 triangles: *const Triangle,\n    \
                 count: usize,\n    \
                 records: *mut [f32; {numbers}],\n\
             ) {{\n    \
                 for place in 0..count {{\n        \
                     unsafe {{\n            \
                         let record = {module}::kernel_{index}::{prepare}(&*triangles.add(place));\n            \
                         records.add(place).write(record);\n        \
                     }}\n    \
                 }}\n\
             }}\n"
        )
    });
    format!(
        "{prepare}\n#[unsafe(no_mangle)]\n\
         pub unsafe extern \"C\" fn {symbol}(\n    \
             packet: &mut Packet<{size}>,\n    \
             hits: &mut Hits<{size}>,\n    \
             records: *const {record},\n    \
             count: usize,\n\
         ) {{\n    \
             unsafe {{\n        \
                 let records = core::slice::from_raw_parts(records, count);\n        \
                 {call}\n    \
             }}\n\
         }}\n"
    )
}

#[cfg(test)]
mod tests {
    use super::{COUNTED, COUNTED_WORDS};

    #[test]
    fn words_are_counted_in_the_order_in_which_they_are_told() {
        let told = COUNTED_WORDS.iter().enumerate();
        let told = told.map(|(place, word)| format!("    {place} {word}("));
        let mut counted = COUNTED
            .lines()
            .skip_while(|line| *line != "counted! {")
            .skip(1);
        for line in told {
            let found = counted.next().unwrap();
            assert!(found.starts_with(&line), "{found}");
        }
        assert_eq!(counted.next(), Some("}"));
    }
}

//! Many kernels compiled at once, and those found that break the build.

use std::path::{Path, PathBuf};

use emit::Kernel;

use crate::interrupt::Interrupt;
use crate::protocol::Entry;
use crate::rustc::{CompileError, Rustc};
use crate::twins::Functions;

/// What libraries are made of kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// As few as are compiled at once.
    Together,
    /// One for each kernel.
    Separate,
    /// As few, with words that are counted.
    Counted,
}

/// Where a kernel is in a library, and what its machine code is.
#[derive(Clone, Debug)]
pub(crate) struct Compiled {
    /// Its place.
    pub entry: Entry,
    /// A hash of its machine code, the same for all that are the same; none if that was not told.
    pub code: Option<String>,
}

/// Compiles `kernels` into libraries in `directory`. Gives every kernel's place, or why it has none.
pub(crate) fn compile(
    rustc: &Rustc,
    kernels: &[&Kernel],
    directory: &Path,
    shape: Shape,
    interrupt: &Interrupt,
) -> Vec<Result<Compiled, CompileError>> {
    let libraries = match shape {
        Shape::Separate => kernels.len(),
        Shape::Together | Shape::Counted => kernels.len().min(rustc.jobs()),
    };
    let text = match shape {
        Shape::Together | Shape::Separate => emit::library,
        Shape::Counted => emit::counted_library,
    };
    // Dealt by length, so that all libraries take as long.
    let mut by_length: Vec<usize> = (0..kernels.len()).collect();
    by_length.sort_by_key(|&kernel| std::cmp::Reverse(kernels[kernel].source.len()));
    let shares: Vec<Vec<usize>> = (0..libraries)
        .map(|first| {
            by_length
                .iter()
                .skip(first)
                .step_by(libraries)
                .copied()
                .collect()
        })
        .collect();
    let job = |(number, share): (usize, &[usize])| {
        let stem = directory.join(format!("{number}"));
        let share: Vec<&Kernel> = share.iter().map(|&kernel| kernels[kernel]).collect();
        compile_share(rustc, text, &share, &stem, interrupt)
    };
    let mut built: Vec<_> = kernels
        .iter()
        .map(|_| Err(CompileError::Interrupted))
        .collect();
    let numbered: Vec<(usize, &[usize])> = (0..).zip(shares.iter().map(Vec::as_slice)).collect();
    for at_once in numbered.chunks(rustc.jobs()) {
        std::thread::scope(|scope| {
            let running: Vec<_> = at_once
                .iter()
                .map(|&share| (share.1, scope.spawn(move || job(share))))
                .collect();
            for (share, job) in running {
                let libraries = job.join().expect("compiling does not panic");
                for (&kernel, library) in share.iter().zip(libraries) {
                    built[kernel] = library;
                }
            }
        });
    }
    built
}

/// Compiles kernels into one library; if that fails, halves them until the culprit is alone.
fn compile_share(
    rustc: &Rustc,
    text: fn(&[Kernel]) -> String,
    kernels: &[&Kernel],
    stem: &Path,
    interrupt: &Interrupt,
) -> Vec<Result<Compiled, CompileError>> {
    let source = with_suffix(stem, ".rs");
    let library = with_suffix(stem, std::env::consts::DLL_SUFFIX);
    let owned: Vec<Kernel> = kernels.iter().map(|&kernel| kernel.clone()).collect();
    let written = std::fs::write(&source, text(&owned));
    let built = match written {
        Ok(()) => rustc.compile(&source, &library, interrupt),
        Err(error) => Err(CompileError::Refused(error.to_string())),
    };
    match built {
        Ok(()) => {
            let object = std::fs::read(library.with_extension("o")).unwrap_or_default();
            let functions = Functions::read(&object);
            let compiled = (0..).zip(kernels).map(|(index, kernel)| {
                Ok(Compiled {
                    entry: Entry::new(library.clone(), index, kernel.signature),
                    code: functions
                        .as_ref()
                        .and_then(|functions| functions.hash(&emit::entry_symbol(index))),
                })
            });
            compiled.collect()
        }
        Err(CompileError::Interrupted) => vec![Err(CompileError::Interrupted); kernels.len()],
        Err(error) if kernels.len() == 1 => vec![Err(error)],
        Err(error) => {
            let rustc = &match error {
                CompileError::TimedOut => rustc.for_a_half(),
                _ => rustc.clone(),
            };
            let (first, second) = kernels.split_at(kernels.len() / 2);
            let mut built = compile_share(rustc, text, first, &with_suffix(stem, "a"), interrupt);
            built.extend(compile_share(
                rustc,
                text,
                second,
                &with_suffix(stem, "b"),
                interrupt,
            ));
            built
        }
    }
}

fn with_suffix(stem: &Path, suffix: &str) -> PathBuf {
    let mut path = stem.as_os_str().to_owned();
    path.push(suffix);
    path.into()
}

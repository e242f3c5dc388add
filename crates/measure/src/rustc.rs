//! The compiler: the rustc that built this program, with the flags of a release build.

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use crate::interrupt::Interrupt;

/// What every library is compiled with: baseline x86-64 and opt-level 3, as the published
/// package is; never the features of the machine at hand.
pub const FLAGS: &[&str] = &[
    "--edition=2024",
    "--crate-type=cdylib",
    "--cap-lints=allow",
    "-Copt-level=3",
    "-Cpanic=abort",
    "-Ccodegen-units=1",
];

const VERSION: &str = env!("RAYBREED_RUSTC_VERSION");

/// How long one compilation may take. A hundred kernels take a few seconds.
const TIME_LIMIT: Duration = Duration::from_secs(120);

/// How often a running compilation is looked at.
const POLL: Duration = Duration::from_millis(2);

/// The compiler.
#[derive(Clone, Debug)]
pub struct Rustc {
    path: PathBuf,
}

/// The compiler that this program was built with cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RustcError {
    /// It cannot be run at all.
    #[error(
        "cannot run {path}, the rustc that built this program ({error}); \
         candidates are compiled with it, so reinstall it or build again"
    )]
    Missing {
        /// Where it was.
        path: PathBuf,
        /// Why it cannot be run.
        error: io::Error,
    },
    /// It is another one now.
    #[error("{path} is now {found}, but {VERSION} built this program; build again")]
    Changed {
        /// Where it is.
        path: PathBuf,
        /// What it says that it is.
        found: String,
    },
}

/// Why a source did not become a library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum CompileError {
    /// rustc refused it; the first lines of what it said.
    Refused(String),
    /// It took too long.
    TimedOut,
    /// The user asked to stop.
    Interrupted,
}

impl Rustc {
    /// The rustc that built this program.
    ///
    /// # Errors
    ///
    /// [`RustcError`] if it is gone or has changed.
    pub fn of_this_build() -> Result<Rustc, RustcError> {
        Rustc::at(PathBuf::from(env!("RAYBREED_RUSTC")))
    }

    fn at(path: PathBuf) -> Result<Rustc, RustcError> {
        match Command::new(&path).arg("--version").output() {
            Err(error) => Err(RustcError::Missing { path, error }),
            Ok(output) => {
                let found = String::from_utf8_lossy(&output.stdout).trim().to_owned();
                if found == VERSION {
                    Ok(Rustc { path })
                } else {
                    Err(RustcError::Changed { path, found })
                }
            }
        }
    }

    /// What it says that it is: `rustc 1.95.0 (…)`.
    pub fn version(&self) -> &'static str {
        VERSION
    }

    /// The version's number alone: `1.95.0`.
    pub fn number(&self) -> &'static str {
        VERSION.split(' ').nth(1).unwrap_or(VERSION)
    }

    /// Compiles `source` into the library at `output`.
    pub(crate) fn compile(
        &self,
        source: &Path,
        output: &Path,
        interrupt: &Interrupt,
    ) -> Result<(), CompileError> {
        let messages = output.with_extension("stderr");
        let stderr = std::fs::File::create(&messages).map_err(refused)?;
        let mut command = Command::new(&self.path);
        command
            .args(FLAGS)
            .args(["--crate-name", "candidates", "-o"])
            .args([output, source])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(stderr);
        let mut child = command.spawn().map_err(refused)?;
        let status = wait(&mut child, interrupt)?;
        if status.success() {
            return Ok(());
        }
        let said = std::fs::read(&messages).unwrap_or_default();
        let said = String::from_utf8_lossy(&said);
        let first: Vec<&str> = said.lines().take(4).collect();
        Err(CompileError::Refused(match first.as_slice() {
            [] => format!("rustc ended with {status}"),
            lines => lines.join("\n"),
        }))
    }
}

fn refused(error: io::Error) -> CompileError {
    CompileError::Refused(error.to_string())
}

fn wait(child: &mut Child, interrupt: &Interrupt) -> Result<ExitStatus, CompileError> {
    let start = Instant::now();
    let stopped = loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok(status),
            Ok(None) => {}
            Err(error) => break refused(error),
        }
        if interrupt.is_raised() {
            break CompileError::Interrupted;
        }
        if start.elapsed() > TIME_LIMIT {
            break CompileError::TimedOut;
        }
        std::thread::sleep(POLL);
    };
    // It may have ended by itself by now; either way it is gone after the wait.
    let _ = child.kill();
    let _ = child.wait();
    Err(stopped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_rustc_is_one_clear_sentence() {
        let error = Rustc::at("/nowhere/rustc".into()).unwrap_err().to_string();
        assert!(
            error.contains("/nowhere/rustc") && !error.contains('\n'),
            "{error}"
        );
    }

    #[test]
    fn another_program_is_not_taken_for_rustc() {
        let error = Rustc::at("true".into()).unwrap_err();
        assert!(matches!(error, RustcError::Changed { .. }));
    }
}

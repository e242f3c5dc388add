//! The compiler: the rustc that built this program, with the flags of a release build.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use crate::group::Group;
use crate::interrupt::Interrupt;
use crate::machine::cores;

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
    time_limit: Duration,
    at_once: usize,
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

    /// The compiler at `path`, which must be of the version that built this program.
    ///
    /// # Errors
    ///
    /// [`RustcError`] if it cannot be run, or is of another version.
    pub fn at(path: PathBuf) -> Result<Rustc, RustcError> {
        match Command::new(&path).arg("--version").output() {
            Err(error) => Err(RustcError::Missing { path, error }),
            Ok(output) => {
                let found = String::from_utf8_lossy(&output.stdout).trim().to_owned();
                if found == VERSION {
                    Ok(Rustc {
                        path,
                        time_limit: TIME_LIMIT,
                        at_once: cores(),
                    })
                } else {
                    Err(RustcError::Changed { path, found })
                }
            }
        }
    }

    /// The same compiler, killed when a compilation takes longer than this.
    #[must_use]
    pub fn with_time_limit(self, time_limit: Duration) -> Rustc {
        Rustc { time_limit, ..self }
    }

    /// The same compiler, run so many times at once instead of once a core.
    ///
    /// # Panics
    ///
    /// If that is never.
    #[must_use]
    pub fn at_once(self, at_once: usize) -> Rustc {
        assert!(at_once > 0, "compiled by nobody");
        Rustc { at_once, ..self }
    }

    /// How many compilations run at once.
    pub(crate) fn jobs(&self) -> usize {
        self.at_once
    }

    /// The same compiler for half of the kernels of a compilation that took too long.
    ///
    /// The halves share the time limit, so that each level of a bisection takes no longer than the
    /// first. One kernel that rustc hangs on costs less than twice the limit, for only the half
    /// that it is in times out again. If rustc hangs whatever it is given, `n` kernels cost as many
    /// limits as there are levels, `1 + log2(n)`, and not `2 n - 1`.
    pub(crate) fn for_a_half(&self) -> Rustc {
        let half = self.time_limit / 2;
        self.clone().with_time_limit(half)
    }

    /// What it says that it is: `rustc 1.95.0 (…)`.
    pub fn version(&self) -> &'static str {
        VERSION
    }

    /// The version's number alone: `1.95.0`.
    pub fn number(&self) -> &'static str {
        VERSION.split(' ').nth(1).unwrap_or(VERSION)
    }

    /// Compiles `source` into the library at `output`, and keeps the object file that it is linked of beside it,
    /// as `.o`.
    pub(crate) fn compile(
        &self,
        source: &Path,
        output: &Path,
        interrupt: &Interrupt,
    ) -> Result<(), CompileError> {
        let messages = output.with_extension("stderr");
        let stderr = std::fs::File::create(&messages).map_err(refused)?;
        // Whatever rustc writes on its way has the same names in every compilation, and several run at once.
        let own = output.with_extension("own");
        std::fs::create_dir_all(&own).map_err(refused)?;
        let emit = |kind: &str, path: &Path| {
            let mut argument = OsString::from(format!("--emit={kind}="));
            argument.push(path);
            argument
        };
        let mut command = Command::new(&self.path);
        command
            .args(FLAGS)
            .args(["--crate-name", "candidates", "--out-dir"])
            .arg(&own)
            .arg(emit("link", output))
            .arg(emit("obj", &output.with_extension("o")))
            .arg(source)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(stderr);
        let group = Group::start(&mut command).map_err(refused)?;
        let status = self.wait(group, interrupt)?;
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

    /// The assembly of a library; none if it does not compile.
    pub(crate) fn assembly(&self, source: &str) -> Option<String> {
        let directory = tempfile::Builder::new()
            .prefix("raybreed-")
            .tempdir()
            .ok()?;
        let [input, output] = ["assembly.rs", "assembly.s"].map(|name| directory.path().join(name));
        std::fs::write(&input, source).ok()?;
        let mut command = Command::new(&self.path);
        command
            .args(FLAGS)
            .args(["--crate-name", "assembly", "--emit", "asm", "-o"])
            .args([&output, &input])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        let group = Group::start(&mut command).ok()?;
        let status = self.wait(group, &Interrupt::default()).ok()?;
        match status.success() {
            true => std::fs::read_to_string(&output).ok(),
            false => None,
        }
    }

    /// Waits for a compilation, and ends it with everything that it started.
    fn wait(&self, mut group: Group, interrupt: &Interrupt) -> Result<ExitStatus, CompileError> {
        let start = Instant::now();
        let mut stopped = CompileError::TimedOut;
        while !group.has_ended() && start.elapsed() <= self.time_limit {
            if interrupt.is_raised() {
                stopped = CompileError::Interrupted;
                break;
            }
            std::thread::sleep(POLL);
        }
        group.end().ok_or(stopped)
    }
}

fn refused(error: io::Error) -> CompileError {
    CompileError::Refused(error.to_string())
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

    #[test]
    fn the_halves_of_what_took_too_long_take_no_longer_together() {
        let rustc = Rustc::of_this_build().unwrap();
        let half = rustc.for_a_half();
        assert!(2 * half.time_limit <= rustc.time_limit);
        assert!(2 * half.for_a_half().time_limit <= half.time_limit);
    }
}

//! Candidates that become no library, and compilers that misbehave.
#![cfg_attr(not(unix), allow(unused, reason = "the compilers are shell scripts"))]

mod bench;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use bench::*;
use emit::{Isa, Kernel};
use measure::{Interrupt, MeasureError, Rustc, Verdict};

/// Long enough to compile two kernels on a busy machine.
const TIME_LIMIT: Duration = Duration::from_secs(8);

#[test]
fn what_rustc_refuses_is_found_among_the_others() {
    let batch = [
        good(),
        broken("nonsense;"),
        good(),
        broken("let x: u8 = packet;"),
        good(),
    ];
    let verdicts = verdicts(&batch);
    for (index, verdict) in verdicts.iter().enumerate() {
        match verdict {
            Verdict::Timed { .. } => assert!(index % 2 == 0),
            Verdict::BuildFailed { message } => {
                assert!(index % 2 == 1 && message.contains("error"), "{message}");
            }
            other => panic!("{other:?}"),
        }
    }
}

/// There is one instruction set so far. So the machine that has the reference's but lacks the
/// candidate's answers yes to the first kernel that it is asked about, and no from then on.
fn has_the_reference_only(_: Isa) -> bool {
    thread_local! {
        static ASKED: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
    }
    !ASKED.replace(true)
}

#[test]
fn what_the_machine_cannot_run_is_not_even_compiled() {
    let bench = bench(Interrupt::default()).on_a_machine_with(has_the_reference_only);
    // rustc would refuse this one.
    let verdicts = verdicts_of(bench, &[broken("nonsense;"), good()], &plan());
    assert_eq!(verdicts, [Verdict::UnsupportedIsa, Verdict::UnsupportedIsa]);
}

#[test]
fn a_reference_that_the_machine_cannot_run_is_an_error() {
    let mut bench = bench(Interrupt::default()).on_a_machine_with(|_| false);
    assert!(matches!(
        bench.measure(&[&good()], &plan()),
        Err(MeasureError::Reference(verdict)) if matches!(*verdict, Verdict::UnsupportedIsa)
    ));
}

/// A shell script that says it is this build's rustc.
struct FakeRustc {
    path: PathBuf,
    _directory: tempfile::TempDir,
}

impl FakeRustc {
    /// A compiler that does this. The script may call `rustc`, the real one, which takes the same
    /// arguments.
    fn that(does: &str) -> FakeRustc {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("rustc");
        let version = Rustc::of_this_build().unwrap().version();
        let rustc = env!("RAYBREED_RUSTC");
        let script = format!(
            "#!/bin/sh
             if [ \"$1\" = --version ]; then echo '{version}'; exit; fi
             rustc() {{ '{rustc}' \"$@\"; }}
             for source; do :; done
             {does}\n"
        );
        // A process that other threads start meanwhile would inherit a file that is being written,
        // and what is being written cannot be run. So another process writes it.
        let write = "printf %s \"$1\" > \"$2\" && chmod +x \"$2\"";
        let mut command = Command::new("/bin/sh");
        command.args(["-c", write, "sh", &script]).arg(&path);
        assert!(command.status().unwrap().success());
        FakeRustc {
            path,
            _directory: directory,
        }
    }

    /// The compiler at a bench.
    fn rustc(&self) -> Rustc {
        rustc_at(&self.path)
    }

    /// What its processes have in their command lines while they run or hang as in [`HANG`].
    fn marker(&self) -> &str {
        self.path.to_str().unwrap()
    }

    fn is_gone(&self) {
        wait_until("rustc is gone", || processes_with(self.marker()) == 0);
    }
}

fn rustc_at(path: &Path) -> Rustc {
    let rustc = Rustc::at(path.into()).unwrap();
    rustc.with_time_limit(TIME_LIMIT)
}

/// Waits for ever, as a process with the script's path in its command line.
const HANG: &str = "exec tail -f \"$0\"";

/// Starts a process that waits for ever, and then waits for ever.
const HANG_WITH_A_CHILD: &str = "tail -f \"$0\" & touch \"$0.has-a-child\"; exec tail -f \"$0\"";

/// Does `code` when the source has [`marked`] kernels in it, else what rustc does.
fn for_marked_kernels(code: &str) -> String {
    format!("if grep -q 'marked kernel' \"$source\"; then {code}; fi; rustc \"$@\"")
}

fn marked() -> Kernel {
    let mut kernel = good();
    kernel.source += "\n// marked kernel\n";
    kernel
}

/// The verdicts of a batch with a marked kernel among others.
#[cfg(unix)]
fn marked_among_others(rustc: Rustc) -> Verdict {
    let bench = bench_that_compiles_with(rustc, Interrupt::default());
    let kernels = [good(), marked(), good(), good()];
    let mut verdicts = verdicts_of(bench, &kernels, &plan());
    let marked = verdicts.remove(1);
    verdicts.iter().for_each(assert_timed);
    marked
}

#[test]
#[cfg(unix)]
fn a_kernel_that_rustc_hangs_on_is_found_among_the_others() {
    if is_on_linux() {
        let fake = FakeRustc::that(&for_marked_kernels(HANG));
        assert_eq!(marked_among_others(fake.rustc()), Verdict::BuildTimedOut);
        fake.is_gone();
    }
}

#[test]
#[cfg(unix)]
fn a_rustc_that_hangs_is_killed_with_what_it_started() {
    if is_on_linux() {
        let fake = FakeRustc::that(HANG_WITH_A_CHILD);
        let mut bench = bench_that_compiles_with(fake.rustc(), Interrupt::default());
        assert!(matches!(
            bench.measure(&[], &plan()),
            Err(MeasureError::Reference(verdict)) if matches!(*verdict, Verdict::BuildTimedOut)
        ));
        assert!(fake.path.with_extension("has-a-child").exists());
        fake.is_gone();
    }
}

#[test]
#[cfg(unix)]
fn an_interrupt_ends_a_rustc_that_hangs_with_what_it_started() {
    if !is_on_linux() {
        return;
    }
    let fake = FakeRustc::that(HANG_WITH_A_CHILD);
    let interrupt = Interrupt::default();
    let rustc = fake.rustc().with_time_limit(Duration::MAX);
    let mut bench = bench_that_compiles_with(rustc, interrupt.clone());
    let stopped = std::thread::scope(|scope| {
        let measuring = scope.spawn(|| bench.measure(&[], &plan()));
        wait_until("rustc has a child", || {
            fake.path.with_extension("has-a-child").exists()
        });
        interrupt.raise();
        measuring.join().unwrap()
    });
    assert!(matches!(stopped, Err(MeasureError::Interrupted)));
    fake.is_gone();
}

#[test]
#[cfg(unix)]
fn a_killed_driver_takes_a_rustc_along_that_hangs() {
    if !is_on_linux() {
        return;
    }
    if let Some(path) = started_again_with() {
        let rustc = rustc_at(Path::new(&path)).with_time_limit(Duration::MAX);
        let _ = bench_that_compiles_with(rustc, Interrupt::default()).measure(&[], &plan());
        return;
    }
    let fake = FakeRustc::that(&format!("touch \"$0.runs\"; {HANG}"));
    let test = "a_killed_driver_takes_a_rustc_along_that_hangs";
    let mut driver = start_again(test, &fake.path);
    wait_until("rustc runs", || fake.path.with_extension("runs").exists());
    driver.kill().unwrap();
    driver.wait().unwrap();
    fake.is_gone();
}

#[test]
#[cfg(unix)]
fn a_kernel_that_rustc_fails_on_has_what_rustc_said() {
    let fake = FakeRustc::that(&for_marked_kernels("echo 'no room' >&2; exit 1"));
    let message = "no room".into();
    assert_eq!(
        marked_among_others(fake.rustc()),
        Verdict::BuildFailed { message }
    );
}

#[test]
#[cfg(unix)]
fn a_kernel_that_kills_rustc_has_how_it_ended() {
    let fake = FakeRustc::that(&for_marked_kernels("kill -9 $$"));
    match marked_among_others(fake.rustc()) {
        Verdict::BuildFailed { message } => assert!(message.contains("signal: 9"), "{message}"),
        other => panic!("{other:?}"),
    }
}

#[test]
#[cfg(unix)]
fn a_rustc_that_makes_no_library_is_an_error() {
    let fake = FakeRustc::that("exit 0");
    let mut bench = bench_that_compiles_with(fake.rustc(), Interrupt::default());
    assert!(matches!(
        bench.measure(&[], &plan()),
        Err(MeasureError::Reference(verdict)) if matches!(*verdict, Verdict::NotLoaded { .. })
    ));
}

#[test]
#[cfg(unix)]
fn a_rustc_that_has_gone_since_the_start_is_an_error() {
    let fake = FakeRustc::that("exit 0");
    let rustc = fake.rustc();
    std::fs::remove_file(&fake.path).unwrap();
    let mut bench = bench_that_compiles_with(rustc, Interrupt::default());
    assert!(matches!(
        bench.measure(&[], &plan()),
        Err(MeasureError::Reference(verdict)) if matches!(*verdict, Verdict::BuildFailed { .. })
    ));
}

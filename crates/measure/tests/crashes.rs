//! Candidates that crash, hang or use the system: they take nobody along and leave nothing behind.

mod bench;

use bench::*;
use measure::{ADDRESS_SPACE, Interrupt, Phase, Verdict, WorkerCommand};

/// Never returns.
const LOOP: &str = "loop { core::hint::spin_loop() }";

const CHECKING: Phase = Phase::CheckBefore;

fn crashed(signal: i32) -> Verdict {
    Verdict::Crashed {
        phase: CHECKING,
        signal: Some(signal),
    }
}

const EXITED: Verdict = Verdict::Crashed {
    phase: CHECKING,
    signal: None,
};

const TIMED_OUT: Verdict = Verdict::TimedOut { phase: CHECKING };

#[test]
#[cfg(unix)]
fn crashes_are_told_by_their_signals_and_leave_the_others_timed() {
    let illegal = "unsafe { core::arch::asm!(\"ud2\") };";
    let verdicts = verdicts(&[
        good(),
        broken(SEGMENTATION_FAULT),
        good(),
        broken(illegal),
        good(),
    ]);
    assert_eq!(verdicts[1], crashed(11));
    assert_eq!(verdicts[3], crashed(4));
    for index in [0, 2, 4] {
        assert_timed(&verdicts[index]);
    }
}

#[test]
#[cfg(unix)]
fn a_crash_while_it_is_timed_is_told_as_such() {
    let first = CHECKED_TRIANGLES;
    let code = when_it_has_seen(first..first + 1, SEGMENTATION_FAULT);
    let verdicts = verdicts(&[good(), after_right_answers(&code)]);
    assert_timed(&verdicts[0]);
    let signal = Some(11);
    let phase = Phase::Time;
    assert_eq!(verdicts[1], Verdict::Crashed { phase, signal });
}

#[test]
#[cfg(unix)]
fn a_recursion_without_end_crashes() {
    let code = "
        fn deeper(depth: u64) -> u64 {
            let frame = core::hint::black_box([depth; 64]);
            deeper(depth + frame[0]) + frame[1]
        }
        core::hint::black_box(deeper(1));";
    match verdict(broken(code)) {
        // Rust aborts when it sees whose fault the segmentation fault was.
        Verdict::Crashed { signal, .. } => assert!(matches!(signal, Some(6 | 11)), "{signal:?}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_endless_loop_times_out_and_leaves_the_others_timed() {
    let verdicts = verdicts(&[good(), broken(LOOP)]);
    assert_timed(&verdicts[0]);
    assert_eq!(verdicts[1], TIMED_OUT);
}

#[test]
fn an_exit_is_a_crash_without_a_signal() {
    if is_on_linux() {
        let exit_group = "unsafe { system_call(231, [0; 6]) };";
        assert_eq!(verdict(broken(exit_group)), EXITED);
    }
}

#[test]
fn a_kernel_that_stops_its_process_times_out() {
    if is_on_linux() {
        let stop = "unsafe { system_call(62, [system_call(39, [0; 6]), 19, 0, 0, 0, 0]) };";
        assert_eq!(verdict(after_right_answers(stop)), TIMED_OUT);
    }
}

#[test]
fn a_kernel_that_closes_all_files_is_a_crash() {
    if is_on_linux() {
        let close_range = "unsafe { system_call(436, [0, 0x7fff_ffff, 0, 0, 0, 0]) };";
        let verdicts = verdicts(&[after_right_answers(close_range), good()]);
        // Whether it then exits or aborts is up to the standard library.
        assert!(
            matches!(
                verdicts[0],
                Verdict::Crashed {
                    phase: CHECKING,
                    ..
                }
            ),
            "{:?}",
            verdicts[0]
        );
        assert_timed(&verdicts[1]);
    }
}

/// Writes 64 KiB of lines that could be events to standard output and error.
fn write_events() -> String {
    let events = r#"
"Done"
{"Failed":{"kernel":0,"failure":"Nondeterministic"}}
{"Failed":{"kernel":1,"failure":{"NotLoaded":"a lie"}}}
{"Sample":{"kernel":1,"seconds":1e-9,"reference":1.0,"tests":1}}
{"Begin":{"kernel":2,"phase":"time"}}
"#;
    let lines = events.repeat((1 << 16) / events.len());
    format!(
        "static LINES: &[u8] = br#\"{lines}\"#;
         for file in [1, 2] {{
             let arguments = [file, LINES.as_ptr() as isize, LINES.len() as isize, 0, 0, 0];
             unsafe {{ system_call(1, arguments) }};
         }}"
    )
}

#[test]
fn megabytes_of_events_on_standard_output_confuse_nobody() {
    if is_on_linux() {
        let verdicts = verdicts(&[good(), after_right_answers(&write_events()), good()]);
        for verdict in &verdicts {
            assert_timed(verdict);
            assert_eq!(verdict.summary().unwrap().rounds, plan().rounds.len());
        }
    }
}

#[test]
fn a_kernel_that_floods_standard_output_for_ever_times_out() {
    if is_on_linux() {
        let code = format!("loop {{ {} }}", write_events());
        assert_eq!(verdict(broken(&code)), TIMED_OUT);
    }
}

#[test]
fn a_kernel_that_reads_standard_input_takes_no_request_away() {
    if is_on_linux() {
        let read = "
            let mut bytes = [0_u8; 4096];
            unsafe { system_call(0, [0, bytes.as_mut_ptr() as isize, 4096, 0, 0, 0]) };";
        assert_timed(&verdict(after_right_answers(read)));
    }
}

/// Takes blocks of 64 MiB and writes to each of their MiB until there are no more, and then
/// crashes with signal 11; or with signal 4 when it got more than the limit.
fn take_all_memory() -> String {
    format!(
        "const BLOCK: isize = 64 << 20;
         let mut taken = 0;
         loop {{
             // Readable and writable, private and anonymous.
             let block = unsafe {{ system_call(9, [0, BLOCK, 3, 0x22, -1, 0]) }};
             if block < 0 {{
                 {SEGMENTATION_FAULT}
             }}
             taken += BLOCK as u64;
             if taken > {ADDRESS_SPACE} {{
                 unsafe {{ core::arch::asm!(\"ud2\") }};
             }}
             for page in (0..BLOCK).step_by(1 << 20) {{
                 unsafe {{ ((block + page) as *mut u8).write_volatile(1) }};
             }}
         }}"
    )
}

#[test]
fn a_kernel_that_eats_memory_gets_no_more_than_the_limit() {
    if is_on_linux() {
        let verdicts = verdicts(&[good(), broken(&take_all_memory()), good()]);
        assert_eq!(verdicts[1], crashed(11));
        assert_timed(&verdicts[0]);
        assert_timed(&verdicts[2]);
    }
}

/// A worker whose processes, and those that a candidate starts from it, can be told from others.
fn marked_worker(name: &str) -> (WorkerCommand, String) {
    let marker = format!("marker-{name}-{}", std::process::id());
    let worker = WorkerCommand {
        arguments: vec![marker.clone()],
        ..worker()
    };
    (worker, marker)
}

/// Ignores what a process may ignore: signals 1, 2, 3 and 15. An illegal instruction if it cannot.
const IGNORE_SIGNALS: &str = "
    let ignore: [usize; 4] = [1, 0, 0, 0];
    for signal in [1, 2, 3, 15] {
        let arguments = [signal, ignore.as_ptr() as isize, 0, 8, 0, 0];
        if unsafe { system_call(13, arguments) } != 0 {
            unsafe { core::arch::asm!(\"ud2\") };
        }
    }";

/// Makes this process two. An illegal instruction if that fails.
const FORK: &str = "
    let child = unsafe { system_call(57, [0; 6]) };
    if child < 0 {
        unsafe { core::arch::asm!(\"ud2\") };
    }";

#[test]
fn a_kernel_that_ignores_signals_and_forks_times_out_and_no_process_survives() {
    if !is_on_linux() {
        return;
    }
    let (worker, marker) = marked_worker("forks");
    let mut bench = bench_with(worker, Interrupt::default());
    let stubborn = broken(&format!("{IGNORE_SIGNALS} {FORK} {LOOP}"));
    let verdicts = bench.measure(&[&stubborn, &good()], &plan()).unwrap();
    assert_eq!(verdicts[1], TIMED_OUT);
    assert_timed(&verdicts[2]);
    // The others were timed by a new worker.
    wait_until("the worker and its child are gone", || {
        processes_with(&marker) == 1
    });
    drop(bench);
    wait_until("no worker is left", || processes_with(&marker) == 0);
}

#[test]
fn a_crash_is_one_although_a_child_lives_on_and_the_child_does_not() {
    if !is_on_linux() {
        return;
    }
    let (worker, marker) = marked_worker("crashes");
    let bench = bench_with(worker, Interrupt::default());
    let code = format!("{FORK} if child == 0 {{ {LOOP} }} {SEGMENTATION_FAULT}");
    let verdicts = verdicts_of(bench, &[broken(&code), good()], &plan());
    assert_eq!(verdicts[0], crashed(11));
    assert_timed(&verdicts[1]);
    wait_until("no process is left", || processes_with(&marker) == 0);
}

#[test]
fn a_killed_driver_takes_a_worker_along_that_hangs() {
    if !is_on_linux() {
        return;
    }
    if let Some(file) = started_again_with() {
        let create = format!(
            "unsafe {{ system_call(85, [c\"{file}\".as_ptr() as isize, 0o600, 0, 0, 0, 0]) }};"
        );
        let worker = WorkerCommand {
            arguments: vec![file],
            patience: std::time::Duration::MAX,
            ..worker()
        };
        let mut bench = bench_with(worker, Interrupt::default());
        let _ = bench.measure(&[&broken(&format!("{create} {LOOP}"))], &plan());
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("loops");
    let marker = file.to_str().unwrap();
    let mut driver = start_again("a_killed_driver_takes_a_worker_along_that_hangs", &file);
    wait_until("the kernel runs", || file.exists());
    assert_eq!(processes_with(marker), 1);
    driver.kill().unwrap();
    driver.wait().unwrap();
    wait_until("the worker is gone", || processes_with(marker) == 0);
}

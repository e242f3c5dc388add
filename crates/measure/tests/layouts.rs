//! Where things lie in memory: a kernel is timed in many layouts, the worst one is told, and a process in which all is
//! slow is replaced.

mod bench;

use bench::*;
use measure::{Bench, Interrupt, Phase, Plan, Processes, Verdict};

/// Code that takes a hundred times as long as a test of eight triangles.
const SLOW: &str = "for number in 0..200_000 { core::hint::black_box(number); }";

fn worst_layout(bench: &mut Bench, code: &str) -> f64 {
    let plan = Plan {
        sweep: true,
        ..plan()
    };
    let kernel = after_right_answers(code);
    let verdicts = bench.measure(&[&kernel], &plan).unwrap();
    match &verdicts[1] {
        Verdict::Timed {
            worst_layout: Some(worst),
            ..
        } => *worst,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_kernel_that_is_slow_at_one_depth_of_the_stack_has_a_bad_layout() {
    let mut bench = bench(Interrupt::default());
    let at_a_line = format!(
        "let here = 0_u8;
         let line = core::hint::black_box(&raw const here) as usize % 4096 / 64;
         if line == 19 {{ {SLOW} }}"
    );
    let worst = worst_layout(&mut bench, &at_a_line);
    assert!(worst > 10.0, "{worst}");
    let worst = worst_layout(&mut bench, "");
    assert!(worst < 10.0, "{worst}");
}

/// However the system has placed the stack, one of these lines is where the sweep begins.
#[test]
fn a_bad_layout_is_told_at_whichever_depth_it_is() {
    let mut bench = bench(Interrupt::default());
    for line in (0..64).step_by(8) {
        let at_some_lines = format!(
            "let here = 0_u8;
             let line = core::hint::black_box(&raw const here) as usize % 4096 / 64;
             if line / 8 * 8 == {line} {{ {SLOW} }}"
        );
        assert!(worst_layout(&mut bench, &at_some_lines) > 10.0, "{line}");
    }
}

#[test]
fn a_kernel_that_is_slow_with_its_packet_at_one_line_of_a_page_has_a_bad_layout() {
    let mut bench = bench(Interrupt::default());
    let at_a_line =
        format!("if core::ptr::from_ref(&*packet) as usize % 4096 / 64 == 5 {{ {SLOW} }}");
    let worst = worst_layout(&mut bench, &at_a_line);
    assert!(worst > 10.0, "{worst}");
}

#[test]
fn nothing_is_swept_unless_the_plan_says_so() {
    let timed = verdict(good());
    assert!(matches!(
        timed,
        Verdict::Timed {
            worst_layout: None,
            ..
        }
    ));
}

#[test]
fn a_kernel_is_timed_by_copies_of_its_code_at_several_places() {
    if !is_on_linux() {
        return;
    }
    // The first place that is known in the process is right, and all others are not.
    let at_the_first_place = format!(
        "let place = kernel as fn(_, _) as usize;
         let first = {}.compare_exchange(
             0, place, core::sync::atomic::Ordering::Relaxed, core::sync::atomic::Ordering::Relaxed,
         ).unwrap_or_else(|first| first);
         if first != 0 && first != place {{ packet.t[0] = 0.125; }}",
        counter()
    );
    let mut kernel = after_right_answers(&at_the_first_place);
    kernel.source = kernel
        .source
        .replace("pub unsafe fn kernel", "pub fn kernel");
    assert_wrong(kernel, Phase::Time);
}

/// Times something in one batch after another, against a reference that is slow in a process when it has seen so many
/// triangles there, and in a process that was calibrated, if it is. Gives what became of processes.
fn processes(slow_from: usize, calibrated: bool) -> Processes {
    let slow = when_it_has_seen(slow_from..usize::MAX, SLOW);
    let mut bench = bench_against(after_right_answers(&slow));
    if calibrated {
        bench.calibrate(plan().rounds, 1).unwrap();
    }
    for _ in 0..8 {
        for verdict in bench.measure(&[&good()], &plan()).unwrap() {
            assert_timed(&verdict);
        }
    }
    bench.processes()
}

#[test]
fn a_process_in_which_the_reference_has_become_slow_is_replaced() {
    if !is_on_linux() {
        return;
    }
    let slow_from = 4 * (CHECKED_TRIANGLES + TIMED_TRIANGLES);
    assert!(processes(slow_from, true).replaced > 0);
    assert_eq!(processes(slow_from, false), Processes::default());
}

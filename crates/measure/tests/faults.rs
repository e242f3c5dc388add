//! Every fault of a candidate has its verdict, and costs nobody else theirs.

use std::time::Duration;

use emit::{Isa, Kernel};
use measure::{
    Bench, Interrupt, MAX_P99_ERROR, MeasureError, Phase, Plan, Race, Rustc, Verdict,
    WorkerCommand, WorkloadSpec,
};
use scene::{Origin, Regime};

#[test]
fn a_right_kernel_is_timed_against_the_reference() {
    let Verdict::Timed {
        ratios,
        speeds,
        accuracy,
    } = verdict(kernel("kensler-shirley"))
    else {
        panic!("the appendix kernel is right");
    };
    assert_eq!(ratios.len(), plan().rounds.len());
    assert_eq!(speeds.len(), ratios.len());
    assert!(
        ratios
            .iter()
            .chain(&speeds)
            .all(|x| x.is_finite() && *x > 0.0)
    );
    assert!(accuracy.hits > 1000 && accuracy.p99 < MAX_P99_ERROR);
}

#[test]
fn when_a_race_is_decided_the_kernel_is_timed_no_further() {
    let rounds = vec![0..2; 12];
    let fast_rival = Race {
        ratios: vec![50.0; rounds.len()],
        every: 4,
    };
    let plan = Plan {
        rounds,
        race: Some(fast_rival),
        racers: 1,
        ..plan()
    };
    let timed = |verdict: &Verdict| match verdict {
        Verdict::Timed { ratios, .. } => ratios.len(),
        other => panic!("{other:?}"),
    };
    let mut bench = bench(Interrupt::default());
    let verdicts = bench.measure(&[&good(), &good()], &plan).unwrap();
    assert_eq!(timed(&verdicts[0]), 12, "the reference");
    assert_eq!(timed(&verdicts[1]), 4, "the racer");
    assert_eq!(timed(&verdicts[2]), 12, "who does not race");
}

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

#[test]
fn a_kernel_that_answers_nothing_is_wrong() {
    assert_wrong(broken(""), Phase::CheckBefore);
}

#[test]
fn a_kernel_that_is_wrong_in_one_lane_is_wrong() {
    assert_wrong(
        after_right_answers("packet.t[13] = 3.25;"),
        Phase::CheckBefore,
    );
}

#[test]
fn a_kernel_that_returns_nan_or_infinity_is_wrong() {
    for value in ["NAN", "INFINITY"] {
        let code = format!("packet.t[5] = f32::{value};");
        assert_wrong(after_right_answers(&code), Phase::CheckBefore);
    }
}

#[test]
fn a_kernel_that_writes_where_it_must_not_is_wrong() {
    assert_wrong(
        after_right_answers("packet.hit_t[0] = 1.0;"),
        Phase::CheckBefore,
    );
}

#[test]
fn a_kernel_that_goes_wrong_after_a_while_is_wrong() {
    let code = "
        use core::sync::atomic::{AtomicU32, Ordering};
        static SEEN: AtomicU32 = AtomicU32::new(0);
        if SEEN.fetch_add(triangles.len() as u32, Ordering::Relaxed) > CHECKED_TRIANGLES {
            packet.t[0] = 0.125;
        }";
    assert_wrong(after_right_answers(&counting(code)), Phase::CheckAfter);
}

#[test]
fn a_kernel_whose_right_answers_change_is_nondeterministic() {
    let code = "
        use core::sync::atomic::{AtomicU32, Ordering};
        static SEEN: AtomicU32 = AtomicU32::new(0);
        if SEEN.fetch_add(triangles.len() as u32, Ordering::Relaxed) > CHECKED_TRIANGLES {
            for t in &mut packet.t {
                if *t < 1e5 {
                    *t = t.next_up();
                }
            }
        }";
    let verdict = verdict(after_right_answers(&counting(code)));
    assert_eq!(verdict, Verdict::Nondeterministic);
}

#[test]
fn a_bare_reciprocal_estimate_gets_no_fitness() {
    let mut kernel = kernel("moller-trumbore");
    let exact = "_mm_div_ps(one, det)";
    assert!(kernel.source.contains(exact));
    kernel.source = kernel.source.replace(exact, "_mm_rcp_ps(det)");
    let verdict = verdict(kernel);
    let refused = matches!(
        verdict,
        Verdict::Inaccurate { .. } | Verdict::WrongAnswer { .. }
    );
    assert!(refused, "{verdict:?}");
}

#[test]
fn a_kernel_whose_t_is_off_in_the_sixth_digit_is_inaccurate() {
    let code = "for t in &mut packet.t { if *t < 1e5 { *t *= 1.000005; } }";
    match verdict(after_right_answers(code)) {
        Verdict::Inaccurate { accuracy } => assert!(accuracy.p99 > 4e-6, "{accuracy:?}"),
        Verdict::WrongAnswer { .. } => {}
        other => panic!("{other:?}"),
    }
}

#[test]
#[cfg(unix)]
fn crashes_are_told_by_their_signals_and_leave_the_others_timed() {
    let segfault = "unsafe { core::ptr::null_mut::<u32>().write_volatile(1) };";
    let illegal = "unsafe { core::arch::asm!(\"ud2\") };";
    let verdicts = verdicts(&[good(), broken(segfault), good(), broken(illegal), good()]);
    let crashed = |number| Verdict::Crashed {
        phase: Phase::CheckBefore,
        signal: Some(number),
    };
    assert_eq!(verdicts[1], crashed(11));
    assert_eq!(verdicts[3], crashed(4));
    for index in [0, 2, 4] {
        assert!(
            matches!(verdicts[index], Verdict::Timed { .. }),
            "{:?}",
            verdicts[index]
        );
    }
}

#[test]
fn an_endless_loop_times_out_and_leaves_the_others_timed() {
    let verdicts = verdicts(&[good(), broken("loop { core::hint::spin_loop() }")]);
    assert!(matches!(verdicts[0], Verdict::Timed { .. }));
    let phase = Phase::CheckBefore;
    assert_eq!(verdicts[1], Verdict::TimedOut { phase });
}

#[test]
fn an_interrupt_ends_measuring() {
    let interrupt = Interrupt::default();
    interrupt.raise();
    let stopped = bench(interrupt).measure(&[&good()], &plan());
    assert!(matches!(stopped, Err(MeasureError::Interrupted)));
}

#[test]
fn a_worker_that_is_none_is_an_error_and_no_verdict() {
    let worker = WorkerCommand {
        program: "true".into(),
        ..worker()
    };
    let mut bench = bench_with(worker, Interrupt::default());
    assert!(matches!(
        bench.measure(&[&good()], &plan()),
        Err(MeasureError::Worker(_))
    ));
}

fn assert_wrong(kernel: Kernel, expected: Phase) {
    match verdict(kernel) {
        Verdict::WrongAnswer { phase, message } => {
            assert_eq!(phase, expected, "{message}");
            assert!(!message.contains('\n'));
        }
        other => panic!("{other:?}"),
    }
}

fn verdict(kernel: Kernel) -> Verdict {
    verdicts(&[kernel]).remove(0)
}

fn verdicts(kernels: &[Kernel]) -> Vec<Verdict> {
    let kernels: Vec<&Kernel> = kernels.iter().collect();
    let verdicts = bench(Interrupt::default()).measure(&kernels, &plan());
    // The first one is the reference's.
    verdicts.unwrap().split_off(1)
}

fn bench(interrupt: Interrupt) -> Bench {
    bench_with(worker(), interrupt)
}

fn bench_with(worker: WorkerCommand, interrupt: Interrupt) -> Bench {
    let rustc = Rustc::of_this_build().unwrap();
    let reference = kernel("moller-trumbore");
    Bench::new(rustc, worker, workload(), reference, interrupt)
}

fn worker() -> WorkerCommand {
    WorkerCommand {
        program: env!("CARGO_BIN_EXE_measure-worker").into(),
        arguments: Vec::new(),
        patience: Duration::from_secs(5),
    }
}

const TRIANGLES: usize = 512;
const PACKETS: usize = 6;

fn workload() -> WorkloadSpec {
    WorkloadSpec {
        seed: 1,
        triangles: TRIANGLES,
        packets: PACKETS,
        origin: Origin::General,
        regime: Regime::Shrinking,
    }
}

fn plan() -> Plan {
    Plan {
        rounds: vec![0..2, 2..4, 4..6],
        separate: false,
        race: None,
        racers: 0,
    }
}

/// More triangles than a kernel is checked on before it is timed: those of two whole lists and,
/// in short lists, of four packets. With those that it is timed on they are fewer.
const CHECKED_TRIANGLES: usize = 7 * TRIANGLES;

fn counting(code: &str) -> String {
    code.replace("CHECKED_TRIANGLES", &CHECKED_TRIANGLES.to_string())
}

fn kernel(rival: &str) -> Kernel {
    let rival = rivals::find(rival).unwrap();
    Kernel {
        isa: Isa::Sse2,
        source: rival.source.to_owned(),
        function: format!("{}::<{}, false>", rival.function, scene::PACKET_SIZE),
    }
}

fn good() -> Kernel {
    kernel("kensler-shirley")
}

/// A kernel that does nothing but `code`.
fn broken(code: &str) -> Kernel {
    Kernel {
        isa: Isa::Sse2,
        source: format!(
            "use crate::{{Packet, Triangle}};
             pub unsafe fn kernel(packet: &mut Packet<64>, triangles: &[Triangle]) {{ {code} }}"
        ),
        function: "kernel".into(),
    }
}

/// A kernel that does `code` after the right thing.
fn after_right_answers(code: &str) -> Kernel {
    let right = good();
    let call = format!("super::right::{}(packet, triangles)", right.function);
    let nested = format!("unsafe {{ {call} }}; {code}").replace("super::right::", "right::");
    let mut kernel = broken(&nested);
    let inner = right.source.replace("super::lanes", "super::super::lanes");
    kernel.source += &format!("\npub mod right {{ {inner} }}");
    kernel
}

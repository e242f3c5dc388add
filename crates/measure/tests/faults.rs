//! Every fault of a candidate has its verdict, and costs nobody else theirs.
//!
//! | fault | verdict | tests |
//! |---|---|---|
//! | an answer is missing, wrong, NaN or infinite | `WrongAnswer` | here |
//! | it writes to the rays, or where a regime has no answers | `WrongAnswer` | here |
//! | it is wrong only while it is timed, or only later | `WrongAnswer`, phase `Time` or `CheckAfter` | here |
//! | right answers that change | `Nondeterministic` | here |
//! | `t` is right but coarse | `Inaccurate` | here |
//! | it returns at once | `WrongAnswer`; a time of zero is no figure | here, `src/tally.rs` |
//! | it falls behind in a race | `Timed`, with fewer rounds | here |
//! | its machine is another one | `UnsupportedIsa` | `builds.rs` |
//! | rustc refuses it, fails or is gone | `BuildFailed` | `builds.rs` |
//! | rustc makes no library of it | `NotLoaded` | `builds.rs` |
//! | rustc hangs | `BuildTimedOut` | `builds.rs` |
//! | it crashes, exits, overflows the stack | `Crashed`, with the signal if there is one | `crashes.rs` |
//! | it takes all memory | it gets no more; `Crashed` if it minds | `crashes.rs` |
//! | it loops, stops, ignores signals, starts processes | `TimedOut`, and nothing survives | `crashes.rs` |
//! | it writes events to standard output | none: `Timed` | `crashes.rs` |
//! | it closes the worker's files | `Crashed` | `crashes.rs` |
//!
//! The reference's fault is `MeasureError::Reference`. Where the driver is interrupted or killed,
//! neither a worker nor a compiler is left.

mod bench;

use bench::*;
use measure::{
    Deal, Interrupt, MAX_P99_ERROR, MeasureError, Phase, Plan, Race, Verdict, WorkerCommand,
};
use scene::Regime;

/// While it is timed.
fn timed_triangles() -> std::ops::Range<usize> {
    let start = CHECKED_TRIANGLES;
    start..start + TIMED_TRIANGLES
}

/// After it was timed.
fn late_triangles() -> std::ops::Range<usize> {
    timed_triangles().end..usize::MAX
}

#[test]
fn a_right_kernel_is_timed_against_the_reference() {
    let Verdict::Timed {
        ratios,
        speeds,
        accuracy,
        worst_layout: None,
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
        cores: 1,
        deal: Deal::Kernels,
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
    for code in ["packet.hit_t[0] = 1.0;", "packet.dz[63] *= 2.0;"] {
        assert_wrong(after_right_answers(code), Phase::CheckBefore);
    }
}

#[test]
fn a_kernel_that_goes_wrong_after_a_while_is_wrong() {
    let code = when_it_has_seen(late_triangles(), "packet.t[0] = 0.125;");
    assert_wrong(after_right_answers(&code), Phase::CheckAfter);
}

#[test]
fn a_kernel_that_is_wrong_only_while_it_is_timed_is_wrong_in_every_regime() {
    for &regime in Regime::ALL {
        let answers = if regime == Regime::Fixed {
            "hit_t"
        } else {
            "t"
        };
        let code = format!("packet.{answers}[13] = 0.125;");
        let code = when_it_has_seen(timed_triangles(), &code);
        let kernel = after_right_answers_in(regime, &code);
        let verdict = verdicts_of(bench_in(regime), &[kernel], &plan()).remove(0);
        let message = assert_is_wrong(verdict, Phase::Time);
        assert!(
            message.contains("packet 0") && message.contains("ray 13"),
            "{message}"
        );
    }
}

#[test]
fn a_kernel_that_is_wrong_only_on_a_packet_that_is_not_checked_is_wrong() {
    let third = CHECKED_TRIANGLES + 2 * TRIANGLES;
    let code = when_it_has_seen(third..third + 1, "packet.t[40] = 0.125;");
    let message = assert_is_wrong(verdict(after_right_answers(&code)), Phase::Time);
    assert!(
        message.contains("packet 2") && message.contains("ray 40"),
        "{message}"
    );
}

/// Wrong on what is timed, and on nothing shorter.
const WRONG_ON_LONG_LISTS: &str = "if triangles.len() > 8 { packet.t[13] = 0.125; }";

#[test]
fn a_kernel_that_is_wrong_on_long_lists_is_wrong() {
    assert_wrong(after_right_answers(WRONG_ON_LONG_LISTS), Phase::Time);
}

#[test]
fn a_reference_that_is_wrong_on_long_lists_is_an_error_although_a_kernel_agrees_with_it() {
    let wrong = after_right_answers(WRONG_ON_LONG_LISTS);
    let mut bench = bench_against(wrong.clone());
    match bench.measure(&[&wrong], &plan()) {
        Err(MeasureError::Reference(verdict)) => assert_is_wrong(*verdict, Phase::Time),
        other => panic!("{other:?}"),
    };
}

#[test]
fn a_kernel_that_changes_the_rays_while_it_is_timed_is_wrong_and_spoils_them_for_nobody() {
    let code = "packet.oy = [1e3; 64]; packet.dx = [f32::NAN; 64];";
    let code = when_it_has_seen(timed_triangles(), code);
    let plan = Plan {
        rounds: vec![0..6; 4],
        ..plan()
    };
    let kernels = [good(), after_right_answers(&code), good()];
    let verdicts = verdicts_of(bench(Interrupt::default()), &kernels, &plan);
    assert_timed(&verdicts[0]);
    assert_timed(&verdicts[2]);
    let [_, wrong, _] = <[Verdict; 3]>::try_from(verdicts).unwrap();
    let message = assert_is_wrong(wrong, Phase::Time);
    assert!(message.contains("rays"), "{message}");
}

#[test]
fn a_kernel_whose_right_answers_change_is_nondeterministic() {
    let code = when_it_has_seen(late_triangles(), NEXT_NUMBERS);
    assert_eq!(
        verdict(after_right_answers(&code)),
        Verdict::Nondeterministic
    );
}

#[test]
fn a_kernel_whose_right_answers_change_from_round_to_round_is_nondeterministic() {
    let second_round = CHECKED_TRIANGLES + 2 * TRIANGLES;
    let code = when_it_has_seen(second_round..second_round + 2 * TRIANGLES, NEXT_NUMBERS);
    let plan = Plan {
        rounds: vec![3..5, 3..5],
        ..plan()
    };
    let bench = bench(Interrupt::default());
    let verdicts = verdicts_of(bench, &[after_right_answers(&code)], &plan);
    assert_eq!(verdicts, [Verdict::Nondeterministic]);
}

#[test]
fn a_bare_reciprocal_estimate_gets_no_fitness() {
    let mut kernel = kernel("moller-trumbore");
    let exact = "div(one, det)";
    assert!(kernel.source.contains(exact));
    kernel.source = kernel.source.replace(exact, "estimate_reciprocal(det)");
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

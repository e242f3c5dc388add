//! Kernels and rounds dealt to several cores. On a machine that lets only one core time, all is
//! dealt to that one.

mod bench;

use bench::{
    SEGMENTATION_FAULT, after_right_answers, assert_timed, bench, broken, good, plan, verdicts_of,
};
use emit::Kernel;
use measure::{Deal, Interrupt, Plan, Race, Verdict, timing_cores};

fn on_two_cores(deal: Deal) -> Plan {
    if timing_cores().len() < 2 {
        println!("skipped: two cores, for this machine lets one time");
    }
    Plan {
        cores: 2,
        deal,
        ..plan()
    }
}

fn names(verdicts: &[Verdict]) -> Vec<&'static str> {
    verdicts.iter().map(Verdict::name).collect()
}

/// Right ones, and one of each way to fail, at places on either core.
fn kernels() -> Vec<Kernel> {
    vec![
        good(),
        broken(SEGMENTATION_FAULT),
        broken("packet.t[0] = 1.0;"),
        good(),
        broken("this is no Rust"),
        after_right_answers("packet.t[0] = f32::NAN;"),
        good(),
    ]
}

#[test]
fn whichever_core_a_kernel_is_dealt_to_its_verdict_is_its_own() {
    let alone = verdicts_of(bench(Interrupt::default()), &kernels(), &plan());
    let expected = [
        "timed",
        "crashed",
        "wrong answer",
        "timed",
        "build failed",
        "wrong answer",
        "timed",
    ];
    assert_eq!(names(&alone), expected);
    for deal in [Deal::Kernels, Deal::Rounds] {
        let plan = on_two_cores(deal);
        let verdicts = verdicts_of(bench(Interrupt::default()), &kernels(), &plan);
        assert_eq!(names(&verdicts), expected, "{deal:?}");
    }
}

#[test]
fn however_it_is_dealt_every_round_is_timed_once() {
    for deal in [Deal::Kernels, Deal::Rounds] {
        for kernels in [vec![], vec![good()], vec![good(), good(), good()]] {
            let refs: Vec<&Kernel> = kernels.iter().collect();
            let plan = on_two_cores(deal);
            let verdicts = bench(Interrupt::default()).measure(&refs, &plan).unwrap();
            assert_eq!(verdicts.len(), kernels.len() + 1);
            for verdict in &verdicts[1..] {
                assert_timed(verdict);
                assert_eq!(verdict.summary().unwrap().rounds, plan.rounds.len());
            }
            // Every core has a reference; with kernels dealt, each in all rounds.
            let cores = timing_cores().len().clamp(1, 2);
            let times = if deal == Deal::Kernels { cores } else { 1 };
            let rounds = verdicts[0].summary().unwrap().rounds;
            assert_eq!(rounds, times * plan.rounds.len(), "{deal:?}");
        }
    }
}

#[test]
fn a_race_is_run_on_every_core() {
    let plan = Plan {
        race: Some(Race {
            ratios: vec![1000.0; 3],
            every: 2,
        }),
        racers: 3,
        ..on_two_cores(Deal::Kernels)
    };
    let kernels = [good(), good(), good(), good()];
    let verdicts = verdicts_of(bench(Interrupt::default()), &kernels, &plan);
    let rounds: Vec<usize> = verdicts
        .iter()
        .map(|verdict| verdict.summary().unwrap().rounds)
        .collect();
    // A thousand times as slow as the rival: out at the first look. The last one does not race.
    assert_eq!(rounds, [2, 2, 2, 3]);
}

#[test]
fn while_kernels_are_timed_others_may_be_built_on_fewer_cores() {
    let mut bench = bench(Interrupt::default());
    let kernels = kernels();
    let refs: Vec<&Kernel> = kernels.iter().collect();
    let built = bench.build(&refs, false).unwrap();
    bench.compile_at_once(1);
    let job = bench.job(&built, &plan()).unwrap();
    let timing = std::thread::spawn(|| job.run());
    let others = bench.build(&[&good(), &good()], false).unwrap();
    let first = bench.verdicts(&built, timing.join().unwrap()).unwrap();
    let then = bench.time(&others, &plan()).unwrap();
    let expected = verdicts_of(crate::bench::bench(Interrupt::default()), &kernels, &plan());
    assert_eq!(names(&first[1..]), names(&expected));
    assert_eq!(names(&then[1..]), ["timed", "timed"]);
}

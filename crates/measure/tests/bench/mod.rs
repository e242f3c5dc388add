//! A small bench, and kernels to be put on it: right ones, and ones that do something else.

#![allow(dead_code, reason = "every test file uses some of it")]

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use emit::{Isa, Kernel};
use measure::{Bench, Deal, Interrupt, Phase, Plan, Rustc, Verdict, WorkerCommand, WorkloadSpec};
use scene::{Grouping, Regime, SceneModel};

/// Triangles of the workload.
pub const TRIANGLES: usize = 512;

const PACKETS: usize = 6;

/// Triangles that a kernel sees before it is timed: four packets' short lists.
pub const CHECKED_TRIANGLES: usize = 4 * TRIANGLES;

/// Triangles that a kernel sees while it is timed in the rounds of [`plan`].
pub const TIMED_TRIANGLES: usize = PACKETS * TRIANGLES;

pub fn verdict(kernel: Kernel) -> Verdict {
    verdicts(&[kernel]).remove(0)
}

pub fn verdicts(kernels: &[Kernel]) -> Vec<Verdict> {
    verdicts_of(bench(Interrupt::default()), kernels, &plan())
}

pub fn verdicts_of(mut bench: Bench, kernels: &[Kernel], plan: &Plan) -> Vec<Verdict> {
    let kernels: Vec<&Kernel> = kernels.iter().collect();
    let verdicts = bench.measure(&kernels, plan);
    // The first one is the reference's.
    verdicts.unwrap().split_off(1)
}

pub fn bench(interrupt: Interrupt) -> Bench {
    bench_with(worker(), interrupt)
}

pub fn bench_with(worker: WorkerCommand, interrupt: Interrupt) -> Bench {
    let rustc = Rustc::of_this_build().unwrap();
    let reference = kernel("moller-trumbore");
    Bench::new(rustc, worker, workload(), reference, interrupt)
}

/// A bench with another reference.
pub fn bench_against(reference: Kernel) -> Bench {
    let rustc = Rustc::of_this_build().unwrap();
    let interrupt = Interrupt::default();
    Bench::new(rustc, worker(), workload(), reference, interrupt)
}

/// A bench whose compiler is another one.
pub fn bench_that_compiles_with(rustc: Rustc, interrupt: Interrupt) -> Bench {
    let reference = kernel("moller-trumbore");
    Bench::new(rustc, worker(), workload(), reference, interrupt)
}

/// A bench on which `t` is treated otherwise.
pub fn bench_in(regime: Regime) -> Bench {
    let rustc = Rustc::of_this_build().unwrap();
    let mut workload = workload();
    workload.scene.regime = regime;
    let reference = kernel_in(regime, "moller-trumbore");
    Bench::new(rustc, worker(), workload, reference, Interrupt::default())
}

pub fn worker() -> WorkerCommand {
    WorkerCommand {
        program: env!("CARGO_BIN_EXE_measure-worker").into(),
        arguments: Vec::new(),
        patience: Duration::from_secs(5),
    }
}

pub fn workload() -> WorkloadSpec {
    WorkloadSpec {
        seed: 1,
        triangles: TRIANGLES,
        packets: PACKETS,
        target_range: None,
        scene: SceneModel::preset("packet").unwrap(),
    }
}

pub fn plan() -> Plan {
    Plan {
        rounds: vec![0..2, 2..4, 4..6],
        separate: false,
        race: None,
        racers: 0,
        cores: 1,
        deal: Deal::Kernels,
        noise_floor: true,
        sweep: false,
        trial: None,
    }
}

pub fn assert_timed(verdict: &Verdict) {
    assert!(matches!(verdict, Verdict::Timed { .. }), "{verdict:?}");
}

pub fn assert_wrong(kernel: Kernel, expected: Phase) {
    assert_is_wrong(verdict(kernel), expected);
}

/// Gives what is wrong.
pub fn assert_is_wrong(verdict: Verdict, expected: Phase) -> String {
    match verdict {
        Verdict::WrongAnswer { phase, message } => {
            assert_eq!(phase, expected, "{message}");
            assert!(!message.contains('\n'));
            message
        }
        other => panic!("{other:?}"),
    }
}

/// A rival in the workload's regime.
pub fn kernel(rival: &str) -> Kernel {
    kernel_in(workload().scene.regime, rival)
}

fn kernel_in(regime: Regime, rival: &str) -> Kernel {
    let rival = rivals::find(rival, Grouping::Packet).unwrap();
    rival.kernel(Isa::Sse2, regime)
}

pub fn good() -> Kernel {
    kernel("kensler-shirley")
}

/// A kernel that does nothing but `code`.
pub fn broken(code: &str) -> Kernel {
    let source = format!(
        "use crate::{{Packet, Triangle}};
         pub unsafe fn kernel(packet: &mut Packet<64>, triangles: &[Triangle]) {{ {code} }}
         {SYSTEM_CALL}"
    );
    Kernel::by_hand(Isa::Sse2, Grouping::Packet, source, "kernel".into())
}

/// A kernel that does `code` after the right thing.
pub fn after_right_answers(code: &str) -> Kernel {
    after_right_answers_in(workload().scene.regime, code)
}

/// A kernel that does `code` after what is right in a regime.
pub fn after_right_answers_in(regime: Regime, code: &str) -> Kernel {
    let right = kernel_in(regime, "kensler-shirley");
    let call = format!("right::{}(packet, triangles)", right.function);
    let mut kernel = broken(&format!("unsafe {{ {call} }}; {code}"));
    let inner = right.source.replace("super::lanes", "super::super::lanes");
    kernel.source += &format!("\npub mod right {{ {inner} }}");
    kernel
}

/// Code that does `code` in calls before which the kernel has seen so many triangles.
pub fn when_it_has_seen(triangles: std::ops::Range<usize>, code: &str) -> String {
    let std::ops::Range { start, end } = triangles;
    format!(
        "let seen = {}.fetch_add(triangles.len(), core::sync::atomic::Ordering::Relaxed);
         if seen >= {start} && seen < {end} {{ {code} }}",
        counter()
    )
}

/// A counter that all copies of a kernel's code in a process share, and no other kernel.
pub fn counter() -> String {
    static COUNTERS: AtomicUsize = AtomicUsize::new(0);
    let own = COUNTERS.fetch_add(1, Ordering::Relaxed);
    // Copies have statics of their own, and there are copies on Linux alone. There a page is asked for at one place; it
    // is there already for all but the first who ask.
    format!(
        "{{
            #[cfg(all(target_os = \"linux\", target_arch = \"x86_64\"))]
            {{
                const PAGE: usize = 0x6a00_0000_0000;
                const PRIVATE_ANONYMOUS_FIXED: isize = 0x10_0022;
                unsafe {{
                    system_call(9, [PAGE as isize, 4096, 3, PRIVATE_ANONYMOUS_FIXED, -1, 0]);
                    (&*(PAGE as *const [core::sync::atomic::AtomicUsize; 512])).get_unchecked({own} % 512)
                }}
            }}
            #[cfg(not(all(target_os = \"linux\", target_arch = \"x86_64\")))]
            {{
                static SEEN: core::sync::atomic::AtomicUsize = core::sync::atomic::AtomicUsize::new(0);
                &SEEN
            }}
        }}"
    )
}

/// Changes every answer to the next number: still right, but not the same.
pub const NEXT_NUMBERS: &str = "
    for t in &mut packet.t {
        if *t < 1e5 {
            *t = t.next_up();
        }
    }";

/// Crashes with signal 11.
pub const SEGMENTATION_FAULT: &str = "unsafe { core::ptr::null_mut::<u32>().write_volatile(1) };";

/// Kernels have no library to call, so they ask the system themselves.
const SYSTEM_CALL: &str = r#"
    unsafe fn system_call(number: isize, arguments: [isize; 6]) -> isize {
        let result;
        let [a, b, c, d, e, f] = arguments;
        core::arch::asm!(
            "syscall",
            inlateout("rax") number => result,
            in("rdi") a, in("rsi") b, in("rdx") c, in("r10") d, in("r8") e, in("r9") f,
            lateout("rcx") _, lateout("r11") _,
        );
        result
    }"#;

/// Whether [`SYSTEM_CALL`] works here and `/proc` tells of processes. If not, says so.
pub fn is_on_linux() -> bool {
    let is = cfg!(all(target_os = "linux", target_arch = "x86_64"));
    if !is {
        println!("skipped: needs Linux on x86-64");
    }
    is
}

/// How many processes have `marker` in their command line. Of a process that has ended nothing is
/// left there, even if nobody has waited for it yet.
pub fn processes_with(marker: &str) -> usize {
    let numbers = std::fs::read_dir("/proc").unwrap().flatten();
    let lines = numbers.filter_map(|process| std::fs::read(process.path().join("cmdline")).ok());
    let marked = lines.filter(|line| String::from_utf8_lossy(line).contains(marker));
    marked.count()
}

/// Waits until something is so, and panics if it never is.
pub fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < Duration::from_secs(60), "never: {what}");
        std::thread::yield_now();
    }
}

/// Names a file to a test that was started again by itself, as a driver to be killed.
const DRIVER: &str = "RAYBREED_TEST_DRIVER";

/// The file that [`start_again`] was given, if it started this process.
pub fn started_again_with() -> Option<String> {
    std::env::var(DRIVER).ok()
}

/// Starts the test of this name once more, in a process of its own. When that is killed, what it
/// leaves behind is beside the file.
pub fn start_again(test: &str, file: &Path) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", test]).env(DRIVER, file);
    command.env("TMPDIR", file.parent().unwrap());
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

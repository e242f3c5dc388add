//! The shoot-out: a few kernels timed together on the full workload, each in a library of its
//! own, in random order, all in a round on one core, and the ranked table of it.

use std::ops::Range;

use emit::Kernel;
use measure::{
    Accuracy, Deal, MeasureError, Plan, Summary, Verdict, median, summarise, timing_cores,
};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use scene::{Record, Stored};
use serde::Serialize;

use crate::arena::{Contestant, PACKETS, REFERENCE};
use crate::benches::Benches;

/// The packets that searches time candidates on: every other one. The rest stays unseen until the
/// shoot-out. On either half of the paper's workload the rivals have the same ratios within 0.3%; on
/// its first 200 packets they have 3% more than on the last 200.
pub fn training_packets() -> impl Iterator<Item = usize> {
    (0..PACKETS).filter(|packet| is_training(*packet))
}

fn is_training(packet: usize) -> bool {
    packet.is_multiple_of(2)
}

/// Seed of the order of the packets.
const ORDER_SEED: u64 = 400;

/// How a contestant did.
#[derive(Clone, Debug, Serialize)]
pub struct Standing {
    /// Its name.
    pub kernel: String,
    /// Speed as a multiple of the reference's, on the full workload.
    pub ratio: f64,
    /// Relative uncertainty of the ratio.
    pub uncertainty: f64,
    /// The ratio on the packets that no search has seen, 0 if there were none.
    pub unseen: f64,
    /// Millions of ray-triangle tests a second.
    pub speed: f64,
    /// Bytes that are kept of a triangle.
    pub bytes: usize,
    /// How accurate its `t` is.
    pub accuracy: Option<Accuracy>,
    /// What became of it.
    pub verdict: &'static str,
    /// The ratio in every round, the same rounds for all.
    #[serde(skip)]
    pub rounds: Vec<f64>,
}

/// Times all contestants and the bench's reference together on the full workload. Gives them
/// ranked, the fastest first, failures last.
pub fn shootout(
    bench: &mut Benches,
    contestants: &[Contestant],
) -> Result<Vec<Standing>, MeasureError> {
    together(bench, contestants, 0..PACKETS)
}

/// The same on every other training packet alone, to see who is worth the full workload.
pub fn heat(
    bench: &mut Benches,
    contestants: &[Contestant],
) -> Result<Vec<Standing>, MeasureError> {
    together(bench, contestants, training_packets().step_by(2))
}

fn together(
    bench: &mut Benches,
    contestants: &[Contestant],
    packets: impl Iterator<Item = usize>,
) -> Result<Vec<Standing>, MeasureError> {
    // Each packet once: the spread between packets is what makes a figure uncertain, and to run
    // them again would not lessen it. A packet a round keeps the kernels near in time to the
    // reference. The order is a random one, so that no core and no moment has packets of a kind.
    let mut rounds: Vec<Range<usize>> = packets.map(|packet| packet..packet + 1).collect();
    rounds.shuffle(&mut ChaCha8Rng::seed_from_u64(ORDER_SEED));
    let plan = Plan {
        rounds: rounds.clone(),
        separate: true,
        race: None,
        racers: 0,
        cores: timing_cores().len(),
        deal: Deal::Rounds,
        noise_floor: true,
    };
    let kernels: Vec<&[Kernel]> = contestants
        .iter()
        .map(|contestant| contestant.kernels.as_slice())
        .collect();
    let verdicts = bench.measure(&kernels, &plan)?;
    let of_contestants = contestants
        .iter()
        .map(|one| (one.name.as_str(), bytes(&one.kernels)));
    let named = [(REFERENCE, Stored::Vertices.bytes())]
        .into_iter()
        .chain(of_contestants);
    let standings = named.zip(verdicts);
    let mut standings: Vec<Standing> = standings
        .map(|((name, bytes), verdict)| Standing {
            bytes,
            ..standing(name, verdict, &rounds)
        })
        .collect();
    standings.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
    Ok(standings)
}

/// Bytes that kernels keep of a triangle.
fn bytes(kernels: &[Kernel]) -> usize {
    let records = kernels.iter().map(|kernel| kernel.signature.layout.record);
    records.map(Record::bytes).max().unwrap_or(0)
}

fn standing(name: &str, verdict: Verdict, rounds: &[Range<usize>]) -> Standing {
    let mut standing = Standing {
        kernel: name.to_owned(),
        ratio: 0.0,
        uncertainty: 0.0,
        unseen: 0.0,
        speed: 0.0,
        bytes: 0,
        accuracy: None,
        verdict: verdict.name(),
        rounds: Vec::new(),
    };
    if let Verdict::Timed {
        ratios,
        speeds,
        accuracy,
    } = verdict
        && !ratios.is_empty()
    {
        let timings = ratios.iter().copied().zip(speeds.iter().copied());
        let unseen = timings
            .zip(rounds)
            .filter(|(_, packets)| !is_training(packets.start));
        let (unseen_ratios, unseen_speeds): (Vec<f64>, Vec<f64>) =
            unseen.map(|(timing, _)| timing).unzip();
        let Summary {
            ratio, uncertainty, ..
        } = summarise(&ratios, &speeds);
        standing = Standing {
            ratio,
            uncertainty,
            unseen: match unseen_ratios.as_slice() {
                [] => 0.0,
                _ => summarise(&unseen_ratios, &unseen_speeds).ratio,
            },
            speed: median(&speeds),
            accuracy: Some(accuracy),
            rounds: ratios,
            ..standing
        };
    }
    standing
}

/// Prints the standings as a table.
pub fn print_table(standings: &[Standing]) {
    let width = standings
        .iter()
        .map(|s| s.kernel.len())
        .max()
        .unwrap_or(0)
        .max(6);
    println!(
        "rank  {:width$}  ratio to MT     unseen packets  M tests/s  bytes  t error: median      p99",
        "kernel"
    );
    for (rank, standing) in (1..).zip(standings) {
        let Standing {
            kernel,
            ratio,
            uncertainty,
            unseen,
            speed,
            bytes,
            ..
        } = standing;
        let Some(accuracy) = standing.accuracy else {
            println!("   -  {kernel:width$}  {}", standing.verdict);
            continue;
        };
        let percent = uncertainty * 100.0;
        println!(
            "{rank:4}  {kernel:width$}  {ratio:5.2}x ±{percent:4.1}%   {unseen:13.2}x  {speed:9.0}  {bytes:5}  \
             {:15.1e}  {:7.1e}",
            accuracy.median, accuracy.p99,
        );
    }
}

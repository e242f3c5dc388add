//! The shoot-out: a few kernels timed together on the full workload, each in a library of its
//! own, in random order, all in a round on one core, and the ranked table of it.

use std::ops::Range;

use emit::Kernel;
use measure::{
    Accuracy, Deal, Look, MeasureError, Plan, Summary, Verdict, layout_weight, median, summarise,
    timing_cores, uncertainty_over,
};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use scene::{Record, Stored};
use serde::Serialize;

use crate::arena::{Contestant, PACKETS, REFERENCE};
use crate::benches::{Benches, BuiltForAll};

/// The packets that searches time candidates on: every other one. The rest stays unseen until the
/// shoot-out. On either half of the paper's workload the rivals have the same ratios within 0.3%; on
/// its first 200 packets they have 3% more than on the last 200.
pub fn training_packets() -> impl Iterator<Item = usize> {
    (0..PACKETS).filter(|packet| is_training(*packet))
}

fn is_training(packet: usize) -> bool {
    packet.is_multiple_of(2)
}

/// Fresh processes that time a shoot-out on each core: kernels differ by a hundredth from one to the next.
const PROCESSES: usize = 4;

/// How often records are made of all triangles, to time that.
const PASSES: usize = 40;

/// Seed of the order of the packets.
const ORDER_SEED: u64 = 400;

/// How a contestant did.
#[derive(Clone, Debug, Serialize)]
pub struct Standing {
    /// Its name.
    pub kernel: String,
    /// Speed as a multiple of the reference's, on the full workload.
    pub ratio: f64,
    /// Relative uncertainty of the ratio: of rounds, each with a memory layout of its own, and of processes.
    pub uncertainty: f64,
    /// The ratio on the packets that no search has seen, 0 if there were none.
    pub unseen: f64,
    /// How many times as slow it is in the worst memory layout as in most.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst_layout: Option<f64>,
    /// Millions of ray-triangle tests a second.
    pub speed: f64,
    /// Bytes that are kept of a triangle.
    pub bytes: usize,
    /// Millions of triangles a second that these are made of, if it has records of its own and that was
    /// timed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub precomputation: Option<f64>,
    /// How accurate its `t` is.
    pub accuracy: Option<Accuracy>,
    /// What became of it.
    pub verdict: &'static str,
    /// The ratio in every round, the same rounds for all.
    #[serde(skip)]
    pub rounds: Vec<f64>,
}

impl Standing {
    /// That of a contestant without a figure.
    pub fn failed(kernel: &str, verdict: &'static str) -> Standing {
        Standing {
            kernel: kernel.to_owned(),
            ratio: 0.0,
            uncertainty: 0.0,
            unseen: 0.0,
            worst_layout: None,
            speed: 0.0,
            bytes: 0,
            precomputation: None,
            accuracy: None,
            verdict,
            rounds: Vec::new(),
        }
    }
}

/// Times all contestants and the bench's reference together on the full workload. Gives them
/// ranked, the fastest first, failures last.
pub fn shootout(
    bench: &mut Benches,
    contestants: &[Contestant],
) -> Result<Vec<Standing>, MeasureError> {
    together(bench, contestants, 0..PACKETS, None)
}

/// The same, and everyone is tried by rays of the accuracy lab as well.
pub fn shootout_and_trial(
    bench: &mut Benches,
    contestants: &[Contestant],
    trial: Look,
) -> Result<Vec<Standing>, MeasureError> {
    together(bench, contestants, 0..PACKETS, Some(trial))
}

/// The shoot-out on every other training packet alone, to see who is worth the full workload.
pub fn heat(
    bench: &mut Benches,
    contestants: &[Contestant],
) -> Result<Vec<Standing>, MeasureError> {
    together(bench, contestants, training_packets().step_by(2), None)
}

fn together(
    bench: &mut Benches,
    contestants: &[Contestant],
    packets: impl Iterator<Item = usize>,
    trial: Option<Look>,
) -> Result<Vec<Standing>, MeasureError> {
    let contestants: Vec<&Contestant> = contestants.iter().collect();
    let shootout = Shootout::new(bench, &contestants, packets)?;
    let mut shootout = Shootout { trial, ..shootout };
    shootout.time_part(bench, 1)?;
    Ok(shootout.standings())
}

/// Contestants that were built, and what they have come to so far.
pub struct Shootout {
    /// The reference, then the contestants: names and bytes of a record.
    who: Vec<(String, usize)>,
    built: BuiltForAll,
    /// All rounds, in the order in which they are timed.
    rounds: Vec<Range<usize>>,
    /// The process that timed each of them, of those that were timed.
    processes: Vec<usize>,
    /// By which rays everyone is tried, if at all.
    trial: Option<Look>,
    /// Of everyone, once a part has been timed.
    verdicts: Vec<Verdict>,
    precomputations: Vec<Option<f64>>,
}

impl Shootout {
    /// Builds contestants, to be timed on these packets together with the reference.
    pub fn new(
        bench: &mut Benches,
        contestants: &[&Contestant],
        packets: impl Iterator<Item = usize>,
    ) -> Result<Shootout, MeasureError> {
        // Each packet once: the spread between packets is what makes a figure uncertain, and to run
        // them again would not lessen it. A packet a round keeps the kernels near in time to the
        // reference. The order is a random one, so that no core and no moment has packets of a kind.
        let mut rounds: Vec<Range<usize>> = packets.map(|packet| packet..packet + 1).collect();
        rounds.shuffle(&mut ChaCha8Rng::seed_from_u64(ORDER_SEED));
        bench.calibrate(&rounds, timing_cores().len())?;
        let kernels = contestants.iter().map(|one| one.kernels.as_slice());
        let built = bench.build(&kernels.collect::<Vec<&[Kernel]>>(), true)?;
        let of_contestants = contestants
            .iter()
            .map(|one| (one.name.clone(), bytes(&one.kernels)));
        let who = [(REFERENCE.to_owned(), Stored::Vertices.bytes())]
            .into_iter()
            .chain(of_contestants);
        Ok(Shootout {
            who: who.collect(),
            built,
            rounds,
            processes: Vec::new(),
            trial: None,
            verdicts: Vec::new(),
            precomputations: Vec::new(),
        })
    }

    /// Times the next one of so many parts of the rounds, on all cores that time; of all parts together, in so many shares
    /// that each core has [`PROCESSES`] fresh processes.
    pub fn time_part(&mut self, bench: &mut Benches, parts: usize) -> Result<(), MeasureError> {
        for _ in 0..PROCESSES.div_ceil(parts) {
            bench.dismiss_workers();
            self.time_share(bench, parts * PROCESSES.div_ceil(parts))?;
        }
        Ok(())
    }

    /// Times the next one of so many shares of the rounds.
    fn time_share(&mut self, bench: &mut Benches, shares: usize) -> Result<(), MeasureError> {
        let (timed, cores) = (self.processes.len(), timing_cores().len().max(1));
        let is_first = timed == 0;
        let share = self.rounds.len().div_ceil(shares);
        let rounds: Vec<Range<usize>> = self
            .rounds
            .iter()
            .skip(timed)
            .take(share)
            .cloned()
            .collect();
        if rounds.is_empty() {
            return Ok(());
        }
        // Rounds are dealt to the cores in turn, and each has a process.
        let before = self.processes.last().map_or(0, |last| last + 1);
        let dealt = (0..rounds.len()).map(|round| before + round % cores);
        self.processes.extend(dealt);
        let plan = Plan {
            rounds,
            separate: true,
            race: None,
            racers: 0,
            cores,
            deal: Deal::Rounds,
            noise_floor: true,
            // Layouts and rays of the lab are the same whichever rounds are timed.
            sweep: is_first,
            trial: self.trial.filter(|_| is_first),
        };
        let verdicts = bench.time(&self.built, &plan)?;
        self.verdicts = match is_first {
            true => verdicts,
            false => {
                let before = std::mem::take(&mut self.verdicts).into_iter();
                let pooled = before.zip(verdicts);
                pooled.map(|(one, more)| one.pooled_with(more)).collect()
            }
        };
        Ok(())
    }

    /// Times how the records of those who have their own are made.
    pub fn time_precomputations(&mut self, bench: &mut Benches) -> Result<(), MeasureError> {
        let verdicts = bench.time_precomputations(&self.built, PASSES)?;
        let speed = |verdict: &Verdict| match verdict {
            Verdict::Timed { speeds, .. } if !speeds.is_empty() => Some(median(speeds)),
            _ => None,
        };
        self.precomputations = verdicts.iter().map(speed).collect();
        Ok(())
    }

    /// How all did in the parts that were timed, the best first by what their speed is worth in all memory layouts, failures
    /// last; none before the first part.
    pub fn standings(&self) -> Vec<Standing> {
        let rounds = &self.rounds[..self.processes.len()];
        let precomputations = self.precomputations.iter().copied();
        let precomputations = precomputations.chain(std::iter::repeat(None));
        let all = self.who.iter().zip(&self.verdicts).zip(precomputations);
        let mut standings: Vec<Standing> = all
            .map(|(((name, bytes), verdict), precomputation)| Standing {
                bytes: *bytes,
                precomputation,
                ..standing(name, verdict.clone(), rounds, &self.processes)
            })
            .collect();
        let worth = |one: &Standing| one.ratio * layout_weight(one.worst_layout);
        standings.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
        standings
    }
}

/// Bytes that kernels keep of a triangle.
fn bytes(kernels: &[Kernel]) -> usize {
    let records = kernels.iter().map(|kernel| kernel.signature.layout.record);
    records.map(Record::bytes).max().unwrap_or(0)
}

fn standing(
    name: &str,
    verdict: Verdict,
    rounds: &[Range<usize>],
    processes: &[usize],
) -> Standing {
    let mut standing = Standing::failed(name, verdict.name());
    if let Verdict::Timed {
        ratios,
        speeds,
        accuracy,
        worst_layout,
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
        // Where the clock was too coarse for a round, it is not known which one.
        let over_processes = match ratios.len() == processes.len() {
            true => uncertainty_over(processes, &ratios, &speeds),
            false => f64::NAN,
        };
        standing = Standing {
            ratio,
            // Whichever is greater; what is no number is not.
            uncertainty: uncertainty.max(over_processes),
            unseen: match unseen_ratios.as_slice() {
                [] => 0.0,
                _ => summarise(&unseen_ratios, &unseen_speeds).ratio,
            },
            speed: median(&speeds),
            accuracy: Some(accuracy),
            worst_layout,
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
        "rank  {:width$}  ratio to MT     unseen packets  worst layout  M tests/s  bytes  t error: median      p99",
        "kernel"
    );
    for (rank, standing) in (1..).zip(standings) {
        let Standing {
            kernel,
            ratio,
            uncertainty,
            unseen,
            worst_layout,
            speed,
            bytes,
            ..
        } = standing;
        let Some(accuracy) = standing.accuracy else {
            println!("   -  {kernel:width$}  {}", standing.verdict);
            continue;
        };
        let percent = uncertainty * 100.0;
        let worst = worst_layout.map_or("-".into(), |worst| format!("{worst:.2}x"));
        println!(
            "{rank:4}  {kernel:width$}  {ratio:5.2}x ±{percent:4.1}%   {unseen:13.2}x  {worst:>12}  {speed:9.0}  {bytes:5}  \
             {:15.1e}  {:7.1e}",
            accuracy.median, accuracy.p99,
        );
    }
}

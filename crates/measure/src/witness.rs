//! What kernels leave while they are timed, so that nobody is right only when looked at.
//!
//! To look at answers takes far longer than to give them. So the timed runs only keep what they
//! leave, and when the timing is over it is compared, with what the kernel left on the same packet
//! before and with what the reference left there. Where that leaves a doubt, the oracle settles it;
//! of the reference it sees some packets in any case.

use std::collections::BTreeMap;
use std::ops::Bound::Included;

use scene::{Expected, PACKET_SIZE, RayPacket, Regime, Task, Workload, one_ray};

use crate::check::{first_error, last_list};
use crate::left::{Left, keeps_rays};
use crate::protocol::{Failure, Phase};

/// The reference's place in a batch.
const REFERENCE: usize = 0;

/// How many of the reference's own packets are in doubt in any case: nobody stands beside it.
const REFERENCE_PACKETS: usize = 2;

/// Answers that differ from the reference's by a greater share of them are in doubt. Right answers
/// do so on a tenth of the packets of the paper's workload: where the closest hit is a very close
/// one, or an edge is hit.
const DOUBT: f32 = 1e-5;

/// What was left in one batch.
pub(crate) struct Witness {
    regime: Regime,
    /// What kernels left on packets for the first time, by kernel and packet.
    first: BTreeMap<(usize, usize), Left>,
    /// The first packet on which a kernel later left something else, and what.
    changed: BTreeMap<usize, (usize, Left)>,
    /// The first packet whose rays a kernel changed.
    rays_changed: BTreeMap<usize, usize>,
}

/// Something that a kernel did to a packet and that may be wrong.
pub(crate) enum Doubt<'a> {
    /// It wrote to the rays, which is wrong.
    Rays { packet: usize },
    /// It left something else than before, which is wrong or at least not deterministic.
    Change(Odd<'a>),
    /// It left something else than the reference, which may be right.
    Oddity(Odd<'a>),
}

/// Rays of which a kernel left something odd.
pub(crate) struct Odd<'a> {
    packet: usize,
    rays: Vec<usize>,
    /// What it left of the whole packet.
    left: &'a Left,
}

impl Witness {
    /// Nothing has been left yet.
    pub fn new(regime: Regime) -> Witness {
        Witness {
            regime,
            first: BTreeMap::new(),
            changed: BTreeMap::new(),
            rays_changed: BTreeMap::new(),
        }
    }

    /// A kernel has run on the packets from number `start` on.
    pub fn see(&mut self, kernel: usize, start: usize, before: &[RayPacket], after: &[RayPacket]) {
        for (packet, (before, after)) in (start..).zip(before.iter().zip(after)) {
            if !keeps_rays(after, before) {
                self.rays_changed.entry(kernel).or_insert(packet);
            }
            let left = Left::of(after);
            let first = self.first.entry((kernel, packet));
            if *first.or_insert_with(|| left.clone()) != left {
                self.changed.entry(kernel).or_insert((packet, left));
            }
        }
    }

    /// What the oracle must be asked about `kernel`.
    pub fn doubts(&self, kernel: usize) -> impl Iterator<Item = Doubt<'_>> {
        let rays = self.rays_changed.get(&kernel);
        let rays = rays.map(|&packet| Doubt::Rays { packet });
        let change = self.changed.get(&kernel).map(|&(packet, ref left)| {
            let first = &self.first[&(kernel, packet)];
            Doubt::Change(Odd {
                packet,
                rays: left.rays_unlike(first, self.regime, 0.0),
                left,
            })
        });
        let of_kernel = (Included((kernel, 0)), Included((kernel, usize::MAX)));
        let odd = self.first.range(of_kernel).enumerate();
        let odd = odd.filter_map(move |(place, (&(_, packet), left))| {
            let is_trusted = kernel != REFERENCE || place >= REFERENCE_PACKETS;
            let reference = self.first.get(&(REFERENCE, packet));
            let rays = match reference.filter(|_| is_trusted) {
                Some(reference) => left.rays_unlike(reference, self.regime, DOUBT),
                None => (0..PACKET_SIZE).collect(),
            };
            (!rays.is_empty()).then_some(Doubt::Oddity(Odd { packet, rays, left }))
        });
        rays.into_iter().chain(change).chain(odd)
    }
}

/// The right answers to what is timed. One ray of the paper's workload takes it a millisecond, so it
/// works them out when they are asked for.
#[derive(Default)]
pub(crate) struct Oracle {
    /// By packet and ray.
    known: BTreeMap<(usize, usize), Expected>,
}

impl Oracle {
    /// The failure that a doubt comes to, if it does.
    pub fn settle(
        &mut self,
        doubt: &Doubt<'_>,
        task: Task,
        workload: &Workload,
    ) -> Option<Failure> {
        match doubt {
            &Doubt::Rays { packet } => Some(wrong(packet, "the rays themselves were changed")),
            Doubt::Change(odd) => {
                let failure = self.first_wrong(odd, task, workload);
                Some(failure.unwrap_or(Failure::Nondeterministic))
            }
            Doubt::Oddity(odd) => self.first_wrong(odd, task, workload),
        }
    }

    fn first_wrong(&mut self, odd: &Odd<'_>, task: Task, workload: &Workload) -> Option<Failure> {
        let before = &workload.packets[odd.packet];
        let after = odd.left.in_packet(before);
        let triangles = last_list(task.regime, &workload.triangles);
        odd.rays.iter().find_map(|&ray| {
            let expected = self.known.entry((odd.packet, ray));
            let before = one_ray(before, ray);
            let expected = expected.or_insert_with(|| Expected::of(task, &before, triangles));
            let (_, why) = first_error(expected, task.regime, &one_ray(&after, ray))?;
            Some(wrong(odd.packet, &format!("ray {ray}: {why}")))
        })
    }
}

fn wrong(packet: usize, why: &str) -> Failure {
    Failure::Wrong(Phase::Time, format!("packet {packet} while timed: {why}"))
}

//! Whether a kernel's answers are right, and how accurate.
//!
//! Right is what the `f64` oracle of [`scene`] allows: away from edges there is one answer, near
//! them either. The lists are short ones, whose hits are many; what is timed, long lists too, is
//! judged by what it leaves behind (`witness.rs`). Accuracy is that of the short lists: the closest
//! of thousands of hits is picked for its small `t`, where `Va` cancels and every kernel in `f32`
//! is ten times worse, with or without an exact division.

use accuracy::Tried;
use scene::{
    Expected, LEAF_TRIANGLES, Layout, List, Lists, NO_HITS, Packet, Part, Query, RayHits,
    RayPacket, Regime, SceneModel, Task, Triangle, answers,
};
use serde::{Deserialize, Serialize};

use crate::left::{Left, keeps_rays};
use crate::reported::Reports;
use crate::statistics::quantile;

/// The greatest p99 of the relative error of `t` that a kernel of the library may have. Möller-Trumbore's
/// is 4e-7, the appendix's 3e-7, that of a bare 12-bit reciprocal estimate 2e-4. About half of all programs
/// of the graph are above, most of them since they take a small difference of large volumes.
///
/// Programs that are tight at edges are no exception. The fastest of them in lists of eight have `V` as the sum of three
/// volumes about the ray's origin, and are off by 2e-6; but that grows with the square of how far away a triangle is,
/// in its own size, and where that was 700 `t` was off by 0.2% at p99, and pictures had dots.
pub const MAX_P99_ERROR: f64 = 1e-6;

/// How many times that a kernel may have and still be timed. A parent in a search may owe its error to one
/// volume alone, and its offspring be rid of it.
pub const MAX_EXCESS: f64 = 4.0;

/// Triangles that are checked in short lists.
const LISTED_TRIANGLES: usize = 4000;

/// Packets that are checked, each against other triangles.
const PACKETS: usize = 4;

/// Relative error of `t` against `f64`, over hits that are clear of every edge; and what a trial by harder rays
/// came to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// How many hits were looked at.
    pub hits: u64,
    /// Half of them are below this.
    pub median: f64,
    /// 99 of 100 are below this.
    pub p99: f64,
    /// The greatest seen, which is no bound.
    pub max: f64,
    /// The mean of the errors' squares: what Havel and Herout report.
    #[serde(default)]
    pub mean_square: f64,
    /// By rays at edges, vertices and all over triangles, if the [`Plan`](crate::Plan) has a trial.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tried: Option<Tried>,
}

impl Accuracy {
    /// The one whose p99 is greater, with the worse of both trials.
    #[must_use]
    pub fn or_worse(self, other: Accuracy) -> Accuracy {
        let tried = match (self.tried, other.tried) {
            (Some(one), Some(other)) => Some(one.or_worse(other)),
            (one, other) => one.or(other),
        };
        let worse = if self.p99 < other.p99 { other } else { self };
        Accuracy { tried, ..worse }
    }
}

/// A packet, a list of triangles and the answers that are right.
struct Case {
    packet: RayPacket,
    triangles: Vec<Triangle>,
    expected: Expected,
}

/// Everything that kernels of one workload are checked on.
pub(crate) struct Checks {
    scene: SceneModel,
    task: Task,
    cases: Vec<Case>,
}

/// A kernel's answers to every case, bit by bit.
#[derive(PartialEq, Eq)]
pub(crate) struct Answers(Vec<Left>);

impl Checks {
    /// Works out the right answers for the first packets of a workload.
    pub fn new(scene: &SceneModel, part: Part<'_>) -> Checks {
        let task = Task::of(scene);
        let packets = &part.packets[..PACKETS.min(part.packets.len())];
        let shares = part.triangles.chunks((LISTED_TRIANGLES / PACKETS).max(1));
        let mut cases = Vec::new();
        for (packet, share) in packets.iter().zip(shares.cycle()) {
            for triangles in share.chunks(LEAF_TRIANGLES) {
                cases.push(Case {
                    packet: packet.clone(),
                    triangles: triangles.to_vec(),
                    expected: Expected::of(task, packet, triangles),
                });
            }
        }
        Checks {
            scene: scene.clone(),
            task,
            cases,
        }
    }

    /// The lists of all cases in a layout.
    pub fn lists(&self, layout: Layout, of: impl FnMut(&Triangle) -> Vec<f32>) -> Lists {
        let lists = self.cases.iter().map(|case| case.triangles.as_slice());
        layout.lists_of(lists, of)
    }

    /// Runs the kernel on every case, of which `lists` has the triangles in its layout.
    ///
    /// # Errors
    ///
    /// A sentence about the first wrong answer.
    pub fn run(
        &self,
        lists: &Lists,
        mut kernel: impl FnMut(&mut RayPacket, &mut RayHits, List<'_>),
    ) -> Result<(Answers, Accuracy), String> {
        let regime = self.task.regime;
        let mut given = Vec::new();
        let mut errors = Vec::new();
        for (index, (case, list)) in self.cases.iter().zip(lists.iter()).enumerate() {
            let mut packet = case.packet.clone();
            let mut hits = NO_HITS;
            kernel(&mut packet, &mut hits, list);
            let complaint = if keeps_rays(&packet, &case.packet) {
                let error = first_error(&case.expected, regime, &packet);
                let error = error.or_else(|| {
                    let reports = Reports {
                        scene: &self.scene,
                        rays: &case.packet,
                        triangles: &case.triangles,
                        expected: &case.expected,
                    };
                    reports.first_error(answers(regime, &packet), &hits)
                });
                error.map(|(ray, error)| format!("ray {ray}: {error}"))
            } else {
                Some("the rays themselves were changed".into())
            };
            if let Some(complaint) = complaint {
                let count = case.triangles.len();
                return Err(format!("check {index} ({count} triangles): {complaint}"));
            }
            let answers = answers(regime, &packet).iter().enumerate();
            errors.extend(answers.filter_map(|(ray, &t)| match self.task.query {
                Query::Closest => case.expected.relative_error(ray, t),
                // There is no t that could be off.
                Query::Any => case.expected.clear_hit(ray).map(|_| 0.0),
            }));
            given.push(Left::of(&packet));
        }
        if errors.is_empty() {
            return Err("the checks have no clear hit; use a larger workload".into());
        }
        let squares: f64 = errors.iter().map(|error| error * error).sum();
        let mean_square = squares / errors.len() as f64;
        let mut quantile = |share| quantile(&mut errors, share);
        let [median, p99, max] = [0.5, 0.99, 1.0].map(&mut quantile);
        let accuracy = Accuracy {
            hits: errors.len() as u64,
            median,
            p99,
            max,
            mean_square,
            tried: None,
        };
        Ok((Answers(given), accuracy))
    }

    /// What the kernel answers now, right or not.
    pub fn answers(
        &self,
        lists: &Lists,
        mut kernel: impl FnMut(&mut RayPacket, &mut RayHits, List<'_>),
    ) -> Answers {
        let answer = |(case, list): (&Case, List<'_>)| {
            let mut packet = case.packet.clone();
            kernel(&mut packet, &mut NO_HITS.clone(), list);
            Left::of(&packet)
        };
        Answers(self.cases.iter().zip(lists.iter()).map(answer).collect())
    }
}

/// The list of which a timed run leaves the answers in a packet.
pub(crate) fn last_list(regime: Regime, triangles: &[Triangle]) -> &[Triangle] {
    match regime {
        Regime::Shrinking | Regime::Fixed => triangles,
        Regime::Leaf => triangles.chunks(LEAF_TRIANGLES).last().unwrap_or(&[]),
    }
}

/// The first wrong ray of `packet` as a kernel left it, if there is one, and what is wrong.
pub(crate) fn first_error<const N: usize>(
    expected: &Expected,
    regime: Regime,
    packet: &Packet<N>,
) -> Option<(usize, String)> {
    let ray = expected.first_wrong_ray(packet)?;
    let t = answers(regime, packet)[ray];
    let clear = expected.clear_hit(ray);
    Some((ray, format!("t = {t}, should be {clear:?}")))
}

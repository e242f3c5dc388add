//! A loaded kernel in the accuracy lab.

use accuracy::{
    Case, CaseLeaks, CaseProfile, Hit, Hostile, Packets, PairCase, Profile, Rate, Scaling, Subject,
    Sweep, Swept, hostile, profiles, scale_range, sweeps, watertightness,
};
use scene::{Origin, Output, PACKET_SIZE, Ray, RayHits, RayPacket, Regime, SceneModel, Triangle};
use serde::{Deserialize, Serialize};

use crate::track::Numbered;

/// What the accuracy lab finds of a kernel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// What leaks, case by case.
    pub leaks: Vec<CaseLeaks>,
    /// Wrong verdicts and errors, case by case.
    pub profiles: Vec<CaseProfile>,
    /// From which exponent of 2 to which a scale changes no verdict.
    pub scales: Vec<(Scaling, i32, i32)>,
    /// What becomes of inputs that are not finite.
    pub hostile: Hostile,
    /// How errors and wrong verdicts go with size and with distance.
    pub sweeps: Vec<Swept>,
}

impl Judged {
    /// Rays aimed at shared edges that no triangle reports, of all cases.
    pub fn edge_leak(&self) -> Rate {
        self.leaks.iter().map(|one| one.leaks.edge.leak).sum()
    }

    /// The same at vertices.
    pub fn vertex_leak(&self) -> Rate {
        self.leaks.iter().map(|one| one.leaks.vertex.leak).sum()
    }

    /// Rays aimed at either that are reported once too often.
    pub fn double(&self) -> Rate {
        let passages = self
            .leaks
            .iter()
            .map(|one| [one.leaks.edge, one.leaks.vertex]);
        passages.flatten().map(|passage| passage.double).sum()
    }

    /// Interior hits that are not reported, of all triangles.
    pub fn missed(&self) -> Rate {
        self.profiles
            .iter()
            .map(|one| one.profile.counts.missed)
            .sum()
    }

    /// Reports of rays that miss, or are parallel, of all triangles.
    pub fn false_hit(&self) -> Rate {
        self.profiles
            .iter()
            .map(|one| one.profile.counts.wrong_hit())
            .sum()
    }

    /// What was found at a kind of triangles, if that was looked at.
    pub fn profile(&self, case: PairCase) -> Option<&Profile> {
        let mut all = self.profiles.iter();
        all.find(|one| one.case == case).map(|one| &one.profile)
    }

    /// The exponents of 2 by which everything can be scaled without another verdict, if that was looked at.
    pub fn scale_range(&self) -> Option<(i32, i32)> {
        let mut all = self.scales.iter();
        let found = all.find(|(scaling, ..)| *scaling == Scaling::Everything);
        found.map(|&(_, least, most)| (least, most))
    }
}

/// How closely a kernel is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Look {
    /// Rays of every case.
    pub samples: u64,
    /// Seed of the cases.
    pub seed: u64,
}

/// Of so many rays, one is tested at ordinary triangles at every scale, and one in hostile company.
const SCALED: u64 = 20;

/// Of so many rays, one is tested at every point of a sweep.
const SWEPT: u64 = 10;

/// Kernels of a common origin are given one ray a packet, and so many times fewer of them.
const ALONE: u64 = 32;

/// Fewest rays of a case.
const FEWEST: u64 = 256;

/// A loaded kernel as the lab takes it. It reports closest hits of both sides, from 0 to `t_max`.
#[derive(Clone, Copy)]
pub(crate) struct Specimen {
    kernel: Numbered,
    origin: Origin,
    regime: Regime,
    /// Whether it reports barycentric coordinates.
    uv: bool,
}

impl Specimen {
    /// A kernel that was built for such a scene.
    pub fn new(kernel: Numbered, scene: &SceneModel) -> Specimen {
        Specimen {
            kernel,
            origin: scene.origin,
            regime: scene.regime,
            uv: scene.reports(Output::Uv),
        }
    }

    /// Takes it to the lab.
    pub fn judge(self, look: Look) -> Judged {
        let samples = match self.origin {
            Origin::General => look.samples,
            Origin::Common => (look.samples / ALONE).max(FEWEST),
        };
        let seed = look.seed;
        let few = (samples / SCALED).max(FEWEST);
        let mut subject = self;
        let scales = Scaling::ALL.map(|scaling| {
            let range = scale_range(&mut subject, scaling, few, seed);
            (scaling, *range.start(), *range.end())
        });
        Judged {
            leaks: watertightness(|| self, &Case::ALL, samples, seed),
            profiles: profiles(|| self, &PairCase::ALL, samples, seed),
            scales: scales.into(),
            hostile: hostile(&mut subject, few, seed),
            sweeps: sweeps(|| self, &Sweep::ALL, (samples / SWEPT).max(FEWEST), seed),
        }
    }
}

impl Subject for Specimen {
    fn hits(&mut self, rays: &[Ray], triangles: &[Triangle], answers: &mut [Option<Hit>]) {
        let Numbered { loaded, layout, .. } = self.kernel;
        let kernel = |packet: &mut RayPacket, hits: &mut RayHits, triangles: &[Triangle]| {
            let lists = [triangles].into_iter();
            let lists = layout.lists_of(lists, |triangle| loaded.prepare(triangle));
            for list in lists.iter() {
                loaded.call(packet, hits, list);
            }
        };
        let Specimen { regime, uv, .. } = *self;
        let mut packets = Packets::<PACKET_SIZE, _> { regime, uv, kernel };
        match self.origin {
            Origin::General => packets.hits(rays, triangles, answers),
            Origin::Common => Alone(packets).hits(rays, triangles, answers),
        }
    }
}

/// A subject that is given one ray at a time.
struct Alone<S>(S);

impl<S: Subject> Subject for Alone<S> {
    fn hits(&mut self, rays: &[Ray], triangles: &[Triangle], answers: &mut [Option<Hit>]) {
        let mut of_one = vec![None; triangles.len()];
        for (number, ray) in rays.iter().enumerate() {
            self.0
                .hits(std::slice::from_ref(ray), triangles, &mut of_one);
            let places = answers.iter_mut().skip(number).step_by(rays.len());
            for (place, answer) in places.zip(&of_one) {
                *place = *answer;
            }
        }
    }
}

//! The data of the library's page.

use accuracy::{PairCase, Rate};
use emit::Recipe;
use evolve::pareto;
use measure::{Judged, Look, Machine, Rustc};
use serde::Serialize;

use super::catalogue::{self, Entry};
use crate::accuracy::Profiled;
use crate::arena::{Arena, REFERENCE};
use crate::bench::figures::{self, Figures};
use crate::bench::running::Running;
use crate::cases::Role;

/// The library beside its rivals, on one machine.
#[derive(Clone, Debug, Serialize)]
pub struct Library {
    /// The machine.
    pub machine: Machine,
    /// The compiler.
    pub rustc: String,
    /// Packets that kernels were timed on, of every case.
    pub packets: usize,
    /// Rays of each of the accuracy lab's cases.
    pub samples: u64,
    /// Their seed.
    pub seed: u64,
    /// Every scene in a regime on an instruction set.
    pub cases: Vec<Compared>,
    /// The library's kernels, as their recipes describe them.
    pub catalogue: Vec<Entry>,
}

/// A case, with all who took part.
#[derive(Clone, Debug, Serialize)]
pub struct Compared {
    /// The scene's name.
    pub scene: String,
    /// The instruction set.
    pub isa: String,
    /// What becomes of `t`.
    pub regime: String,
    /// What was timed: packets, triangles, hits.
    pub workload: String,
    /// Who took part, the fastest first, failures last.
    pub kernels: Vec<Contender>,
}

/// A kernel that was timed and judged.
#[derive(Clone, Debug, Serialize)]
pub struct Contender {
    /// Its timing.
    #[serde(flatten)]
    pub figures: Figures,
    /// What it takes part as.
    pub role: Role,
    /// Nanoseconds a test of one ray and one triangle: the reference's median over all rounds, divided by the ratio,
    /// which is more certain than two medians are; none if it was not timed.
    pub nanoseconds: Option<f64>,
    /// 99.99% of the relative errors of `t` at ordinary triangles are below this; none if there were no hits.
    pub t_error_p9999: Option<f64>,
    /// Whether nobody is as good in nanoseconds, that error and the share of rays at edges and vertices that leak,
    /// and better in one of them.
    pub on_front: bool,
    /// What became of it in the accuracy lab: `judged`, or why not.
    pub lab: &'static str,
    /// What the lab found.
    pub judged: Option<Judged>,
}

impl Library {
    /// Puts together what was timed and what was judged.
    pub fn new(
        running: &[Running<'_>],
        profiled: &[Profiled],
        packets: usize,
        look: Look,
        rustc: &Rustc,
        recipes: &[Recipe],
    ) -> Library {
        Library {
            machine: Machine::here(),
            rustc: rustc.number().to_owned(),
            packets,
            samples: look.samples,
            seed: look.seed,
            cases: running.iter().map(|one| compared(one, profiled)).collect(),
            catalogue: recipes.iter().map(catalogue::entry).collect(),
        }
    }
}

impl Compared {
    /// What it is, in words with something between them.
    pub fn title(&self, between: &str) -> String {
        let regime = format!("t {}", self.regime);
        [&self.scene, &self.isa, &regime]
            .map(String::as_str)
            .join(between)
    }

    /// Those on the front with their numbers, the fastest first.
    pub fn front(&self) -> impl Iterator<Item = (usize, &Contender)> {
        let numbered = self.kernels.iter().enumerate();
        numbered.filter(|(_, one)| one.on_front)
    }
}

impl Contender {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.figures.of.kernel
    }

    /// Rays aimed at shared edges that leak, if it was judged.
    pub fn edge_leak(&self) -> Option<Rate> {
        self.judged.as_ref().map(Judged::edge_leak)
    }

    /// Rays aimed at shared edges and vertices that leak, if it was judged.
    pub fn leak(&self) -> Option<Rate> {
        let judged = self.judged.as_ref()?;
        Some([judged.edge_leak(), judged.vertex_leak()].into_iter().sum())
    }

    /// Rays aimed at edges and vertices that are reported once too often, if it was judged.
    pub fn double(&self) -> Option<Rate> {
        self.judged.as_ref().map(Judged::double)
    }

    /// What it is to be small in: time, error, leaks.
    fn objectives(&self) -> Option<Vec<f64>> {
        Some(vec![
            self.nanoseconds?,
            self.t_error_p9999?,
            self.leak()?.share(),
        ])
    }
}

fn compared(running: &Running<'_>, profiled: &[Profiled]) -> Compared {
    let case = running.case;
    let Arena { scene, isas, .. } = &case.arena;
    let all = figures::of(running);
    let mut references = all.iter().filter(|one| one.of.kernel == REFERENCE);
    let reference = references
        .find_map(|one| one.speed)
        .map(|speed| 1e3 / speed);
    let contender = |figures: Figures| {
        let profiled = profiled.iter().find(|one| one.of == figures.of);
        let judged = profiled.and_then(|one| one.judged.clone());
        Contender {
            role: case.role(&figures.of.kernel),
            nanoseconds: reference
                .zip(figures.ratio)
                .map(|(reference, ratio)| reference / ratio),
            t_error_p9999: judged.as_ref().and_then(ordinary_p9999),
            on_front: false,
            lab: profiled.map_or("not judged", |one| one.verdict),
            judged,
            figures,
        }
    };
    let mut kernels: Vec<Contender> = all.into_iter().map(contender).collect();
    mark_front(&mut kernels);
    Compared {
        scene: scene.name.to_string(),
        isa: isas.to_string(),
        regime: scene.regime.to_string(),
        workload: case.arena.describe_workload(),
        kernels,
    }
}

/// What 99.99% of the errors at ordinary triangles are below, if there were hits.
fn ordinary_p9999(judged: &Judged) -> Option<f64> {
    let errors = judged.profile(PairCase::Ordinary)?.relative_error?;
    Some(errors.p9999)
}

/// Marks who is beaten in nothing. Whoever was not timed or not judged is not among them.
fn mark_front(kernels: &mut [Contender]) {
    let (places, points): (Vec<usize>, Vec<Vec<f64>>) = kernels
        .iter()
        .enumerate()
        .filter_map(|(place, one)| Some((place, one.objectives()?)))
        .unzip();
    for member in pareto::front(&points) {
        kernels[places[member]].on_front = true;
    }
}

#[cfg(test)]
impl Library {
    /// An exact kernel, one that sees nothing but is faster, one that failed, and a champion with a strange name.
    pub fn example() -> Library {
        let mut kernels = vec![
            Contender::example(
                "blind",
                Role::Library,
                Some(0.5),
                Some(tests::judged(|_| None)),
            ),
            Contender::example(
                "exact",
                Role::Rival,
                Some(2.0),
                Some(tests::judged(tests::right)),
            ),
            Contender::example(
                "runs/<b>",
                Role::Champion,
                Some(3.0),
                Some(tests::judged(tests::right)),
            ),
            Contender::example("broken", Role::Rival, None, None),
        ];
        mark_front(&mut kernels);
        let recipes = crate::files::read_recipes().expect("the recipes");
        Library {
            machine: Machine::here(),
            rustc: "1.89.0".into(),
            packets: 400,
            samples: 256,
            seed: 1,
            cases: vec![Compared {
                scene: "packet".into(),
                isa: "sse2".into(),
                regime: "shrinking".into(),
                workload: "400 packets".into(),
                kernels,
            }],
            catalogue: recipes.iter().map(catalogue::entry).collect(),
        }
    }
}

#[cfg(test)]
impl Contender {
    /// A kernel with a time and a judgement.
    pub fn example(
        name: &str,
        role: Role,
        nanoseconds: Option<f64>,
        judged: Option<Judged>,
    ) -> Contender {
        let of = crate::cases::Identity::example(name, "shrinking");
        Contender {
            role,
            nanoseconds,
            t_error_p9999: judged.as_ref().and_then(ordinary_p9999),
            on_front: false,
            lab: "judged",
            judged,
            figures: Figures::untimed(of, "wrong answer"),
        }
    }
}

#[cfg(test)]
mod tests {
    use accuracy::{Case, Class, Exact, Hostile, Scalar, Sweep, profiles, sweeps, watertightness};
    use scene::{Ray, Triangle};

    use super::*;

    const RAYS: u64 = 256;

    /// What the lab finds of a kernel for one ray and one triangle.
    pub fn judged(kernel: fn(Exact) -> Option<f32>) -> Judged {
        let subject =
            || Scalar(|ray: &Ray, triangle: &Triangle| kernel(Exact::new(ray, triangle)?));
        Judged {
            leaks: watertightness(subject, &Case::ALL, RAYS, 1),
            profiles: profiles(subject, &PairCase::ALL, RAYS, 1),
            scales: Vec::new(),
            hostile: Hostile::default(),
            sweeps: sweeps(subject, &Sweep::ALL, RAYS, 1),
        }
    }

    /// The right answer, ties counting as hits.
    pub fn right(exact: Exact) -> Option<f32> {
        let is_hit = matches!(
            exact.class(),
            Class::Interior | Class::Edge(_) | Class::Vertex(_)
        );
        is_hit.then(|| exact.t().map(|t| t as f32)).flatten()
    }

    #[test]
    fn the_front_is_of_those_who_were_timed_and_judged_and_are_beaten_by_none() {
        let Library { cases, .. } = Library::example();
        let front: Vec<&str> = cases[0].front().map(|(_, one)| one.name()).collect();
        // Who is blind has no error to compare, and the champion is the exact one, slower.
        assert_eq!(front, ["exact"]);
    }
}

//! Who comes out of a search: the finalists, and the champion as a recipe.

use emit::{ErrorProfile, Isa, Name, Provenance, Recipe};
use evolve::{Individual, Objective, Outcome};
use measure::{MeasureError, Verdict};

use super::conditions::Conditions;
use crate::arena::{Arena, Contestant};
use crate::benches::Benches;
use crate::shootout::{Standing, heat};

/// How many of the fittest meet in the heat. The best of the search was timed in a hurry, in a
/// library with others, and owes some of its figure to luck.
const IN_HEAT: usize = 5;

/// How many of those meet the rivals. The figure of the best of many owes something to luck, so
/// they are few.
const FINALISTS: usize = 3;

/// Those who may become the champion.
pub struct Finalists<'a> {
    /// Best first.
    pub individuals: Vec<&'a Individual>,
    /// Whether their `t` is accurate enough for the library.
    pub accurate: bool,
}

impl<'a> Finalists<'a> {
    /// The fittest that are accurate enough for the library. In a small run there may be none;
    /// then the fittest of all, which can be looked at but not promoted.
    pub fn of<E>(outcome: &'a Outcome<E>, limit: f64) -> Finalists<'a> {
        let fittest = outcome.best(outcome.population.len());
        let is_accurate = |finalist: &&Individual| excess(finalist, limit) <= 1.0;
        let mut individuals: Vec<&Individual> =
            fittest.iter().copied().filter(is_accurate).collect();
        let accurate = !individuals.is_empty();
        if !accurate {
            individuals = fittest;
        }
        individuals.truncate(IN_HEAT);
        Finalists {
            individuals,
            accurate,
        }
    }

    /// Lets them meet on the training packets, and leaves the best.
    pub fn heat(&mut self, arena: &Arena, bench: &mut Benches) -> Result<(), MeasureError> {
        let standings = heat(bench, &self.contestants(arena))?;
        let best = standings.iter().filter_map(|standing| self.named(standing));
        let best: Vec<&Individual> = best.take(FINALISTS).collect();
        if !best.is_empty() {
            self.individuals = best;
        }
        Ok(())
    }

    /// They as contestants.
    pub fn contestants(&self, arena: &Arena) -> Vec<Contestant> {
        let places = self.individuals.iter().enumerate();
        places
            .map(|(place, finalist)| Contestant {
                name: name(place),
                kernels: arena.kernels(&finalist.candidate.program),
            })
            .collect()
    }

    /// Names the best of a shoot-out the champion. Gives it with its speed.
    pub fn crown(&self, standings: &mut [Standing]) -> Option<(&'a Individual, Speed)> {
        let best = standings.iter_mut().find(|one| self.named(one).is_some())?;
        let champion = self.named(best)?;
        best.kernel = "champion".into();
        Some((champion, Speed::of(best)))
    }

    /// Whose standing this is, unless it failed or is a rival's.
    fn named(&self, standing: &Standing) -> Option<&'a Individual> {
        let mut places = self.individuals.iter().enumerate();
        let (_, finalist) = places.find(|(place, _)| name(*place) == standing.kernel)?;
        standing.accuracy.map(|_| *finalist)
    }
}

/// The best figures that there are of a champion's speed.
#[derive(Clone, Copy)]
pub struct Speed {
    /// As a multiple of the reference's.
    pub ratio: f64,
    /// Relative uncertainty of that, of all processes that timed it; none in a search, where it is one process.
    pub uncertainty: Option<f64>,
    /// How many times as slow it is in the worst memory layout as in most, if that was measured.
    pub worst_layout: Option<f64>,
}

impl Speed {
    /// That of a contestant.
    pub fn of(standing: &Standing) -> Speed {
        Speed {
            ratio: standing.ratio,
            uncertainty: Some(standing.uncertainty),
            worst_layout: standing.worst_layout,
        }
    }

    /// That of a candidate in the search: its fitness may be less.
    pub fn in_search(individual: &Individual) -> Speed {
        let verdict = serde_json::from_value(individual.evaluation.details.clone());
        let summary = verdict.ok().and_then(|verdict: Verdict| verdict.summary());
        Speed {
            ratio: summary.map_or(individual.weight(), |summary| summary.ratio),
            uncertainty: None,
            worst_layout: individual.evaluation.details["worst_layout"].as_f64(),
        }
    }
}

/// The name of the finalist at a place.
fn name(place: usize) -> String {
    format!("finalist {}", place + 1)
}

/// How many times the limit the p99 of the relative error of an individual's `t` is.
fn excess(individual: &Individual, limit: f64) -> f64 {
    let p99 = &individual.evaluation.details["accuracy"]["p99"];
    p99.as_f64().unwrap_or(f64::INFINITY) / limit
}

/// A program with where it comes from.
pub fn recipe(
    conditions: &Conditions,
    evaluations: u64,
    distinct: u64,
    champion: &Individual,
    speed: Speed,
) -> Recipe {
    let Conditions {
        settings,
        scene,
        isas,
        ..
    } = conditions;
    let regime = scene.regime;
    let accuracy = &champion.evaluation.details["accuracy"];
    let figure = |name: &str| accuracy[name].as_f64().unwrap_or(f64::MAX);
    let small = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    let number = conditions.rustc.split(' ').nth(1).unwrap_or("unknown");
    Recipe {
        name: Name::of(&match isas[..] {
            // What every x86-64 processor can run goes without saying, and so do all.
            [Isa::Sse2] => format!("{}-{regime}", scene.name),
            [isa] => format!("{}-{}-{regime}", scene.name, isa.module()),
            _ => format!("{}-{regime}", scene.name),
        }),
        scene: scene.clone(),
        isas: isas.to_vec(),
        // Figures of a quick look are none to publish.
        provenance: conditions.arena().is_full().then(|| Provenance {
            search: emit::Search {
                strategy: Name::of(settings.strategy.name()),
                population: small(settings.population),
                objective: (settings.objective != Objective::Speed)
                    .then(|| Name::of(settings.objective.name())),
                elite: small(settings.elite),
                generations: small(settings.generations),
                islands: (settings.islands > 1).then(|| small(settings.islands)),
                seed: settings.seed,
            },
            evaluations,
            distinct,
            ratio: speed.ratio,
            uncertainty: speed.uncertainty,
            worst_layout: speed.worst_layout,
            cpu: Name::of(&conditions.machine.cpu),
            rustc: Name::new(number).unwrap_or_else(|_| Name::of(number)),
            graph: conditions.graph.clone(),
            improved: None,
        }),
        error: Some(ErrorProfile {
            hits: accuracy["hits"].as_u64().unwrap_or(0),
            median: figure("median"),
            p99: figure("p99"),
            max: figure("max"),
        }),
        stability: None,
        program: champion.candidate.program.clone(),
    }
}

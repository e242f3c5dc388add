//! Who comes out of a search: the finalists, and the champion as a recipe.

use emit::{ErrorProfile, Name, Provenance, Recipe};
use evolve::{Individual, Outcome};

use super::conditions::Conditions;
use crate::promote::CHAMPION_P99_ERROR;
use crate::shootout::Standing;

/// How many of the fittest meet in the shoot-out. The best of the search was timed in a hurry,
/// and owes some of its figure to luck.
const FINALISTS: usize = 8;

/// Those who meet in the shoot-out.
pub struct Finalists<'a> {
    /// Best first.
    pub individuals: Vec<&'a Individual>,
    /// Whether their `t` is accurate enough for the library.
    pub accurate: bool,
}

impl<'a> Finalists<'a> {
    /// The fittest that are accurate enough for the library. In a small run there may be none;
    /// then the fittest of all, which can be looked at but not promoted.
    pub fn of<E>(outcome: &'a Outcome<E>) -> Finalists<'a> {
        let fittest = outcome.best(outcome.population.len());
        let is_accurate = |finalist: &&Individual| p99_error(finalist) <= CHAMPION_P99_ERROR;
        let mut individuals: Vec<&Individual> =
            fittest.iter().copied().filter(is_accurate).collect();
        let accurate = !individuals.is_empty();
        if !accurate {
            individuals = fittest;
        }
        individuals.truncate(FINALISTS);
        Finalists {
            individuals,
            accurate,
        }
    }

    /// The name of the finalist at a place, in the shoot-out.
    pub fn name(place: usize) -> String {
        format!("finalist {}", place + 1)
    }

    /// Names the best finalist of the shoot-out the champion.
    pub fn crown(&self, standings: &mut [Standing]) -> Option<(&'a Individual, f64)> {
        let places = self.individuals.iter().enumerate();
        let named = |standing: &Standing| {
            let mut places = places.clone();
            places.find(|(place, _)| Finalists::name(*place) == standing.kernel)
        };
        let best = standings
            .iter_mut()
            .find(|standing| named(standing).is_some())?;
        let (_, champion) = named(best)?;
        best.kernel = "champion".into();
        Some((champion, best.ratio))
    }
}

/// The p99 of the relative error of an individual's `t`.
fn p99_error(individual: &Individual) -> f64 {
    let p99 = &individual.evaluation.details["accuracy"]["p99"];
    p99.as_f64().unwrap_or(f64::INFINITY)
}

/// A program with where it comes from: `ratio` is the best figure that there is of it.
pub fn recipe(
    conditions: &Conditions,
    evaluations: u64,
    distinct: u64,
    champion: &Individual,
    ratio: f64,
) -> Recipe {
    let Conditions {
        settings,
        scene,
        isa,
        regime,
        ..
    } = conditions;
    let accuracy = &champion.evaluation.details["accuracy"];
    let figure = |name: &str| accuracy[name].as_f64().unwrap_or(f64::MAX);
    let small = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    let number = conditions.rustc.split(' ').nth(1).unwrap_or("unknown");
    Recipe {
        name: Name::of(&format!("{}-{regime}", scene.name)),
        scene: scene.clone(),
        regime: *regime,
        isas: vec![*isa],
        provenance: Provenance {
            search: emit::Search {
                strategy: conditions.strategy.clone(),
                population: small(settings.population),
                elite: small(settings.elite),
                generations: small(settings.generations),
                seed: settings.seed,
            },
            evaluations,
            distinct,
            ratio,
            cpu: Name::of(&conditions.machine.cpu),
            rustc: Name::new(number).unwrap_or_else(|_| Name::of(number)),
            graph: conditions.graph.clone(),
        },
        error: ErrorProfile {
            hits: accuracy["hits"].as_u64().unwrap_or(0),
            median: figure("median"),
            p99: figure("p99"),
            max: figure("max"),
        },
        program: champion.candidate.program.clone(),
    }
}

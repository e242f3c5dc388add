//! Who survives and who breeds.

use std::collections::HashSet;
use std::fmt;

use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use crate::individual::Individual;
use crate::operators::draw_parent;
use crate::pareto;

/// What a search is after.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// The fastest, as in the paper: the fittest survive, and everyone alive breeds in proportion to fitness.
    #[default]
    Speed,
    /// All that are not beaten in speed and in every cost at once, by NSGA-II: the first fronts survive,
    /// of the front that does not fit the loneliest; survivors breed by binary tournament.
    Pareto,
}

impl Objective {
    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Objective::Speed => "speed",
            Objective::Pareto => "pareto",
        }
    }

    /// Puts the best first. Of equals the one that came first is ahead, so that the older ones stay.
    pub(crate) fn rank(self, population: &mut Vec<Individual>) {
        match self {
            Objective::Speed => population.sort_by(|a, b| b.weight().total_cmp(&a.weight())),
            Objective::Pareto => rank_by_fronts(population),
        }
    }

    /// Draws a parent by its place in a ranked population, of which the first ones survive. None if nobody
    /// has any fitness.
    pub(crate) fn parent(
        self,
        population: &[Individual],
        survivors: usize,
        rng: &mut impl Rng,
    ) -> Option<usize> {
        let weights = population.iter().map(Individual::weight);
        match self {
            Objective::Speed => draw_parent(&weights.collect::<Vec<f64>>(), rng),
            Objective::Pareto => {
                let fit = weights
                    .take(survivors.max(1))
                    .filter(|&weight| weight > 0.0);
                let fit = fit.count();
                (fit > 0).then(|| {
                    let [a, b] = [(); 2].map(|()| rng.random_range(0..fit));
                    a.min(b)
                })
            }
        }
    }
}

impl fmt::Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Individuals in the order of [`pareto::ranked`]. Those who are the same kernel as one before them come after
/// everyone else, lest a front be full of one, and failures last.
fn rank_by_fronts(population: &mut Vec<Individual>) {
    let (fit, failed): (Vec<_>, Vec<_>) = std::mem::take(population)
        .into_iter()
        .partition(|one| one.evaluation.fitness.is_some());
    let (fit, twins) = without_twins(fit);
    let points: Vec<Vec<f64>> = fit.iter().map(point).collect();
    let mut fit: Vec<Option<Individual>> = fit.into_iter().map(Some).collect();
    let ranked = pareto::ranked(&points);
    population.extend(ranked.into_iter().filter_map(|place| fit[place].take()));
    population.extend(twins);
    population.extend(failed);
}

/// Individuals no two of which are the same kernel, and those that are one of the former's.
fn without_twins(individuals: Vec<Individual>) -> (Vec<Individual>, Vec<Individual>) {
    let mut kernels = HashSet::new();
    let is_first = |one: &Individual| kernels.insert(one.kernel().to_owned());
    individuals.into_iter().partition(is_first)
}

/// Puts those who are the same kernel as one before them behind everyone else, lest an elite be full of one.
pub(crate) fn put_twins_last(population: &mut Vec<Individual>) {
    let (first, twins) = without_twins(std::mem::take(population));
    population.extend(first);
    population.extend(twins);
}

/// Those who have fitness, the fittest first, no two the same kernel.
pub(crate) fn distinct(population: &[Individual]) -> Vec<&Individual> {
    let mut kernels = HashSet::new();
    let fit = population
        .iter()
        .filter(|one| one.evaluation.fitness.is_some());
    let mut distinct: Vec<&Individual> = fit.filter(|one| kernels.insert(one.kernel())).collect();
    distinct.sort_by(|a, b| b.weight().total_cmp(&a.weight()));
    distinct
}

/// Of those the ones that nobody dominates, the fittest first.
pub(crate) fn front(population: &[Individual]) -> Vec<&Individual> {
    fronts(population, 1)
}

/// Of those the first front, and the next ones until there are so many; the fittest first in each.
pub(crate) fn fronts(population: &[Individual], count: usize) -> Vec<&Individual> {
    let all = distinct(population);
    let points: Vec<Vec<f64>> = all.iter().map(|one| point(one)).collect();
    let mut members = Vec::new();
    for front in pareto::fronts(&points) {
        if members.len() >= count {
            break;
        }
        members.extend(front.into_iter().map(|place| all[place]));
    }
    members
}

/// The time of an individual that has fitness, in terms of the reference's, and its costs.
fn point(individual: &Individual) -> Vec<f64> {
    let time = individual.weight().recip();
    let costs = individual.evaluation.costs.iter().copied();
    [time].into_iter().chain(costs).collect()
}

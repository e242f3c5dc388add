//! The search for a front, with programs judged by two formulas that contradict each other.

mod mock;

use std::collections::BTreeSet;
use std::sync::LazyLock;

use evolve::pareto::dominates;
use evolve::{Individual, Objective, Outcome, Settings, search};
use mock::{Observed, Priced, Watch};
use program::{Graph, kensler_shirley};

static GRAPH: LazyLock<Graph> = LazyLock::new(kensler_shirley);

#[test]
fn of_those_who_die_nobody_is_better_in_everything_than_one_who_survives() {
    let (generations, _) = run(small());
    for generation in &generations {
        let (survivors, dying) = generation.population.split_at(small().elite);
        let kept: BTreeSet<&str> = survivors.iter().map(source).collect();
        for one in dying.iter().filter(|one| !kept.contains(source(one))) {
            let beaten = survivors
                .iter()
                .find(|survivor| dominates(&point(one), &point(survivor)));
            assert_eq!(beaten, None, "by {one:?}");
        }
    }
}

#[test]
fn nobody_survives_as_often_as_he_is_there_while_others_could() {
    let (generations, _) = run(small());
    for generation in &generations {
        let sources: BTreeSet<&str> = generation.population.iter().map(source).collect();
        let survivors = &generation.population[..small().elite];
        let kept: BTreeSet<&str> = survivors.iter().map(source).collect();
        assert_eq!(kept.len(), sources.len().min(survivors.len()));
    }
}

#[test]
fn parents_are_survivors() {
    let (generations, _) = run(small());
    for pair in generations.windows(2) {
        let survivors = &pair[0].population[..small().elite];
        let survivors: BTreeSet<u64> = survivors.iter().map(|one| one.candidate.id).collect();
        for offspring in &pair[1].new {
            let parents = offspring.candidate.origin.parents();
            assert_eq!(parents.len(), 2);
            assert!(parents.iter().all(|parent| survivors.contains(parent)));
        }
    }
}

#[test]
fn the_front_is_what_nobody_beats_from_the_fastest_to_the_cheapest() {
    let (_, outcome) = run(small());
    let front = outcome.front();
    let all: Vec<&Individual> = outcome.best(usize::MAX);
    for one in &all {
        let beaten = all
            .iter()
            .any(|other| dominates(&point(other), &point(one)));
        assert_eq!(!beaten, front.contains(one));
    }
    assert!(front.is_sorted_by(|a, b| a.weight() >= b.weight()));
    assert!(front.is_sorted_by(|a, b| a.evaluation.costs[0] >= b.evaluation.costs[0]));
    assert!(front.len() > 2, "{front:?}");

    let more = outcome.fronts(front.len() + 1);
    assert!(more.starts_with(&front) && more.len() > front.len());
    assert_eq!(outcome.fronts(usize::MAX).len(), all.len());
}

#[test]
fn the_front_covers_more_than_that_of_as_many_random_genomes() {
    for seed in 1..=3 {
        let bred = Settings {
            seed,
            ..Settings::usual(Objective::Pareto)
        };
        let drawn = Settings {
            population: bred.evaluations() as usize,
            elite: 0,
            generations: 0,
            ..bred
        };
        let [bred, drawn] = [bred, drawn].map(|settings| run(settings).1);
        assert_eq!(bred.evaluations, drawn.evaluations);
        let fronts = [bred.front(), drawn.front()];
        let worst = [0, 1].map(|objective| {
            let all = fronts.iter().flatten();
            all.map(|one| point(one)[objective]).fold(0.0, f64::max)
        });
        let [bred, drawn] = fronts.map(|front| covered(&front, worst));
        assert!(bred > 1.05 * drawn, "seed {seed}: {bred} and {drawn}");
    }
}

/// The area between a front, the fastest first, and a point that is no better than anybody.
fn covered(front: &[&Individual], worst: [f64; 2]) -> f64 {
    let mut area = 0.0;
    let mut cost_before = worst[1];
    for one in front {
        let [time, cost] = point(one)[..] else {
            panic!("two objectives")
        };
        area += (worst[0] - time) * (cost_before - cost);
        cost_before = cost;
    }
    area
}

fn point(individual: &Individual) -> Vec<f64> {
    vec![individual.weight().recip(), individual.evaluation.costs[0]]
}

fn source(individual: &Individual) -> &str {
    &individual.candidate.source
}

fn small() -> Settings {
    Settings {
        population: 20,
        elite: 8,
        generations: 12,
        objective: Objective::Pareto,
        seed: 5,
        ..Settings::default()
    }
}

fn run(settings: Settings) -> (Vec<Observed>, Outcome<std::convert::Infallible>) {
    let mut watch = Watch::default();
    let outcome = search(&GRAPH, settings, &mut Priced, &mut watch);
    (watch.seen, outcome)
}

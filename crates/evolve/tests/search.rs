//! The search with programs judged by a formula: what it keeps, whom it breeds, when it stops.

mod mock;

use std::collections::BTreeSet;
use std::sync::LazyLock;

use evolve::{Evaluate, Individual, Origin, Outcome, Settings, Stop, search, search_from};
use mock::{Breaks, FORMULA, Judge, Lucky, Observed, Watch, hash, source, speed};
use program::{Graph, Program, Rules, Watertight, kensler_shirley};

static GRAPH: LazyLock<Graph> = LazyLock::new(kensler_shirley);

#[test]
fn the_same_seed_makes_the_same_search_and_another_seed_another() {
    let [(first, outcome), (again, same_outcome), (other, _)] =
        [7, 7, 8].map(|seed| run(Settings { seed, ..small() }, FORMULA));
    assert_eq!(first, again);
    assert_eq!(outcome.population, same_outcome.population);
    assert_ne!(
        first[0].new[0].candidate.genome,
        other[0].new[0].candidate.genome
    );
}

#[test]
fn every_individual_has_the_program_of_its_genome() {
    let (generations, _) = run(small(), FORMULA);
    for individual in generations.iter().flat_map(|generation| &generation.new) {
        let candidate = &individual.candidate;
        assert_eq!(candidate.program, GRAPH.program(&candidate.genome).unwrap());
        assert_eq!(candidate.source, source(&candidate.program));
    }
}

#[test]
fn the_elite_survives_unchanged_and_the_new_replace_the_rest() {
    let (generations, outcome) = run(small(), FORMULA);
    for pair in generations.windows(2) {
        let [before, after] = pair else {
            unreachable!()
        };
        let elite = &before.population[..small().elite];
        assert!(elite.iter().all(|one| after.population.contains(one)));
        assert!(after.new.iter().all(|one| after.population.contains(one)));
        assert_eq!(elite.len() + after.new.len(), after.population.len());
    }
    assert_eq!(outcome.population, generations.last().unwrap().population);
}

#[test]
fn the_population_is_sorted_best_first_and_its_best_never_falls() {
    let (generations, _) = run(small(), FORMULA);
    for generation in &generations {
        assert!(
            generation
                .population
                .is_sorted_by(|a, b| a.weight() >= b.weight())
        );
    }
    assert!(generations.is_sorted_by(|a, b| best(&a.population) <= best(&b.population)));
}

#[test]
fn every_generation_evaluates_population_less_elite_and_ids_count_up() {
    let (generations, outcome) = run(small(), FORMULA);
    let Settings {
        population, elite, ..
    } = small();
    for (number, generation) in generations.iter().enumerate() {
        let expected = if number == 0 {
            population
        } else {
            population - elite
        };
        assert_eq!(
            (generation.number, generation.new.len()),
            (number, expected)
        );
    }
    assert_eq!(generations.len(), 1 + small().generations);
    let ids = generations
        .iter()
        .flat_map(|g| g.new.iter().map(|one| one.candidate.id));
    assert!(ids.eq(0..small().evaluations()));
    assert_eq!(outcome.evaluations, small().evaluations());
    assert!(matches!(outcome.stop, Stop::Done));
}

#[test]
fn the_first_generation_is_random_and_later_parents_were_alive_in_the_one_before() {
    let (generations, _) = run(small(), FORMULA);
    assert!(
        generations[0]
            .new
            .iter()
            .all(|one| one.candidate.origin == Origin::Random)
    );
    for pair in generations.windows(2) {
        let alive: BTreeSet<u64> = pair[0]
            .population
            .iter()
            .map(|one| one.candidate.id)
            .collect();
        for twins in pair[1].new.chunks(2) {
            let [a, b] = parents(&twins[0]);
            assert_eq!(parents(&twins[1]), [b, a]);
            assert!(alive.contains(&a) && alive.contains(&b));
        }
    }
}

#[test]
fn the_first_generation_has_as_many_of_every_nursery_and_the_rest_of_the_graph() {
    let rules = Rules {
        watertight: Watertight::Edges,
        ..Rules::ALL
    };
    let nursery = GRAPH.restricted(&rules).unwrap();
    let mut watch = Watch::default();
    let nurseries = std::slice::from_ref(&nursery);
    search_from(&GRAPH, nurseries, small(), &mut { FORMULA }, &mut watch);
    for (place, one) in watch.seen[0].new.iter().enumerate() {
        let is_of_nursery = one.candidate.program.breaks(&rules).is_none();
        assert_eq!(is_of_nursery, place % 2 == 0, "{place}");
    }
}

#[test]
fn whoever_entered_the_elite_is_judged_again_with_the_next_generation() {
    let (generations, outcome) = run(small(), Lucky::default());
    let honest = |one: &&Individual| one.evaluation.fitness == Some(speed(&one.candidate.program));
    let first_judgements = generations.iter().flat_map(|generation| &generation.new);
    assert!(first_judgements.filter(|one| !honest(one)).count() > 10);
    for pair in generations.windows(2) {
        let new: Vec<u64> = pair[1].new.iter().map(|one| one.candidate.id).collect();
        let elite = pair[1].population[..small().elite].iter();
        for old in elite.filter(|one| !new.contains(&one.candidate.id)) {
            let before = &pair[0].population[..small().elite];
            let was_elite = before.iter().any(|one| one.candidate == old.candidate);
            assert!(!was_elite || honest(&old));
        }
    }
    assert!(
        outcome.population[..small().elite]
            .iter()
            .all(|one| honest(&one))
    );
}

#[test]
fn what_failed_is_never_a_parent() {
    let mostly_failing =
        |program: &Program| hash(program).is_multiple_of(3).then(|| speed(program));
    let (generations, _) = run(small(), Judge(mostly_failing));
    let mut failed_alive = 0;
    for pair in generations.windows(2) {
        let failed = |one: &&Individual| one.evaluation.fitness.is_none();
        let failed: Vec<u64> = pair[0]
            .population
            .iter()
            .filter(failed)
            .map(|one| one.candidate.id)
            .collect();
        failed_alive += failed.len();
        let parents = pair[1].new.iter().flat_map(parents);
        assert!(parents.into_iter().all(|parent| !failed.contains(&parent)));
    }
    assert!(failed_alive > 50, "{failed_alive}");
}

#[test]
fn if_everybody_fails_the_search_stops_after_the_random_generation() {
    let (generations, outcome) = run(small(), Judge(|_| None));
    assert!(matches!(outcome.stop, Stop::NobodyFit));
    assert_eq!(generations.len(), 1);
    assert_eq!(outcome.evaluations, small().population as u64);
    assert_eq!(outcome.population, generations[0].population);
    assert!(outcome.best(3).is_empty());
}

#[test]
fn if_judging_cannot_go_on_the_population_so_far_is_kept() {
    let (generations, outcome) = run(small(), Breaks { after: 3 });
    assert!(matches!(
        outcome.stop,
        Stop::Evaluation("the worker is gone")
    ));
    assert_eq!(generations.len(), 3);
    assert_eq!(outcome.population, generations[2].population);
    let evaluated: usize = generations.iter().map(|g| g.new.len()).sum();
    assert_eq!(outcome.evaluations, evaluated as u64);

    let (generations, outcome) = run(small(), Breaks { after: 0 });
    assert!(matches!(outcome.stop, Stop::Evaluation(_)));
    assert!(generations.is_empty() && outcome.population.is_empty());
    assert_eq!(outcome.evaluations, 0);
}

#[test]
fn the_observer_may_end_the_search_after_any_generation() {
    let mut watch = Watch {
        end_after: Some(3),
        ..Watch::default()
    };
    let outcome = search(&GRAPH, small(), &mut { FORMULA }, &mut watch);
    assert!(matches!(outcome.stop, Stop::Ended));
    assert_eq!(watch.seen.len(), 3);
    assert_eq!(outcome.population, watch.seen[2].population);
}

#[test]
fn the_search_stops_at_its_limit_even_within_a_generation() {
    let all = small().evaluations();
    for limit in [1, 7, 20, 21, 50, all - 1, all, all + 1] {
        let settings = Settings {
            limit: Some(limit),
            ..small()
        };
        let (generations, outcome) = run(settings, FORMULA);
        assert_eq!(outcome.evaluations, limit.min(all));
        assert_eq!(matches!(outcome.stop, Stop::Enough), limit <= all);
        let (unlimited, _) = run(small(), FORMULA);
        let new = |generations: &[Observed]| -> Vec<Individual> {
            generations.iter().flat_map(|one| one.new.clone()).collect()
        };
        assert!(new(&unlimited).starts_with(&new(&generations)));
    }
}

#[test]
fn the_papers_search_finds_better_than_as_many_random_genomes() {
    let mut gains = Vec::new();
    for seed in 1..=3 {
        let bred = Settings {
            seed,
            ..Settings::default()
        };
        let drawn = Settings {
            population: bred.evaluations() as usize,
            elite: 0,
            generations: 0,
            ..bred
        };
        let [bred, drawn] = [bred, drawn].map(|settings| run(settings, FORMULA).1);
        assert_eq!(bred.evaluations, drawn.evaluations);
        let [bred, drawn] = [bred, drawn].map(|outcome| best(&outcome.population));
        gains.push(bred / drawn);
    }
    let mean = gains.iter().sum::<f64>() / gains.len() as f64;
    assert!(
        gains.iter().all(|&gain| gain >= 1.0) && mean > 1.05,
        "{gains:?}"
    );
}

#[test]
fn the_best_are_distinct_sources_best_first() {
    let coarse = |program: &Program| Some(1.0 / program.statements().len() as f64);
    let (_, outcome) = run(small(), Judge(coarse));
    let sources = |individuals: &[&Individual]| -> BTreeSet<String> {
        individuals
            .iter()
            .map(|one| one.candidate.source.clone())
            .collect()
    };
    let all: Vec<&Individual> = outcome.population.iter().collect();
    let ranked = outcome.best(usize::MAX);
    assert_eq!(sources(&ranked), sources(&all));
    assert_eq!(sources(&ranked).len(), ranked.len());
    assert!(ranked.is_sorted_by(|a, b| a.weight() >= b.weight()));
    assert_eq!(ranked[0], &outcome.population[0]);
    assert_eq!(outcome.best(3), ranked[..3]);
    assert!(outcome.best(0).is_empty());
}

#[test]
fn small_populations_breed() {
    for (population, elite) in [(2, 0), (3, 1), (4, 2)] {
        let settings = Settings {
            population,
            elite,
            ..small()
        };
        let (generations, outcome) = run(settings, FORMULA);
        assert!(matches!(outcome.stop, Stop::Done));
        assert_eq!(generations.len(), 1 + settings.generations);
        assert_eq!(outcome.population.len(), population);
    }
}

#[test]
#[should_panic(expected = "valid settings")]
fn no_search_begins_with_settings_that_contradict_each_other() {
    run(
        Settings {
            elite: 10,
            population: 10,
            ..small()
        },
        FORMULA,
    );
}

fn small() -> Settings {
    Settings {
        population: 20,
        elite: 8,
        generations: 12,
        seed: 5,
        ..Settings::default()
    }
}

fn best(population: &[Individual]) -> f64 {
    population[0].weight()
}

fn parents(individual: &Individual) -> [u64; 2] {
    match individual.candidate.origin {
        Origin::Crossover { parents } => parents,
        origin => panic!("{} is of {origin:?}", individual.candidate.id),
    }
}

fn run<E: Evaluate>(settings: Settings, mut evaluate: E) -> (Vec<Observed>, Outcome<E::Error>) {
    let mut watch = Watch::default();
    let outcome = search(&GRAPH, settings, &mut evaluate, &mut watch);
    (watch.seen, outcome)
}

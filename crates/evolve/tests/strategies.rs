//! What every strategy keeps to, and that each is worth more than chance.

mod mock;

use std::collections::{HashMap, HashSet};
use std::sync::LazyLock;

use evolve::{
    Batch, Candidate, EvaluateAtOnce, Evaluation, Foresee, Individual, Judged, Origin, Outcome,
    Settings, Stop, Strategy, search,
};
use mock::{FORMULA, Judge, Observed, Watch, speed};
use program::{Graph, Program, kensler_shirley};

static GRAPH: LazyLock<Graph> = LazyLock::new(kensler_shirley);

/// Those that try nothing twice.
const NEW: [Strategy; 4] = [
    Strategy::Random,
    Strategy::Hill,
    Strategy::Memetic,
    Strategy::Guided,
];

fn small(strategy: Strategy) -> Settings {
    Settings {
        strategy,
        population: 20,
        elite: 8,
        generations: 12,
        seed: 5,
        ..Settings::default()
    }
}

fn run(settings: Settings, mut judge: Judge) -> (Vec<Observed>, Outcome<std::convert::Infallible>) {
    let mut watch = Watch::default();
    let outcome = search(&GRAPH, settings, &mut judge, &mut watch);
    (watch.seen, outcome)
}

fn all(generations: &[Observed]) -> Vec<&Individual> {
    generations.iter().flat_map(|one| &one.new).collect()
}

#[test]
fn every_strategy_has_as_many_evaluations_and_the_same_seed_makes_the_same_search() {
    for strategy in Strategy::ALL {
        let [(first, outcome), (again, _)] = [(); 2].map(|()| run(small(strategy), FORMULA));
        assert_eq!(first, again, "{strategy}");
        assert!(matches!(outcome.stop, Stop::Done), "{strategy}");
        assert_eq!(outcome.evaluations, small(strategy).evaluations());
        assert_eq!(all(&first).len() as u64, outcome.evaluations);
    }
}

#[test]
fn a_name_is_its_strategys_and_a_wrong_one_names_them_all() {
    for strategy in Strategy::ALL {
        assert_eq!(strategy.name().parse::<Strategy>().unwrap(), strategy);
    }
    let wrong = "annealing".parse::<Strategy>().unwrap_err().to_string();
    for strategy in Strategy::ALL {
        assert!(wrong.contains(strategy.name()), "{wrong}");
    }
}

#[test]
fn no_source_is_tried_twice_but_by_the_paper() {
    for strategy in NEW {
        let (generations, _) = run(small(strategy), FORMULA);
        let mut sources = HashSet::new();
        let tried = all(&generations);
        assert!(
            tried
                .iter()
                .all(|one| sources.insert(&one.candidate.source)),
            "{strategy}"
        );
    }
    let (generations, outcome) = run(
        Settings {
            generations: 100,
            ..small(Strategy::Paper)
        },
        FORMULA,
    );
    let tried = all(&generations);
    let sources: HashSet<&String> = tried.iter().map(|one| &one.candidate.source).collect();
    assert!(sources.len() < tried.len());
    assert_eq!(outcome.redrawn, 0);
}

#[test]
fn whoever_has_parents_has_those_that_were_judged_before_and_fit() {
    let mostly_failing = |program: &Program| {
        mock::hash(program)
            .is_multiple_of(3)
            .then(|| speed(program))
    };
    for strategy in NEW {
        let (generations, _) = run(small(strategy), Judge(mostly_failing));
        let mut fit: HashSet<u64> = HashSet::new();
        for generation in &generations {
            for one in &generation.new {
                let parents = one.candidate.origin.parents();
                assert!(
                    parents.iter().all(|parent| fit.contains(parent)),
                    "{strategy}"
                );
            }
            let new = generation.new.iter();
            let new = new.filter(|one| one.evaluation.fitness.is_some());
            fit.extend(new.map(|one| one.candidate.id));
        }
    }
}

#[test]
fn a_hill_is_climbed_from_its_best_in_steps_that_are_flips_and_slides() {
    let (generations, _) = run(small(Strategy::Hill), FORMULA);
    for pair in generations.windows(2) {
        let best = pair[0].population[0].candidate.id;
        for one in &pair[1].new {
            match one.candidate.origin {
                Origin::Flip { parent } | Origin::Slide { parent } => assert_eq!(parent, best),
                origin => panic!("{origin:?}"),
            }
        }
    }
}

#[test]
fn a_memetic_search_uses_every_operator_and_ends_near_the_few_best() {
    let (generations, _) = run(small(Strategy::Memetic), FORMULA);
    let mut operators: HashMap<&str, usize> = HashMap::new();
    for one in all(&generations) {
        *operators.entry(one.candidate.origin.name()).or_default() += 1;
    }
    for operator in ["random", "crossover", "graft", "flip", "slide"] {
        assert!(operators[operator] > 5, "{operators:?}");
    }
    let last = generations.last().unwrap();
    let parents = last
        .new
        .iter()
        .flat_map(|one| one.candidate.origin.parents());
    assert!(parents.collect::<HashSet<&u64>>().len() <= 3);
}

#[test]
fn a_guided_search_that_finds_nothing_better_begins_anew_with_parents_of_its_own() {
    let settings = Settings {
        strategy: Strategy::Guided,
        limit: Some(900),
        ..Settings::default()
    };
    let (generations, _) = run(settings, Judge(|_| Some(1.0)));
    let random = |one: &&Individual| one.candidate.origin == Origin::Random;
    let begin = generations[1..]
        .iter()
        .find_map(|generation| generation.new.iter().find(random));
    let begin = begin.expect("it begins anew").candidate.id;
    // At last neighbours of the best of all are tried.
    let bred = all(&generations).into_iter();
    let bred = bred.filter(|one| one.candidate.id > begin && one.candidate.id < 750);
    let mut children = 0;
    for parent in bred.flat_map(|one| one.candidate.origin.parents()) {
        assert!(*parent >= begin);
        children += 1;
    }
    assert!(children > 100, "{children}");
}

#[test]
fn what_fails_is_nobodys_parent_and_where_all_fail_there_is_no_second_generation() {
    for strategy in [Strategy::Hill, Strategy::Memetic, Strategy::Guided] {
        let (generations, outcome) = run(small(strategy), Judge(|_| None));
        assert!(matches!(outcome.stop, Stop::NobodyFit), "{strategy}");
        assert_eq!(generations.len(), 1);
    }
}

#[test]
fn where_chance_is_the_judge_nothing_breaks() {
    let coarse = |program: &Program| (program.statements().len().is_multiple_of(2)).then_some(1.0);
    for strategy in Strategy::ALL {
        let (_, outcome) = run(small(strategy), Judge(coarse));
        assert_eq!(
            outcome.evaluations,
            small(strategy).evaluations(),
            "{strategy}"
        );
    }
}

/// The best speed after so many evaluations, the mean of three seeds, as a multiple of what chance finds.
#[test]
fn every_strategy_beats_chance_and_moves_that_change_programs_beat_the_papers() {
    let best = |strategy| {
        let seeds = 1..=3_u64;
        let best = seeds.map(|seed| {
            let settings = Settings {
                seed,
                strategy,
                limit: Some(600),
                ..Settings::default()
            };
            let (_, outcome) = run(settings, FORMULA);
            speed(&outcome.population[0].candidate.program)
        });
        best.sum::<f64>() / 3.0
    };
    let chance = best(Strategy::Random);
    let gains: Vec<(Strategy, f64)> = Strategy::ALL
        .into_iter()
        .map(|strategy| (strategy, best(strategy) / chance))
        .collect();
    println!("{gains:?}");
    for &(strategy, gain) in &gains {
        assert!(strategy == Strategy::Random || gain > 1.02, "{gains:?}");
        let moves = matches!(
            strategy,
            Strategy::Hill | Strategy::Memetic | Strategy::Guided
        );
        assert!(!moves || gain > gains[0].1, "{gains:?}");
    }
}

/// Knows every program by its length alone, and half of the lengths by the same code.
struct Coarse;

impl Foresee for Coarse {
    fn source(&mut self, program: &Program) -> String {
        mock::source(program)
    }
}

impl EvaluateAtOnce for Coarse {
    type Error = std::convert::Infallible;

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, Self::Error> {
        let judge = |candidate: &Candidate| {
            let length = candidate.program.statements().len() / 2;
            Evaluation {
                code: Some(format!("{length}")),
                ..mock::evaluation(Some(1.0 / length as f64))
            }
        };
        let again = batch.again.iter().map(|one| judge(&one.candidate));
        Ok(Judged {
            new: batch.new.iter().map(judge).collect(),
            again: again.collect(),
        })
    }
}

/// The same with figures that are never the same twice: of a code that is known a newcomer gets what is known.
#[derive(Default)]
struct Drifting {
    known: HashMap<String, Evaluation>,
    drift: f64,
}

impl Foresee for Drifting {
    fn source(&mut self, program: &Program) -> String {
        mock::source(program)
    }
}

impl EvaluateAtOnce for Drifting {
    type Error = std::convert::Infallible;

    fn evaluate(&mut self, batch: &Batch<'_>) -> Result<Judged, Self::Error> {
        let mut judged = Coarse.evaluate(batch)?;
        for evaluation in judged.new.iter_mut().chain(&mut judged.again) {
            self.drift = (self.drift + 0.618_033_988_75).fract();
            let noise = 1.0 + 0.05 * self.drift;
            evaluation.fitness = evaluation.fitness.map(|fitness| fitness * noise);
        }
        let code = |evaluation: &Evaluation| evaluation.code.clone().expect("it has one");
        for evaluation in &mut judged.new {
            let known = self.known.entry(code(evaluation));
            *evaluation = known.or_insert_with(|| evaluation.clone()).clone();
        }
        for evaluation in &judged.again {
            self.known.insert(code(evaluation), evaluation.clone());
        }
        Ok(judged)
    }
}

#[test]
fn what_is_the_same_code_has_the_same_figure_also_when_one_is_judged_again() {
    for strategy in Strategy::ALL {
        for islands in [1, 2] {
            let settings = Settings {
                islands,
                ..small(strategy)
            };
            let mut watch = Watch::default();
            search(&GRAPH, settings, &mut Drifting::default(), &mut watch);
            let mut twins = 0;
            for generation in &watch.seen {
                let mut figures: HashMap<&str, Option<f64>> = HashMap::new();
                for one in &generation.population {
                    let fitness = one.evaluation.fitness;
                    let known = figures.insert(one.kernel(), fitness);
                    twins += usize::from(known.is_some());
                    assert_eq!(known.unwrap_or(fitness), fitness, "{strategy} on {islands}");
                }
            }
            assert!(twins > 0, "{strategy} has none");
        }
    }
}

#[test]
fn an_elite_has_every_kernel_once_but_the_papers_does_not_ask() {
    for strategy in Strategy::ALL {
        let mut watch = Watch::default();
        let outcome = search(&GRAPH, small(strategy), &mut Coarse, &mut watch);
        let elite = &outcome.population[..small(strategy).elite];
        let kernels: HashSet<&str> = elite.iter().map(Individual::kernel).collect();
        let all: HashSet<&str> = outcome.population.iter().map(Individual::kernel).collect();
        match strategy {
            Strategy::Paper => assert!(kernels.len() < elite.len()),
            _ => assert_eq!(kernels.len(), elite.len().min(all.len()), "{strategy}"),
        }
        let best = outcome.best(usize::MAX);
        assert_eq!(best.len(), all.len(), "{strategy}");
    }
}

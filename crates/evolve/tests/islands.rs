//! Several populations that take turns: while one's generation is judged, the next one's is made ready.

mod mock;

use std::collections::{HashMap, HashSet};
use std::convert::Infallible;
use std::sync::LazyLock;

use evolve::{
    Batch, Evaluate, EvaluateAtOnce, Foresee, Individual, Judged, Outcome, Settings, Stop,
    Strategy, search,
};
use mock::{Breaks, FORMULA, Observed, Watch};
use program::{Graph, Program, kensler_shirley};

static GRAPH: LazyLock<Graph> = LazyLock::new(kensler_shirley);

fn small(strategy: Strategy, islands: usize) -> Settings {
    Settings {
        strategy,
        islands,
        population: 20,
        elite: 8,
        generations: 20,
        seed: 5,
        ..Settings::default()
    }
}

fn run<E: Evaluate>(settings: Settings, mut evaluate: E) -> (Vec<Observed>, Outcome<E::Error>) {
    let mut watch = Watch::default();
    let outcome = search(&GRAPH, settings, &mut evaluate, &mut watch);
    (watch.seen, outcome)
}

/// What is done with the batch of which generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    Prepare(usize),
    Begin(usize),
    Finish(usize),
}

/// Judges by the formula, and keeps what it was asked to do.
#[derive(Default)]
struct Steps(Vec<Step>);

impl Foresee for Steps {
    fn source(&mut self, program: &Program) -> String {
        mock::source(program)
    }
}

impl Evaluate for Steps {
    type Error = Infallible;
    type Ready = (usize, Judged);
    type Begun = (usize, Judged);

    fn prepare(&mut self, batch: &Batch<'_>) -> Result<(usize, Judged), Infallible> {
        self.0.push(Step::Prepare(batch.generation));
        Ok((batch.generation, { FORMULA }.evaluate(batch)?))
    }

    fn begin(&mut self, ready: (usize, Judged)) -> Result<(usize, Judged), Infallible> {
        self.0.push(Step::Begin(ready.0));
        Ok(ready)
    }

    fn finish(&mut self, begun: (usize, Judged)) -> Result<Judged, Infallible> {
        self.0.push(Step::Finish(begun.0));
        Ok(begun.1)
    }
}

/// The steps of so many generations.
fn steps(islands: usize) -> Vec<Step> {
    let mut steps = Steps::default();
    let settings = small(Strategy::Paper, islands);
    search(&GRAPH, settings, &mut steps, &mut Watch::default());
    steps.0
}

#[test]
fn a_single_population_waits_for_each_generation() {
    for (number, steps) in steps(1).chunks(3).enumerate() {
        assert_eq!(
            steps,
            [
                Step::Prepare(number),
                Step::Begin(number),
                Step::Finish(number)
            ]
        );
    }
}

#[test]
fn of_several_each_is_made_ready_while_the_one_before_is_judged() {
    for islands in [2, 3] {
        let steps = steps(islands);
        assert_eq!(steps[..2], [Step::Prepare(0), Step::Begin(0)]);
        // Those who are due at the end are judged island by island.
        let turns = &steps[2..steps.len() - 3 * islands - 1];
        for (number, steps) in turns.chunks(3).enumerate() {
            let next = number + 1;
            assert_eq!(
                steps,
                [Step::Prepare(next), Step::Finish(number), Step::Begin(next)],
                "{islands} islands"
            );
        }
    }
}

#[test]
fn islands_share_the_evaluations_and_the_same_seed_makes_the_same_search() {
    for strategy in Strategy::ALL {
        for islands in [2, 3] {
            let settings = small(strategy, islands);
            let [(first, outcome), (again, _)] = [(); 2].map(|()| run(settings, FORMULA));
            assert_eq!(first, again, "{strategy}");
            assert!(matches!(outcome.stop, Stop::Done), "{strategy}");
            assert_eq!(outcome.evaluations, settings.evaluations());
            let new = first.iter().flat_map(|generation| &generation.new);
            let ids = new.map(|one| one.candidate.id);
            assert!(ids.eq(0..settings.evaluations()), "{strategy}");
            let numbers = first.iter().map(|generation| generation.number);
            assert!(numbers.eq(0..first.len()));
        }
    }
}

#[test]
fn parents_have_been_judged_and_but_for_the_last_of_the_search_are_of_the_same_island() {
    for strategy in Strategy::ALL {
        for islands in [2, 3] {
            let (generations, _) = run(small(strategy, islands), FORMULA);
            let born: HashMap<u64, usize> = all(&generations)
                .iter()
                .map(|one| (one.candidate.id, one.candidate.generation))
                .collect();
            let early = generations.len() / 2;
            for one in all(&generations) {
                let generation = one.candidate.generation;
                for parent in one.candidate.origin.parents() {
                    let before = generation - born[parent];
                    assert!(before >= 2, "{strategy}: in flight");
                    if generation < early {
                        assert_eq!(before % islands, 0, "{strategy}: of another island");
                    }
                }
            }
        }
    }
}

#[test]
fn no_island_but_the_papers_tries_what_another_has_tried() {
    for strategy in Strategy::ALL {
        let (generations, outcome) = run(small(strategy, 3), FORMULA);
        let sources = all(&generations)
            .iter()
            .map(|one| &one.candidate.source)
            .collect::<HashSet<_>>();
        match strategy {
            Strategy::Paper => assert_eq!(outcome.redrawn, 0),
            _ => assert_eq!(sources.len() as u64, outcome.evaluations, "{strategy}"),
        }
    }
}

#[test]
fn everyone_alive_on_any_island_is_observed_best_first_and_kept() {
    let settings = small(Strategy::Random, 3);
    let (generations, outcome) = run(settings, FORMULA);
    let last = generations.last().unwrap();
    assert_eq!(outcome.population, last.population);
    assert!(
        outcome
            .population
            .is_sorted_by(|a, b| a.weight() >= b.weight())
    );
    let islands: HashSet<usize> = outcome
        .population
        .iter()
        .map(|one| one.candidate.generation % 3)
        .collect();
    assert_eq!(islands.len(), 3);
    let best = all(&generations)
        .iter()
        .map(|one| one.weight())
        .fold(0.0, f64::max);
    assert_eq!(outcome.population[0].weight(), best);
}

#[test]
fn what_was_made_and_never_judged_does_not_count() {
    let settings = small(Strategy::Memetic, 2);
    let mut watch = Watch {
        end_after: Some(3),
        ..Watch::default()
    };
    let outcome = search(&GRAPH, settings, &mut { FORMULA }, &mut watch);
    assert!(matches!(outcome.stop, Stop::Ended));
    assert_eq!(outcome.evaluations, all(&watch.seen).len() as u64);

    // The fourth batch cannot be made ready, while the third is being judged.
    let (generations, outcome) = run(settings, Breaks { after: 3 });
    assert!(matches!(
        outcome.stop,
        Stop::Evaluation("the worker is gone")
    ));
    assert_eq!(generations.len(), 3);
    assert_eq!(outcome.evaluations, all(&generations).len() as u64);
    assert_eq!(outcome.population, generations[2].population);
}

#[test]
fn two_islands_with_a_limit_end_at_it() {
    let settings = Settings {
        limit: Some(33),
        ..small(Strategy::Guided, 2)
    };
    let (_, outcome) = run(settings, FORMULA);
    assert!(matches!(outcome.stop, Stop::Enough));
    assert_eq!(outcome.evaluations, 33);
}

fn all(generations: &[Observed]) -> Vec<&Individual> {
    generations.iter().flat_map(|one| &one.new).collect()
}

//! The genetic algorithm of the paper's section 5, made exact.
//!
//! The first generation is random. In every later one the elite survives unchanged and the rest
//! is replaced by pairs of offspring: both parents are drawn from the whole population with
//! probability proportional to fitness, a segment between two cut points is exchanged by order,
//! and in each of the offspring a random pair of values is swapped, twice. Another [`Objective`] has
//! others survive and breed.
//!
//! [`Objective`]: crate::Objective
//!
//! Fitness is a measurement, and who is let into the elite on a lucky one would stay there. So
//! whoever has entered it is judged once more together with the next generation, and the few best
//! in every generation.

use std::cmp::Reverse;
use std::collections::HashMap;
use std::ops::ControlFlow;

use program::{Genome, Graph, ProgramError};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::evaluate::{Batch, Evaluate};
use crate::individual::{Candidate, Individual, Origin};
use crate::operators::{crossover, mutate, random_cut};
use crate::selection::{distinct, front, fronts};
use crate::settings::Settings;

/// Told of every generation.
pub trait Observe {
    /// A generation has been evaluated. Says whether to go on.
    fn generation(&mut self, generation: &Generation<'_>) -> ControlFlow<()>;
}

/// One generation, evaluated.
pub struct Generation<'a> {
    /// Its number; 0 is the random one.
    pub number: usize,
    /// Those evaluated in it.
    pub new: &'a [Individual],
    /// Everyone alive, best first.
    pub population: &'a [Individual],
}

impl Generation<'_> {
    /// The kernels alive that no other one beats in speed and in every cost at once, the fittest first.
    pub fn front(&self) -> Vec<&Individual> {
        front(self.population)
    }
}

/// How many of the best are judged again in every generation.
const FRONT: usize = 2;

/// So often, and nobody is judged any more.
const ENOUGH: u32 = 6;

/// Why a search stopped.
#[derive(Debug)]
pub enum Stop<E> {
    /// All generations are through.
    Done,
    /// Nobody has any fitness, so nobody can be a parent.
    NobodyFit,
    /// The graph lets a genome pick a program that is none.
    Graph(ProgramError),
    /// Judging could not go on.
    Evaluation(E),
    /// As many have been evaluated as were to be.
    Enough,
    /// The observer did not want to go on.
    Ended,
}

/// How a search ended.
#[derive(Debug)]
pub struct Outcome<E> {
    /// Everyone alive, best first. Empty if the first generation was never finished.
    pub population: Vec<Individual>,
    /// How many individuals were evaluated.
    pub evaluations: u64,
    /// Why it stopped.
    pub stop: Stop<E>,
}

impl<E> Outcome<E> {
    /// The fittest kernels, the fittest first, no two of the same source.
    pub fn best(&self, count: usize) -> Vec<&Individual> {
        let mut best = distinct(&self.population);
        best.truncate(count);
        best
    }

    /// The kernels that no other one beats in speed and in every cost at once, the fittest first, no two of the
    /// same source.
    pub fn front(&self) -> Vec<&Individual> {
        front(&self.population)
    }

    /// The front, and those behind it until there are so many: whole fronts, the fittest first in each.
    pub fn fronts(&self, count: usize) -> Vec<&Individual> {
        fronts(&self.population, count)
    }
}

/// Searches `graph` for the fittest program.
///
/// # Panics
///
/// If the settings are not [valid](Settings::validate).
pub fn search<E: Evaluate>(
    graph: &Graph,
    settings: Settings,
    evaluate: &mut E,
    observe: &mut impl Observe,
) -> Outcome<E::Error> {
    search_from(graph, &[], settings, evaluate, observe)
}

/// The same, from a first generation that has random programs of `graph` and, in turn, of each of the
/// `nurseries`: restrictions of it, to kinds of programs that are rare and have to be whole to be worth anything.
///
/// # Panics
///
/// If the settings are not [valid](Settings::validate), or a nursery has other nodes than `graph`.
pub fn search_from<E: Evaluate>(
    graph: &Graph,
    nurseries: &[Graph],
    settings: Settings,
    evaluate: &mut E,
    observe: &mut impl Observe,
) -> Outcome<E::Error> {
    settings.validate().expect("valid settings");
    let mut search = Search {
        graph,
        nurseries,
        settings,
        rng: ChaCha8Rng::seed_from_u64(settings.seed),
        population: Vec::new(),
        judgements: HashMap::new(),
        evaluations: 0,
    };
    let stop = search.run(evaluate, observe);
    Outcome {
        population: search.population,
        evaluations: search.evaluations,
        stop,
    }
}

/// A genome that picks from a graph what `genome` picks from a restriction of it, in the same order.
fn of_nursery(nursery: &Graph, genome: &Genome) -> Genome {
    let mut live = nursery.live(genome);
    live.sort_by_key(|id| Reverse(genome.priorities()[id.index()]));
    genome.preferring(&live)
}

struct Search<'a> {
    graph: &'a Graph,
    nurseries: &'a [Graph],
    settings: Settings,
    rng: ChaCha8Rng,
    population: Vec<Individual>,
    /// How often every source was judged.
    judgements: HashMap<String, u32>,
    evaluations: u64,
}

impl Search<'_> {
    fn run<E: Evaluate>(&mut self, evaluate: &mut E, observe: &mut impl Observe) -> Stop<E::Error> {
        for number in 0..=self.settings.generations {
            let stop = match self.generation(number, evaluate, observe) {
                Ok(()) if number < self.settings.generations => continue,
                Ok(()) => Stop::Done,
                Err(early @ (Stop::Enough | Stop::Ended)) => early,
                Err(early) => return early,
            };
            // The last to have entered the elite are judged again as all before them were.
            return match self.evaluate(number + 1, Vec::new(), evaluate) {
                Ok(_) => stop,
                Err(early) => early,
            };
        }
        Stop::Done
    }

    fn generation<E: Evaluate>(
        &mut self,
        number: usize,
        evaluate: &mut E,
        observe: &mut impl Observe,
    ) -> Result<(), Stop<E::Error>> {
        let mut genomes = if number == 0 {
            self.random_genomes()
        } else {
            self.offspring().ok_or(Stop::NobodyFit)?
        };
        let left = self.settings.evaluations_left(self.evaluations);
        let enough = genomes.len() >= left;
        genomes.truncate(left);
        if genomes.is_empty() {
            return Err(Stop::Enough);
        }
        let candidates = self.candidates(number, genomes, evaluate);
        let candidates = candidates.map_err(Stop::Graph)?;
        let new = self.evaluate(number, candidates, evaluate)?;
        let kept = if number == 0 { 0 } else { self.settings.elite };
        self.population.truncate(kept);
        self.population.extend(new.iter().cloned());
        self.rank();
        let observed = observe.generation(&Generation {
            number,
            new: &new,
            population: &self.population,
        });
        match observed {
            ControlFlow::Break(()) => Err(Stop::Ended),
            ControlFlow::Continue(()) if enough => Err(Stop::Enough),
            ControlFlow::Continue(()) => Ok(()),
        }
    }

    /// Puts the best first.
    fn rank(&mut self) {
        self.settings.objective.rank(&mut self.population);
    }

    /// The fittest few, and those in the elite whose source was judged only once; best first, one
    /// of a source.
    fn due(&self) -> Vec<Individual> {
        let mut due: Vec<Individual> = Vec::new();
        let elite = self.population.iter().take(self.settings.elite);
        for (rank, individual) in elite.enumerate() {
            let source = &individual.candidate.source;
            let judgements = self.judgements[source];
            let asked = judgements == 1 || rank < FRONT && judgements < ENOUGH;
            let twin = due.iter().any(|other| other.candidate.source == *source);
            if asked && !twin && individual.evaluation.fitness.is_some() {
                due.push(individual.clone());
            }
        }
        due
    }

    fn random_genomes(&mut self) -> Vec<(Origin, Genome)> {
        let nodes = self.graph.nodes().len();
        let kinds = 1 + self.nurseries.len();
        let genomes = (0..self.settings.population).map(|place| {
            let genome = Genome::random(nodes, &mut self.rng);
            let genome = match self.nurseries.get(place % kinds) {
                Some(nursery) => of_nursery(nursery, &genome),
                None => genome,
            };
            (Origin::Random, genome)
        });
        genomes.collect()
    }

    /// The next offspring, or none if nobody has any fitness.
    fn offspring(&mut self) -> Option<Vec<(Origin, Genome)>> {
        let Settings {
            population,
            elite,
            objective,
            ..
        } = self.settings;
        let count = population - elite;
        let mut offspring = Vec::with_capacity(count);
        while offspring.len() < count {
            let mut parent = || objective.parent(&self.population, elite, &mut self.rng);
            let [a, b] = [parent()?, parent()?].map(|place| &self.population[place]);
            let cut = random_cut(self.graph.nodes().len(), &mut self.rng);
            let pair = crossover(&a.candidate.genome, &b.candidate.genome, cut);
            let parents = [
                [a.candidate.id, b.candidate.id],
                [b.candidate.id, a.candidate.id],
            ];
            for (mut genome, parents) in pair.into_iter().zip(parents) {
                mutate(&mut genome, &mut self.rng);
                offspring.push((Origin::Crossover { parents }, genome));
            }
        }
        Some(offspring)
    }

    fn candidates<E: Evaluate>(
        &self,
        generation: usize,
        genomes: Vec<(Origin, Genome)>,
        evaluate: &mut E,
    ) -> Result<Vec<Candidate>, ProgramError> {
        let numbered = (self.evaluations..).zip(genomes);
        let candidates = numbered.map(|(id, (origin, genome))| {
            let program = self.graph.program(&genome)?;
            Ok(Candidate {
                id,
                generation,
                origin,
                source: evaluate.source(&program),
                genome,
                program,
            })
        });
        candidates.collect()
    }

    /// Judges candidates, and those alive who are due. Gives the former as individuals; the latter
    /// are ranked anew.
    fn evaluate<E: Evaluate>(
        &mut self,
        generation: usize,
        candidates: Vec<Candidate>,
        evaluate: &mut E,
    ) -> Result<Vec<Individual>, Stop<E::Error>> {
        let due = self.due();
        let survivors = self.settings.elite.min(self.population.len());
        let batch = Batch {
            generation,
            new: &candidates,
            again: &due,
            survivors: &self.population[..survivors],
        };
        let judged = evaluate.evaluate(&batch).map_err(Stop::Evaluation)?;
        assert_eq!(judged.new.len(), candidates.len(), "one a candidate");
        assert_eq!(judged.again.len(), due.len(), "one an individual");
        for (individual, evaluation) in due.iter().zip(judged.again) {
            let source = &individual.candidate.source;
            *self.judgements.entry(source.clone()).or_default() += 1;
            let twins = self.population.iter_mut();
            for twin in twins.filter(|twin| twin.candidate.source == *source) {
                twin.evaluation = evaluation.clone();
            }
        }
        self.rank();
        self.evaluations += candidates.len() as u64;
        for candidate in &candidates {
            self.judgements.entry(candidate.source.clone()).or_insert(1);
        }
        let individuals = candidates.into_iter().zip(judged.new);
        Ok(individuals
            .map(|(candidate, evaluation)| Individual {
                candidate,
                evaluation,
            })
            .collect())
    }
}

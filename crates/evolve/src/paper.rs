//! The genetic algorithm of the paper's section 5, made exact.
//!
//! The first generation is random. In every later one the elite survives unchanged and the rest
//! is replaced by pairs of offspring: both parents are drawn from the whole population with
//! probability proportional to fitness, a segment between two cut points is exchanged by order,
//! and in each of the offspring a random pair of values is swapped, twice.
//!
//! Fitness is a measurement, and who is let into the elite on a lucky one stays there. So whoever
//! is about to enter it is judged once more first, and the few best in every generation.

use std::collections::HashSet;

use program::{Genome, Graph, Program, ProgramError};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::evaluate::Evaluate;
use crate::individual::{Individual, Origin};
use crate::operators::{crossover, draw_parent, mutate, random_cut};
use crate::settings::Settings;

/// Told of every generation.
pub trait Observe {
    /// A generation has been evaluated.
    ///
    /// # Errors
    ///
    /// If it cannot be recorded; the search then stops.
    fn generation(&mut self, generation: &Generation<'_>) -> std::io::Result<()>;
}

/// One generation, evaluated.
pub struct Generation<'a> {
    /// Its number; 0 is the random one.
    pub number: usize,
    /// Those evaluated in it.
    pub new: &'a [Individual],
    /// Those judged again in it, as they are known now; not all of them are new.
    pub confirmed: &'a [Individual],
    /// Everyone alive, best first.
    pub population: &'a [Individual],
}

/// How many of the best are judged again in every generation.
const FRONT: usize = 3;

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
    /// A generation could not be recorded.
    Observation(std::io::Error),
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
    /// The fittest kernels, best first, no two of the same source.
    pub fn best(&self, count: usize) -> Vec<&Individual> {
        let mut best: Vec<&Individual> = Vec::new();
        for individual in &self.population {
            let source = &individual.evaluation.source;
            let known = best.iter().any(|other| other.evaluation.source == *source);
            if individual.evaluation.fitness.is_some() && !known {
                best.push(individual);
            }
        }
        best.truncate(count);
        best
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
    settings.validate().expect("valid settings");
    let mut search = Search {
        graph,
        settings,
        rng: ChaCha8Rng::seed_from_u64(settings.seed),
        population: Vec::new(),
        confirmed: HashSet::new(),
        evaluations: 0,
    };
    let stop = search.run(evaluate, observe);
    Outcome {
        population: search.population,
        evaluations: search.evaluations,
        stop,
    }
}

struct Search<'a> {
    graph: &'a Graph,
    settings: Settings,
    rng: ChaCha8Rng,
    population: Vec<Individual>,
    /// Sources of which nobody need be judged again to enter the elite.
    confirmed: HashSet<String>,
    evaluations: u64,
}

impl Search<'_> {
    fn run<E: Evaluate>(&mut self, evaluate: &mut E, observe: &mut impl Observe) -> Stop<E::Error> {
        for number in 0..=self.settings.generations {
            let genomes = if number == 0 {
                self.random_genomes()
            } else {
                match self.offspring() {
                    Some(genomes) => genomes,
                    None => return Stop::NobodyFit,
                }
            };
            let programs = genomes.iter().map(|(_, genome)| self.graph.program(genome));
            let programs: Vec<Program> = match programs.collect() {
                Ok(programs) => programs,
                Err(error) => return Stop::Graph(error),
            };
            let new = match self.evaluate(genomes, programs, evaluate) {
                Ok(new) => new,
                Err(error) => return Stop::Evaluation(error),
            };
            let kept = if number == 0 { 0 } else { self.settings.elite };
            self.population.truncate(kept);
            self.population.extend(new.iter().cloned());
            self.rank();
            let confirmed = match self.confirm(evaluate) {
                Ok(confirmed) => confirmed,
                Err(error) => return Stop::Evaluation(error),
            };
            let observed = observe.generation(&Generation {
                number,
                new: &new,
                confirmed: &confirmed,
                population: &self.population,
            });
            if let Err(error) = observed {
                return Stop::Observation(error);
            }
        }
        Stop::Done
    }

    /// Puts the best first. The sort is stable, so that of equals the older one is ahead.
    fn rank(&mut self) {
        self.population
            .sort_by(|a, b| b.weight().total_cmp(&a.weight()));
    }

    /// Judges again the front, and then whoever is in the elite by a single judgement, until
    /// nobody is. Ranks all anew and gives those judged.
    fn confirm<E: Evaluate>(&mut self, evaluate: &mut E) -> Result<Vec<Individual>, E::Error> {
        let mut confirmed = Vec::new();
        let mut due = self.due(FRONT);
        while !due.is_empty() {
            let evaluations = evaluate.confirm(&due.iter().collect::<Vec<_>>())?;
            assert_eq!(evaluations.len(), due.len(), "an evaluation an individual");
            for (mut individual, mut evaluation) in due.into_iter().zip(evaluations) {
                evaluation.drop_what_is_no_fitness();
                self.confirmed.insert(individual.evaluation.source.clone());
                for twin in &mut self.population {
                    if twin.evaluation.source == individual.evaluation.source {
                        twin.evaluation = evaluation.clone();
                    }
                }
                individual.evaluation = evaluation;
                confirmed.push(individual);
            }
            self.rank();
            due = self.due(0);
        }
        Ok(confirmed)
    }

    /// The fittest few, and those in the elite whose source was judged only once; best first, one
    /// of a source.
    fn due(&self, front: usize) -> Vec<Individual> {
        let mut due: Vec<Individual> = Vec::new();
        let elite = self.population.iter().take(self.settings.elite);
        for (rank, individual) in elite.enumerate() {
            let source = &individual.evaluation.source;
            let asked = rank < front || !self.confirmed.contains(source);
            let twin = due.iter().any(|other| other.evaluation.source == *source);
            if asked && !twin && individual.evaluation.fitness.is_some() {
                due.push(individual.clone());
            }
        }
        due
    }

    fn random_genomes(&mut self) -> Vec<(Origin, Genome)> {
        let nodes = self.graph.nodes().len();
        (0..self.settings.population)
            .map(|_| (Origin::Random, Genome::random(nodes, &mut self.rng)))
            .collect()
    }

    /// The next offspring, or none if nobody has any fitness.
    fn offspring(&mut self) -> Option<Vec<(Origin, Genome)>> {
        let weights: Vec<f64> = self.population.iter().map(Individual::weight).collect();
        let count = self.settings.population - self.settings.elite;
        let mut offspring = Vec::with_capacity(count);
        while offspring.len() < count {
            let a = &self.population[draw_parent(&weights, &mut self.rng)?];
            let b = &self.population[draw_parent(&weights, &mut self.rng)?];
            let cut = random_cut(self.graph.nodes().len(), &mut self.rng);
            let pair = crossover(&a.genome, &b.genome, cut);
            let parents = [[a.id, b.id], [b.id, a.id]];
            for (mut genome, parents) in pair.into_iter().zip(parents) {
                mutate(&mut genome, &mut self.rng);
                offspring.push((Origin::Crossover { parents }, genome));
            }
        }
        Some(offspring)
    }

    fn evaluate<E: Evaluate>(
        &mut self,
        genomes: Vec<(Origin, Genome)>,
        programs: Vec<Program>,
        evaluate: &mut E,
    ) -> Result<Vec<Individual>, E::Error> {
        let mut evaluations = evaluate.evaluate(&programs)?;
        assert_eq!(evaluations.len(), programs.len(), "an evaluation a program");
        for evaluation in &mut evaluations {
            evaluation.drop_what_is_no_fitness();
        }
        let first = self.evaluations;
        self.evaluations += programs.len() as u64;
        let parts = genomes.into_iter().zip(programs).zip(evaluations);
        Ok((first..)
            .zip(parts)
            .map(
                |(id, (((origin, genome), program), evaluation))| Individual {
                    id,
                    origin,
                    genome,
                    program,
                    evaluation,
                },
            )
            .collect())
    }
}

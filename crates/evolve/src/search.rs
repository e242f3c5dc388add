//! The search: generation by generation a [strategy](crate::Propose) says who is tried, and somebody else judges.
//!
//! Of everyone alive the elite survives unchanged, and those just judged join it. Fitness is a measurement, and
//! who is let into the elite on a lucky one would stay there. So whoever has entered it is judged once more together
//! with the next generation, and the few best in every generation.

use std::collections::HashMap;
use std::ops::ControlFlow;

use program::{Graph, ProgramError};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::evaluate::{Batch, Evaluate};
use crate::individual::{Candidate, Draft, Individual};
use crate::selection::{distinct, front, fronts, put_twins_last};
use crate::settings::Settings;
use crate::strategy::{Propose, Strategy};
use crate::world::World;

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
    /// Everyone alive, best first; but by the paper, those who are the same kernel as one before them come last.
    pub population: &'a [Individual],
    /// How many drafts so far were no candidates, since their source had been tried.
    pub redrawn: u64,
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
    /// The strategy finds nothing that has not been tried.
    Exhausted,
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
    /// How many drafts were no candidates, since their source had been tried.
    pub redrawn: u64,
    /// Why it stopped.
    pub stop: Stop<E>,
}

impl<E> Outcome<E> {
    /// The fittest kernels, the fittest first, each once.
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
        strategy: settings.strategy.proposes(),
        rng: ChaCha8Rng::seed_from_u64(settings.seed),
        population: Vec::new(),
        judgements: HashMap::new(),
        evaluations: 0,
        redrawn: 0,
    };
    let stop = search.run(evaluate, observe);
    Outcome {
        population: search.population,
        evaluations: search.evaluations,
        redrawn: search.redrawn,
        stop,
    }
}

struct Search<'a> {
    graph: &'a Graph,
    nurseries: &'a [Graph],
    settings: Settings,
    strategy: Box<dyn Propose>,
    rng: ChaCha8Rng,
    population: Vec<Individual>,
    /// How often every source was judged.
    judgements: HashMap<String, u32>,
    evaluations: u64,
    redrawn: u64,
}

impl Search<'_> {
    fn run<E: Evaluate>(&mut self, evaluate: &mut E, observe: &mut impl Observe) -> Stop<E::Error> {
        for number in 0.. {
            let stop = match self.generation(number, evaluate, observe) {
                Ok(()) if self.left() > 0 => continue,
                Ok(()) if self.settings.limit == Some(self.evaluations) => Stop::Enough,
                Ok(()) => Stop::Done,
                Err(early @ (Stop::Ended | Stop::Exhausted)) => early,
                Err(early) => return early,
            };
            // The last to have entered the elite are judged again as all before them were.
            return match self.evaluate(number + 1, Vec::new(), evaluate) {
                Ok(_) => stop,
                Err(early) => early,
            };
        }
        unreachable!("generations are numbered without end")
    }

    fn generation<E: Evaluate>(
        &mut self,
        number: usize,
        evaluate: &mut E,
        observe: &mut impl Observe,
    ) -> Result<(), Stop<E::Error>> {
        let mut drafts = self.drafts(evaluate)?;
        drafts.truncate(self.left());
        let candidates = self.candidates(number, drafts);
        let new = self.evaluate(number, candidates, evaluate)?;
        let kept = if number == 0 { 0 } else { self.settings.elite };
        self.population.truncate(kept);
        self.population.extend(new.iter().cloned());
        self.rank();
        let observed = observe.generation(&Generation {
            number,
            new: &new,
            population: &self.population,
            redrawn: self.redrawn,
        });
        match observed {
            ControlFlow::Break(()) => Err(Stop::Ended),
            ControlFlow::Continue(()) => Ok(()),
        }
    }

    /// How many more are evaluated.
    fn left(&self) -> usize {
        self.settings.evaluations_left(self.evaluations)
    }

    /// What the strategy would have judged: something, or the search is over.
    fn drafts<E: Evaluate>(&mut self, evaluate: &mut E) -> Result<Vec<Draft>, Stop<E::Error>> {
        let mut world = World {
            graph: self.graph,
            nurseries: self.nurseries,
            settings: &self.settings,
            population: &self.population,
            evaluations: self.evaluations,
            rng: &mut self.rng,
            judgements: &self.judgements,
            foresee: evaluate,
            redrawn: &mut self.redrawn,
        };
        let drafts = self.strategy.propose(&mut world).map_err(Stop::Graph)?;
        let is_fit = |one: &Individual| one.evaluation.fitness.is_some();
        match drafts.is_empty() {
            false => Ok(drafts),
            true if self.population.iter().any(is_fit) => Err(Stop::Exhausted),
            true => Err(Stop::NobodyFit),
        }
    }

    fn candidates(&self, generation: usize, drafts: Vec<Draft>) -> Vec<Candidate> {
        let numbered = (self.evaluations..).zip(drafts);
        let candidate = |(id, draft): (u64, Draft)| Candidate {
            id,
            generation,
            origin: draft.origin,
            genome: draft.genome,
            program: draft.program,
            source: draft.source,
        };
        numbered.map(candidate).collect()
    }

    /// Puts the best first. In the paper's elite a kernel may be several times.
    fn rank(&mut self) {
        self.settings.objective.rank(&mut self.population);
        if self.settings.strategy != Strategy::Paper {
            put_twins_last(&mut self.population);
        }
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

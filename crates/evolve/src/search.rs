//! The search: generation by generation a [strategy](crate::Propose) says who is tried, and somebody else judges.
//!
//! Of everyone alive the elite survives unchanged, and those just judged join it. Fitness is a measurement, and
//! who is let into the elite on a lucky one would stay there. So whoever has entered it is judged once more together
//! with the next generation, and the few best in every generation.
//!
//! With several [islands](Settings::islands) there are as many populations, which have a generation in turn. While
//! one's is judged, the next one's is proposed and made ready:
//!
//! ```text
//! propose, prepare   0 1 2 3 …      (generation 2 knows 0, generation 3 knows 0 and 1)
//! judge                0 1 2 …
//! ```

use std::collections::HashMap;
use std::ops::ControlFlow;

use program::Graph;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::evaluate::{Batch, Evaluate};
use crate::individual::{Candidate, Draft, Individual};
use crate::island::{Island, rank};
use crate::outcome::{Generation, Observe, Outcome, Stop};
use crate::settings::Settings;
use crate::world::World;

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
        islands: (0..settings.islands)
            .map(|_| Island::new(&settings))
            .collect(),
        judgements: HashMap::new(),
        made: 0,
        judged: 0,
        generations: 0,
        redrawn: 0,
    };
    let stop = search.run(evaluate, observe);
    Outcome {
        population: search.everyone(),
        evaluations: search.judged,
        redrawn: search.redrawn,
        stop,
    }
}

struct Search<'a> {
    graph: &'a Graph,
    nurseries: &'a [Graph],
    settings: Settings,
    rng: ChaCha8Rng,
    islands: Vec<Island>,
    /// How often every source was judged; once if it will be.
    judgements: HashMap<String, u32>,
    /// How many candidates were made, and will be judged.
    made: u64,
    /// How many of them were.
    judged: u64,
    /// How many generations live on their islands.
    generations: usize,
    redrawn: u64,
}

/// A generation on its way from an island to who judges it, and back.
struct Flight<T> {
    /// Its number.
    number: usize,
    /// The island's place.
    island: usize,
    new: Vec<Candidate>,
    again: Vec<Individual>,
    /// The batch, as who judges knows it.
    batch: T,
}

impl Search<'_> {
    fn run<E: Evaluate>(&mut self, evaluate: &mut E, observe: &mut impl Observe) -> Stop<E::Error> {
        let stop = self.generations(evaluate, observe);
        if !matches!(
            stop,
            Stop::Done | Stop::Enough | Stop::Ended | Stop::Exhausted
        ) {
            return stop;
        }
        // The last to have entered an elite are judged again as all before them were.
        match self.judge_the_last(evaluate) {
            Ok(()) => stop,
            Err(early) => early,
        }
    }

    /// Generation after generation, each on the next island, until there is a reason to stop.
    fn generations<E: Evaluate>(
        &mut self,
        evaluate: &mut E,
        observe: &mut impl Observe,
    ) -> Stop<E::Error> {
        let mut judging: Option<Flight<E::Begun>> = None;
        for number in 0.. {
            // A single island can propose nothing before it knows the last generation.
            if self.islands.len() == 1
                && let Err(stop) = self.land(judging.take(), evaluate, observe)
            {
                return stop;
            }
            let ready = self.make(number, evaluate);
            if let Err(stop) = self.land(judging.take(), evaluate, observe) {
                return stop;
            }
            match ready.and_then(|ready| ready.begin(evaluate)) {
                Ok(begun) => judging = Some(begun),
                Err(stop) => return stop,
            }
        }
        unreachable!("generations are numbered without end")
    }

    /// Makes the next generation of an island, and has it made ready.
    fn make<E: Evaluate>(
        &mut self,
        number: usize,
        evaluate: &mut E,
    ) -> Result<Flight<E::Ready>, Stop<E::Error>> {
        let left = self.settings.evaluations_left(self.made);
        if left == 0 {
            return Err(match self.settings.limit == Some(self.made) {
                true => Stop::Enough,
                false => Stop::Done,
            });
        }
        let island = number % self.islands.len();
        let mut drafts = self.drafts(island, evaluate)?;
        drafts.truncate(left);
        let candidates = self.candidates(number, drafts);
        let count = candidates.len() as u64;
        self.made += count;
        self.islands[island].evaluations += count;
        for candidate in &candidates {
            self.judgements.entry(candidate.source.clone()).or_insert(1);
        }
        self.prepare((number, island), candidates, evaluate)
    }

    /// What the strategy would have judged: something, or the search is over.
    fn drafts<E: Evaluate>(
        &mut self,
        island: usize,
        evaluate: &mut E,
    ) -> Result<Vec<Draft>, Stop<E::Error>> {
        let (before, rest) = self.islands.split_at_mut(island);
        let (own, after) = rest.split_first_mut().expect("the island is there");
        let others = before.iter().chain(after.iter());
        let mut world = World {
            graph: self.graph,
            nurseries: self.nurseries,
            settings: &self.settings,
            population: &own.population,
            others: others.flat_map(|other| &other.population).collect(),
            evaluations: own.evaluations,
            made: self.made,
            rng: &mut self.rng,
            judgements: &self.judgements,
            foresee: evaluate,
            redrawn: &mut self.redrawn,
        };
        let drafts = own.strategy.propose(&mut world).map_err(Stop::Graph)?;
        let is_fit = |one: &Individual| one.evaluation.fitness.is_some();
        let anyone_fit = own.population.iter().any(is_fit);
        match drafts.is_empty() {
            false => Ok(drafts),
            true if anyone_fit => Err(Stop::Exhausted),
            true => Err(Stop::NobodyFit),
        }
    }

    fn candidates(&self, generation: usize, drafts: Vec<Draft>) -> Vec<Candidate> {
        let numbered = (self.made..).zip(drafts);
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

    /// Has candidates made ready to be judged, and those of the island who are due.
    fn prepare<E: Evaluate>(
        &self,
        (number, island): (usize, usize),
        new: Vec<Candidate>,
        evaluate: &mut E,
    ) -> Result<Flight<E::Ready>, Stop<E::Error>> {
        let of = &self.islands[island];
        let again = of.due(&self.judgements, &self.settings);
        let batch = evaluate.prepare(&Batch {
            generation: number,
            new: &new,
            again: &again,
            survivors: of.survivors(&self.settings),
        });
        Ok(Flight {
            number,
            island,
            new,
            again,
            batch: batch.map_err(Stop::Evaluation)?,
        })
    }

    /// Waits for a generation, if there is one, and lets it live on its island.
    fn land<E: Evaluate>(
        &mut self,
        flight: Option<Flight<E::Begun>>,
        evaluate: &mut E,
        observe: &mut impl Observe,
    ) -> Result<(), Stop<E::Error>> {
        let Some(flight) = flight else {
            return Ok(());
        };
        let (number, island) = (flight.number, flight.island);
        let new = self.judged(flight, evaluate)?;
        self.islands[island].replace(new.iter().cloned(), &self.settings);
        self.generations += 1;
        let observed = observe.generation(&Generation {
            number,
            new: &new,
            population: &self.everyone(),
            redrawn: self.redrawn,
        });
        match observed {
            ControlFlow::Break(()) => Err(Stop::Ended),
            ControlFlow::Continue(()) => Ok(()),
        }
    }

    /// Waits for a generation. Gives the new ones. What was learnt of those who were judged again is known of
    /// everyone who is the same kernel.
    fn judged<E: Evaluate>(
        &mut self,
        flight: Flight<E::Begun>,
        evaluate: &mut E,
    ) -> Result<Vec<Individual>, Stop<E::Error>> {
        let judged = evaluate.finish(flight.batch).map_err(Stop::Evaluation)?;
        assert_eq!(judged.new.len(), flight.new.len(), "one a candidate");
        assert_eq!(judged.again.len(), flight.again.len(), "one an individual");
        self.judged += flight.new.len() as u64;
        let new = flight.new.into_iter().zip(judged.new);
        let new = new.map(|(candidate, evaluation)| Individual {
            candidate,
            evaluation,
        });
        let mut new: Vec<Individual> = new.collect();
        for (individual, evaluation) in flight.again.iter().zip(judged.again) {
            let source = individual.candidate.source.clone();
            *self.judgements.entry(source).or_default() += 1;
            let islands = self.islands.iter_mut();
            let alive = islands.flat_map(|island| &mut island.population);
            let twins = alive.chain(&mut new);
            for twin in twins.filter(|twin| twin.kernel() == individual.kernel()) {
                twin.evaluation = evaluation.clone();
            }
        }
        for island in &mut self.islands {
            rank(&mut island.population, &self.settings);
        }
        Ok(new)
    }

    /// Judges nobody new, but whoever is due.
    fn judge_the_last<E: Evaluate>(&mut self, evaluate: &mut E) -> Result<(), Stop<E::Error>> {
        for island in 0..self.islands.len() {
            let number = self.generations + island;
            let flight = self.prepare((number, island), Vec::new(), evaluate)?;
            let flight = flight.begin(evaluate)?;
            self.judged(flight, evaluate)?;
        }
        Ok(())
    }

    /// Everyone alive, on all islands, best first.
    fn everyone(&self) -> Vec<Individual> {
        let populations = self
            .islands
            .iter()
            .map(|island| island.population.as_slice());
        let mut everyone = populations.collect::<Vec<_>>().concat();
        if self.islands.len() > 1 {
            rank(&mut everyone, &self.settings);
        }
        everyone
    }
}

impl<T> Flight<T> {
    /// Has it judged.
    fn begin<E: Evaluate<Ready = T>>(
        self,
        evaluate: &mut E,
    ) -> Result<Flight<E::Begun>, Stop<E::Error>> {
        let Flight {
            number,
            island,
            new,
            again,
            batch,
        } = self;
        Ok(Flight {
            number,
            island,
            new,
            again,
            batch: evaluate.begin(batch).map_err(Stop::Evaluation)?,
        })
    }
}

//! Progress of a search: a line a generation, a bar.

use std::cell::Cell;
use std::collections::{HashSet, VecDeque};
use std::ops::ControlFlow;
use std::rc::Rc;
use std::time::{Duration, Instant};

use evolve::{Generation, Individual, Objective, Observe, Settings};
use indicatif::{ProgressBar, ProgressStyle};
use measure::median;
use serde_json::json;

use super::evaluator::Totals;
use crate::progress::short;

/// Generations that the estimate of the time left is made from.
const RECENT: usize = 8;

/// How much is said of a generation.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Say {
    /// A line, in the bar if there is one.
    Line,
    /// An object of JSON beside it.
    Json,
    /// Nothing where there is no bar: somebody else says how far it is.
    Nothing,
}

/// Reports every generation, and ends the search when its time is over.
pub struct Progress {
    spent: Rc<Cell<Totals>>,
    say: Say,
    bar: ProgressBar,
    settings: Settings,
    deadline: Option<Instant>,
    /// Evaluations that were recorded before: nobody wants to read of them again.
    recorded: usize,
    evaluations: usize,
    sources: HashSet<String>,
    last: (Instant, Totals),
    recent: VecDeque<Duration>,
    /// Failures by verdict, in order of appearance, with an example each.
    failures: Vec<(String, usize, String)>,
}

impl Progress {
    /// Begins to report a search, of which so many evaluations are recorded already.
    pub fn new(
        spent: Rc<Cell<Totals>>,
        settings: Settings,
        recorded: usize,
        deadline: Option<Instant>,
        say: Say,
    ) -> Progress {
        let bar = ProgressBar::new(settings.evaluations());
        let style = ProgressStyle::with_template("{bar:24} {msg}").expect("a fixed template");
        bar.set_style(style);
        bar.set_message("the first generation");
        bar.enable_steady_tick(Duration::from_millis(200));
        Progress {
            spent,
            say,
            bar,
            settings,
            deadline,
            recorded,
            evaluations: 0,
            sources: HashSet::new(),
            last: (Instant::now(), Totals::default()),
            recent: VecDeque::new(),
            failures: Vec::new(),
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// Says which verdicts there were that are no timing.
    pub fn say_failures(&self) {
        for (verdict, count, example) in &self.failures {
            eprintln!("failed     {count} {verdict}, for example {example}");
        }
    }

    fn note_failures(&mut self, new: &[&Individual]) {
        for individual in new.iter().filter(|new| new.evaluation.fitness.is_none()) {
            let details = &individual.evaluation.details;
            let verdict = details["verdict"].as_str().unwrap_or("failed").to_owned();
            let known = self.failures.iter_mut().find(|(name, ..)| *name == verdict);
            match known {
                Some((_, count, _)) => *count += 1,
                None => {
                    let example =
                        format!("individual {}: {}", individual.candidate.id, cause(details));
                    self.failures.push((verdict, 1, example));
                }
            }
        }
    }

    /// Time left, by the pace of the last generations or by the deadline.
    fn eta(&mut self, number: usize, took: Duration) -> Duration {
        // The first generation is larger than the others.
        if number > 0 {
            self.recent.push_back(took);
        }
        if self.recent.len() > RECENT {
            self.recent.pop_front();
        }
        let pace = match self.recent.len() as u32 {
            0 => took,
            count => self.recent.iter().sum::<Duration>() / count,
        };
        let evaluations = self.settings.evaluations() as usize - self.evaluations;
        let each = self.settings.population - self.settings.elite;
        let left = pace * evaluations.div_ceil(each) as u32;
        let until = |deadline: Instant| deadline.saturating_duration_since(Instant::now());
        self.deadline
            .map_or(left, |deadline| left.min(until(deadline)))
    }
}

impl Observe for Progress {
    fn generation(&mut self, generation: &Generation<'_>) -> ControlFlow<()> {
        let Generation {
            number,
            new,
            population,
            redrawn,
        } = *generation;
        self.evaluations += new.len();
        let fresh: Vec<&Individual> = new
            .iter()
            .filter(|individual| self.sources.insert(individual.candidate.source.clone()))
            .collect();
        self.note_failures(&fresh);
        self.bar.set_position(self.evaluations as u64);
        if self.evaluations <= self.recorded {
            return ControlFlow::Continue(());
        }
        let failed = fresh
            .iter()
            .filter(|new| new.evaluation.fitness.is_none())
            .count();
        let alive: Vec<f64> = population
            .iter()
            .filter_map(|one| one.evaluation.fitness)
            .collect();
        let (then, before) = self.last;
        let totals = self.spent.get();
        self.last = (Instant::now(), totals);
        let compile = totals.bench.compile.saturating_sub(before.bench.compile);
        let measured = |totals: Totals| totals.bench.check + totals.bench.time;
        let measure = measured(totals).saturating_sub(measured(before));
        let eta = self.eta(number, self.last.0 - then);
        let best = population
            .iter()
            .max_by(|a, b| a.weight().total_cmp(&b.weight()));
        let best = best.map(|best| &best.evaluation);
        let front = match self.settings.objective {
            Objective::Speed => None,
            Objective::Pareto => Some(generation.front().len()),
        };
        let ratio = best.and_then(|best| best.fitness).unwrap_or(0.0);
        let uncertainty = best.map_or(0.0, |best| best.uncertainty);
        let middle = if alive.is_empty() {
            0.0
        } else {
            median(&alive)
        };
        if self.say == Say::Json {
            let line = json!({
                "generation": number,
                "generations": self.settings.generations,
                "evaluations": self.evaluations,
                "new": fresh.len(),
                "duplicates": new.len() - fresh.len(),
                "redrawn": redrawn,
                "failed": failed,
                "best": ratio,
                "uncertainty": uncertainty,
                "median": middle,
                "front": front,
                "compile_seconds": compile.as_secs_f64(),
                "measure_seconds": measure.as_secs_f64(),
                "eta_seconds": eta.as_secs_f64(),
            });
            println!("{line}");
        }
        let line = format!(
            "gen {number}/{}  evals {} (new {}, dup {}, failed {failed})  {}\
             best {ratio:.2}x MT ±{:.1}%  median {middle:.2}x  \
             compile {:.1}s measure {:.1}s  ETA {}",
            self.settings.generations,
            self.evaluations,
            fresh.len(),
            new.len() - fresh.len(),
            front.map_or(String::new(), |front| format!("front {front}  ")),
            uncertainty * 100.0,
            compile.as_secs_f64(),
            measure.as_secs_f64(),
            short(eta),
        );
        match (self.bar.is_hidden(), self.say) {
            (true, Say::Nothing) => {}
            (true, _) => eprintln!("{line}"),
            (false, _) => self.bar.set_message(line),
        }
        match self.deadline {
            Some(deadline) if Instant::now() >= deadline => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }
}

/// Why an individual failed, from the details of its evaluation.
pub fn cause(details: &serde_json::Value) -> String {
    let message = details["message"]
        .as_str()
        .map(|text| text.lines().next().unwrap_or(""));
    match (message, details["accuracy"]["p99"].as_f64()) {
        (Some(message), _) => message.to_owned(),
        (None, Some(p99)) => format!("p99 of the relative error of t is {p99:.1e}"),
        (None, None) => format!("while {}", details["phase"].as_str().unwrap_or("building")),
    }
}

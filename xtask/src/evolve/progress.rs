//! Progress of a search: the journal, a line a generation, a bar.

use std::cell::Cell;
use std::collections::{HashSet, VecDeque};
use std::io;
use std::rc::Rc;
use std::time::{Duration, Instant};

use evolve::{Generation, Individual, Journal, Observe};
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use measure::median;
use serde_json::json;

use super::evaluator::Totals;

/// Generations that the estimate of the time left is made from.
const RECENT: usize = 8;

/// Records and reports every generation.
pub struct Progress {
    journal: Journal,
    spent: Rc<Cell<Totals>>,
    json: bool,
    bar: ProgressBar,
    generations: usize,
    evaluations: usize,
    sources: HashSet<String>,
    last: (Instant, Totals),
    recent: VecDeque<Duration>,
    /// Failures by verdict, in order of appearance, with an example each.
    pub failures: Vec<(String, usize, String)>,
}

impl Progress {
    /// Begins to report a search of so many generations after the first.
    pub fn new(
        journal: Journal,
        spent: Rc<Cell<Totals>>,
        generations: usize,
        json: bool,
    ) -> Progress {
        let bar = ProgressBar::new(generations as u64 + 1);
        let style = ProgressStyle::with_template("{bar:24} {msg}").expect("a fixed template");
        bar.set_style(style);
        bar.set_message("the first generation");
        bar.enable_steady_tick(Duration::from_millis(200));
        Progress {
            journal,
            spent,
            json,
            bar,
            generations,
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

    fn note_failures(&mut self, new: &[&Individual]) {
        for individual in new.iter().filter(|new| new.evaluation.fitness.is_none()) {
            let details = &individual.evaluation.details;
            let verdict = details["verdict"].as_str().unwrap_or("failed").to_owned();
            let known = self.failures.iter_mut().find(|(name, ..)| *name == verdict);
            match known {
                Some((_, count, _)) => *count += 1,
                None => {
                    let example = format!("individual {}: {}", individual.id, cause(details));
                    self.failures.push((verdict, 1, example));
                }
            }
        }
    }

    /// Time left, by the pace of the last generations.
    fn eta(&mut self, number: usize, took: Duration) -> Duration {
        // The first generation is larger than the others.
        if number > 0 {
            self.recent.push_back(took);
        }
        if self.recent.len() > RECENT {
            self.recent.pop_front();
        }
        let left = (self.generations - number) as u32;
        match self.recent.len() as u32 {
            0 => took * left,
            count => self.recent.iter().sum::<Duration>() * left / count,
        }
    }
}

impl Observe for Progress {
    fn generation(&mut self, generation: &Generation<'_>) -> io::Result<()> {
        let Generation {
            number,
            new,
            confirmed,
            population,
        } = *generation;
        self.journal.append(number, new, confirmed)?;
        self.evaluations += new.len();
        let fresh: Vec<&Individual> = new
            .iter()
            .filter(|individual| self.sources.insert(individual.evaluation.source.clone()))
            .collect();
        self.note_failures(&fresh);
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
        let measure = totals.bench.measure.saturating_sub(before.bench.measure);
        let eta = self.eta(number, self.last.0 - then);
        let best = population.first().map(|best| &best.evaluation);
        let ratio = best.and_then(|best| best.fitness).unwrap_or(0.0);
        let uncertainty = best.map_or(0.0, |best| best.uncertainty);
        let middle = if alive.is_empty() {
            0.0
        } else {
            median(&alive)
        };
        if self.json {
            let line = json!({
                "generation": number,
                "generations": self.generations,
                "evaluations": self.evaluations,
                "new": fresh.len(),
                "duplicates": new.len() - fresh.len(),
                "failed": failed,
                "best": ratio,
                "uncertainty": uncertainty,
                "median": middle,
                "compile_seconds": compile.as_secs_f64(),
                "measure_seconds": measure.as_secs_f64(),
                "eta_seconds": eta.as_secs_f64(),
            });
            println!("{line}");
        }
        let line = format!(
            "gen {number}/{}  evals {} (new {}, dup {}, failed {failed})  \
             best {ratio:.2}x MT ±{:.1}%  median {middle:.2}x  \
             compile {:.1}s measure {:.1}s  ETA {}",
            self.generations,
            self.evaluations,
            fresh.len(),
            new.len() - fresh.len(),
            uncertainty * 100.0,
            compile.as_secs_f64(),
            measure.as_secs_f64(),
            short(eta),
        );
        self.bar.inc(1);
        if self.bar.is_hidden() {
            eprintln!("{line}");
        } else {
            self.bar.set_message(line);
        }
        Ok(())
    }
}

/// Why an individual failed, from the details of its evaluation.
fn cause(details: &serde_json::Value) -> String {
    let message = details["message"]
        .as_str()
        .map(|text| text.lines().next().unwrap_or(""));
    match (message, details["accuracy"]["p99"].as_f64()) {
        (Some(message), _) => message.to_owned(),
        (None, Some(p99)) => format!("p99 of the relative error of t is {p99:.1e}"),
        (None, None) => format!("while {}", details["phase"].as_str().unwrap_or("building")),
    }
}

/// A duration as `2m10s`.
pub fn short(duration: Duration) -> String {
    let seconds = duration.as_secs_f64().round() as u64;
    match (seconds / 3600, seconds / 60 % 60, seconds % 60) {
        (0, 0, s) => format!("{s}s"),
        (0, m, s) => format!("{m}m{s:02}s"),
        _ => HumanDuration(duration).to_string(),
    }
}

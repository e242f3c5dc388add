//! A search from its first batch to its ranked table, begun or resumed.

use std::cell::Cell;
use std::rc::Rc;
use std::time::{Duration, Instant};

use anyhow::Context;
use emit::{Name, Recipe};
use evolve::{Individual, Journal, Memory, MemoryError, Objective, Outcome, Recorded, search_from};
use measure::{MAX_P99_ERROR, MeasureError, Rustc};
use program::Graph;
use serde_json::json;

use super::champion::{Finalists, Speed, recipe};
use super::conditions::Conditions;
use super::cores;
use super::directory::{Run, RunDirectory, champion_source};
use super::ending::{ended_early, is_end, reason};
use super::evaluator::{Evaluator, Totals, source};
use super::front::{self, Front};
use super::progress::{Progress, Say};
use super::reference::{calibrate, noise};
use super::replay::nurseries;
use super::story::{self, Champion};
use crate::arena::Arena;
use crate::benches::{Benches, disbelieved};
use crate::history::History;
use crate::interrupt::interrupt_on_ctrl_c;
use crate::progress::{say, short, with_spinner};
use crate::shootout::{print_table, shootout};

/// A search that is ready to begin, or to go on.
pub struct Session {
    /// What is searched.
    pub graph: Graph,
    /// What candidates are compiled with.
    pub rustc: Rustc,
    /// The run's description.
    pub run: Run,
    /// Where it is kept.
    pub directory: RunDirectory,
    /// How long it may take.
    pub budget: Option<Duration>,
    /// Whether to print JSON.
    pub json: bool,
}

/// What came of the search itself.
struct Bred {
    outcome: Outcome<MemoryError<MeasureError>>,
    /// Evaluations that were not recorded before.
    evaluations: u64,
    took: Duration,
    spent: Totals,
    /// Kept to the end, so that nobody else works in the directory.
    _journal: Option<Journal>,
}

impl Session {
    /// Searches, lets the finalists meet their rivals, and prints who won. The journal has the
    /// evaluations in `recorded` already, if the run goes on.
    pub fn search(mut self, journal: Journal, recorded: Option<Recorded>) -> anyhow::Result<()> {
        let start = Instant::now();
        let arena = self.run.conditions.arena();
        let interrupt = interrupt_on_ctrl_c()?;
        say(&format!(
            "machine    {}; {}",
            self.run.conditions.machine.cpu, self.run.conditions.rustc
        ));
        say(&format!("run        {}", self.directory.display()));
        say(&format!("scene      {}", arena.describe()));
        self.say_islands();
        let mut bench = arena.bench(&self.rustc, &interrupt)?;
        let (reference, processes) = self.directory.earlier();
        let now = calibrate(&mut bench, self.run.conditions.cores)?;
        self.run.reference = Some(reference.unwrap_or(now));
        self.run.noise_floor = Some(noise(&mut bench, self.run.conditions.cores)?);

        let say_each = if self.json { Say::Json } else { Say::Line };
        let bred = self.breed(&arena, &mut bench, journal, recorded, say_each);
        let mut finalists = Finalists::of(&bred.outcome, MAX_P99_ERROR);
        self.run.processes = Some(processes + bench.processes());
        let kept = self.keep_best(&finalists);
        if !is_end(&bred.outcome.stop) || finalists.individuals.is_empty() {
            return Err(ended_early(&bred.outcome.stop, &kept?));
        }
        if !finalists.accurate {
            say(&format!(
                "accuracy   nobody's t is good to {MAX_P99_ERROR:.0e} at the 99th percentile, so the champion cannot be \
                 promoted"
            ));
        }
        let champion = match self.run.conditions.settings.objective {
            Objective::Speed => self.shoot_out(&arena, &mut bench, &mut finalists)?,
            Objective::Pareto => self.confirm(&arena, &mut bench, &bred.outcome)?,
        };
        let processes = processes + bench.processes();
        self.run.processes = Some(processes);
        if let Some(line) = disbelieved(processes) {
            say(&line);
        }
        say_time(start.elapsed(), &bred, self.run.distinct.unwrap_or(0));
        say_duplicates(&bred, self.run.distinct.unwrap_or(0));
        self.say_story(&arena, &bred.outcome.population, &champion)?;
        self.directory.write_champion(&champion)?;
        self.directory.write_run(&self.run)?;
        say(&format!(
            "champion   {0}/champion.rs; cargo xtask promote {0}; the whole story: cargo xtask report {0}",
            self.directory.display()
        ));
        Ok(())
    }

    /// How several populations share the machine.
    fn say_islands(&self) {
        let Conditions {
            settings,
            machine,
            cores,
            ..
        } = &self.run.conditions;
        let islands = settings.islands;
        if islands > 1 {
            let compiling = cores::compiling(machine, islands, *cores);
            say(&format!(
                "islands    {islands} in turn: while one is timed (cores: {cores}), the next one is compiled ({compiling})"
            ));
        }
    }

    /// How the search went, and where its champion comes from.
    fn say_story(
        &self,
        arena: &Arena,
        population: &[Individual],
        champion: &Recipe,
    ) -> anyhow::Result<()> {
        let history = History::of(&self.directory.recorded()?.lines);
        let elite = self.run.conditions.settings.elite.min(population.len());
        let champion = Champion {
            source: source(&arena.kernels(&champion.program)),
            program: &champion.program,
        };
        story::lines(&history, &champion, &population[..elite])
            .iter()
            .for_each(|line| say(line));
        Ok(())
    }

    /// Searches as part of an experiment: what comes of it is kept in its directory, and who wins a heat of the
    /// fittest is the champion. Nothing is said, and no rival takes part.
    pub fn trial(
        mut self,
        bench: &mut Benches,
        journal: Journal,
        recorded: Option<Recorded>,
    ) -> anyhow::Result<()> {
        let arena = self.run.conditions.arena();
        let bred = self.breed(&arena, bench, journal, recorded, Say::Nothing);
        let mut finalists = Finalists::of(&bred.outcome, MAX_P99_ERROR);
        let kept = self.keep_best(&finalists)?;
        if !is_end(&bred.outcome.stop) || finalists.individuals.is_empty() {
            return Err(ended_early(&bred.outcome.stop, &kept));
        }
        finalists.heat(&arena, bench)?;
        let champion = finalists.individuals[0];
        let champion = self.recipe(champion, Speed::in_search(champion));
        self.directory.write_champion(&champion)
    }

    /// The search itself.
    fn breed(
        &mut self,
        arena: &Arena,
        bench: &mut Benches,
        journal: Journal,
        recorded: Option<Recorded>,
        say: Say,
    ) -> Bred {
        let start = Instant::now();
        let settings = self.run.conditions.settings;
        let spent = Rc::new(Cell::new(Totals::default()));
        let before = recorded.as_ref().map_or(0, Recorded::candidates);
        let deadline = self.budget.map(|budget| start + budget);
        let mut progress = Progress::new(spent.clone(), settings, before, deadline, say);
        let Conditions { cores, .. } = self.run.conditions;
        let machine = &self.run.conditions.machine;
        bench.compile_on(cores::compiling(machine, settings.islands, cores));
        let mut evaluator = Evaluator::new(arena, bench, settings.objective, cores, spent.clone());
        if let Some(recorded) = &recorded {
            evaluator.remember(recorded);
        }
        let mut memory = match recorded {
            None => Memory::new(evaluator, journal),
            Some(recorded) => Memory::resume(evaluator, journal, recorded),
        };
        let nurseries = nurseries(&self.graph, arena, settings);
        let outcome = search_from(
            &self.graph,
            &nurseries,
            settings,
            &mut memory,
            &mut progress,
        );
        let sources = memory.sources() as u64;
        let journal = memory.into_journal();
        bench.compile_on(machine.cores);
        progress.finish();
        if say != Say::Nothing {
            progress.say_failures();
        }
        self.run.evaluations = Some(outcome.evaluations);
        self.run.distinct = Some(sources);
        self.run.redrawn = Some(outcome.redrawn);
        self.run.twins = Some(spent.get().twins);
        self.run.seconds = (before == 0).then(|| start.elapsed().as_secs_f64());
        self.run.stopped = Some(reason(&outcome.stop));
        Bred {
            evaluations: outcome.evaluations.saturating_sub(before as u64),
            outcome,
            took: start.elapsed(),
            spent: spent.get(),
            _journal: journal,
        }
    }

    /// Writes the fittest as the champion so far, or prints it if that cannot be. Gives a clause
    /// about it.
    fn keep_best(&self, finalists: &Finalists<'_>) -> anyhow::Result<String> {
        let Some(&fittest) = finalists.individuals.first() else {
            self.directory.write_run(&self.run)?;
            return Ok("no candidate was timed, so there is no champion".into());
        };
        let champion = self.recipe(fittest, Speed::in_search(fittest));
        let best = format!(
            "the best so far, {:.2}x MT in the search,",
            Speed::in_search(fittest).ratio
        );
        let written = self.directory.write_champion(&champion);
        match written.and_then(|()| self.directory.write_run(&self.run)) {
            Ok(()) => Ok(format!("{best} is kept in {}", self.directory.display())),
            Err(_) => {
                println!("{}", champion_source(&champion));
                Ok(format!("{best} is printed above"))
            }
        }
    }

    /// The heat and the shoot-out, and the table. Gives the champion.
    fn shoot_out(
        &mut self,
        arena: &Arena,
        bench: &mut Benches,
        finalists: &mut Finalists<'_>,
    ) -> anyhow::Result<Recipe> {
        let mut standings = with_spinner("the shoot-out, on the full workload", || {
            finalists.heat(arena, bench)?;
            let mut contestants = arena.papers_own();
            contestants.extend(finalists.contestants(arena));
            shootout(bench, &contestants)
        })?;
        let fittest = finalists.individuals[0];
        let (champion, speed) = finalists
            .crown(&mut standings)
            .unwrap_or((fittest, Speed::in_search(fittest)));
        if self.json {
            let run = self.directory.display();
            println!("{}", json!({ "run": run, "shootout": standings }));
        } else {
            print_table(&standings);
        }
        self.run.shootout = Some(standings);
        Ok(self.recipe(champion, speed))
    }

    /// The front on the full workload and by held-out rays: its table, and a recipe of every member. Gives the
    /// champion: the fastest that the library takes, or else the fastest.
    fn confirm<E>(
        &mut self,
        arena: &Arena,
        bench: &mut Benches,
        outcome: &Outcome<E>,
    ) -> anyhow::Result<Recipe> {
        let front = Front::of(outcome);
        let members = with_spinner(
            "the front, on the full workload and by held-out rays",
            || front.confirm(arena, bench),
        )?;
        let mut recipes = Vec::new();
        for member in &members {
            let (Some(number), Some(individual)) = (member.number, front.individual(member)) else {
                continue;
            };
            let mut recipe = self.recipe(individual, Speed::of(&member.standing));
            recipe.name = Name::of(&format!("{}-front-{number}", recipe.name));
            recipes.push(recipe);
        }
        self.directory.write_front(&recipes)?;
        if self.json {
            let run = self.directory.display();
            println!("{}", json!({ "run": run, "front": members }));
        } else {
            front::print(&members, MAX_P99_ERROR);
            say(&format!(
                "front      {0}/front; cargo xtask promote {0}/front/NO.json",
                self.directory.display()
            ));
        }
        self.run.front = Some(members);
        let is_fit =
            |recipe: &&Recipe| recipe.error.is_some_and(|error| error.p99 <= MAX_P99_ERROR);
        let champion = recipes.iter().find(is_fit).or(recipes.first());
        champion
            .cloned()
            .context("nobody of the front came through the shoot-out")
    }

    fn recipe(&self, champion: &Individual, speed: Speed) -> Recipe {
        let evaluations = self.run.evaluations.unwrap_or(0);
        let distinct = self.run.distinct.unwrap_or(0);
        recipe(&self.run.conditions, evaluations, distinct, champion, speed)
    }
}

/// How many kernels were the same as an earlier one, by source and by machine code.
fn say_duplicates(bred: &Bred, distinct: u64) {
    let Outcome {
        evaluations,
        redrawn,
        ..
    } = bred.outcome;
    let percent = |part: u64, whole: u64| 100.0 * part as f64 / whole.max(1) as f64;
    let duplicates = evaluations.saturating_sub(distinct);
    let twins = bred.spent.twins;
    say(&format!(
        "duplicates {:.0}% of drafts drawn again, {:.0}% of candidates by source, {:.0}% of sources by machine code",
        percent(redrawn, redrawn + evaluations),
        percent(duplicates, evaluations),
        percent(twins, distinct),
    ));
}

fn say_time(total: Duration, bred: &Bred, distinct: u64) {
    let Totals { emit, bench, .. } = bred.spent;
    let evaluations = bred.evaluations;
    say(&format!(
        "time       {}: emit {:.1}s, compile {:.1}s, check {:.1}s, time {:.1}s in the search; \
         {evaluations} evaluations, {:.1} a second, {distinct} different sources",
        short(total),
        emit.as_secs_f64(),
        bench.compile.as_secs_f64(),
        bench.check.as_secs_f64(),
        bench.time.as_secs_f64(),
        evaluations as f64 / bred.took.as_secs_f64(),
    ));
}

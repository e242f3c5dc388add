//! A recorded search gone through again: with its timings it makes the same candidates.

use std::cell::Cell;
use std::rc::Rc;

use evolve::{
    Individual, Memory, MemoryError, Objective, Observe, Outcome, Recorded, Settings, Stop,
    search_from,
};
use program::Graph;
use serde_json::json;

use super::ending::reason;
use super::evaluator::{NeverTimed, Nobody, Totals};
use super::progress::{Progress, Say};
use crate::arena::Arena;
use crate::progress::say;

/// What the first generation comes from beside the graph.
pub fn nurseries(graph: &Graph, arena: &Arena, settings: Settings) -> Vec<Graph> {
    match settings.objective {
        Objective::Speed => Vec::new(),
        Objective::Pareto => arena.nurseries(graph),
    }
}

/// Searches with recorded timings, and shows every generation. A search that makes other candidates than the recorded
/// one ends where it does.
pub fn search_again(
    graph: &Graph,
    arena: &Arena,
    settings: Settings,
    recorded: Recorded,
    observe: &mut impl Observe,
) -> Outcome<MemoryError<NeverTimed>> {
    let mut memory = Memory::replay(Nobody(arena), recorded);
    let nurseries = nurseries(graph, arena, settings);
    search_from(graph, &nurseries, settings, &mut memory, observe)
}

/// Searches with recorded timings, and says who is the fittest by them.
pub fn replay(
    graph: &Graph,
    arena: &Arena,
    settings: Settings,
    recorded: Recorded,
    json: bool,
) -> anyhow::Result<()> {
    let spent = Rc::new(Cell::new(Totals::default()));
    let say_each = if json { Say::Json } else { Say::Line };
    let mut progress = Progress::new(spent, settings, 0, None, say_each);
    let outcome = search_again(graph, arena, settings, recorded, &mut progress);
    progress.finish();
    if !json {
        say(&match &outcome.stop {
            Stop::Done => "the whole search was replayed".into(),
            stop => reason(stop),
        });
    }
    let (best, front) = match settings.objective {
        Objective::Speed => (outcome.best(1), None),
        Objective::Pareto => (outcome.front(), Some(outcome.front())),
    };
    if json {
        let described = |one: &&Individual| {
            json!({
                "source": one.candidate.source,
                "candidate": one.candidate.id,
                "ratio": one.weight(),
                "costs": one.evaluation.costs,
            })
        };
        println!(
            "{}",
            json!({
                "evaluations": outcome.evaluations,
                "stopped": reason(&outcome.stop),
                "best": best.first().map(described),
                "front": front.map(|front| front.iter().map(described).collect::<Vec<_>>()),
            })
        );
        return Ok(());
    }
    match best.first() {
        Some(best) => println!(
            "{} evaluations; the best is candidate {}, {:.2}x MT",
            outcome.evaluations,
            best.candidate.id,
            best.weight()
        ),
        None => println!("no generation was complete"),
    }
    for one in front.into_iter().flatten() {
        if let [error, leak] = one.evaluation.costs[..] {
            println!(
                "on the front: candidate {:4}, {:.2}x MT, t p99.99 {error:.1e}, leak {:.2}%",
                one.candidate.id,
                one.weight(),
                100.0 * leak
            );
        }
    }
    Ok(())
}

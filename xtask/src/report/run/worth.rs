//! What each choice of a champion is worth: the champion beside programs that make one choice otherwise, timed
//! together.

use std::collections::{HashMap, HashSet};

use emit::Kernel;
use measure::{Interrupt, Race, Rustc};
use program::{Genome, Graph, NodeId, Program};
use serde::Serialize;

use crate::arena::{Arena, Contestant};
use crate::evolve::source;
use crate::history::traits::{Change, changes, traits};
use crate::progress;
use crate::shootout::{Shootout, Standing, training_packets};

/// So many other options of a choice are tried at most, those of the fewest operations.
const OPTIONS: usize = 3;

/// So many programs are timed at most.
const MOST: usize = 72;

/// Parts that the timing is done in, for the bar.
const PARTS: usize = 10;

/// Of so many packets of the training half, one is timed on.
const EVERY: usize = 2;

/// The champion's name while it is timed.
const CHAMPION: &str = "champion";

/// All that was flipped.
#[derive(Clone, Debug, Serialize)]
pub struct Worth {
    /// Live choices of the champion that have several options.
    pub choices: usize,
    /// Those among them whose flips make no other program: what they decide is live for another's sake.
    pub bound: usize,
    /// The programs that were timed, the slowest first.
    pub flips: Vec<Flip>,
}

/// A program that makes a choice otherwise.
#[derive(Clone, Debug, Serialize)]
pub struct Flip {
    /// The choice's name in the graph.
    pub choice: String,
    /// The names of the champion's option and of the other one.
    pub options: [String; 2],
    /// In what the program differs then; the rest of a program follows a choice.
    pub changes: Vec<Change>,
    /// Its speed as a multiple of the champion's, and the relative uncertainty of that; none if it failed.
    pub speed: Option<(f64, f64)>,
    /// What became of it.
    pub verdict: &'static str,
}

impl Flip {
    /// Whether it is faster or slower than the champion by more than the noise.
    pub fn is_clear(&self) -> bool {
        let clear = |(speed, uncertainty): (f64, f64)| speed.ln().abs() > uncertainty;
        self.speed.is_some_and(clear)
    }
}

/// A flip that is to be timed.
pub struct Variant {
    flip: Flip,
    program: Program,
}

/// All flips of a genome that are worth a timing: a few options a choice, no two of the same source. Gives them with the
/// number of choices and of those that have none.
pub fn variants(graph: &Graph, genome: &Genome, arena: &Arena) -> (Vec<Variant>, usize, usize) {
    let Ok(own) = graph.program(genome) else {
        return (Vec::new(), 0, 0);
    };
    let chosen = traits(&own);
    let mut seen = HashSet::from([source(&arena.kernels(&own))]);
    let order = graph.statements(genome);
    let (mut found, mut choices, mut bound) = (Vec::new(), 0, 0);
    for decided in graph.choices(genome) {
        let options = &graph.node(decided.choice).optional;
        if options.len() < 2 {
            continue;
        }
        choices += 1;
        let others = options.iter().filter(|&&other| other != decided.option);
        let flipped = others.filter_map(|&other| {
            let mut genome = genome.clone();
            genome.swap(decided.option.index(), other.index());
            let program = in_order(graph, genome, &order, [decided.option, other])?;
            let work = emit::operations(&program, &arena.scene);
            Some((work, other, program))
        });
        let mut flipped: Vec<(f64, NodeId, Program)> = flipped.collect();
        flipped.sort_by(|a, b| a.0.total_cmp(&b.0));
        let before = found.len();
        for (_, other, program) in flipped {
            if found.len() - before == OPTIONS || found.len() == MOST {
                break;
            }
            if !seen.insert(source(&arena.kernels(&program))) {
                continue;
            }
            let name = |id: NodeId| graph.node(id).name.to_string();
            found.push(Variant {
                flip: Flip {
                    choice: name(decided.choice),
                    options: [name(decided.option), name(other)],
                    changes: changes(&chosen, &traits(&program)),
                    speed: None,
                    verdict: "not timed",
                },
                program,
            });
        }
        bound += usize::from(found.len() == before);
    }
    (found, choices, bound)
}

/// The program of a flipped genome with its statements as near to `order` as they can be, the flipped option at the
/// place of the other one: what a statement needs and was not there before comes right before it. By its priorities alone
/// that would come anywhere, and what the order is worth would be taken for what the choice is.
fn in_order(
    graph: &Graph,
    flipped: Genome,
    order: &[NodeId],
    [own, other]: [NodeId; 2],
) -> Option<Program> {
    let program = graph.program(&flipped).ok()?;
    let ids = graph.statements(&flipped);
    let numbered = ids.iter().enumerate();
    let places: HashMap<NodeId, usize> = numbered.map(|(place, &id)| (id, place)).collect();
    let named = |&id: &NodeId| places.get(if id == own { &other } else { &id });
    let mut wanted: Vec<usize> = Vec::new();
    for &place in order.iter().filter_map(named) {
        put(&program, place, &mut wanted);
    }
    for place in 0..ids.len() {
        put(&program, place, &mut wanted);
    }
    let wanted: Vec<NodeId> = wanted.into_iter().map(|place| ids[place]).collect();
    let genome = flipped.preferring(&wanted);
    // Raised above all others, two live options of a choice may change places.
    match graph.statements(&genome) == wanted {
        true => graph.program(&genome).ok(),
        false => Some(program),
    }
}

/// Appends a statement behind what it works on, unless it is there.
fn put(program: &Program, place: usize, order: &mut Vec<usize>) {
    if order.contains(&place) {
        return;
    }
    for &operand in &program.statements()[place].operands {
        put(program, operand as usize, order);
    }
    order.push(place);
}

impl Worth {
    /// Times the flips of a champion beside it. The error says in a sentence why there are none.
    pub fn of(
        graph: &Graph,
        genome: &Genome,
        arena: &Arena,
        rustc: &Rustc,
        interrupt: &Interrupt,
    ) -> anyhow::Result<Worth> {
        let (variants, choices, bound) = variants(graph, genome, arena);
        let own = graph.program(genome)?;
        let mut contestants = vec![contestant(CHAMPION.into(), arena.kernels(&own))];
        let numbered = variants.iter().enumerate();
        contestants.extend(numbered.map(|(number, variant)| {
            contestant(number.to_string(), arena.kernels(&variant.program))
        }));
        let what = format!("timing {} flips of the champion's choices", variants.len());
        // Building takes about as long as two parts.
        let bar = progress::bar(PARTS + 2, &what);
        let mut bench = arena.bench(rustc, interrupt)?;
        let all: Vec<&Contestant> = contestants.iter().collect();
        let packets = training_packets().step_by(EVERY);
        let mut shootout = Shootout::new(&mut bench, &all, packets)?;
        bar.inc(2);
        for _ in 0..PARTS {
            shootout.time_part(&mut bench, PARTS)?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        let standings = shootout.standings();
        let standing = |name: &str| standings.iter().find(|one| one.kernel == name);
        let champion = standing(CHAMPION).map_or(&[][..], |one| &one.rounds);
        let race = Race {
            ratios: champion.to_vec(),
            every: 1,
        };
        let flips = variants.into_iter().enumerate().map(|(number, variant)| {
            let standing = standing(&number.to_string());
            Flip {
                speed: standing.and_then(|one| speed(&race, one)),
                verdict: standing.map_or("not timed", |one| one.verdict),
                ..variant.flip
            }
        });
        let mut flips: Vec<Flip> = flips.collect();
        // Failures last.
        let place = |flip: &Flip| flip.speed.map_or(f64::INFINITY, |(speed, _)| speed);
        flips.sort_by(|a, b| place(a).total_cmp(&place(b)));
        Ok(Worth {
            choices,
            bound,
            flips,
        })
    }
}

/// The speed of a flip as a multiple of the champion's with the uncertainty of that, round by round.
fn speed(champion: &Race, flip: &Standing) -> Option<(f64, f64)> {
    let lead = champion.lead(&flip.rounds)?;
    let speed = lead.mean.exp();
    speed.is_finite().then_some((speed, 1.96 * lead.error))
}

fn contestant(name: String, kernels: Vec<Kernel>) -> Contestant {
    Contestant { name, kernels }
}

#[cfg(test)]
mod tests {
    use emit::Isa;
    use program::{appendix, kensler_shirley};
    use scene::SceneModel;

    use super::*;
    use crate::isas::Isas;

    #[test]
    fn every_flip_is_another_kernel_and_says_in_what() {
        let arena = Arena {
            scene: SceneModel::preset("packet").unwrap(),
            isas: Isas(vec![Isa::Sse2]),
            triangles: 500,
        };
        let graph = kensler_shirley();
        let genome = appendix(&graph);
        let (variants, choices, bound) = variants(&graph, &genome, &arena);
        assert!((10..=MOST).contains(&variants.len()), "{}", variants.len());
        assert!(bound < choices, "{bound} of {choices}");
        let sources: HashSet<String> = variants
            .iter()
            .map(|variant| source(&arena.kernels(&variant.program)))
            .collect();
        assert_eq!(sources.len(), variants.len());
        let divides = |variant: &Variant| {
            let mut changes = variant.flip.changes.iter();
            changes.any(|change| change.question == "1 / V" && change.to == ["by division"])
        };
        assert!(variants.iter().any(divides));
    }

    #[test]
    fn what_a_flip_does_not_touch_keeps_its_order() {
        let graph = kensler_shirley();
        let genome = appendix(&graph);
        let order = graph.statements(&genome);
        let [own, other] = ["reciprocal.newton", "reciprocal.exact"]
            .map(|name| graph.find(name).expect("it is a node of the graph"));
        let mut flipped = genome.clone();
        flipped.swap(own.index(), other.index());
        let program = in_order(&graph, flipped, &order, [own, other]).unwrap();
        let before = graph.program(&genome).unwrap();
        let names = |program: &Program| -> Vec<String> {
            let statements = program.statements().iter();
            statements
                .map(|one| one.op.to_string().replace("newton", "exact"))
                .collect()
        };
        // A division needs a one, which comes right before it.
        let mut expected = names(&before);
        let division = expected.iter().position(|name| name == "reciprocal.exact");
        expected.insert(division.unwrap(), "one".into());
        assert_eq!(names(&program), expected);
    }

    #[test]
    fn a_flip_is_compared_with_the_champion_round_by_round() {
        let race = Race {
            ratios: vec![1.0, 2.0, 4.0, 1.0],
            every: 1,
        };
        let flip = Standing {
            rounds: vec![0.9, 1.8, 3.6, 0.9],
            ..Standing::failed("0", "timed")
        };
        let (ratio, uncertainty) = speed(&race, &flip).unwrap();
        assert!((ratio - 0.9).abs() < 1e-9 && uncertainty < 1e-9);
        assert_eq!(speed(&race, &Standing::failed("0", "crashed")), None);
    }
}

//! The step from GA to GA+: a program with the cheapest formulation that is nearest to its own.

use volumes::{Case, Cost, Formulation, Model, cheapest};

use crate::rules::Rules;
use crate::statements::Program;

/// What became of a program.
#[derive(Clone, Debug)]
pub struct Improvement {
    /// The cheapest formulation that is nearest to the program's own; none if no formulation is
    /// cheaper than what the program has.
    pub formulation: Option<Formulation>,
    /// How many formulations were tried in the program.
    pub tried: usize,
    /// The program with that formulation, and what is dead still in it.
    pub rewritten: Program,
    /// Without what is dead.
    pub clean: Program,
    /// With the mask begun by the first test.
    pub finished: Program,
    /// What the program cost.
    pub before: Cost,
    /// What it costs now.
    pub after: Cost,
    /// Of both, what the volumes cost.
    pub of_volumes: [Cost; 2],
}

/// The sets of volumes that a test may compute directly: `Va` and any three of the others.
const SETS: [[volumes::Volume; 4]; 4] = [
    Formulation::WITH_V,
    Formulation::WITH_V0,
    Formulation::WITHOUT_V1,
    Formulation::WITHOUT_V2,
];

/// The cheapest formulations of a case, to improve programs with.
#[derive(Clone, Debug)]
pub struct Optimum {
    case: Case,
    model: Model,
    formulations: Vec<Formulation>,
}

impl Optimum {
    /// Counts the operations of all formulations, of every set of volumes.
    pub fn new(case: Case, model: Model) -> Optimum {
        let formulations = SETS.map(|volumes| cheapest(case, &model, volumes).formulations);
        Optimum {
            case,
            model,
            formulations: formulations.concat(),
        }
    }

    /// Gives a program the formulation that makes it cheapest, of those that the rules allow; if there are
    /// several, the one that changes the fewest statements. Its structure, which is its divisions, tests,
    /// exits and their order, stays. Volumes of a sheared ray are no formulation's, and stay as they are.
    pub fn improve(&self, program: &Program, rules: &Rules) -> Improvement {
        let cost = |program: &Program| program.cost(self.case, &self.model);
        let formulations: &[Formulation] = match program.is_sheared() {
            true => &[],
            false => &self.formulations,
        };
        let tried = formulations.iter().filter_map(|formulation| {
            let rewritten = program.with_formulation(formulation);
            let clean = rewritten.without_dead();
            let order = (cost(&clean).units, program.changes(&clean));
            let is_allowed = clean.breaks(rules).is_none();
            is_allowed.then_some((order, *formulation, rewritten, clean))
        });
        let before = cost(program);
        let best = tried.min_by_key(|(order, ..)| *order);
        let better = best.filter(|((units, _), ..)| *units < before.units);
        let formulation = better.as_ref().map(|(_, formulation, ..)| *formulation);
        let (rewritten, clean) = match better {
            Some((_, _, rewritten, clean)) => (rewritten, clean),
            None => (program.clone(), program.without_dead()),
        };
        let finished = clean.beginning_with_first_test();
        Improvement {
            formulation,
            tried: formulations.len(),
            after: cost(&finished),
            of_volumes: [program, &finished].map(|one| one.cost_of_volumes(self.case, &self.model)),
            rewritten,
            clean,
            finished,
            before,
        }
    }
}

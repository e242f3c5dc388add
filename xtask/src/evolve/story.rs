//! The story of a search in a few lines: how it rose, where its champion comes from, what that has chosen and how many
//! of the survivors chose the same.

use std::collections::BTreeMap;

use evolve::Individual;
use program::Program;

use crate::history::ancestry::{Step, line};
use crate::history::course::Course;
use crate::history::traits::{Topic, Trait, traits};
use crate::history::{History, Tried};

/// Numbers of evaluations at which the best so far is told.
const MARKS: [u64; 4] = [30, 100, 300, 1000];

/// Two kernels so near to each other are seldom told apart.
const NEARLY: f64 = 0.98;

/// Who won.
pub struct Champion<'a> {
    /// The hash of its source.
    pub source: String,
    /// What it is.
    pub program: &'a Program,
}

/// The lines, each with its heading.
pub fn lines(history: &History, champion: &Champion<'_>, elite: &[Individual]) -> Vec<String> {
    let mut lines = vec![format!("course     {}", course(&Course::of(history)))];
    let first = history.first_of(&champion.source);
    lines.extend(first.map(|first| format!("descent    {}", descent(history, first))));
    let elite: Vec<_> = elite
        .iter()
        .map(|one| traits(&one.candidate.program))
        .collect();
    let share = |own: &Trait| {
        let same = elite.iter().filter(|theirs| theirs.contains(own)).count();
        same as f64 / elite.len().max(1) as f64
    };
    lines.extend(chosen(traits(champion.program), share));
    lines
}

/// The best so far at some marks, and from when on it rose no more than timings are apart.
fn course(course: &Course) -> String {
    let Some(&(evaluations, last)) = course.best.last() else {
        return "nobody was timed".into();
    };
    let marks = MARKS.into_iter().filter(|mark| *mark < evaluations);
    let best_at = |mark: u64| {
        let before = course.best.iter().take_while(|(at, _)| *at <= mark);
        before.last().map(|(_, fitness)| (mark, *fitness))
    };
    let told = marks.filter_map(best_at).chain([(evaluations, last)]);
    let told: Vec<String> = told
        .map(|(at, best)| format!("{best:.2}x after {at}"))
        .collect();
    let near = course.reached(NEARLY).unwrap_or(evaluations);
    format!(
        "{}; within 2% of that after {near} evaluations",
        told.join(", ")
    )
}

/// How many steps there were from the random ancestor, by which operators, and which was the widest.
fn descent(history: &History, champion: &Tried) -> String {
    let steps = line(history, champion.id, |_| None);
    let Some((ancestor, bred)) = steps.split_first() else {
        return "not in the journal".into();
    };
    let begin = match ancestor.fitness {
        Some(fitness) => format!(
            "candidate {}, {} of {fitness:.2}x",
            ancestor.id, ancestor.operator
        ),
        None => format!("candidate {}, {}", ancestor.id, ancestor.operator),
    };
    let mut operators: BTreeMap<&str, usize> = BTreeMap::new();
    for step in bred {
        *operators.entry(step.operator).or_default() += 1;
    }
    let mut operators: Vec<(&str, usize)> = operators.into_iter().collect();
    operators.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    let operators: Vec<String> = operators
        .into_iter()
        .map(|(operator, count)| format!("{count} by {operator}"))
        .collect();
    let widest = bred
        .iter()
        .filter(|step| step.gain.is_some_and(|gain| gain > 1.0));
    let widest = widest.max_by(|a, b| gain(a).total_cmp(&gain(b)));
    let widest = widest.map_or(String::new(), |step| {
        format!(
            "; the widest, {} {}, was worth {:.0}%",
            step.operator,
            step.id,
            100.0 * (gain(step) - 1.0)
        )
    });
    match bred.len() {
        0 => begin,
        count => format!(
            "{count} steps from {begin}: {}{widest}",
            operators.join(", ")
        ),
    }
}

fn gain(step: &Step) -> f64 {
    step.gain.unwrap_or(1.0)
}

/// A line for what the champion chose of each topic, with how many of the elite chose the same.
fn chosen(own: impl IntoIterator<Item = Trait>, share: impl Fn(&Trait) -> f64) -> Vec<String> {
    let mut topics: BTreeMap<Topic, Vec<String>> = BTreeMap::new();
    for one in own {
        let percent = 100.0 * share(&one);
        let answer = match one.topic {
            // The heading is the question.
            Topic::Exit | Topic::Order => one.option,
            _ => format!("{} {}", one.question, one.option),
        };
        let answers = topics.entry(one.topic).or_default();
        answers.push(format!("{answer} ({percent:.0}%)"));
    }
    topics
        .into_iter()
        .filter_map(|(topic, answers)| {
            Some(format!("{:10} {}", heading(topic)?, answers.join("; ")))
        })
        .collect()
}

/// What a topic is called here; nothing for what is told of in the champion's own code.
fn heading(topic: Topic) -> Option<&'static str> {
    match topic {
        Topic::Formulation => Some("volumes"),
        Topic::Division => Some("division"),
        Topic::Exit => Some("exits"),
        Topic::Order => Some("tests"),
        Topic::Test | Topic::Writing => None,
    }
}

#[cfg(test)]
mod tests {
    use program::{appendix, kensler_shirley};

    use super::*;
    use crate::history::example::new;

    #[test]
    fn a_search_is_told_in_lines_with_headings() {
        let graph = kensler_shirley();
        let program = graph.program(&appendix(&graph)).unwrap();
        let mut journal: Vec<_> = (0..30)
            .map(|id| new(id, 0, r#""random""#, &format!("random {id}"), 1.0))
            .collect();
        journal.push(new(30, 1, r#""crossover","parents":[2,1]"#, "better", 1.5));
        journal.push(new(31, 2, r#""slide","parent":30"#, "best", 1.52));
        journal.push(new(32, 3, r#""flip","parent":31"#, "worse", 1.2));
        let champion = Champion {
            source: "best".into(),
            program: &program,
        };
        let lines = lines(&History::of(&journal), &champion, &[]);
        assert_eq!(
            lines[..2],
            [
                "course     1.00x after 30, 1.52x after 33; within 2% of that after 31 evaluations",
                "descent    2 steps from candidate 2, random of 1.00x: 1 by crossover, 1 by slide; \
                 the widest, crossover 30, was worth 50%",
            ]
        );
        let division = lines.iter().find(|line| line.starts_with("division"));
        assert!(
            division
                .unwrap()
                .contains("1 / V by an estimate and a Newton step (0%)")
        );
        for heading in ["volumes", "exits", "tests"] {
            assert!(
                lines.iter().any(|line| line.starts_with(heading)),
                "{lines:?}"
            );
        }
    }

    #[test]
    fn of_a_search_that_timed_nobody_there_is_little_to_tell() {
        assert_eq!(course(&Course::of(&History::of(&[]))), "nobody was timed");
    }
}

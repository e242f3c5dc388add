//! Which answers to the graph's choices survived: the share of the elite that has each, stretch by stretch of the run.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::replayed::Alive;
use crate::history::traits::{Topic, Trait};

/// Into so many stretches a run is cut at most.
const STRETCHES: usize = 12;

/// So many answers to a question have a row of their own at most.
const ROWS: usize = 5;

/// An answer that was never so frequent has no row of its own.
const RARE: f64 = 0.1;

/// The shares of all answers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Survivors {
    /// The generations of each column, first and last; the first column is the random generation.
    pub stretches: Vec<(usize, usize)>,
    /// The questions.
    pub questions: Vec<Question>,
}

/// A question with its answers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Question {
    /// What it is about.
    pub topic: Topic,
    /// The question.
    pub question: String,
    /// The answers, the most frequent at the end first.
    pub rows: Vec<Row>,
}

/// An answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The answer.
    pub option: String,
    /// The share that has it, stretch by stretch.
    pub shares: Vec<f64>,
    /// Whether the champion has it.
    pub is_champions: bool,
}

impl Survivors {
    /// Those of a run. `traits` says what a candidate has chosen.
    pub fn of<'a>(
        generations: &[Alive],
        champion: Option<&BTreeSet<Trait>>,
        traits: impl Fn(u64) -> Option<&'a BTreeSet<Trait>>,
    ) -> Survivors {
        let columns = columns(generations);
        let mut shares: BTreeMap<&Trait, Vec<f64>> = BTreeMap::new();
        for (place, column) in columns.iter().enumerate() {
            for generation in *column {
                let part = 1.0 / (generation.elite.len().max(1) * column.len()) as f64;
                for chosen in generation.elite.iter().filter_map(|&id| traits(id)) {
                    for one in chosen.iter().filter(|one| one.topic != Topic::Writing) {
                        let all = || vec![0.0; columns.len()];
                        shares.entry(one).or_insert_with(all)[place] += part;
                    }
                }
            }
        }
        let has = |one: &Trait| champion.is_some_and(|champion| champion.contains(one));
        let mut questions: Vec<Question> = Vec::new();
        for (one, shares) in shares {
            let row = Row {
                option: one.option.clone(),
                shares,
                is_champions: has(one),
            };
            match questions.last_mut() {
                Some(last) if last.question == one.question => last.rows.push(row),
                _ => questions.push(Question {
                    topic: one.topic,
                    question: one.question.clone(),
                    rows: vec![row],
                }),
            }
        }
        questions.retain(Question::is_one);
        for question in &mut questions {
            question.shorten();
        }
        let numbers = |column: &&[Alive]| Some((column.first()?.number, column.last()?.number));
        Survivors {
            stretches: columns.iter().filter_map(numbers).collect(),
            questions,
        }
    }
}

impl Question {
    /// Whether there was anything to choose, and an answer that more than a few survivors had.
    fn is_one(&self) -> bool {
        let always = |row: &Row| row.shares.iter().all(|share| *share > 0.999);
        let is_told = |row: &Row| row.is_champions || row.most() >= RARE;
        !self.rows.iter().all(always) && self.rows.iter().any(is_told)
    }

    /// Puts the most frequent first, and the rare ones together.
    fn shorten(&mut self) {
        self.rows.sort_by(|a, b| {
            let backwards = |row: &Row| row.shares.iter().rev().copied().collect::<Vec<f64>>();
            backwards(b)
                .partial_cmp(&backwards(a))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let mut own = 0;
        let (kept, others): (Vec<Row>, Vec<Row>) = self.rows.drain(..).partition(|row| {
            let keeps = row.is_champions || own < ROWS && row.most() >= RARE;
            own += usize::from(keeps);
            keeps
        });
        self.rows = kept;
        // Of answers that go together, a sum would say nothing.
        if self.topic == Topic::Exit || others.is_empty() {
            return;
        }
        let columns = others[0].shares.len();
        let sum = |column: usize| others.iter().map(|row| row.shares[column]).sum();
        self.rows.push(Row {
            option: match others.as_slice() {
                [one] => one.option.clone(),
                several => format!("{} others", several.len()),
            },
            shares: (0..columns).map(sum).collect(),
            is_champions: false,
        });
    }
}

impl Row {
    /// The greatest share after the random generation, which has all answers a few times; of that if there is no other.
    fn most(&self) -> f64 {
        let later = self.shares.get(1..).filter(|later| !later.is_empty());
        let shares = later.unwrap_or(&self.shares).iter().copied();
        shares.fold(0.0, f64::max)
    }
}

/// The random generation, and the others in stretches of about the same length.
fn columns(generations: &[Alive]) -> Vec<&[Alive]> {
    let begin = generations.iter().take_while(|one| one.number == 0).count();
    let (random, bred) = generations.split_at(begin);
    let count = bred.len().min(STRETCHES);
    let cut = |place: usize| place * bred.len() / count;
    let stretches = (0..count).map(|place| &bred[cut(place)..cut(place + 1)]);
    let random = (!random.is_empty()).then_some(random);
    random.into_iter().chain(stretches).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(question: &str, option: &str) -> Trait {
        Trait {
            topic: Topic::Division,
            question: question.into(),
            option: option.into(),
        }
    }

    fn alive(number: usize, elite: &[u64]) -> Alive {
        Alive {
            number,
            elite: elite.to_vec(),
        }
    }

    #[test]
    fn shares_are_of_the_elite_and_the_champions_answer_is_marked() {
        let exact = BTreeSet::from([answer("1 / V", "exact"), answer("t", "Va / V")]);
        let newton = BTreeSet::from([answer("1 / V", "newton"), answer("t", "Va / V")]);
        let traits = |id: u64| Some(if id < 10 { &exact } else { &newton });
        let generations = [
            alive(0, &[1, 2, 3, 11]),
            alive(1, &[1, 11]),
            alive(2, &[10, 11]),
        ];
        let survivors = Survivors::of(&generations, Some(&newton), traits);
        assert_eq!(survivors.stretches, [(0, 0), (1, 1), (2, 2)]);
        // All have the same t, so nothing was chosen there.
        let [question] = survivors.questions.as_slice() else {
            panic!("{:?}", survivors.questions);
        };
        let rows: Vec<(&str, &[f64], bool)> = question
            .rows
            .iter()
            .map(|row| (row.option.as_str(), row.shares.as_slice(), row.is_champions))
            .collect();
        assert_eq!(
            rows,
            [
                ("newton", &[0.25, 0.5, 1.0][..], true),
                ("exact", &[0.75, 0.5, 0.0][..], false),
            ]
        );
    }

    #[test]
    fn a_long_run_is_cut_into_stretches_and_rare_answers_are_put_together() {
        let generations: Vec<Alive> = (0..=100)
            .map(|number| alive(number, &[number as u64]))
            .collect();
        let all: Vec<BTreeSet<Trait>> = (0..=100)
            .map(|number: u32| {
                let option = if number < 60 {
                    format!("rare {number}")
                } else {
                    "the one".into()
                };
                BTreeSet::from([answer("V", &option)])
            })
            .collect();
        let survivors = Survivors::of(&generations, None, |id| all.get(id as usize));
        assert_eq!(survivors.stretches.len(), 1 + STRETCHES);
        assert_eq!(survivors.stretches[1], (1, 8));
        assert_eq!(survivors.stretches[STRETCHES].1, 100);
        let rows = &survivors.questions[0].rows;
        assert_eq!(rows[0].option, "the one");
        assert!(rows[0].shares[STRETCHES] > 0.999);
        assert!(rows.len() <= ROWS + 1 && rows.last().unwrap().option.ends_with("others"));
        for column in 0..=STRETCHES {
            let sum: f64 = rows.iter().map(|row| row.shares[column]).sum();
            assert!((sum - 1.0).abs() < 1e-9, "{column}: {sum}");
        }
    }
}

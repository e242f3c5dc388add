//! What comes out of a search for a front: who is still on it by figures that no candidate was chosen by, and the
//! table of them.

use accuracy::Rate;
use evolve::{Individual, Outcome, pareto};
use measure::MeasureError;
use serde::Serialize;

use super::costs::{CONFIRMING, costs};
use crate::arena::{Arena, Contestant};
use crate::benches::Benches;
use crate::shootout::{Standing, shootout_and_trial};

/// How many meet at the end. The search timed its candidates in a hurry: who is hardly beaten by its figures
/// need not be by better ones.
const CONTENDERS: usize = 16;

/// Those who may be on the front.
pub struct Front<'a>(Vec<&'a Individual>);

/// Somebody who met the front's members in the shoot-out: one of them, or a rival.
#[derive(Clone, Debug, Serialize)]
pub struct Member {
    /// Its place on the front, from 1 on; none if another one beats it in everything.
    pub number: Option<usize>,
    /// The number of the candidate; none for a rival.
    pub candidate: Option<u64>,
    /// How it did on the full workload, and in the trial by held-out rays.
    #[serde(flatten)]
    pub standing: Standing,
}

impl<'a> Front<'a> {
    /// The front of an outcome by the figures of the search, and those behind it.
    pub fn of<E>(outcome: &'a Outcome<E>) -> Front<'a> {
        Front(outcome.fronts(CONTENDERS))
    }

    /// Times everyone on the full workload beside the rivals that a champion has to beat, and tries them by held-out
    /// rays. Gives them the fastest first; rivals have no place on the front, and failures none either.
    pub fn confirm(&self, arena: &Arena, bench: &mut Benches) -> Result<Vec<Member>, MeasureError> {
        let Front(individuals) = self;
        let own = individuals.iter().map(|one| Contestant {
            name: one.candidate.id.to_string(),
            kernels: arena.kernels(&one.candidate.program),
        });
        let contestants: Vec<Contestant> = own.chain(arena.papers_own()).collect();
        let standings = shootout_and_trial(bench, &contestants, CONFIRMING)?;
        let members = standings.into_iter().map(|standing| Member {
            number: None,
            candidate: standing.kernel.parse().ok(),
            standing,
        });
        Ok(numbered(members.collect()))
    }

    /// Who a member is.
    pub fn individual(&self, member: &Member) -> Option<&'a Individual> {
        let mut individuals = self.0.iter().copied();
        individuals.find(|one| Some(one.candidate.id) == member.candidate)
    }
}

/// Gives candidates that no other candidate beats their numbers.
fn numbered(mut members: Vec<Member>) -> Vec<Member> {
    let point = |member: &Member| {
        member.candidate?;
        let tried = member.standing.accuracy?.tried?;
        let time = member.standing.ratio.recip();
        Some([vec![time], costs(tried)].concat())
    };
    let (places, points): (Vec<usize>, Vec<Vec<f64>>) = members
        .iter()
        .enumerate()
        .filter_map(|(place, member)| Some((place, point(member)?)))
        .unzip();
    for (number, place) in (1..).zip(pareto::front(&points)) {
        members[places[place]].number = Some(number);
    }
    members
}

/// Prints the front, and the rivals for comparison.
pub fn print(members: &[Member], p99_limit: f64) {
    println!(
        "  no.  kernel              ratio to MT  unseen packets  t error: p99  p99.99  leak of rays at edges and vertices"
    );
    let is_shown = |member: &&Member| member.number.is_some() || member.candidate.is_none();
    let mut unfit = false;
    for member in members.iter().filter(is_shown) {
        let Standing {
            kernel,
            ratio,
            uncertainty,
            unseen,
            ..
        } = &member.standing;
        let Some((accuracy, tried)) = member
            .standing
            .accuracy
            .and_then(|accuracy| Some((accuracy, accuracy.tried?)))
        else {
            println!("    -  {kernel:18}  {}", member.standing.verdict);
            continue;
        };
        let mark = match member.number {
            Some(_) if accuracy.p99 > p99_limit => {
                unfit = true;
                "*"
            }
            _ => " ",
        };
        println!(
            "{:>5}{mark} {:18}  {ratio:5.2}x ±{:3.1}%  {unseen:13.2}x  {:12.1e}  {:6.1e}  {}",
            member
                .number
                .map_or("-".to_owned(), |number| number.to_string()),
            member
                .candidate
                .map_or(kernel.clone(), |id| format!("candidate {id}")),
            uncertainty * 100.0,
            accuracy.p99,
            tried.t_p9999,
            leak(tried.leak),
        );
    }
    if unfit {
        println!(
            "*: p99 of the error of t is above {p99_limit:.0e}, the most that the library takes"
        );
    }
    let beaten = members.iter().filter(|member| !is_shown(member)).count();
    if beaten > 0 {
        println!(
            "{beaten} more met with these, on or behind the front by the figures of the search, and are beaten"
        );
    }
}

fn leak(rate: Rate) -> String {
    match rate.bound_of_zero() {
        Some(bound) => format!("none of {}, so below {bound:.0e}", rate.samples),
        None => format!("{:.3}% of {}", 100.0 * rate.share(), rate.samples),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accuracy::Tried;
    use measure::Accuracy;

    fn member(candidate: Option<u64>, ratio: f64, t_p9999: f64, leaks: u64) -> Member {
        let accuracy: Accuracy = serde_json::from_value(serde_json::json!({
            "hits": 1, "median": 0.0, "p99": 0.0, "max": 0.0,
        }))
        .unwrap();
        let tried = Tried {
            t_p9999,
            leak: Rate {
                events: leaks,
                samples: 1000,
            },
        };
        Member {
            number: None,
            candidate,
            standing: Standing {
                ratio,
                accuracy: Some(Accuracy {
                    tried: Some(tried),
                    ..accuracy
                }),
                ..Standing::failed("some", "timed")
            },
        }
    }

    #[test]
    fn numbers_are_for_candidates_that_no_candidate_beats() {
        let members = vec![
            member(Some(9), 2.5, 4e-7, 100),
            member(None, 2.4, 1e-9, 0),
            member(Some(4), 2.3, 5e-7, 100),
            member(Some(7), 2.2, 1e-7, 100),
            member(Some(1), 1.1, 4e-7, 0),
        ];
        let numbers = numbered(members).into_iter().map(|member| member.number);
        assert!(numbers.eq([Some(1), None, None, Some(2), Some(3)]));
    }
}

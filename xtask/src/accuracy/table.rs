//! What was found, as tables for people: one for each case of scene and instruction set, a row a kernel.

use accuracy::{PairCase, Passage, Rate, Scaling};
use measure::Judged;

use super::Profiled;
use super::tags::Tags;
use crate::cases::Identity;

/// Prints all tables.
pub fn print(profiled: &[Profiled]) {
    if profiled.is_empty() {
        println!("nothing was judged");
    }
    let key = |one: &Profiled| {
        (
            one.of.grouping.clone(),
            one.of.origin.clone(),
            one.of.isa.clone(),
        )
    };
    for of_case in profiled.chunk_by(|a, b| key(a) == key(b)) {
        print_table(of_case);
    }
}

fn print_table(profiled: &[Profiled]) {
    let Identity {
        grouping,
        origin,
        isa,
        ..
    } = &profiled[0].of;
    println!("\n{grouping}, {origin} origin, {isa}:");
    let names = profiled.iter().map(|one| one.of.kernel.len());
    let width = names.max().unwrap_or(0).max(6);
    println!(
        "{:width$}  {:^31}  {:^20}  {:^17}  {:^9}  {:>9}  by its",
        "", "rays at shared edges, vertices", "wrong at extremes", "error of t", "scales", "not"
    );
    println!(
        "{:width$}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}  {:>8}  {:>7}  {:>9}  {:>9}  statements",
        "kernel", "leak", "leak", "double", "missed", "false", "p99.99", "far p99", "2^", "finite"
    );
    for one in profiled {
        match &one.judged {
            Some(judged) => {
                let tags = one.tags.as_ref().map_or("-".into(), Tags::words);
                println!("{:width$}  {}  {tags}", one.of.kernel, row(judged));
            }
            None => println!("{:width$}  {}", one.of.kernel, one.verdict),
        }
    }
    println!(
        "\"<\": none was seen, and the share is below that with a confidence of 95%. p99.99: relative, at \
         ordinary triangles; far: at 1e3 to 2e5 from the origin. scales: everything times 2^k changes no verdict. \
         not finite: reported hits of NaN and infinities, or other rays that they changed. by its statements: \
         where a program cannot leak, and scales that are safe for certain; -: there is no program"
    );
}

fn row(judged: &Judged) -> String {
    let leaks = || judged.leaks.iter().map(|case| case.leaks);
    let edges = leaks().map(|one| one.edge.leak).sum();
    let vertices = leaks().map(|one| one.vertex.leak).sum();
    let doubles = |passage: Passage| passage.double;
    let doubles = leaks().flat_map(|one| [one.edge, one.vertex].map(doubles));
    let counts = || judged.profiles.iter().map(|case| case.profile.counts);
    let missed = counts().map(|one| one.missed).sum();
    let wrong = counts().flat_map(|one| [one.false_hit, one.parallel_hit]);
    let of_case = |case: PairCase| {
        let mut all = judged.profiles.iter();
        let found = all.find(|one| one.case == case)?;
        found.profile.relative_error
    };
    let error = |figure: Option<f64>| figure.map_or("-".into(), |error| format!("{error:.1e}"));
    let tail = error(of_case(PairCase::Ordinary).map(|errors| errors.p9999));
    let far = error(of_case(PairCase::Far).map(|errors| errors.p99));
    let everything = judged
        .scales
        .iter()
        .find(|(scaling, ..)| *scaling == Scaling::Everything);
    let scales = everything.map_or("-".into(), |(_, least, most)| format!("{least}..{most}"));
    let hostile = judged.hostile;
    let hostile: Rate = [
        hostile.ray_hit,
        hostile.triangle_hit,
        hostile.inactive_hit,
        hostile.disturbed,
    ]
    .into_iter()
    .sum();
    format!(
        "{:>9}  {:>9}  {:>9}  {:>9}  {:>9}  {tail:>8}  {far:>7}  {scales:>9}  {:>9}",
        share(edges),
        share(vertices),
        share(doubles.sum()),
        share(missed),
        share(wrong.sum()),
        if hostile.events == 0 {
            "ok".into()
        } else {
            share(hostile)
        },
    )
}

/// A share for people; of nothing, what it is below.
fn share(rate: Rate) -> String {
    match rate.bound_of_zero() {
        Some(bound) => format!("<{bound:.0e}"),
        None if rate.samples == 0 => "-".into(),
        None if rate.share() < 1e-3 => format!("{:.1e}", rate.share()),
        None => format!("{:.1}%", 100.0 * rate.share()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_of_nothing_says_how_little_that_may_be() {
        let rate = |events, samples| share(Rate { events, samples });
        assert_eq!(rate(0, 300_000), "<1e-5");
        assert_eq!(rate(0, 0), "-");
        assert_eq!(rate(3, 100_000), "3.0e-5");
        assert_eq!(rate(65, 1000), "6.5%");
    }
}

//! What was found, as tables for people: one for each case of scene and instruction set, a row a kernel.

use accuracy::{PairCase, Rate};
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
        "{:width$}  {:^31}  {:^20}  {:^17}  {:>7}  {:^9}  {:>9}  by its",
        "",
        "rays at shared edges, vertices",
        "wrong at extremes",
        "error of t",
        "of u, v",
        "scales",
        "not"
    );
    println!(
        "{:width$}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}  {:>8}  {:>7}  {:>7}  {:>9}  {:>9}  statements",
        "kernel",
        "leak",
        "leak",
        "double",
        "missed",
        "false",
        "p99.99",
        "far p99",
        "p99.99",
        "2^",
        "finite"
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
        "\"<\": none was seen, and the share is below that with a confidence of 95%. p99.99: relative, of u and v \
         absolute where they are reported (--outputs uv), at ordinary triangles; far: at 1e3 to 2e5 from the origin. \
         scales: everything times 2^k changes no verdict, nor t. not finite: reported hits of NaN and infinities, or other \
         rays that they changed. by its statements: where a program cannot leak, and scales that are safe for certain; \
         -: there is no program"
    );
}

fn row(judged: &Judged) -> String {
    let error = |figure: Option<f64>| figure.map_or("-".into(), |error| format!("{error:.1e}"));
    let ordinary = judged.profile(PairCase::Ordinary);
    let far = judged.profile(PairCase::Far);
    let tail = error(ordinary.and_then(|one| Some(one.relative_error?.p9999)));
    let uv = error(ordinary.and_then(|one| Some(one.uv_error?.p9999)));
    let far = error(far.and_then(|one| Some(one.relative_error?.p99)));
    let scales = judged.scale_range();
    let scales = scales.map_or("-".into(), |(least, most)| format!("{least}..{most}"));
    let hostile = judged.hostile.all();
    format!(
        "{:>9}  {:>9}  {:>9}  {:>9}  {:>9}  {tail:>8}  {far:>7}  {uv:>7}  {scales:>9}  {:>9}",
        share(judged.edge_leak()),
        share(judged.vertex_leak()),
        share(judged.double()),
        share(judged.missed()),
        share(judged.false_hit()),
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

//! Figures as tables for people: one for each grouping and instruction set, a row a kernel, a column a case.

use std::fmt::Write;

use super::figures::Figures;
use crate::arena::REFERENCE;

/// Which table figures belong to.
type Key<'a> = (&'a str, &'a str, &'a str);

/// Prints all tables.
pub fn print(figures: &[Figures]) {
    if figures.is_empty() {
        println!("nothing was timed");
    }
    for key in distinct(figures, table) {
        let of_table: Vec<&Figures> = figures.iter().filter(|one| table(one) == key).collect();
        print!("\n{}", text(key, &of_table));
    }
}

/// The table: grouping, what is asked, instruction set.
fn table(figures: &Figures) -> Key<'_> {
    (&figures.grouping, &figures.query, &figures.isa)
}

/// The column: origin and regime.
fn column(figures: &Figures) -> (&str, &str) {
    (&figures.origin, &figures.regime)
}

/// Different keys, in order of appearance.
fn distinct<'a, T, K: PartialEq>(all: &'a [T], key: impl Fn(&'a T) -> K) -> Vec<K> {
    let mut keys = Vec::new();
    for one in all {
        let key = key(one);
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}

/// A table.
fn text((grouping, query, isa): Key<'_>, figures: &[&Figures]) -> String {
    let mut text = String::new();
    let columns = distinct(figures, |one| column(one));
    let names = ranked(figures, &columns);
    let width = names.iter().map(|name| name.len()).max().unwrap_or(0);
    let find = |name: &str, place: (&str, &str)| {
        let mut all = figures.iter();
        all.find(|one| one.kernel == name && column(one) == place)
    };
    let _ = writeln!(
        text,
        "{grouping}, {query}, {isa}: speed as a multiple of {REFERENCE}'s at the same work"
    );
    let origins: String = columns.iter().map(|(origin, _)| cell(origin)).collect();
    let regimes: String = columns.iter().map(|(_, regime)| cell(regime)).collect();
    let _ = writeln!(
        text,
        "{:width$}  {origins}  bytes    records  t error: median      p99",
        ""
    );
    let _ = writeln!(text, "{:width$}  {regimes}              M/s", "kernel");
    let best = |place| {
        let of_column = figures.iter().filter(|one| column(one) == place);
        of_column.filter_map(|one| one.ratio).fold(0.0, f64::max)
    };
    let bests: Vec<f64> = columns.iter().map(|&place| best(place)).collect();
    for name in &names {
        let cells: String = std::iter::zip(&columns, &bests)
            .map(|(&place, &best)| match find(name, place) {
                None => cell("-"),
                Some(one) => match one.ratio {
                    None => cell("failed"),
                    Some(ratio) if ratio == best => cell(&format!("*{ratio:.2}")),
                    Some(ratio) => cell(&format!("{ratio:.2}")),
                },
            })
            .collect();
        let mut of_kernel = figures.iter().filter(|one| one.kernel == *name);
        let any = of_kernel.clone().next().map_or(0, |one| one.bytes);
        let speeds = of_kernel.clone().filter_map(|one| one.precomputation);
        let speed = speeds.reduce(f64::max);
        let speed = speed.map_or(String::new(), |speed| format!("{speed:.0}"));
        let errors = of_kernel.find_map(|one| Some((one.t_error_median?, one.t_error_p99?)));
        let errors = errors.map_or(String::new(), |(median, p99)| {
            format!("{median:15.1e}  {p99:7.1e}")
        });
        let _ = writeln!(
            text,
            "{name:width$}  {cells}  {any:5}  {speed:>9}  {errors}"
        );
    }
    let speed = |&place: &(&str, &str)| {
        let speed = find(REFERENCE, place).and_then(|one| one.speed);
        cell(&speed.map_or(String::new(), |speed| format!("{speed:.0}")))
    };
    let speeds: String = columns.iter().map(speed).collect();
    let _ = writeln!(text, "{:width$}  {speeds}  M tests/s of {REFERENCE}", "");
    let uncertainty = figures.iter().filter_map(|one| one.uncertainty);
    let uncertainty = uncertainty.fold(0.0, f64::max) * 100.0;
    let _ = writeln!(
        text,
        "* the fastest of its column; no ratio is more uncertain than ±{uncertainty:.1}%"
    );
    for one in figures.iter().filter(|one| one.ratio.is_none()) {
        let Figures {
            kernel,
            origin,
            regime,
            verdict,
            ..
        } = one;
        let _ = writeln!(text, "failed: {kernel}, {origin}, {regime}: {verdict}");
    }
    text
}

/// The names of the kernels, those with the greatest product of their ratios' roots first; whoever failed
/// somewhere, last.
fn ranked<'a>(figures: &[&'a Figures], columns: &[(&str, &str)]) -> Vec<&'a str> {
    let mut names: Vec<(&str, f64)> = Vec::new();
    for one in figures {
        if names.iter().any(|(name, _)| *name == one.kernel) {
            continue;
        }
        let of_kernel = figures.iter().filter(|other| other.kernel == one.kernel);
        let ratios: Vec<f64> = of_kernel
            .filter(|other| columns.contains(&column(other)))
            .map(|other| other.ratio.unwrap_or(0.0))
            .collect();
        let product: f64 = ratios.iter().product();
        names.push((&one.kernel, product.powf((ratios.len() as f64).recip())));
    }
    names.sort_by(|a, b| b.1.total_cmp(&a.1));
    names.into_iter().map(|(name, _)| name).collect()
}

fn cell(text: &str) -> String {
    format!("{text:>10}")
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::*;

    fn figures(kernel: &str, regime: &str, ratio: Option<f64>) -> Figures {
        Figures {
            kernel: kernel.into(),
            isa: "sse2".into(),
            grouping: "packet".into(),
            origin: "general".into(),
            query: "closest".into(),
            numeric: "fast".into(),
            watertight: "none".into(),
            regime: regime.into(),
            ratio,
            uncertainty: ratio.map(|_| 0.012),
            speed: ratio.map(|ratio| 600.0 * ratio),
            bytes: 40,
            precomputation: ratio.map(|_| 200.0),
            t_error_median: ratio.map(|_| 1e-7),
            t_error_p99: ratio.map(|_| 4e-7),
            t_error_max: ratio.map(|_| 1e-6),
            t_error_mean_square: ratio.map(|_| 1e-14),
            verdict: if ratio.is_some() {
                "timed"
            } else {
                "wrong answer"
            },
        }
    }

    #[test]
    fn a_kernel_that_disagrees_is_marked_and_comes_last() {
        let figures = [
            figures("culls", "leaf", None),
            figures("moller-trumbore", "fixed", Some(1.0)),
            figures("moller-trumbore", "leaf", Some(1.0)),
            figures("wald", "fixed", Some(2.0)),
            figures("wald", "leaf", Some(0.9)),
            figures("culls", "fixed", Some(3.0)),
        ];
        let all: Vec<&Figures> = figures.iter().collect();
        let text = text(table(&figures[0]), &all);
        expect![[r#"
            packet, closest, sse2: speed as a multiple of moller-trumbore's at the same work
                                general   general  bytes    records  t error: median      p99
            kernel                 leaf     fixed              M/s
            wald                   0.90      2.00     40        200           1.0e-7   4.0e-7
            moller-trumbore       *1.00      1.00     40        200           1.0e-7   4.0e-7
            culls                failed     *3.00     40        200           1.0e-7   4.0e-7
                                    600       600  M tests/s of moller-trumbore
            * the fastest of its column; no ratio is more uncertain than ±1.2%
            failed: culls, general, leaf: wrong answer
        "#]]
        .assert_eq(&text);
    }
}

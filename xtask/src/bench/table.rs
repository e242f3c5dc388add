//! Figures as tables for people: one for each grouping and instruction set, a row a kernel, a column a case.

use std::fmt::Write;

use super::figures::Figures;
use crate::arena::REFERENCE;
use crate::cases::Identity;

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
    (&figures.of.grouping, &figures.of.query, &figures.of.isa)
}

/// A column: origin and regime.
type Column<'a> = (&'a str, &'a str);

/// The column that figures belong to.
fn column(figures: &Figures) -> Column<'_> {
    (&figures.of.origin, &figures.of.regime)
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
    let columns = distinct(figures, |one| column(one));
    let names = ranked(figures, &columns);
    let width = names.iter().map(|name| name.len()).max().unwrap_or(0);
    let table = Table {
        figures,
        columns: &columns,
        width,
    };
    let mut text = format!(
        "{grouping}, {query}, {isa}: speed as a multiple of {REFERENCE}'s at the same work\n{}",
        table.heads(
            "  bytes    records  t error: median      p99",
            "              M/s"
        )
    );
    let best = |place: &Column<'_>| {
        let of_column = figures.iter().filter(|one| column(one) == *place);
        of_column.filter_map(|one| one.ratio).fold(0.0, f64::max)
    };
    let bests: Vec<f64> = columns.iter().map(best).collect();
    for name in &names {
        let mut bests = bests.iter();
        let ratio = |one: Option<&Figures>| {
            let best = *bests.next()?;
            Some(match one?.ratio {
                None => "failed".into(),
                Some(ratio) if ratio == best => format!("*{ratio:.2}"),
                Some(ratio) => format!("{ratio:.2}"),
            })
        };
        let cells = table.cells(name, ratio);
        let _ = writeln!(text, "{name:width$}  {cells}  {}", of_kernel(figures, name));
    }
    let speed = |one: Option<&Figures>| Some(format!("{:.0}", one?.speed?));
    let speeds = table.cells(REFERENCE, speed);
    let _ = writeln!(text, "{:width$}  {speeds}  M tests/s of {REFERENCE}", "");
    let uncertainty = figures.iter().filter_map(|one| one.uncertainty);
    let uncertainty = uncertainty.fold(0.0, f64::max) * 100.0;
    let _ = writeln!(
        text,
        "* the fastest of its column; no ratio is more uncertain than ±{uncertainty:.1}%"
    );
    for one in figures.iter().filter(|one| one.ratio.is_none()) {
        let Identity {
            kernel,
            origin,
            regime,
            ..
        } = &one.of;
        let verdict = one.verdict;
        let _ = writeln!(text, "failed: {kernel}, {origin}, {regime}: {verdict}");
    }
    text + &table.limits(&names)
}

/// What a kernel has in all columns alike: bytes of a record, how fast it is made, errors of `t`.
fn of_kernel(figures: &[&Figures], name: &str) -> String {
    let mut all = figures.iter().filter(|one| one.of.kernel == name);
    let bytes = all.clone().next().map_or(0, |one| one.bytes);
    let speeds = all.clone().filter_map(|one| one.precomputation);
    let speed = speeds.reduce(f64::max);
    let speed = speed.map_or(String::new(), |speed| format!("{speed:.0}"));
    let errors = all.find_map(|one| Some((one.t_error_median?, one.t_error_p99?)));
    let errors = errors.map(|(median, p99)| format!("  {median:15.1e}  {p99:7.1e}"));
    format!("{bytes:5}  {speed:>9}{}", errors.unwrap_or_default())
}

/// Figures in columns.
struct Table<'a> {
    figures: &'a [&'a Figures],
    columns: &'a [Column<'a>],
    /// That of the names.
    width: usize,
}

impl Table<'_> {
    /// The two lines that name the columns, with what stands right of them.
    fn heads(&self, above: &str, below: &str) -> String {
        let origins: String = self
            .columns
            .iter()
            .map(|(origin, _)| cell(origin))
            .collect();
        let regimes: String = self
            .columns
            .iter()
            .map(|(_, regime)| cell(regime))
            .collect();
        let width = self.width;
        format!(
            "{:width$}  {origins}{above}\n{:width$}  {regimes}{below}\n",
            "", "kernel"
        )
    }

    /// A kernel's cells; a dash where it did not take part.
    fn cells(
        &self,
        name: &str,
        mut text: impl FnMut(Option<&Figures>) -> Option<String>,
    ) -> String {
        let cells = self.columns.iter().map(|place| {
            let mut all = self.figures.iter();
            let found = all.find(|one| one.of.kernel == name && column(one) == *place);
            cell(&text(found.copied()).unwrap_or("-".into()))
        });
        cells.collect()
    }

    /// What share of its cycles a kernel's arithmetic takes at least; nothing if that was not counted.
    fn limits(&self, names: &[&str]) -> String {
        if self.figures.iter().all(|one| one.least_cycles.is_none()) {
            return String::new();
        }
        let width = self.width;
        let mut text = format!(
            "\ncycles a test, and the share of them that its arithmetic takes at least:\n{}",
            self.heads("  llvm-mca:", " first exit")
        );
        for name in names {
            let limit = |one: Option<&Figures>| {
                let (taken, least) = (one?.cycles?, one?.least_cycles?);
                Some(format!("{taken:.2} {:3.0}%", 100.0 * least / taken))
            };
            let mut of_kernel = self.figures.iter().filter(|one| one.of.kernel == *name);
            let estimate = of_kernel.find_map(|one| one.first_exit_cycles);
            let estimate = estimate.map_or("-".into(), |cycles| format!("{cycles:.2}"));
            let cells = self.cells(name, limit);
            let _ = writeln!(text, "{name:width$}  {cells}{estimate:>11}");
        }
        text
    }
}

/// The names of the kernels, those with the greatest product of their ratios' roots first; whoever failed
/// somewhere, last.
fn ranked<'a>(figures: &[&'a Figures], columns: &[Column<'_>]) -> Vec<&'a str> {
    let mut names: Vec<(&str, f64)> = Vec::new();
    for one in figures {
        if names.iter().any(|(name, _)| *name == one.of.kernel) {
            continue;
        }
        let of_kernel = figures
            .iter()
            .filter(|other| other.of.kernel == one.of.kernel);
        let ratios: Vec<f64> = of_kernel
            .filter(|other| columns.contains(&column(other)))
            .map(|other| other.ratio.unwrap_or(0.0))
            .collect();
        let product: f64 = ratios.iter().product();
        names.push((&one.of.kernel, product.powf((ratios.len() as f64).recip())));
    }
    names.sort_by(|a, b| b.1.total_cmp(&a.1));
    names.into_iter().map(|(name, _)| name).collect()
}

fn cell(text: &str) -> String {
    format!("{text:>11}")
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::*;

    fn figures(kernel: &str, regime: &str, ratio: Option<f64>) -> Figures {
        Figures {
            of: Identity::example(kernel, regime),
            ratio,
            worst_layout: None,
            uncertainty: ratio.map(|_| 0.012),
            speed: ratio.map(|ratio| 600.0 * ratio),
            cycles: ratio.map(|ratio| 6.0 / ratio),
            least_cycles: ratio.map(|_| 1.5),
            first_exit_cycles: None,
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
                                 general    general  bytes    records  t error: median      p99
            kernel                  leaf      fixed              M/s
            wald                    0.90       2.00     40        200           1.0e-7   4.0e-7
            moller-trumbore        *1.00       1.00     40        200           1.0e-7   4.0e-7
            culls                 failed      *3.00     40        200           1.0e-7   4.0e-7
                                     600        600  M tests/s of moller-trumbore
            * the fastest of its column; no ratio is more uncertain than ±1.2%
            failed: culls, general, leaf: wrong answer

            cycles a test, and the share of them that its arithmetic takes at least:
                                 general    general  llvm-mca:
            kernel                  leaf      fixed first exit
            wald               6.67  23%  3.00  50%          -
            moller-trumbore    6.00  25%  6.00  25%          -
            culls                      -  2.00  75%          -
        "#]]
        .assert_eq(&text);
    }
}

//! Tables of the library's page.

use accuracy::{Case, Leaks, PairCase, Profile, Rate};
use maud::{Markup, html};
use measure::Judged;

use super::library::{Compared, Contender};
use super::scatter::{fill, role_class, shape};
use super::text::{self, share};

/// Everyone in a line, the fastest first.
pub fn standings(case: &Compared) -> Markup {
    html! {
        div.scroll {
            table.standings {
                caption { b { "All kernels" } ", the fastest first; ◂ those on the front" }
                thead {
                    tr {
                        th scope="col" { "kernel" }
                        @for head in [
                            "", "ns a test", "× Möller-Trumbore", "bytes", "t error: median", "p99.99", "far, p99",
                            "edge leaks", "vertex leaks", "doubles", "missed", "false hits", "scales 2ᵏ", "not finite",
                        ] {
                            th scope="col" { (head) }
                        }
                    }
                }
                tbody {
                    @for (number, one) in case.kernels.iter().enumerate() { (standing(one, number)) }
                }
            }
        }
    }
}

/// Those that nobody beats, with what they are compared by.
pub fn front(case: &Compared) -> Markup {
    let or_dash = |figure: Option<String>| figure.unwrap_or("–".into());
    html! {
        figure.card {
            figcaption {
                b { "On the front" }
                "Nobody has fewer nanoseconds, error and leaks at once: who is better in one is worse in another."
            }
            table {
                thead {
                    tr {
                        th scope="col" { "kernel" }
                        @for head in ["ns a test", "p99.99 error", "leaks"] { th scope="col" { (head) } }
                    }
                }
                tbody {
                    @for (number, one) in case.front() {
                        tr {
                            (name(one, number))
                            td { (or_dash(one.nanoseconds.map(text::plain))) }
                            td { (or_dash(one.t_error_p9999.map(text::power))) }
                            td { (or_dash(one.leak().map(share))) }
                        }
                    }
                }
            }
        }
    }
}

/// The class of a kernel in all plots and tables of its case.
pub fn class(number: usize) -> String {
    format!("k{number}")
}

/// A kernel's name with its form, as the head of a row.
fn name(one: &Contender, number: usize) -> Markup {
    html! {
        th scope="row" class={ (role_class(one.role)) " " (class(number)) } {
            svg.key viewBox="0 0 14 14" aria-hidden="true" {
                g class={ "mark " (role_class(one.role)) " " (fill(one.on_front)) } {
                    (shape(one.role, (7.0, 7.0)))
                }
            }
            (one.name())
        }
    }
}

fn standing(one: &Contender, number: usize) -> Markup {
    let or_dash = |figure: Option<String>| figure.unwrap_or("–".into());
    let uncertainty = one.figures.uncertainty.unwrap_or(0.0);
    let ratio = one.figures.ratio;
    let ratio = ratio.map(|ratio| format!("{ratio:.2} ± {:.2}", ratio * uncertainty));
    let error = |case: PairCase, figure: fn(&accuracy::Summary) -> f64| {
        let profile = one.judged.as_ref()?.profile(case)?;
        Some(text::power(figure(&profile.relative_error?)))
    };
    let rate =
        |rate: fn(&Judged) -> Rate| or_dash(one.judged.as_ref().map(|judged| share(rate(judged))));
    let scales = one.judged.as_ref().and_then(Judged::scale_range);
    let scales = scales.map(|(least, most)| format!("{least} … {most}").replace('-', "−"));
    let hostile = one.judged.as_ref().map(|judged| judged.hostile.all());
    let hostile = hostile.map(|rate| match rate.events {
        0 => "ok".into(),
        _ => share(rate),
    });
    html! {
        tr {
            (name(one, number))
            td.front { @if one.on_front { "◂" } }
            @if let Some(nanoseconds) = one.nanoseconds {
                td { (text::plain(nanoseconds)) }
                td { (or_dash(ratio)) }
            } @else {
                td colspan="2" { (one.figures.verdict) }
            }
            td { (one.figures.bytes) }
            td { (or_dash(error(PairCase::Ordinary, |errors| errors.median))) }
            td { (or_dash(error(PairCase::Ordinary, |errors| errors.p9999))) }
            td { (or_dash(error(PairCase::Far, |errors| errors.p99))) }
            td { (rate(Judged::edge_leak)) }
            td { (rate(Judged::vertex_leak)) }
            td { (rate(Judged::double)) }
            td { (rate(Judged::missed)) }
            td { (rate(Judged::false_hit)) }
            td { (or_dash(scales)) }
            td { (or_dash(hostile)) }
        }
    }
}

/// A figure of a cell: what it is, and what it is worth; the greater the worse.
struct Figure {
    text: String,
    badness: f64,
}

impl Figure {
    fn share(rate: Rate) -> Figure {
        Figure {
            text: share(rate),
            badness: match rate.samples {
                0 => 0.0,
                _ => rate.share(),
            },
        }
    }

    fn error(profile: &Profile) -> Figure {
        match profile.relative_error {
            Some(errors) => Figure {
                text: text::power(errors.p9999),
                badness: errors.p9999,
            },
            None => Figure {
                text: "–".into(),
                badness: 0.0,
            },
        }
    }
}

/// What each kernel makes of every kind of triangle.
pub fn extremes(case: &Compared) -> Markup {
    let figures = |judged: &Judged, case: PairCase| {
        let profile = judged.profile(case)?;
        let counts = profile.counts;
        Some([
            Figure::share(counts.missed),
            Figure::share(counts.wrong_hit()),
            Figure::error(profile),
        ])
    };
    let caption = "hits that are missed, misses that are hit, p99.99 error of t";
    cells(
        case,
        "Extreme triangles",
        caption,
        &PairCase::ALL.map(|it| (it.name(), it)),
        figures,
    )
}

/// What of every kind of closed surface leaks through each kernel.
pub fn surfaces(case: &Compared) -> Markup {
    let figures = |judged: &Judged, case: Case| {
        let found = judged.leaks.iter().find(|one| one.case == case)?;
        let Leaks { edge, vertex, .. } = found.leaks;
        let double = [edge.double, vertex.double].into_iter().sum();
        Some([edge.leak, vertex.leak, double].map(Figure::share))
    };
    let caption = "leaks at edges, leaks at vertices, doubles at either";
    cells(
        case,
        "Closed surfaces",
        caption,
        &Case::ALL.map(|it| (it.name(), it)),
        figures,
    )
}

/// A row a kernel, a column a case, and in every cell three figures, of which the worst of a column is marked.
fn cells<K: Copy>(
    case: &Compared,
    title: &str,
    caption: &str,
    columns: &[(&str, K)],
    figures: impl Fn(&Judged, K) -> Option<[Figure; 3]>,
) -> Markup {
    let judged: Vec<(usize, &Contender, &Judged)> = case
        .kernels
        .iter()
        .enumerate()
        .filter_map(|(number, one)| Some((number, one, one.judged.as_ref()?)))
        .collect();
    // From the best to the worst of every figure. Where all are alike, nobody is the worst.
    let range_of = |column: K| -> [(f64, f64); 3] {
        let all = judged
            .iter()
            .filter_map(|(.., judged)| figures(judged, column));
        all.fold([(f64::INFINITY, 0.0); 3], |ranges, figures| {
            std::array::from_fn(|place| {
                let ((best, worst), badness) = (ranges[place], figures[place].badness);
                (badness.min(best), badness.max(worst))
            })
        })
    };
    let ranges: Vec<_> = columns
        .iter()
        .map(|&(_, column)| range_of(column))
        .collect();
    html! {
        details open {
            summary { b { (title) } ": " (caption) "; ▲ the worst of a column" }
            div.scroll {
            table.cells {
                thead {
                    tr {
                        th scope="col" { "kernel" }
                        @for (name, _) in columns { th scope="col" { (name) } }
                    }
                }
                tbody {
                    @for &(number, one, judged) in &judged {
                        tr {
                            (name(one, number))
                            @for (&(_, column), ranges) in columns.iter().zip(&ranges) {
                                td {
                                    @for (place, figure) in figures(judged, column).into_iter().flatten().enumerate() {
                                        @let (best, worst) = ranges[place];
                                        @let is_worst = best < worst && figure.badness == worst;
                                        div.worst[is_worst] { @if is_worst { "▲ " } (figure.text) }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
        }
    }
}

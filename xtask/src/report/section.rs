//! All of a case: plots and tables.

use std::collections::BTreeSet;

use accuracy::{Rate, Sweep};
use maud::{Markup, html};

use super::axis::Naming;
use super::library::{Compared, Contender};
use super::lines::{self, Line, Ordinate};
use super::scatter::{self, Mark, Plot, Value, role_class};
use super::tables;
use crate::cases::Role;

/// Ways in which lines of rivals are drawn.
const LINE_STYLES: usize = 18;

/// Dashes of the lines of other roles.
const DASHES: usize = 3;

/// A case, to be shown.
pub struct Section<'a> {
    /// The case.
    pub case: &'a Compared,
    /// The names of all rivals of the page, so that each has lines of its own in whatever case.
    pub rivals: &'a BTreeSet<&'a str>,
}

impl<'a> Section<'a> {
    /// It, as part of a page.
    pub fn markup(&self) -> Markup {
        let case = self.case;
        html! {
            section {
                h2 { (case.title(" · ")) }
                p.soft { (case.workload) }
                div.plots {
                    (scatter::figure(&plot(
                        case, "p99.99 error of t",
                        "Relative, at ordinary triangles; half of the rays pass next to sides.",
                        Naming::Power, |one| one.t_error_p9999.filter(|error| error.is_finite()).map(Value::Seen),
                    )))
                    (scatter::figure(&plot(
                        case, "Edge leaks",
                        "Rays at shared edges of closed fans and meshes that no triangle reports.",
                        Naming::Percent, |one| value(one.edge_leak()?),
                    )))
                    (scatter::figure(&plot(
                        case, "Doubles",
                        "Rays at shared edges and vertices that are reported once too often.",
                        Naming::Percent, |one| value(one.double()?),
                    )))
                    (tables::front(case))
                }
                (tables::standings(case))
                (self.legend())
                div.plots {
                    @for ordinate in [Ordinate::Error, Ordinate::Wrong] {
                        @for sweep in Sweep::ALL {
                            (lines::figure(ordinate, sweep, &self.swept(sweep)))
                        }
                    }
                }
                (tables::extremes(case))
                (tables::surfaces(case))
            }
        }
    }

    /// How a kernel's lines are drawn: each rival's in its own way in all cases, those of the library and of champions
    /// in the colour of their role, one after the other in other dashes.
    fn line_class(&self, number: usize) -> String {
        let one = &self.case.kernels[number];
        let own = match one.role {
            Role::Rival => {
                let place = self.rivals.iter().position(|name| *name == one.name());
                format!("s{}", place.unwrap_or(0) % LINE_STYLES)
            }
            role => {
                let before = self.case.kernels[..number].iter();
                let before = before.filter(|other| other.role == role).count();
                format!("{} n{}", role_class(role), before % DASHES)
            }
        };
        format!("{own} {}", tables::class(number))
    }

    fn swept(&self, sweep: Sweep) -> Vec<Line<'a>> {
        let numbered = self.case.kernels.iter().enumerate();
        let lines = numbered.filter_map(|(number, one)| {
            let mut sweeps = one.judged.as_ref()?.sweeps.iter();
            Some(Line {
                name: one.name(),
                class: self.line_class(number),
                points: &sweeps.find(|one| one.sweep == sweep)?.points,
            })
        });
        lines.collect()
    }

    fn legend(&self) -> Markup {
        html! {
            ul.legend {
                @for (number, one) in self.case.kernels.iter().enumerate() {
                    @if one.judged.is_some() {
                        li class=(tables::class(number)) {
                            svg.sample viewBox="0 0 30 10" aria-hidden="true" {
                                g class={ "line " (self.line_class(number)) } { path d="M2 5h26" {} }
                            }
                            (one.name())
                        }
                    }
                }
            }
        }
    }
}

fn value(rate: Rate) -> Option<Value> {
    match rate.bound_of_zero() {
        Some(bound) => Some(Value::Below(bound)),
        None => (rate.samples > 0).then(|| Value::Seen(rate.share())),
    }
}

fn plot<'a>(
    case: &'a Compared,
    title: &'a str,
    caption: &'a str,
    naming: Naming,
    value: impl Fn(&Contender) -> Option<Value>,
) -> Plot<'a> {
    let numbered = case.kernels.iter().enumerate();
    let marks = numbered.filter_map(|(number, one)| {
        Some(Mark {
            name: one.name(),
            class: tables::class(number),
            role: one.role,
            nanoseconds: one.nanoseconds?,
            value: value(one)?,
        })
    });
    Plot {
        title,
        caption,
        naming,
        marks: marks.collect(),
    }
}

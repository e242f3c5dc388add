//! The champion as code.

use maud::{Markup, html};
use volumes::Kind;

use super::super::kernel::Listing;
use crate::report::text;

/// Operations, source and assembly.
pub fn markup(listing: &Listing) -> Markup {
    html! {
        p {
            "A test of a ray and a triangle takes " b { (text::plain(listing.operations)) } " operations if the ray does not leave early, work on \
             the packet shared among its rays. How often each is done:"
        }
        div.scroll {
            table.counts {
                thead {
                    tr {
                        th.text scope="col" { "once for each" }
                        @for kind in Kind::ALL { th scope="col" { (name(kind)) } }
                    }
                }
                tbody {
                    @for counted in &listing.rates {
                        tr {
                            th scope="row" { (counted.rate) }
                            @for count in counted.counts { td { @if count > 0 { (count) } @else { "·" } } }
                        }
                    }
                }
            }
        }
        details open {
            summary { b { "Source" } ": Rust for " (listing.isa) }
            pre { code { (listing.source) } }
        }
        @if let Some(assembly) = &listing.assembly {
            details {
                summary { b { "Machine code" } ": the function that does the work, " (instructions(assembly)) " instructions, as compiled here" }
                pre { code { (assembly) } }
            }
        } @else {
            p.missing { "Its machine code is not known: it could not be compiled here." }
        }
    }
}

fn name(kind: Kind) -> &'static str {
    match kind {
        Kind::Multiply => "multiplications",
        Kind::Add => "additions",
        Kind::Fused => "fused",
        Kind::Divide => "divisions",
        Kind::Test => "tests",
    }
}

fn instructions(assembly: &str) -> usize {
    assembly.lines().filter(|line| !line.ends_with(':')).count()
}

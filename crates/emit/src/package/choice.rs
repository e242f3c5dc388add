//! Which kernel is called for what a scene requires: the fastest, as measured, of those that keep what is promised.
//!
//! A kernel that promises more than is required may serve, if nothing is faster. On an instruction set that has
//! none, the next narrower one's is called. What is portable must be one program on all of them.

use std::fmt::Write;

use program::Watertight;
use scene::{Numeric, Origin, Regime};

use super::catalogue::{lists, watertight};
use super::entry::Entry;
use crate::isa::Isa;

/// What a scene may require.
#[derive(Clone, Copy)]
struct Requirement {
    function: Function,
    numeric: Numeric,
    watertight: Watertight,
    regime: Regime,
}

/// The functions that choose.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Function {
    Packet,
    CommonOrigin,
    Ray,
}

/// The text of the file: a function for what is tested together, a line in it for everything required.
pub(super) fn choice(kernels: &[Entry<'_>]) -> String {
    let mut text = String::from(
        "//! Which kernel serves a scene: a line for what it requires, a kernel for every instruction set.\n\n\
         use crate::dispatch::{kernels, requires};\n\
         use crate::isa::Isa;\n\
         use crate::ray::{Hits, Packet, Ray};\n\
         use crate::scene::{Lists, Numeric, Scene, Watertight};\n\
         use crate::triangle::Record;\n",
    );
    for function in [Function::Packet, Function::CommonOrigin, Function::Ray] {
        let (takes, name, about) = match function {
            Function::Packet => ("packet", "packet", "Tests a packet of rays of any origin."),
            Function::CommonOrigin => (
                "packet",
                "common_origin",
                "Tests a packet of rays of the origin of ray 0.",
            ),
            Function::Ray => (
                "ray",
                "ray",
                "Tests one ray against blocks, and gives its `t`.",
            ),
        };
        let _ = write!(
            text,
            "\nkernels! {{\n    /// {about}\n    {takes} fn {name}, {name}_name {{\n"
        );
        for numeric in Numeric::ALL.iter().copied() {
            for promise in [Watertight::No, Watertight::Edges, Watertight::Full] {
                for regime in [Regime::Leaf, Regime::Shrinking] {
                    let requirement = Requirement {
                        function,
                        numeric,
                        watertight: promise,
                        regime,
                    };
                    if let Some(kernels) = requirement.kernels(kernels) {
                        let (watertight, lists) = (watertight(promise), lists(regime));
                        let kernels = kernels.join("\n            ");
                        let _ = writeln!(
                            text,
                            "        {numeric:?} {watertight} {lists}:\n            {kernels};"
                        );
                    }
                }
            }
        }
        text += "    }\n}\n";
    }
    text
}

impl Requirement {
    /// The paths of its kernels, an instruction set each; none if there is not even a scalar one.
    fn kernels(self, kernels: &[Entry<'_>]) -> Option<Vec<String>> {
        let of_all = (self.numeric == Numeric::Portable).then(|| {
            let portable = kernels.iter().filter(|one| {
                Isa::ALL
                    .iter()
                    .all(|&isa| one.is_for(isa) && self.is_served_by(one, isa))
            });
            self.best(portable)
        });
        let mut narrower: Option<String> = None;
        let mut paths = Vec::new();
        for isa in Isa::ALL {
            let best = of_all.unwrap_or_else(|| {
                let serving = kernels.iter().filter(|one| self.is_served_by(one, isa));
                self.best(serving)
            });
            let path = best.map(|kernel| format!("{}::{}", isa.module(), kernel.function(isa)));
            narrower = path.or(narrower);
            paths.push(narrower.clone()?);
        }
        Some(paths)
    }

    fn is_served_by(self, kernel: &Entry<'_>, isa: Isa) -> bool {
        let scene = &kernel.recipe.scene;
        let takes = match self.function {
            Function::Packet => kernel.takes_packets() && scene.origin == Origin::General,
            Function::CommonOrigin => kernel.takes_packets(),
            Function::Ray => !kernel.takes_packets(),
        };
        let tags = kernel.recipe.program.tags(isa.fuses());
        takes
            && match self.numeric {
                // The next narrower one's own is better than what was bred for none.
                Numeric::Fast => kernel.recipe.isas.contains(&isa),
                Numeric::Portable => scene.numeric == Numeric::Portable,
            }
            && tags.watertight >= self.watertight
    }

    /// The fastest of those that were bred for this origin, if there are any, and of these for such lists.
    fn best<'a, 'b>(self, kernels: impl Iterator<Item = &'a Entry<'b>>) -> Option<&'a Entry<'b>>
    where
        'b: 'a,
    {
        let fits = |kernel: &Entry<'_>| {
            let scene = &kernel.recipe.scene;
            let is_common = scene.origin == Origin::Common;
            let of_origin = is_common == (self.function == Function::CommonOrigin);
            (of_origin, scene.regime == self.regime)
        };
        kernels.max_by(|a, b| {
            let by_speed = || a.provenance.ratio.total_cmp(&b.provenance.ratio);
            fits(a).cmp(&fits(b)).then_with(by_speed)
        })
    }
}

//! The champion as code: its source, its operations by rate and its machine code.

use std::num::NonZeroU16;

use emit::print_kernel;
use measure::{Rustc, kernel_assembly};
use program::Program;
use serde::Serialize;
use volumes::{Case, Kind, Model, Rate};

use crate::arena::Arena;
use crate::evolve::source_to_read;

/// The rays that share what is worked out for a packet.
const SHARERS: NonZeroU16 =
    NonZeroU16::new(scene::PACKET_SIZE as u16).expect("a packet has some rays");

/// A kernel to be read.
#[derive(Clone, Debug, Serialize)]
pub struct Listing {
    /// The instruction set of source and assembly: the first one of the run.
    pub isa: &'static str,
    /// The source.
    pub source: String,
    /// Operations at every rate that has some.
    pub rates: Vec<Counted>,
    /// Operations of a ray and a triangle if no ray leaves early, work on the packet shared among its rays.
    pub operations: f64,
    /// The machine code of the function that does the work; none if it does not compile.
    pub assembly: Option<String>,
}

/// Operations at a rate.
#[derive(Clone, Debug, Serialize)]
pub struct Counted {
    /// How often they are done: once for each of these.
    pub rate: String,
    /// By kind, in the order of [`Kind::ALL`].
    pub counts: [u32; Kind::ALL.len()],
}

impl Listing {
    /// A program as a kernel for an arena. Without a compiler there is no assembly.
    pub fn of(program: &Program, arena: &Arena, rustc: Option<&Rustc>) -> Listing {
        let isa = arena.isas[0];
        let case = Case {
            rates: arena.scene.rates(),
            ..Case::packet(SHARERS)
        };
        let counted = Rate::ALL
            .into_iter()
            .zip(program.operations(case, isa.fuses()));
        let rates = counted
            .filter(|(_, operations)| operations.total() > 0)
            .map(|(rate, operations)| Counted {
                rate: rate.to_string(),
                counts: Kind::ALL.map(|kind| operations.count(kind)),
            });
        let kernel = print_kernel(program, &arena.scene, isa, "champion", "");
        let assembly = rustc.and_then(|rustc| kernel_assembly(rustc, &kernel));
        Listing {
            isa: isa.name(),
            rates: rates.collect(),
            operations: program.cost(case, &Model::paper()).operations(),
            assembly,
            source: source_to_read(kernel),
        }
    }
}

#[cfg(test)]
mod tests {
    use program::{appendix, kensler_shirley};
    use scene::SceneModel;

    use super::*;
    use crate::isas::Isas;

    #[test]
    fn a_kernel_is_told_by_its_source_and_its_operations() {
        let arena = Arena {
            scene: SceneModel::preset("packet").unwrap(),
            isas: Isas(vec![emit::Isa::Sse2]),
            triangles: 500,
        };
        let graph = kensler_shirley();
        let program = graph.program(&appendix(&graph)).unwrap();
        let listing = Listing::of(&program, &arena, None);
        assert!(listing.source.contains("fn champion"));
        assert!(listing.operations > 32.0, "{}", listing.operations);
        let rates: Vec<&str> = listing.rates.iter().map(|one| one.rate.as_str()).collect();
        assert!(rates.contains(&"ray×triangle") && rates.contains(&"triangle"));
    }
}

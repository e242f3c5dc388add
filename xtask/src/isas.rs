//! Instruction sets, as they are asked for: one, several or all.

use std::fmt;
use std::ops::Deref;

use emit::Isa;
use scene::{Grouping, SceneModel};
use serde::{Deserialize, Serialize};

use crate::failure::bad_input;

/// At least one instruction set, and none twice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Isas(pub Vec<Isa>);

impl Isas {
    /// Reads names with commas between them, or `all`: those that this machine has and that are of
    /// use to the scene. Of those it lacks `all` names none, but says so.
    pub fn parse(names: &str, scene: &SceneModel) -> anyhow::Result<Isas> {
        if names == "all" {
            let of_use = |isa: &Isa| scene.grouping != Grouping::Scalar || *isa == Isa::Scalar;
            let of_use = Isa::ALL.into_iter().filter(of_use);
            return Isas(of_use.collect()).here();
        }
        let mut isas: Vec<Isa> = Vec::new();
        for name in names.split(',') {
            let isa = name.parse().map_err(bad_input)?;
            if isas.contains(&isa) {
                return Err(bad_input(format!("--isa names {isa} twice")));
            }
            isas.push(isa);
        }
        Ok(Isas(isas))
    }

    /// Those of them that this processor has; the others are named as skipped.
    pub fn here(self) -> anyhow::Result<Isas> {
        let Isas(isas) = self;
        let (here, missing): (Vec<Isa>, Vec<Isa>) =
            isas.into_iter().partition(|isa| isa.is_available());
        if let (true, Some(isa)) = (here.is_empty(), missing.first()) {
            return Err(bad_input(format!(
                "this processor has no {isa}; choose another ISA"
            )));
        }
        for isa in missing {
            eprintln!("skipped: {isa}, which this processor lacks");
        }
        Ok(Isas(here))
    }
}

impl Deref for Isas {
    type Target = [Isa];

    fn deref(&self) -> &[Isa] {
        &self.0
    }
}

impl fmt::Display for Isas {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.iter().map(|isa| isa.name()).collect();
        f.pad(&names.join("+"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_once_each() {
        let scene = SceneModel::preset("packet").unwrap();
        let read = |names| Isas::parse(names, &scene).map(|isas| isas.to_string());
        assert_eq!(read("sse2").unwrap(), "sse2");
        assert_eq!(read("scalar,avx2").unwrap(), "scalar+avx2");
        assert!(read("sse2,sse2").unwrap_err().to_string().contains("twice"));
        assert!(
            read("sse2,")
                .unwrap_err()
                .to_string()
                .contains("unknown ISA")
        );
        let here = Isa::ALL.into_iter().filter(|isa| isa.is_available());
        assert!(Isas::parse("all", &scene).unwrap().iter().copied().eq(here));
    }
}

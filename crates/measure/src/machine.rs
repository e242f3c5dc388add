//! The machine that a figure belongs to.

use emit::Isa;
use serde::{Deserialize, Serialize};

/// What a figure must be read with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name for itself.
    pub cpu: String,
    /// Which of the instruction sets that kernels are printed for it has.
    pub isas: Vec<Isa>,
    /// Cores that this process may run on.
    pub cores: usize,
    /// Operating system and architecture.
    pub system: String,
}

impl Machine {
    /// This machine.
    pub fn here() -> Machine {
        Machine {
            cpu: cpu(),
            isas: Isa::ALL
                .into_iter()
                .filter(|isa| isa.is_available())
                .collect(),
            cores: cores(),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        }
    }
}

/// Cores that this process may run on, at least one.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn cpu() -> String {
    let id = raw_cpuid::CpuId::new();
    let brand = id.get_processor_brand_string();
    let brand = brand.map(|brand| brand.as_str().trim().to_owned());
    let family = id
        .get_feature_info()
        .map(|info| format!(" (family {}, model {})", info.family_id(), info.model_id()));
    brand.unwrap_or_else(|| "unknown x86".into()) + &family.unwrap_or_default()
}

#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
fn cpu() -> String {
    "not an x86 processor".into()
}

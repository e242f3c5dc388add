//! The paper's strategy stays what it is: which genomes a seed draws, breeds and mutates is pinned.

mod mock;

use evolve::{Settings, search};
use mock::{FORMULA, Watch};
use program::kensler_shirley;

#[test]
fn a_seed_tries_the_genomes_that_it_always_did() {
    let settings = Settings {
        population: 20,
        elite: 8,
        generations: 30,
        seed: 5,
        ..Settings::default()
    };
    let mut watch = Watch::default();
    search(&kensler_shirley(), settings, &mut { FORMULA }, &mut watch);
    let mut hasher = blake3::Hasher::new();
    for individual in watch.seen.iter().flat_map(|generation| &generation.new) {
        for priority in individual.candidate.genome.priorities() {
            hasher.update(&priority.to_le_bytes());
        }
    }
    let digest = hasher.finalize().to_hex();
    assert_eq!(digest[..16], *"403729d0aecf2d11");
}

//! The paper's operators, which know a genome as a permutation and nothing of the graph.

use std::ops::Range;

use program::Genome;
use rand::{Rng, RngExt};

/// How often a random pair is swapped in each of the offspring.
const SWAPS: usize = 2;

/// A pair of offspring by two-point order crossover: in each, the values of the segment `cut`
/// are put in the order that they have in the other parent, and the rest stays where it is.
///
/// # Panics
///
/// If the parents differ in length or the segment is not within them.
pub fn crossover(a: &Genome, b: &Genome, cut: Range<usize>) -> [Genome; 2] {
    [reorder(a, b, cut.clone()), reorder(b, a, cut)]
}

fn reorder(genome: &Genome, other: &Genome, cut: Range<usize>) -> Genome {
    assert_eq!(genome.len(), other.len(), "parents of one graph");
    let mut values = genome.priorities().to_vec();
    let mut in_segment = vec![false; values.len()];
    for &value in &values[cut.clone()] {
        in_segment[value as usize] = true;
    }
    let in_their_order = other.priorities().iter().copied();
    let reordered = in_their_order.filter(|&value| in_segment[value as usize]);
    for (place, value) in cut.zip(reordered) {
        values[place] = value;
    }
    Genome::try_from(values).expect("a reordered permutation is one")
}

/// A segment between two cut points, all pairs of points equally likely.
pub(crate) fn random_cut(length: usize, rng: &mut impl Rng) -> Range<usize> {
    let [a, b] = [(); 2].map(|()| rng.random_range(0..=length));
    a.min(b)..a.max(b)
}

/// Swaps the values of two random places, twice.
pub fn mutate(genome: &mut Genome, rng: &mut impl Rng) {
    for _ in 0..SWAPS {
        let [a, b] = [(); 2].map(|()| rng.random_range(0..genome.len()));
        genome.swap(a, b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn genome(values: &[u32]) -> Genome {
        Genome::try_from(values.to_vec()).unwrap()
    }

    #[test]
    fn a_segment_takes_the_order_of_the_other_parent() {
        let a = genome(&[0, 1, 2, 3, 4, 5]);
        let b = genome(&[5, 3, 1, 4, 2, 0]);
        let [first, second] = crossover(&a, &b, 1..5);
        assert_eq!(first, genome(&[0, 3, 1, 4, 2, 5]));
        assert_eq!(second, genome(&[5, 1, 2, 3, 4, 0]));
    }

    #[test]
    fn offspring_of_any_cut_are_permutations_that_keep_what_is_outside_it() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        for _ in 0..1000 {
            let [a, b] = [(); 2].map(|()| Genome::random(40, &mut rng));
            let cut = random_cut(40, &mut rng);
            let [first, _] = crossover(&a, &b, cut.clone());
            for place in (0..40).filter(|place| !cut.contains(place)) {
                assert_eq!(first.priorities()[place], a.priorities()[place]);
            }
        }
    }

    #[test]
    fn mutation_moves_at_most_four_values() {
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let original = Genome::random(40, &mut rng);
        for _ in 0..1000 {
            let mut mutant = original.clone();
            mutate(&mut mutant, &mut rng);
            let pairs = original.priorities().iter().zip(mutant.priorities());
            assert!(pairs.filter(|(a, b)| a != b).count() <= 4);
        }
    }
}

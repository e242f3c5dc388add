//! Who is a parent: a place in a population, which is ranked where the operator says so.

use rand::{Rng, RngExt};

/// Draws a place with probability proportional to its weight, or none if all weights are 0.
///
/// # Panics
///
/// If a weight is negative or not finite.
pub fn draw_parent(weights: &[f64], rng: &mut impl Rng) -> Option<usize> {
    let sound = |weight: &f64| weight.is_finite() && *weight >= 0.0;
    assert!(weights.iter().all(sound), "fitness is a positive number");
    let total: f64 = weights.iter().sum();
    if total <= 0.0 {
        return None;
    }
    let mut at = rng.random::<f64>() * total;
    for (place, &weight) in weights.iter().enumerate() {
        if at < weight {
            return Some(place);
        }
        at -= weight;
    }
    // Rounding may leave a crumb beyond the last weight.
    weights.iter().rposition(|&weight| weight > 0.0)
}

/// Draws a place among the first `count` of a ranked population: of two drawn at random the better one. None if
/// there are none.
///
/// How much better the better ones are plays no part, so the pressure is the same where all are nearly as fast as
/// each other, as they soon are.
pub fn tournament(count: usize, rng: &mut impl Rng) -> Option<usize> {
    (count > 0).then(|| {
        let [a, b] = [(); 2].map(|()| rng.random_range(0..count));
        a.min(b)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn parents_are_drawn_in_proportion_to_fitness() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let mut drawn = [0; 4];
        for _ in 0..60_000 {
            drawn[draw_parent(&[1.0, 0.0, 2.0, 3.0], &mut rng).unwrap()] += 1;
        }
        assert_eq!(drawn[1], 0);
        for (place, expected) in [(0, 10_000_i32), (2, 20_000), (3, 30_000)] {
            assert!((drawn[place] - expected).abs() < 600, "{drawn:?}");
        }
        assert_eq!(draw_parent(&[0.0, 0.0], &mut rng), None);
    }

    #[test]
    fn the_first_win_their_tournaments_and_the_last_win_one_in_as_many() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mut drawn = [0_i32; 4];
        for _ in 0..160_000 {
            drawn[tournament(4, &mut rng).unwrap()] += 1;
        }
        for (drawn, expected) in drawn.into_iter().zip([70_000, 50_000, 30_000, 10_000]) {
            assert!((drawn - expected).abs() < 1000, "{drawn}");
        }
        assert_eq!(tournament(0, &mut rng), None);
    }
}

//! Points of which none is better in everything: fronts, and how lonely their members are.
//!
//! After Deb, Pratap, Agarwal and Meyarivan, "A Fast and Elitist Multiobjective Genetic Algorithm:
//! NSGA-II" (IEEE Transactions on Evolutionary Computation 6(2), 2002), section III. A point has a number
//! for each objective, all points the same objectives, and the smaller a number the better.

/// Whether `a` is no worse than `b` in anything, and better in something.
///
/// ```
/// use evolve::pareto::dominates;
/// assert!(dominates(&[1.0, 2.0], &[1.0, 3.0]));
/// assert!(!dominates(&[1.0, 2.0], &[0.9, 3.0]));
/// assert!(!dominates(&[1.0, 2.0], &[1.0, 2.0]));
/// ```
///
/// # Panics
///
/// If the points differ in their number of objectives.
pub fn dominates(a: &[f64], b: &[f64]) -> bool {
    assert_eq!(a.len(), b.len(), "the same objectives");
    let pairs = || a.iter().zip(b);
    pairs().all(|(a, b)| a <= b) && pairs().any(|(a, b)| a < b)
}

/// The points that none dominates, by number, in order.
///
/// # Panics
///
/// If the points differ in their number of objectives.
pub fn front(points: &[Vec<f64>]) -> Vec<usize> {
    fronts(points).into_iter().next().unwrap_or_default()
}

/// All points by number, in fronts: the first one has those that none dominates, the next one those that
/// none dominates once the first has gone, and so on. Within a front they keep their order.
///
/// # Panics
///
/// If the points differ in their number of objectives.
pub fn fronts(points: &[Vec<f64>]) -> Vec<Vec<usize>> {
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut fronts = Vec::new();
    while !left.is_empty() {
        let is_dominated = |&place: &usize| {
            let mut others = left.iter();
            others.any(|&other| dominates(&points[other], &points[place]))
        };
        let (later, front) = left.iter().copied().partition(is_dominated);
        left = later;
        fronts.push(front);
    }
    fronts
}

/// How far each point of a front is from its neighbours: in each objective the distance between the next
/// smaller and the next larger one, as a part of the front's extent, and the sum of these. The first and
/// last of an objective have nobody on one side, and are at infinity.
///
/// # Panics
///
/// If a number of the front is out of `points`, or the points differ in their number of objectives.
pub fn crowding(points: &[Vec<f64>], front: &[usize]) -> Vec<f64> {
    let objectives = front.first().map_or(0, |&place| points[place].len());
    let mut distances = vec![0.0; front.len()];
    let of_all = |objective: usize| front.iter().map(move |&place| points[place][objective]);
    for values in (0..objectives).map(of_all) {
        add_gaps(&values.collect::<Vec<f64>>(), &mut distances);
    }
    distances
}

/// Adds to every distance what is between the neighbours of its value, the whole extent being 1.
fn add_gaps(values: &[f64], distances: &mut [f64]) {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let (least, most) = (order[0], order[order.len() - 1]);
    distances[least] = f64::INFINITY;
    distances[most] = f64::INFINITY;
    let extent = values[most] - values[least];
    for neighbours in order.windows(3).filter(|_| extent > 0.0) {
        if let [before, member, after] = *neighbours {
            distances[member] += (values[after] - values[before]) / extent;
        }
    }
}

/// Points by number, the best first: by front, and within a front the loneliest first; of equals the one
/// that came first.
///
/// # Panics
///
/// If the points differ in their number of objectives.
pub fn ranked(points: &[Vec<f64>]) -> Vec<usize> {
    let of_front = |front: Vec<usize>| {
        let distances = crowding(points, &front);
        let mut members: Vec<(f64, usize)> = distances.into_iter().zip(front).collect();
        members.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        members.into_iter().map(|(_, place)| place)
    };
    fronts(points).into_iter().flat_map(of_front).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Points on a coarse grid, so that many share a number or are equal.
    fn random_points(rng: &mut ChaCha8Rng) -> Vec<Vec<f64>> {
        let count = rng.random_range(1..40);
        let mut point = || {
            (0..3)
                .map(|_| f64::from(rng.random_range(0_u8..6)))
                .collect()
        };
        (0..count).map(|_| point()).collect()
    }

    #[test]
    fn nobody_dominates_who_dominates_him_or_equals_him() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        for _ in 0..200 {
            let points = random_points(&mut rng);
            for a in &points {
                assert!(!dominates(a, a));
                for b in &points {
                    assert!(!(dominates(a, b) && dominates(b, a)));
                }
            }
        }
    }

    #[test]
    fn a_front_has_those_whom_only_earlier_fronts_dominate() {
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        for _ in 0..200 {
            let points = random_points(&mut rng);
            let fronts = fronts(&points);
            let mut all: Vec<usize> = fronts.concat();
            all.sort_unstable();
            assert!(
                all.into_iter().eq(0..points.len()),
                "each is in one of them"
            );
            for (number, front) in fronts.iter().enumerate() {
                for &member in front {
                    let dominated_by =
                        |other: &&usize| dominates(&points[**other], &points[member]);
                    assert_eq!(front.iter().find(dominated_by), None);
                    let before = number.checked_sub(1).map(|before| &fronts[before]);
                    if let Some(before) = before {
                        assert!(before.iter().any(|other| dominated_by(&other)));
                    }
                }
            }
        }
    }

    #[test]
    fn of_all_points_on_a_grid_the_corner_is_the_front_and_without_it_its_neighbours() {
        let grid = || (0..27).map(|n| [n / 9, n / 3 % 3, n % 3].map(f64::from).to_vec());
        let points: Vec<_> = grid().collect();
        assert_eq!(front(&points), [0]);
        let points: Vec<_> = grid().skip(1).collect();
        let members: Vec<_> = front(&points).into_iter().map(|n| &points[n]).collect();
        assert_eq!(
            members,
            [&[0.0, 0.0, 1.0], &[0.0, 1.0, 0.0], &[1.0, 0.0, 0.0]]
        );
    }

    #[test]
    fn equals_are_on_the_front_together() {
        let points = [[1.0, 2.0], [2.0, 2.0], [1.0, 2.0]].map(|point| point.to_vec());
        assert_eq!(front(&points), [0, 2]);
        assert_eq!(front(&[]), [] as [usize; 0]);
    }

    #[test]
    fn the_lonely_are_ahead_of_the_crowded_and_ends_ahead_of_all() {
        let points: Vec<Vec<f64>> = [0.0, 1.0, 2.0, 8.0, 10.0]
            .map(|x| vec![x, -x])
            .into_iter()
            .collect();
        let front: Vec<usize> = (0..5).collect();
        let distances = crowding(&points, &front);
        assert_eq!(distances[0], f64::INFINITY);
        assert_eq!(distances[4], f64::INFINITY);
        let expected = [2.0 * 0.2, 2.0 * 0.7, 2.0 * 0.8];
        for (distance, expected) in distances[1..4].iter().zip(expected) {
            assert!((distance - expected).abs() < 1e-12);
        }
        assert_eq!(ranked(&points), [0, 4, 3, 2, 1]);
    }

    #[test]
    fn one_objective_alone_is_sorting() {
        let points: Vec<Vec<f64>> = [3.0, 1.0, 2.0, 1.0].map(|x| vec![x]).into();
        assert_eq!(ranked(&points), [1, 3, 2, 0]);
        assert!(ranked(&[]).is_empty());
    }

    #[test]
    fn a_front_without_extent_in_an_objective_is_ordered_by_the_others() {
        let points: Vec<Vec<f64>> = [[0.0, 1.0, 5.0], [1.0, 0.5, 5.0], [2.0, 0.0, 5.0]]
            .map(Vec::from)
            .into();
        let distances = crowding(&points, &[0, 1, 2]);
        assert!(distances.iter().all(|distance| !distance.is_nan()));
    }
}

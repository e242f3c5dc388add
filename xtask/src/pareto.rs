//! Who is beaten in everything, and who is not.

/// Whether `a` is no worse than `b` in anything, and better in something. A point has a number for each objective,
/// and the smaller a number the better.
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
    let is_beaten = |point: &[f64]| points.iter().any(|other| dominates(other, point));
    let numbered = points.iter().enumerate();
    let front = numbered.filter(|(_, point)| !is_beaten(point));
    front.map(|(number, _)| number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_takes_no_worse_in_all_and_better_in_one() {
        assert!(dominates(&[1.0, 2.0], &[1.0, 3.0]));
        assert!(!dominates(&[1.0, 2.0], &[0.9, 3.0]), "worse in one");
        assert!(!dominates(&[1.0, 2.0], &[1.0, 2.0]), "better in none");
        // What is not a number is neither.
        assert!(!dominates(&[f64::NAN, 1.0], &[2.0, 2.0]));
        assert!(!dominates(&[2.0, 2.0], &[f64::NAN, 3.0]));
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
}

//! The answers that a kernel may give for a packet and a list of triangles.

use crate::oracle::{Verdict, for_each_verdict};
use crate::{Packet, Query, Regime, Task, Triangle, answers};

/// The answers that an `f32` kernel may give for a packet and a list of triangles in a regime.
///
/// In [`Regime::Shrinking`] and [`Regime::Leaf`] that is a ray's closest hit, in
/// [`Regime::Fixed`] its last one in the list's order; either the oracle's clear hit, or one
/// that the oracle is unsure of and that would come before it. Of a query for any hit the answer is
/// negative infinity, if there may be a hit.
#[derive(Clone, Debug)]
pub struct Expected {
    task: Task,
    rays: Vec<RayAnswers>,
}

/// The answers that are right for one ray.
#[derive(Clone, Debug)]
struct RayAnswers {
    /// What the kernel finds where it stores its answer, and leaves there without a hit.
    before: f32,
    /// What it finds in the other one of `t` and `hit_t`, and leaves there.
    other: f32,
    /// The answer must not be greater than this: some clear hit comes before it.
    limit: f64,
    /// Parameter of the closest, or last, clear hit.
    clear: Option<f64>,
    possible: Vec<PossibleHit>,
}

#[derive(Clone, Copy, Debug)]
struct PossibleHit {
    t: f64,
    tolerance: f64,
    is_clear: bool,
    /// The triangle's place in the list.
    triangle: usize,
}

impl PossibleHit {
    fn explains(&self, kernel_t: f64) -> bool {
        (kernel_t - self.t).abs() <= self.tolerance
    }
}

impl Expected {
    /// Judges every ray of `packet`, as it is before the kernel has seen it, against `triangles`.
    /// Takes some 40 ns a ray and triangle. In [`Regime::Leaf`], `triangles` is one list.
    pub fn of<const N: usize>(
        task: impl Into<Task>,
        packet: &Packet<N>,
        triangles: &[Triangle],
    ) -> Self {
        let task = task.into();
        let regime = task.regime;
        let (before, other) = (answers(regime, packet), untouched(regime, packet));
        let mut rays: Vec<RayAnswers> = std::iter::zip(before, other)
            .map(|(&before, &other)| RayAnswers {
                before,
                other,
                limit: f64::INFINITY,
                clear: None,
                possible: Vec::new(),
            })
            .collect();
        for_each_verdict(task, packet, triangles, |ray, triangle, verdict| {
            let hit = match verdict {
                Verdict::Miss => return,
                Verdict::Hit { t, tolerance } => PossibleHit {
                    t,
                    tolerance,
                    is_clear: true,
                    triangle,
                },
                Verdict::Unsure { t, tolerance } => PossibleHit {
                    t,
                    tolerance,
                    is_clear: false,
                    triangle,
                },
            };
            match regime {
                Regime::Shrinking | Regime::Leaf => rays[ray].add_closest(hit),
                Regime::Fixed => rays[ray].add_last(hit),
            }
        });
        Self { task, rays }
    }

    /// The oracle's parameter of ray `ray`'s clear hit, if it has one.
    ///
    /// # Panics
    ///
    /// There are not so many rays.
    pub fn clear_hit(&self, ray: usize) -> Option<f64> {
        self.rays[ray].clear
    }

    /// Whether a kernel may leave `kernel_t` where it stores the answer of ray `ray`: a right
    /// hit, or, if there is no clear one, what was there before, bit by bit.
    ///
    /// # Panics
    ///
    /// There are not so many rays.
    pub fn accepts(&self, ray: usize, kernel_t: f32) -> bool {
        let answers = &self.rays[ray];
        if self.task.query == Query::Any && kernel_t == f32::NEG_INFINITY {
            return !answers.possible.is_empty() || answers.before == f32::NEG_INFINITY;
        }
        if kernel_t.to_bits() == answers.before.to_bits() {
            answers.clear.is_none()
        } else {
            self.task.query == Query::Closest && answers.explanation(kernel_t).is_some()
        }
    }

    /// `|kernel_t - t| / t`, if the kernel returned a clear hit of ray `ray`, and `t` is that
    /// hit's parameter in `f64`.
    ///
    /// # Panics
    ///
    /// There are not so many rays.
    pub fn relative_error(&self, ray: usize, kernel_t: f32) -> Option<f64> {
        let hit = self.rays[ray].explanation(kernel_t)?;
        hit.is_clear
            .then(|| (f64::from(kernel_t) - hit.t).abs() / hit.t)
    }

    /// The places in the list of the triangles that explain an answer: those that the kernel may
    /// have meant. None if nothing was hit.
    ///
    /// # Panics
    ///
    /// There are not so many rays.
    pub fn triangles(&self, ray: usize, kernel_t: f32) -> Vec<usize> {
        let answers = &self.rays[ray];
        if kernel_t.to_bits() == answers.before.to_bits() {
            return Vec::new();
        }
        let t = f64::from(kernel_t);
        let explains = answers.possible.iter().filter(|hit| hit.explains(t));
        explains.map(|hit| hit.triangle).collect()
    }

    /// The first ray for which `after`, the packet as the kernel left it, has a wrong answer, or
    /// a changed value in `t` ([`Regime::Fixed`]) or `hit_t` (the others).
    ///
    /// # Panics
    ///
    /// There are not so many rays.
    pub fn first_wrong_ray<const N: usize>(&self, after: &Packet<N>) -> Option<usize> {
        let (answers, others) = (
            answers(self.task.regime, after),
            untouched(self.task.regime, after),
        );
        (0..N).find(|&ray| {
            let is_kept = others[ray].to_bits() == self.rays[ray].other.to_bits();
            !(is_kept && self.accepts(ray, answers[ray]))
        })
    }
}

impl RayAnswers {
    /// A kernel that keeps the closest hit finds every clear one, so its answer is at most the
    /// least that any of them allows.
    fn add_closest(&mut self, hit: PossibleHit) {
        if hit.t - hit.tolerance > self.limit {
            return;
        }
        self.possible.push(hit);
        if !hit.is_clear {
            return;
        }
        self.clear = Some(self.clear.map_or(hit.t, |t| t.min(hit.t)));
        if hit.t + hit.tolerance < self.limit {
            let limit = hit.t + hit.tolerance;
            self.limit = limit;
            self.possible.retain(|hit| hit.t - hit.tolerance <= limit);
        }
    }

    /// A kernel that keeps the last hit overwrites all others with a clear one.
    fn add_last(&mut self, hit: PossibleHit) {
        if hit.is_clear {
            self.possible.clear();
            self.clear = Some(hit.t);
        }
        self.possible.push(hit);
    }

    /// The possible hit that `kernel_t` is nearest to, if it is near enough to any.
    fn explanation(&self, kernel_t: f32) -> Option<PossibleHit> {
        let kernel_t = f64::from(kernel_t);
        if !(kernel_t > 0.0 && kernel_t <= self.limit) {
            return None;
        }
        let explains = self.possible.iter().filter(|hit| hit.explains(kernel_t));
        let distance = |hit: &PossibleHit| (kernel_t - hit.t).abs();
        explains
            .copied()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

/// What a kernel built for `regime` leaves alone: the other one of `t` and `hit_t`.
fn untouched<const N: usize>(regime: Regime, packet: &Packet<N>) -> &[f32; N] {
    match regime {
        Regime::Shrinking | Regime::Leaf => &packet.hit_t,
        Regime::Fixed => &packet.t,
    }
}

#[cfg(test)]
mod tests {
    use super::Expected;
    use crate::{Packet, Regime, Triangle, one_ray};

    const T_MAX: f32 = 100.0;

    /// Rays 0 and 1 go up through the triangles of [`at_height`], ray 1 through their edges; ray
    /// 2 goes past them, and ray 3 is inactive.
    fn packet() -> Packet<4> {
        Packet {
            ox: [0.25, 0.0, -1.0, 0.25],
            oy: [0.25; 4],
            oz: [0.0; 4],
            dx: [0.0; 4],
            dy: [0.0; 4],
            dz: [1.0; 4],
            t: [T_MAX, T_MAX, T_MAX, -1.0],
            hit_t: [f32::INFINITY; 4],
            t_min: [0.0; 4],
        }
    }

    fn at_height(z: f32) -> Triangle {
        Triangle {
            p0: [0.0, 0.0, z],
            p1: [1.0, 0.0, z],
            p2: [0.0, 1.0, z],
        }
    }

    #[test]
    fn shrinking_wants_the_closest_hit_and_fixed_the_last() {
        let triangles = [3.0, 2.0, 4.0].map(at_height);
        for (regime, right, wrong) in [
            (Regime::Shrinking, 2.0, [3.0, 4.0, T_MAX]),
            (Regime::Leaf, 2.0, [3.0, 4.0, T_MAX]),
            (Regime::Fixed, 4.0, [2.0, 3.0, f32::INFINITY]),
        ] {
            let expected = Expected::of(regime, &packet(), &triangles);
            assert_eq!(expected.clear_hit(0), Some(f64::from(right)));
            assert!(expected.accepts(0, right) && expected.accepts(0, right * (1.0 + 1e-6)));
            assert!(!expected.accepts(0, right * 0.999) && !expected.accepts(0, f32::NAN));
            for wrong in wrong {
                assert!(!expected.accepts(0, wrong), "{regime}: {wrong}");
            }
        }
    }

    #[test]
    fn an_unsure_hit_may_be_reported_or_not() {
        let expected = Expected::of(Regime::Shrinking, &packet(), &[2.0, 3.0].map(at_height));
        assert_eq!(expected.clear_hit(1), None);
        for t in [T_MAX, 2.0, 3.0] {
            assert!(expected.accepts(1, t), "{t}");
        }
        assert!(!expected.accepts(1, 2.5));
        assert_eq!(expected.relative_error(1, 2.0), None);
    }

    #[test]
    fn an_unsure_hit_behind_a_clear_one_is_wrong() {
        let shifted = |z: f32| {
            let Triangle { p0, p1, p2 } = at_height(z);
            let left = |[x, y, z]: [f32; 3]| [x - 0.25, y, z];
            Triangle {
                p0: left(p0),
                p1: left(p1),
                p2: left(p2),
            }
        };
        let behind = Expected::of(
            Regime::Shrinking,
            &packet(),
            &[at_height(3.0), shifted(2.0)],
        );
        assert!(behind.accepts(1, 2.0) && !behind.accepts(1, 3.0));
        let before = Expected::of(
            Regime::Shrinking,
            &packet(),
            &[at_height(1.0), shifted(2.0)],
        );
        assert!(before.accepts(1, 2.0) && before.accepts(1, 1.0));
    }

    #[test]
    fn without_a_hit_the_bits_stay() {
        let expected = Expected::of(Regime::Shrinking, &packet(), &[at_height(2.0)]);
        assert!(expected.accepts(2, T_MAX) && !expected.accepts(2, 2.0));
        assert!(expected.accepts(3, -1.0) && !expected.accepts(3, 2.0));
    }

    #[test]
    fn a_ray_by_itself_has_the_answers_that_it_has_among_others() {
        let triangles = [3.0, 2.0, 4.0].map(at_height);
        for &regime in Regime::ALL {
            let together = Expected::of(regime, &packet(), &triangles);
            for ray in 0..4 {
                let alone = Expected::of(regime, &one_ray(&packet(), ray), &triangles);
                assert_eq!(alone.clear_hit(0), together.clear_hit(ray));
                for t in [2.0, 3.0, 4.0, T_MAX, -1.0, f32::INFINITY] {
                    assert_eq!(alone.accepts(0, t), together.accepts(ray, t), "{ray}, {t}");
                }
            }
        }
    }

    #[test]
    fn the_error_is_relative_to_the_clear_hit() {
        let expected = Expected::of(Regime::Shrinking, &packet(), &[at_height(2.0)]);
        let next = 2.0_f32.next_up();
        assert_eq!(
            expected.relative_error(0, next),
            Some(f64::from(f32::EPSILON))
        );
        assert_eq!(expected.relative_error(0, 1.5), None);
        assert_eq!(expected.relative_error(2, T_MAX), None);
    }

    #[test]
    fn the_array_that_holds_no_answers_must_not_change() {
        let mut after = packet();
        after.t[0] = 2.0;
        let expected = Expected::of(Regime::Shrinking, &packet(), &[at_height(2.0)]);
        assert_eq!(expected.first_wrong_ray(&after), None);
        after.hit_t[2] = 1.0;
        assert_eq!(expected.first_wrong_ray(&after), Some(2));
        after.t[0] = T_MAX;
        assert_eq!(expected.first_wrong_ray(&after), Some(0));

        let fixed = Expected::of(Regime::Fixed, &packet(), &[at_height(2.0)]);
        let mut after = packet();
        after.hit_t[0] = 2.0;
        assert_eq!(fixed.first_wrong_ray(&after), None);
        after.t[0] = 2.0;
        assert_eq!(fixed.first_wrong_ray(&after), Some(0));
    }
}

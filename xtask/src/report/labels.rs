//! Labels of marks in a plot, where none covers another or a mark.

/// A point in pixels, or a vector.
pub type Point = (f64, f64);

/// A rectangle: its corner at the upper left, its width and its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// The left end.
    pub x: f64,
    /// The upper end.
    pub y: f64,
    /// How wide it is.
    pub width: f64,
    /// How high it is.
    pub height: f64,
}

/// A label that is to be put beside a mark.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// The mark.
    pub mark: Point,
    /// The label's width.
    pub width: f64,
    /// How much more it matters than others that it is near.
    pub weight: f64,
}

/// Where a label is put.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// The label.
    pub label: Rectangle,
    /// The ends of a line from the mark to the label, if that is too far away to do without.
    pub leader: Option<(Point, Point)>,
}

/// Half of a mark's width, and what is left free around it.
const MARK: f64 = 7.0;

/// Distances from a mark that are tried, in pixels.
const DISTANCES: [f64; 12] = [
    9.0, 14.0, 20.0, 27.0, 36.0, 46.0, 57.0, 70.0, 85.0, 102.0, 125.0, 155.0,
];

/// Directions that are tried.
const DIRECTIONS: usize = 32;

/// Marks that are nearer to each other than this are a crowd.
const CROWD: f64 = 50.0;

/// A label that is farther than this has a leader.
const LEADERLESS: f64 = 10.0;

/// How often every label may choose again, when it knows where the others are.
const PASSES: usize = 6;

/// At this distance a label costs as much as there are pixels to it.
const FAR: f64 = 50.0;

/// What it costs to cover a label or a mark, to be out of the frame, or to have lines cross.
const COVERED: f64 = 2_000.0;
const CROSSED: f64 = 150.0;

/// What it costs to be nearer to another mark than this, which it may seem to belong to.
const BESIDE: f64 = 20.0;
const NEAR: f64 = 14.0;

/// Puts labels beside their marks, all of a height, within a frame. Marks that are near each other have theirs
/// farther away.
pub fn place(wanted: &[Wanted], height: f64, frame: Rectangle) -> Vec<Placed> {
    let marks: Vec<Point> = wanted.iter().map(|one| one.mark).collect();
    let near = |mark: &Point| {
        let near = marks
            .iter()
            .filter(|other| distance(*mark, **other) < CROWD);
        near.count() as f64
    };
    // What is best for all depends on who chooses first.
    let firsts: [&dyn Fn(&Point) -> f64; 6] = [
        &near,
        &|mark| -near(mark),
        &|mark| mark.0,
        &|mark| -mark.0,
        &|mark| mark.1,
        &|mark| -mark.1,
    ];
    let placements = firsts.map(|first| {
        let mut order: Vec<usize> = (0..marks.len()).collect();
        order.sort_by(|&a, &b| first(&marks[a]).total_cmp(&first(&marks[b])));
        place_in(&order, wanted, height, frame)
    });
    let best = placements.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(Vec::new(), |(_, placed)| placed)
}

/// The same, where labels choose their places in an order, and what it costs.
fn place_in(
    order: &[usize],
    wanted: &[Wanted],
    height: f64,
    frame: Rectangle,
) -> (f64, Vec<Placed>) {
    let mut placed: Vec<Option<Placed>> = vec![None; wanted.len()];
    let mut total = 0.0;
    for _ in 0..PASSES {
        total = 0.0;
        for &number in order {
            placed[number] = None;
            let others: Vec<Placed> = placed.iter().flatten().copied().collect();
            let candidates = candidates(wanted[number].mark, wanted[number].width, height);
            let costs = candidates.map(|one| (cost(&one, wanted, number, &others, frame), one));
            if let Some((cost, best)) = costs.min_by(|a, b| a.0.total_cmp(&b.0)) {
                total += cost;
                placed[number] = Some(best);
            }
        }
    }
    (total, placed.into_iter().flatten().collect())
}

/// All places that a label may have.
fn candidates(mark: Point, width: f64, height: f64) -> impl Iterator<Item = Placed> {
    DISTANCES.into_iter().flat_map(move |away| {
        (0..DIRECTIONS).map(move |direction| {
            let angle = std::f64::consts::TAU * direction as f64 / DIRECTIONS as f64;
            let (along, up) = (angle.cos(), angle.sin());
            let near = (mark.0 + away * along, mark.1 - away * up);
            // The label begins where it is nearest to the mark.
            let label = Rectangle {
                x: near.0 - width * (1.0 - along) / 2.0,
                y: near.1 - height * (1.0 + up) / 2.0,
                width,
                height,
            };
            Placed {
                label,
                leader: (away > LEADERLESS).then(|| leader(mark, label)),
            }
        })
    })
}

/// From the rim of a mark to the nearest point of a label.
fn leader(mark: Point, label: Rectangle) -> (Point, Point) {
    let end = label.nearest(mark);
    let share = ((MARK - 2.0) / distance(mark, end)).min(1.0);
    let start = (
        mark.0 + share * (end.0 - mark.0),
        mark.1 + share * (end.1 - mark.1),
    );
    (start, end)
}

fn cost(one: &Placed, wanted: &[Wanted], own: usize, others: &[Placed], frame: Rectangle) -> f64 {
    let Wanted { mark, weight, .. } = wanted[own];
    let near = one.label.nearest(mark);
    // Two labels that are a little away are better than one that is far away.
    let mut cost = weight * distance(mark, near).powi(2) / FAR;
    cost += COVERED * f64::from(u8::from(!frame.holds(one.label)));
    for (number, &Wanted { mark, .. }) in wanted.iter().enumerate() {
        let nearest = one.label.nearest(mark);
        let room = if number == own { MARK - 2.0 } else { MARK };
        cost += COVERED * f64::from(u8::from(distance(mark, nearest) < room));
        let is_near = number != own && distance(mark, nearest) < NEAR;
        cost += BESIDE * f64::from(u8::from(is_near));
        let is_crossed = |(start, end)| number != own && from_segment(mark, start, end) < MARK;
        cost += CROSSED * f64::from(u8::from(one.leader.is_some_and(is_crossed)));
    }
    for other in others {
        cost += COVERED * f64::from(u8::from(one.label.touches(other.label)));
        let through = |leader: Option<(Point, Point)>, label: Rectangle| {
            leader.is_some_and(|(start, end)| label.is_crossed_by(start, end))
        };
        let crossings = [
            through(one.leader, other.label),
            through(other.leader, one.label),
            matches!((one.leader, other.leader), (Some(a), Some(b)) if cross(a, b)),
        ];
        cost += CROSSED
            * crossings
                .into_iter()
                .map(|it| f64::from(u8::from(it)))
                .sum::<f64>();
    }
    cost
}

impl Rectangle {
    fn nearest(&self, (x, y): Point) -> Point {
        (
            x.clamp(self.x, self.x + self.width),
            y.clamp(self.y, self.y + self.height),
        )
    }

    fn holds(&self, other: Rectangle) -> bool {
        let is_within = |start: f64, size: f64, other: f64, other_size: f64| {
            start <= other && other + other_size <= start + size
        };
        is_within(self.x, self.width, other.x, other.width)
            && is_within(self.y, self.height, other.y, other.height)
    }

    fn touches(&self, other: Rectangle) -> bool {
        self.x < other.x + other.width
            && other.x < self.x + self.width
            && self.y < other.y + other.height
            && other.y < self.y + self.height
    }

    fn is_crossed_by(&self, start: Point, end: Point) -> bool {
        let Rectangle {
            x,
            y,
            width,
            height,
        } = *self;
        let (right, lower) = (x + width, y + height);
        let diagonals = [((x, y), (right, lower)), ((right, y), (x, lower))];
        let ends_within = [start, end].iter().any(|&it| self.nearest(it) == it);
        ends_within
            || diagonals
                .iter()
                .any(|&diagonal| cross(diagonal, (start, end)))
    }
}

fn distance(a: Point, b: Point) -> f64 {
    (a.0 - b.0).hypot(a.1 - b.1)
}

/// How far a point is from a segment.
fn from_segment(point: Point, start: Point, end: Point) -> f64 {
    let (along, to) = (
        (end.0 - start.0, end.1 - start.1),
        (point.0 - start.0, point.1 - start.1),
    );
    let squared = along.0 * along.0 + along.1 * along.1;
    let share = match squared > 0.0 {
        true => ((along.0 * to.0 + along.1 * to.1) / squared).clamp(0.0, 1.0),
        false => 0.0,
    };
    distance(
        point,
        (start.0 + share * along.0, start.1 + share * along.1),
    )
}

/// Whether two segments cross.
fn cross(a: (Point, Point), b: (Point, Point)) -> bool {
    let side = |(start, end): (Point, Point), point: Point| {
        (end.0 - start.0) * (point.1 - start.1) - (end.1 - start.1) * (point.0 - start.0)
    };
    side(a, b.0) * side(a, b.1) < 0.0 && side(b, a.0) * side(b, a.1) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rectangle = Rectangle {
        x: 0.0,
        y: 0.0,
        width: 540.0,
        height: 330.0,
    };

    #[test]
    fn of_a_crowd_of_marks_no_label_covers_another_or_a_mark_or_leaves_the_frame() {
        // Sixteen in a strip of 150 by 20, as kernels are that differ by a little.
        let marks: Vec<Point> = (0..16)
            .map(|number| {
                (
                    60.0 + 10.0 * f64::from(number),
                    150.0 + f64::from(number * 7 % 20),
                )
            })
            .collect();
        let wanted = |(number, &mark): (usize, &Point)| Wanted {
            mark,
            width: 40.0 + 7.0 * (number % 13) as f64,
            weight: 1.0,
        };
        let wanted: Vec<Wanted> = marks.iter().enumerate().map(wanted).collect();
        let placed = place(&wanted, 13.0, FRAME);
        assert_eq!(placed.len(), marks.len());
        for (number, one) in placed.iter().enumerate() {
            assert!(FRAME.holds(one.label), "{one:?}");
            for mark in &marks {
                assert!(
                    distance(*mark, one.label.nearest(*mark)) >= MARK - 2.0,
                    "{one:?}"
                );
            }
            for other in &placed[..number] {
                assert!(!one.label.touches(other.label), "{one:?} {other:?}");
            }
        }
    }

    #[test]
    fn a_lonely_mark_has_its_label_beside_it_and_no_line() {
        let alone = |x| Wanted {
            mark: (x, 100.0),
            width: 80.0,
            weight: 1.0,
        };
        let placed = place(&[alone(200.0)], 12.0, FRAME);
        assert_eq!(placed[0].leader, None);
        assert!(distance((200.0, 100.0), placed[0].label.nearest((200.0, 100.0))) < 10.0);
        // At the right end it is put where there is room.
        let placed = place(&[alone(530.0)], 12.0, FRAME);
        assert!(FRAME.holds(placed[0].label), "{placed:?}");
    }

    #[test]
    fn segments_cross_where_they_cross() {
        assert!(cross(((0.0, 0.0), (2.0, 2.0)), ((0.0, 2.0), (2.0, 0.0))));
        assert!(!cross(((0.0, 0.0), (2.0, 2.0)), ((3.0, 2.0), (5.0, 0.0))));
        assert_eq!(from_segment((1.0, 1.0), (0.0, 0.0), (2.0, 0.0)), 1.0);
        assert_eq!(from_segment((5.0, 4.0), (2.0, 0.0), (2.0, 0.0)), 5.0);
    }
}

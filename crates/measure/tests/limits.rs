//! What every class of kernels keeps to: one table of limits, each with its reason, and kernels of each class that
//! are judged by it on every instruction set.
//!
//! A kernel beyond a limit fails, and so does a limit that is more than ten times what the worst of its class
//! needs. What is limited by nothing is said to be so.

mod figures;
mod loaded;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

use accuracy::{Aim, PairCase, Scaling, Sweep};
use emit::{Isa, Kernel, Recipe, graph, print_kernel};
use figures::{Metric, figures};
use loaded::{isas, recipes, small_bench};
use measure::{Judged, Look};
use program::{Genome, Program, kensler_shirley, moller_trumbore_volumes};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use scene::{Grouping, Numeric, Origin, Output, SceneModel, Watertight};

/// Random programs of each class.
const RANDOM_PROGRAMS: usize = 2;

const LOOK: Look = Look {
    samples: 1024,
    seed: 21,
};

/// What kernels promise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Class {
    watertight: Watertight,
    numeric: Numeric,
}

/// The limits of a metric, by class.
struct Limits {
    /// Of kernels that promise nothing about edges, that are tight at edges, and at vertices too.
    fast: [f64; 3],
    /// The same of portable ones.
    portable: [f64; 3],
    /// Why so much, and no less.
    because: &'static str,
}

/// No limit.
const NOTHING: f64 = f64::INFINITY;

/// A limit that is more than so many times what is needed hides what becomes worse.
const LOOSE: f64 = 10.0;

/// A limit of zero says something only if so many could have been more.
const FEWEST: u64 = 1000;

/// The same for portable kernels.
fn limits(fast: [f64; 3], because: &'static str) -> Limits {
    Limits {
        fast,
        portable: fast,
        because,
    }
}

impl Limits {
    fn portable(self, portable: [f64; 3]) -> Limits {
        Limits { portable, ..self }
    }

    fn of(&self, class: Class) -> f64 {
        let by_watertight = match class.numeric {
            Numeric::Fast => self.fast,
            Numeric::Portable => self.portable,
        };
        by_watertight[match class.watertight {
            Watertight::None => 0,
            Watertight::Edges => 1,
            Watertight::Full => 2,
        }]
    }
}

/// The table.
#[rustfmt::skip]
fn limits_of(metric: Metric) -> Limits {
    match metric {
        Metric::Leak(Aim::Edge) => limits([0.5, 0.0, 0.0],
            "each triangle of a side computes that side by itself, unless it is tight there"),
        Metric::Leak(Aim::Vertex) => limits([0.6, 7e-3, 0.0],
            "sides that meet in a vertex agree about it only where it is one point for all of them"),
        Metric::Leak(Aim::Elsewhere) => limits([0.0; 3],
            "rounding moves nothing that is not at a side"),
        Metric::Double(Aim::Edge) => limits([0.7, 0.5, 1e-3],
            "a zero is inside on both sides; exact signs have zeros only where far vertices fall on one point"),
        Metric::Double(Aim::Vertex) => limits([0.9; 3],
            "as at edges, and most vertices are far away, or many meet there"),
        Metric::Double(Aim::Elsewhere) => limits([0.0; 3],
            "rounding moves nothing that is not at a side"),
        Metric::Unpaired => limits([2e-2, 3e-3, 0.0],
            "the way out of a mesh leaks as the way in does"),
        Metric::Wrong(case) => wrong(case),
        Metric::WrongBy(case) => wrong_by(case),
        Metric::ParallelHit => limits([0.3, 0.2, 0.2],
            "three points on a line have an area by the rounding of their differences"),
        Metric::Tie => limits([NOTHING; 3],
            "either answer is right"),
        Metric::TBoundaryHit => limits([NOTHING; 3],
            "the ends do not count, and quotients of small integers are exact, which estimates are not")
            .portable([0.0; 3]),
        Metric::NotFinite | Metric::OutOfRange => limits([0.0; 3],
            "what is stored has passed ordered tests of both ends"),
        Metric::RelativeError(case) => relative_error(case),
        Metric::Ulps => limits([12.0, 16.0, 1.5],
            "the median of the worst formulation; sheared vertices have the ray for an axis"),
        Metric::PositionError(case) => position_error(case),
        Metric::UvError(case) => uv_error(case),
        Metric::Swept(Sweep::Distance) => limits([2e-4, 4e-4, 8e-7],
            "as ordinary ones: coordinates are used by their differences alone"),
        Metric::Swept(Sweep::Scale) => limits([2e-4, 6e-4, 6e-7],
            "as ordinary ones: powers of two round nothing"),
        Metric::Scale(Scaling::Everything) => limits([1.0 / 16.0, 1.0 / 37.0, 1.0 / 24.0],
            "sixth powers of the scale may be compared; third ones at edges; fourth ones of sheared vertices"),
        Metric::Scale(Scaling::Positions) => limits([1.0 / 19.0, 1.0 / 37.0, 1.0 / 19.0],
            "as above, and t_max is among positions"),
        Metric::Scale(Scaling::Directions) => limits([1.0 / 48.0, 1.0 / 100.0, 1.0 / 97.0],
            "directions are in volumes once; the lab looks no farther than 100"),
        Metric::HostileHit => limits([0.0; 3],
            "no ordered comparison with NaN is true, and no infinite volume has a t in range"),
        Metric::Disturbed => limits([0.0; 3],
            "lanes have nothing to do with each other"),
    }
}

/// Half of the rays are next to a side, from a tenth of the triangle down to 10^-7 of it away.
#[rustfmt::skip]
fn wrong(case: PairCase) -> Limits {
    match case {
        PairCase::Ordinary | PairCase::Scaled => limits([0.07, 0.07, 0.03],
            "next to a side, less than a rounding of a coordinate away"),
        PairCase::Sliver => limits([0.5, 0.5, 0.3],
            "of a sliver nothing is more than 10^-6 to 10^-2 away from a side"),
        PairCase::Grazing => limits([0.3, 0.3, 0.15],
            "a triangle 1 across has 0.01 to be aimed at"),
        PairCase::NearlyParallel => limits([0.7, 0.7, 0.5],
            "the triangle is as high as the rounding of its vertices"),
        PairCase::SelfHit => limits([0.2, 0.2, 0.1],
            "rounding decides which side of the triangle a ray begins on"),
        PairCase::Small => limits([1.0, 1.0, 0.4],
            "volumes are small differences of products of what the origin is away; sheared vertices are less so"),
        PairCase::Far => limits([0.06, 0.025, 0.01],
            "differences of coordinates are exact, and rays are that much coarser"),
        PairCase::Subnormal => limits([1.0; 3],
            "volumes are zero, so all is missed"),
        PairCase::Degenerate => limits([NOTHING; 3],
            "there is no inside"),
        PairCase::Limits => limits([0.0; 3],
            "small integers have no rounding"),
    }
}

#[rustfmt::skip]
fn wrong_by(case: PairCase) -> Limits {
    match case {
        PairCase::Ordinary | PairCase::Far => limits([6e-5, 6e-5, 2e-6],
            "rounding of volumes beside the triangle's, which is 10^-2 of what they are differences of; sheared \
             vertices are off by a rounding of their distance from the ray"),
        PairCase::Scaled => limits([1.5e-4, 5e-5, 4e-6],
            "as ordinary ones, and at the least scales squares lose bits")
            .portable([3e-5, 5e-5, 4e-6]),
        PairCase::Sliver => limits([1.5, 1.0, 1.0],
            "a rounding of a coordinate may be a third of the height"),
        PairCase::Grazing => limits([1e-2, 1e-2, 3e-3],
            "as ordinary ones, a hundred times as flat"),
        PairCase::NearlyParallel => limits([NOTHING; 3],
            "the exact coordinates of a point in the plane of a triangle that is seen from its side are anything"),
        PairCase::SelfHit => limits([1.0; 3],
            "any point of the triangle may be the one that is before or behind its plane"),
        PairCase::Small => limits([4.0, 1.0, 1.0],
            "the triangle is as large as the rounding of the distance, and its volume may have either sign"),
        PairCase::Subnormal => limits([1.0; 3],
            "all is missed, the middle too"),
        PairCase::Degenerate | PairCase::Limits => limits([NOTHING; 3],
            "nothing is wrong there"),
    }
}

#[rustfmt::skip]
fn relative_error(case: PairCase) -> Limits {
    match case {
        PairCase::Ordinary => limits([6e-4, 9e-4, 8e-7],
            "V and Va may be small differences of volumes about the ray's origin; of sheared vertices, Va is a mean \
             of depths"),
        PairCase::Far | PairCase::Scaled => limits([3e-4, 4e-4, 8e-7],
            "as ordinary ones, of other rays"),
        PairCase::Sliver => limits([4.0, 4.0, 4e-3],
            "V is rounding; so are all volumes in a quotient of sheared ones, but not their ratio if division is exact")
            .portable([4.0, 4.0, 8e-7]),
        PairCase::Grazing => limits([6e-2, 0.1, 7e-5],
            "V is a hundredth of what it is a difference of")
            .portable([6e-2, 0.1, 1.5e-5]),
        PairCase::NearlyParallel => limits([70.0, 10.0, 0.3],
            "V is rounding"),
        PairCase::SelfHit => limits([NOTHING; 3],
            "the exact t is rounding"),
        PairCase::Small => limits([9.0, 3.0, 8e-7],
            "V is rounding; depths of sheared vertices are all alike"),
        PairCase::Limits => limits([3e-7, 0.0, 3e-7],
            "small integers have no rounding, but a reciprocal has")
            .portable([0.0; 3]),
        PairCase::Subnormal | PairCase::Degenerate => limits([NOTHING; 3],
            "there is no hit"),
    }
}

/// The point is where `t` says: limits are those of its error, by what is between origin and point.
#[rustfmt::skip]
fn position_error(case: PairCase) -> Limits {
    match case {
        PairCase::Ordinary => limits([9e-4, 1.3e-3, 1.2e-6],
            "as that of t"),
        PairCase::Scaled => limits([4e-4, 6e-4, 1.2e-6],
            "as that of t"),
        PairCase::Far => limits([5e-6, 2.5e-6, 8e-9],
            "as that of t, by coordinates that are farther than the way is long"),
        PairCase::Sliver => limits([4.0, 4.0, 4e-3],
            "as that of t")
            .portable([4.0, 4.0, 1.2e-6]),
        PairCase::Grazing => limits([7e-2, 0.15, 7e-5],
            "as that of t")
            .portable([7e-2, 0.15, 1.6e-5]),
        PairCase::NearlyParallel => limits([70.0, 10.0, 0.3],
            "as that of t"),
        PairCase::SelfHit => limits([1.5e-5, 2e-5, 4e-7],
            "the way is rounding, and so is what t is off"),
        PairCase::Small => limits([9.0, 6.0, 1.2e-6],
            "as that of t"),
        PairCase::Limits => limits([5e-7, 0.0, 5e-7],
            "as that of t")
            .portable([0.0; 3]),
        PairCase::Subnormal | PairCase::Degenerate => limits([NOTHING; 3],
            "there is no hit"),
    }
}

#[rustfmt::skip]
fn uv_error(case: PairCase) -> Limits {
    match case {
        PairCase::Ordinary | PairCase::Far | PairCase::Scaled => limits([4e-4, 4e-4, 2e-5],
            "volumes of sides may be small differences of what is as large as the ray is long; of sheared vertices, \
             of what is as large as the triangle"),
        PairCase::Sliver => limits([1.5, 5.0, 0.6],
            "V is rounding"),
        PairCase::Grazing => limits([6e-2, 0.1, 3e-3],
            "V is a hundredth of what it is a difference of"),
        PairCase::NearlyParallel => limits([3.0, 20.0, 1.5],
            "V is rounding"),
        PairCase::SelfHit => limits([1e-5, 6e-6, 6e-7],
            "the ray begins at the triangle, so volumes are no larger than that"),
        PairCase::Small => limits([3.0, 2e6, 1.5],
            "V is rounding, and not that of its sides if it is computed by itself"),
        PairCase::Limits => limits([1.2e-7, 6e-8, 2e-7],
            "quotients of small integers are rounded once; estimates, and products with a reciprocal, twice")
            .portable([6e-8; 3]),
        PairCase::Subnormal | PairCase::Degenerate => limits([NOTHING; 3],
            "there is no hit"),
    }
}

/// The worst of a class.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    value: f64,
    /// Of all kernels of the class together.
    samples: u64,
    isa: Option<Isa>,
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Worst {
            value,
            samples,
            isa,
        } = self;
        write!(f, "{value:.1e} of {samples}")?;
        isa.map_or(Ok(()), |isa| write!(f, " at worst, on {isa}"))
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "watertight {}, {}", self.watertight, self.numeric)
    }
}

/// Every class.
fn classes() -> impl Iterator<Item = Class> {
    let watertight = Watertight::ALL.iter();
    watertight.flat_map(|&watertight| {
        Numeric::ALL.iter().map(move |&numeric| Class {
            watertight,
            numeric,
        })
    })
}

/// Programs of a class for an instruction set.
fn programs(class: Class, isa: Isa) -> Vec<Program> {
    let Class {
        watertight,
        numeric,
    } = class;
    let scene = class.scene();
    assert_eq!(scene.check(), Ok(()));
    let graph = graph(&scene, &[isa]);
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let random = (0..RANDOM_PROGRAMS).map(|_| Genome::random(graph.nodes().len(), &mut rng));
    let mut programs: Vec<Program> = random
        .map(|genome| graph.program(&genome).unwrap())
        .collect();
    let is_of_class = |recipe: &Recipe| {
        let own = &recipe.scene;
        own.is_plain()
            && (numeric == Numeric::Portable || recipe.isas.contains(&isa))
            && (own.grouping, own.origin) == (Grouping::Packet, Origin::General)
            && (own.watertight, own.numeric) == (watertight, numeric)
    };
    let library = recipes().into_iter().filter(is_of_class);
    programs.extend(library.map(|recipe| recipe.program));
    programs
}

/// The rivals that belong to a class.
fn rivals_of(class: Class) -> &'static [&'static str] {
    match (class.watertight, class.numeric) {
        (Watertight::None, Numeric::Fast) => &["moller-trumbore", "kensler-shirley"],
        (Watertight::Full, Numeric::Fast) => &["woop"],
        (Watertight::Edges, Numeric::Fast) | (_, Numeric::Portable) => &[],
    }
}

fn rival(name: &str, isa: Isa) -> Kernel {
    let scene = packet();
    let rival = rivals::find(name, scene.grouping).unwrap();
    rival.kernel(isa, scene.regime)
}

fn packet() -> SceneModel {
    SceneModel::preset("packet").unwrap()
}

impl Class {
    /// The scene of its kernels, which report u and v.
    fn scene(self) -> SceneModel {
        SceneModel {
            watertight: self.watertight,
            numeric: self.numeric,
            outputs: vec![Output::Uv],
            ..packet()
        }
    }
}

/// What is found of the kernels of all classes on an instruction set.
fn judged(isa: Isa) -> Found {
    let bred = classes().flat_map(|class| {
        let print = move |program| print_kernel(&program, &class.scene(), isa, "kernel", "");
        let programs = programs(class, isa).into_iter();
        programs.map(move |program| (class, print(program)))
    });
    let by_hand = classes().flat_map(|class| {
        let rivals = rivals_of(class).iter();
        rivals.map(move |name| (class, rival(name, isa)))
    });
    let uv = SceneModel {
        outputs: vec![Output::Uv],
        ..packet()
    };
    let graph = kensler_shirley();
    let reference = graph.program(&moller_trumbore_volumes(&graph)).unwrap();
    let reference = print_kernel(&reference, &uv, isa, "kernel", "");
    let mut found = judged_beside(&uv, reference, bred.collect());
    // Those by hand report t alone.
    let reference = rival("moller-trumbore", isa);
    found.extend(judged_beside(&packet(), reference, by_hand.collect()));
    found
}

fn judged_beside(scene: &SceneModel, reference: Kernel, all: Vec<(Class, Kernel)>) -> Found {
    let mut bench = small_bench(scene, reference, 1000);
    let kernels: Vec<&Kernel> = all.iter().map(|(_, kernel)| kernel).collect();
    let built = bench.build(&kernels, false).unwrap();
    let judged = bench.judge(&built, LOOK).unwrap().into_iter();
    let classes = all.iter().map(|(class, _)| *class);
    classes.zip(judged.map(Result::unwrap)).collect()
}

/// What is found of the kernels of every class.
type Found = Vec<(Class, Judged)>;

/// The same on every instruction set.
static FOUND: LazyLock<Vec<(Isa, Found)>> =
    LazyLock::new(|| isas().into_iter().map(|isa| (isa, judged(isa))).collect());

#[test]
fn every_kernel_keeps_to_the_limits_of_its_class_and_no_limit_is_loose() {
    let mut worst: BTreeMap<(Metric, Class), Worst> = BTreeMap::new();
    for (isa, found) in FOUND.iter() {
        for (class, judged) in found {
            for (metric, value, samples) in figures(judged) {
                let one = worst.entry((metric, *class)).or_default();
                one.samples += samples;
                if value > one.value {
                    (one.value, one.isa) = (value, Some(*isa));
                }
            }
        }
    }
    let mut faults = Vec::new();
    for ((metric, class), worst) in worst {
        let limits = limits_of(metric);
        let limit = limits.of(class);
        let line = format!("{metric:?}, {class}: {limit:.1e}, {worst}");
        println!("{line}");
        let is_loose = limit.is_finite() && worst.value * LOOSE < limit;
        let is_empty = limit == 0.0 && worst.samples < FEWEST;
        if worst.value > limit || is_loose || is_empty {
            faults.push(format!("{line}, because {}", limits.because));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// To the last bit, whatever is asked; how that is at its worst is in `bits.rs`.
#[test]
fn what_is_found_of_portable_kernels_is_the_same_on_every_instruction_set() {
    let portable = |found: &'static Found| {
        let found = found.iter();
        found.filter(|(class, _)| class.numeric == Numeric::Portable)
    };
    let (first, others) = FOUND.split_first().unwrap();
    for (isa, found) in others {
        assert!(
            portable(found).eq(portable(&first.1)),
            "{isa} and {}",
            first.0
        );
    }
}

//! Packets of any size, blocks of any width, and scenes that ask for less than all.

use raybreed::{Block, Isa, Lists, Numeric, Origin, Packet, Ray, Scene, Triangle, Watertight};

use crate::calls::{CallWithHits, UNWRITTEN, packet_hits, ray_hits, test, unwritten};
use crate::checks::{all_hit_bits, all_ray_bits, hit_bits};
use crate::kernels::{RAYS, Required, available};
use crate::reference::{Verdict, closest};
use crate::worlds::{ODD, Random, World};

/// The scene of a requirement.
macro_rules! scene {
    ($numeric:ident $watertight:ident $lists:ident $origin:ident) => {
        Required<
            { Numeric::$numeric as usize },
            { Watertight::$watertight as usize },
            { Lists::$lists as usize },
            { Origin::$origin as usize },
            0,
        >
    };
}

/// Rays of a world, over and over.
fn packet<const N: usize>(world: &World) -> Packet<N> {
    Packet::of(&std::array::from_fn(|i| world.rays[i % world.rays.len()]))
}

/// Whether the function's closest hits are those of `f64`.
fn assert_right<const N: usize>(function: CallWithHits<N>, origin: Origin, what: &str) {
    let mut random = Random(11);
    for isa in available() {
        for _ in 0..20 {
            let world = random.world();
            let mut rays = packet::<N>(&world);
            if origin == Origin::Common {
                [rays.ox, rays.oy, rays.oz] = rays.ray(0).origin.map(|x| [x; N]);
            }
            let (before, mut hits) = (rays.clone(), unwritten());
            function(isa, &mut rays, &mut hits, &world.triangles);
            for i in 0..N {
                let what = || {
                    format!(
                        "{what} on {isa}: {:?} of {:?}",
                        before.ray(i),
                        world.triangles
                    )
                };
                match closest(&before.ray(i), &world.triangles, raybreed::Culling::None) {
                    Verdict::Unsure => {}
                    Verdict::Miss => assert_eq!(rays.t[i], before.t[i], "{}", what()),
                    Verdict::Hit(hit) => {
                        assert!((f64::from(rays.t[i]) - hit.t).abs() < 1e-3, "{}", what());
                        assert_eq!(hits.triangle[i] as usize, hit.triangle, "{}", what());
                    }
                }
            }
        }
    }
}

#[test]
fn packets_are_of_any_size() {
    macro_rules! sizes {
        ($($n:literal)+) => {$(
            let general: CallWithHits<$n> = packet_hits::<scene!(Fast No Short General), Triangle, $n>;
            assert_right(general, Origin::General, stringify!($n rays));
            let common: CallWithHits<$n> = packet_hits::<scene!(Fast No Short Common), Triangle, $n>;
            assert_right(common, Origin::Common, stringify!($n rays of one origin));
        )+};
    }
    sizes!(1 3 4 8 16 64 1000);
}

#[test]
fn packets_of_no_rays_are_fine() {
    let triangle = Random(1).world().triangles[0];
    for isa in available() {
        let mut packet = Packet::<0>::new();
        test::<scene!(Fast No Short General)>(isa).closest(&mut packet, &[triangle]);
        test::<scene!(Fast No Short General)>(isa).any(&mut packet, &[triangle]);
    }
}

#[test]
fn packets_of_no_rays_and_no_origin_are_fine() {
    let triangle = Random(1).world().triangles[0];
    for isa in available() {
        let mut packet = Packet::<0>::new();
        test::<scene!(Fast No Short Common)>(isa).closest(&mut packet, &[triangle]);
        test::<scene!(Fast No Short Common)>(isa).any(&mut packet, &[triangle]);
    }
}

#[test]
fn blocks_are_of_any_width() {
    macro_rules! widths {
        ($($w:literal)+) => {$(
            let ray: CallWithHits<RAYS> = ray_hits::<scene!(Fast No Short General), Triangle, RAYS, $w>;
            assert_right(ray, Origin::General, stringify!(blocks of $w));
        )+};
    }
    widths!(1 2 4 8 16 32);
}

#[test]
fn portable_answers_depend_on_no_size_and_no_width() {
    let mut random = Random(7);
    let worlds: Vec<World> = (0..40).map(|_| odd_world(&mut random)).collect();
    macro_rules! requirements {
        ($($watertight:ident $lists:ident)+) => {$(
            for world in &worlds {
                same_of_sizes::<scene!(Portable $watertight $lists General)>(world);
                same_of_widths::<scene!(Portable $watertight $lists General)>(world);
            }
        )+};
    }
    requirements!(No Short No Long Edges Short Edges Long Full Short Full Long);
}

/// A world in which some numbers are odd.
fn odd_world(random: &mut Random) -> World {
    let mut world = random.world();
    for (i, ray) in world.rays.iter_mut().enumerate().step_by(5) {
        ray.direction[i % 3] = ODD[i % ODD.len()];
    }
    let odd = ODD[(random.0 % ODD.len() as u64) as usize];
    world.triangles[3].p1[1] = odd;
    world
}

fn same_of_sizes<S: Scene>(world: &World) {
    for isa in available() {
        let whole = answers::<RAYS>(
            isa,
            packet_hits::<S, Triangle, RAYS>,
            &world.rays,
            &world.triangles,
        );
        for (i, expected) in whole.iter().enumerate() {
            let ray = &world.rays[i..=i];
            let one = answers::<1>(isa, packet_hits::<S, Triangle, 1>, ray, &world.triangles);
            assert_eq!(&one[0], expected, "alone, on {isa}: {ray:?}");
        }
        let rays = &world.rays[..12];
        let twelve = answers::<12>(isa, packet_hits::<S, Triangle, 12>, rays, &world.triangles);
        assert_eq!(twelve, whole[..12], "12 of them, on {isa}");
    }
}

fn same_of_widths<S: Scene>(world: &World) {
    for isa in available() {
        let answers = |function| answers::<RAYS>(isa, function, &world.rays, &world.triangles);
        let expected = answers(ray_hits::<S, Triangle, RAYS, 16>);
        assert_eq!(
            answers(ray_hits::<S, Triangle, RAYS, 1>),
            expected,
            "one by one, on {isa}"
        );
        assert_eq!(
            answers(ray_hits::<S, Triangle, RAYS, 4>),
            expected,
            "by fours, on {isa}"
        );
        assert_eq!(
            answers(ray_hits::<S, Triangle, RAYS, 8>),
            expected,
            "by eights, on {isa}"
        );
    }
}

/// The bits of every ray and hit, of NaNs that they are such.
fn answers<const N: usize>(
    isa: Isa,
    function: CallWithHits<N>,
    rays: &[Ray],
    triangles: &[Triangle],
) -> Vec<([u32; 8], [u32; 9])> {
    let mut packet = Packet::of(&std::array::from_fn(|i| rays[i]));
    let mut hits = unwritten();
    function(isa, &mut packet, &mut hits, triangles);
    let hits = all_hit_bits(&hits)
        .into_iter()
        .map(|bits| bits.map(crate::checks::one_nan));
    all_ray_bits(&packet).into_iter().zip(hits).collect()
}

#[test]
fn a_scene_gets_what_it_asks_for_and_nothing_else() {
    /// A scene that asks for one thing, and the places of it among the numbers of a hit.
    macro_rules! asks {
        ($($scene:ident: $asked:ident, $numbers:expr;)*) => {$(
            struct $scene;
            impl Scene for $scene {
                const $asked: bool = true;
            }
            reports_only::<$scene>($numbers, stringify!($asked));
        )*};
    }
    asks! {
        Textured: UV, &[0, 1];
        Numbered: TRIANGLE, &[2];
        Lit: NORMAL, &[3, 4, 5];
        Placed: POINT, &[6, 7, 8];
    }
    reports_only::<()>(&[], "nothing");
}

fn reports_only<S: Scene>(numbers: &[usize], what: &str) {
    let triangle = Triangle::new([-1.0, -1.0, 5.0], [1.0, -1.0, 5.0], [0.0, 1.0, 5.0]);
    let ray = Ray::new([0.0; 3], [0.0, 0.0, 1.0]);
    for isa in available() {
        let mut packet = Packet::of(&[ray; RAYS]);
        let mut hits = unwritten();
        test::<S>(isa).closest_hits(&mut packet, &mut hits, &[triangle]);
        for (number, bits) in hit_bits(&hits, 0).into_iter().enumerate() {
            assert_eq!(
                bits != UNWRITTEN,
                numbers.contains(&number),
                "{what} on {isa}: {hits:?}"
            );
        }
        let block: Block<8> = Triangle::block(&[triangle; 3]);
        let hit = test::<S>(isa)
            .ray_closest_hit(&mut ray.clone(), &[block])
            .expect("it is hit");
        assert_eq!(hit.t, 5.0);
        let asked = [hit.u != 0.0, hit.normal != [0.0; 3], hit.point != [0.0; 3]];
        assert_eq!(
            asked,
            [0, 3, 6].map(|number| numbers.contains(&number)),
            "{what} on {isa}: {hit:?}"
        );
    }
}

#[test]
fn numbers_are_counted_from_the_first() {
    let triangle = |z| Triangle::new([-1.0, -1.0, z], [1.0, -1.0, z], [0.0, 1.0, z]);
    let leaf = [triangle(7.0), triangle(5.0)];
    for isa in available() {
        for first in [0, 40, u32::MAX] {
            let mut packet = Packet::of(&[Ray::new([0.0; 3], [0.0, 0.0, 1.0]); RAYS]);
            let mut hits = unwritten();
            hits.first = first;
            test::<scene!(Fast No Short General)>(isa).closest_hits(&mut packet, &mut hits, &leaf);
            assert_eq!(hits.triangle, [first.wrapping_add(1); RAYS], "{isa}");
        }
    }
}

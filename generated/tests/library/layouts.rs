//! An answer hangs on rays and triangles alone, and not on where they or the stack lie in memory.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use raybreed::{Block, Hit, Intersector, Isa, Ray, Scene, Triangle, Watertight};
use scene::{DEPTHS, at_depth};

use crate::kernels::{Required, available};

/// Lines of the cache in a page.
const LINES: usize = 64;

/// A block that begins at a line; 64 of them that follow one another begin at all lines of a page.
#[derive(Clone)]
#[repr(align(64))]
struct OnALine<T>(T);

/// A block that begins four bytes behind a line: no vector of it is aligned.
#[derive(Clone)]
#[repr(C, align(64))]
struct BehindALine<T>(u32, T);

/// Any rays, most of which hit one of any triangles.
fn rays_and_triangles() -> (Vec<Ray>, Vec<Triangle>) {
    let mut rng = ChaCha8Rng::seed_from_u64(22);
    let mut point = |z: f32| -> [f32; 3] {
        let [x, y] = [(); 2].map(|()| rng.random_range(-4.0..4.0));
        [x, y, z]
    };
    let triangles = (0..16).map(|number| {
        let z = 2.0 + number as f32;
        Triangle::new(point(z), point(z + 1.0), point(z))
    });
    let triangles = triangles.collect();
    let rays = (0..8).map(|_| Ray::new([0.0; 3], point(8.0))).collect();
    (rays, triangles)
}

/// What is reported of every ray in a layout, bit by bit.
fn answers<S: Scene, const W: usize>(
    test: Intersector<S>,
    rays: &[Ray],
    blocks: &[Block<W>],
) -> Vec<Option<[u32; 4]>> {
    let bits = |hit: Hit| {
        [
            hit.t.to_bits(),
            hit.u.to_bits(),
            hit.v.to_bits(),
            hit.triangle,
        ]
    };
    let mut rays = rays.to_vec();
    let hits = rays.iter_mut();
    hits.map(|ray| test.ray_closest_hit(ray, blocks).map(bits))
        .collect()
}

fn check<S: Scene, const W: usize>(isa: Isa) {
    let test = Intersector::<S>::with_isa(isa).expect("it is available");
    let (rays, triangles) = rays_and_triangles();
    let blocks = vec![OnALine(Block::<W>::block(&triangles[..W])); LINES];
    let expected = answers(test, &rays, &[blocks[0].0]);
    assert!(expected.iter().any(Option::is_some));
    let watertight = S::WATERTIGHT;
    let behind = BehindALine(0, blocks[0].0);
    assert_eq!(
        answers(test, &rays, std::slice::from_ref(&behind.1)),
        expected,
        "{isa}, {watertight:?}, {W}, unaligned"
    );
    for depth in 0..DEPTHS {
        let line = depth % LINES;
        let block = std::slice::from_ref(&blocks[line].0);
        let found = at_depth(depth, || answers(test, &rays, block));
        assert_eq!(
            found, expected,
            "{isa}, {watertight:?}, {W}, depth {depth}, line {line}"
        );
    }
}

#[test]
fn one_ray_is_answered_alike_at_every_depth_of_the_stack_and_place_of_a_block() {
    const NO: usize = Watertight::No as usize;
    const EDGES: usize = Watertight::Edges as usize;
    const FULL: usize = Watertight::Full as usize;
    for isa in available() {
        check::<Required<0, NO, 0, 0, 0>, 4>(isa);
        check::<Required<0, NO, 0, 0, 0>, 8>(isa);
        check::<Required<0, NO, 0, 0, 0>, 16>(isa);
        check::<Required<0, EDGES, 0, 0, 0>, 4>(isa);
        check::<Required<0, EDGES, 0, 0, 0>, 8>(isa);
        check::<Required<0, EDGES, 0, 0, 0>, 16>(isa);
        check::<Required<0, FULL, 0, 0, 0>, 4>(isa);
        check::<Required<0, FULL, 0, 0, 0>, 8>(isa);
        check::<Required<0, FULL, 0, 0, 0>, 16>(isa);
    }
}

//! Every function of the library against Möller-Trumbore in `f64`, and what it promises of odd
//! input.

#![cfg(target_arch = "x86_64")]

use raybreed::{CATALOGUE, Packet, Triangle, closest_hits, closest_hits_from_one_origin};

type Test = fn(&mut Packet<64>, &[Triangle]);

/// The functions under test; every row goes through every test.
const FUNCTIONS: [(&str, Test); 2] = [
    ("closest_hits", closest_hits::<64>),
    (
        "closest_hits_from_one_origin",
        closest_hits_from_one_origin::<64>,
    ),
];

const T_MAX: f32 = 1e6;

#[test]
fn closest_hits_are_those_of_f64_away_from_edges() {
    for (name, test) in FUNCTIONS {
        let mut random = Random(1);
        let (mut hits, mut unsure, mut worst) = (0, 0, 0.0_f64);
        for _ in 0..200 {
            let mut packet = random.packet();
            let triangles: Vec<Triangle> = (0..8).map(|_| random.triangle()).collect();
            let expected: Vec<Answer> = (0..64)
                .map(|ray| Answer::of(&packet, ray, &triangles))
                .collect();
            test(&mut packet, &triangles);
            for (ray, expected) in expected.into_iter().enumerate() {
                match expected {
                    Answer::Unsure => unsure += 1,
                    Answer::Miss => assert_eq!(packet.t[ray], T_MAX, "{name}"),
                    Answer::Hit(t) => {
                        let error = (f64::from(packet.t[ray]) - t).abs() / t;
                        assert!(error < 1e-3, "{name}: {} for {t}", packet.t[ray]);
                        worst = worst.max(error);
                        hits += 1;
                    }
                }
            }
        }
        println!("{name}: {hits} hits, {unsure} unsure, worst relative error of t {worst:.1e}");
        assert!(
            hits > 5000 && unsure < 1000,
            "{name}: {hits} hits, {unsure} unsure"
        );
    }
}

#[test]
fn packets_of_any_whole_number_of_vectors_work() {
    let triangle = Random(2).facing_triangle();
    let mut small = Packet::<4>::new();
    let mut large = Packet::<1024>::new();
    for ray in 0..4 {
        small.set_ray(ray, [0.0; 3], [0.0, 0.0, 1.0], T_MAX);
        large.set_ray(1023 - ray, [0.0; 3], [0.0, 0.0, 1.0], T_MAX);
    }
    closest_hits(&mut small, &[triangle]);
    closest_hits(&mut large, &[triangle]);
    assert!(small.t.into_iter().all(is_five));
    assert!(large.t[1020..].iter().copied().all(is_five));
    assert!(
        large.t[..1020].iter().all(|&t| t == 0.0),
        "inactive rays stay as they are"
    );
}

#[test]
fn what_is_not_finite_is_a_miss_in_its_lane_and_no_other() {
    let triangle = Random(3).facing_triangle();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for component in 0..6 {
            let mut packet = facing_packet();
            let array = match component {
                0 => &mut packet.ox,
                1 => &mut packet.oy,
                2 => &mut packet.oz,
                3 => &mut packet.dx,
                4 => &mut packet.dy,
                _ => &mut packet.dz,
            };
            array[9] = value;
            closest_hits(&mut packet, &[triangle]);
            for ray in 0..64 {
                let right = if ray == 9 {
                    packet.t[ray] == T_MAX
                } else {
                    is_five(packet.t[ray])
                };
                assert!(right, "ray {ray} where component {component} is {value}");
            }
        }
    }
}

#[test]
fn rays_with_nothing_left_of_their_range_keep_their_bits() {
    let triangle = Random(4).facing_triangle();
    for (name, test) in FUNCTIONS {
        for t in [0.0, -0.0, -1.0, f32::NEG_INFINITY, f32::NAN, 4.999] {
            let mut packet = facing_packet();
            packet.t[3] = t;
            test(&mut packet, &[triangle]);
            assert_eq!(packet.t[3].to_bits(), t.to_bits(), "{name}: {t}");
            assert!(is_five(packet.t[4]), "{name}");
        }
    }
}

#[test]
fn triangles_that_are_no_triangles_are_missed() {
    let Triangle { p0, p1, p2 } = Random(5).facing_triangle();
    let nan = [f32::NAN, 0.0, 5.0];
    let infinite = [0.0, f32::INFINITY, 5.0];
    let odd = [
        Triangle { p0, p1: p0, p2: p0 },
        Triangle { p0, p1, p2: p1 },
        Triangle { p0, p1: nan, p2 },
        Triangle {
            p0: infinite,
            p1,
            p2,
        },
    ];
    for (name, test) in FUNCTIONS {
        let mut packet = facing_packet();
        test(&mut packet, &odd);
        assert_eq!(packet, facing_packet(), "{name}");
        test(&mut packet, &[]);
        assert_eq!(packet, facing_packet(), "{name}");
    }
}

#[test]
fn the_catalogue_lists_every_kernel_with_figures_that_can_be() {
    assert!(CATALOGUE.len() >= FUNCTIONS.len());
    for entry in CATALOGUE {
        assert!(
            entry.ratio > 1.0,
            "{} is slower than Möller-Trumbore",
            entry.name
        );
        let error = entry.t_error;
        assert!(0.0 < error.median && error.median < error.p99 && error.p99 <= 1e-6);
        assert!(error.p99 < error.max && error.hits > 10_000);
        let stability = entry.stability.unwrap();
        assert!(
            stability.edge_leak.samples > 10_000,
            "judged where it is hard"
        );
        let (least, most) = stability.scale;
        assert!(
            least < -15 && 15 < most,
            "{}: {:?}",
            entry.name,
            stability.scale
        );
    }
}

/// The `f64` verdict on a ray and some triangles.
enum Answer {
    Miss,
    Hit(f64),
    /// So near an edge, or so nearly in a triangle's plane, that `f32` may say either.
    Unsure,
}

impl Answer {
    fn of(packet: &Packet<64>, ray: usize, triangles: &[Triangle]) -> Answer {
        let a = [packet.ox[ray], packet.oy[ray], packet.oz[ray]].map(f64::from);
        let d = [packet.dx[ray], packet.dy[ray], packet.dz[ray]].map(f64::from);
        let mut closest = f64::INFINITY;
        for triangle in triangles {
            let [p0, p1, p2] = [triangle.p0, triangle.p1, triangle.p2].map(|p| p.map(f64::from));
            let (e1, e2, s) = (sub(p1, p0), sub(p2, p0), sub(a, p0));
            let (p, q) = (cross(d, e2), cross(s, e1));
            let v = dot(e1, p);
            let (beta, gamma, t) = (dot(s, p) / v, dot(d, q) / v, dot(e2, q) / v);
            let inside = beta.min(gamma).min(1.0 - beta - gamma);
            if inside.abs() < 1e-4 || v.abs() < 1e-2 {
                return Answer::Unsure;
            }
            if inside > 0.0 && t > 0.0 {
                closest = closest.min(t);
            }
        }
        match closest {
            f64::INFINITY => Answer::Miss,
            t => Answer::Hit(t),
        }
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let component = |j: usize, k: usize| a[j] * b[k] - a[k] * b[j];
    [component(1, 2), component(2, 0), component(0, 1)]
}

/// Where the facing triangle is, to the accuracy of `f32`.
fn is_five(t: f32) -> bool {
    (t - 5.0).abs() < 1e-5
}

/// Rays from the origin along z.
fn facing_packet() -> Packet<64> {
    let mut packet = Packet::new();
    for ray in 0..64 {
        packet.set_ray(ray, [0.0; 3], [0.0, 0.0, 1.0], T_MAX);
    }
    packet
}

/// SplitMix64.
struct Random(u64);

impl Random {
    /// A number in -1..1.
    fn number(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    fn point(&mut self) -> [f32; 3] {
        [(); 3].map(|()| self.number())
    }

    fn triangle(&mut self) -> Triangle {
        let [p0, p1, p2] = [(); 3].map(|()| self.point());
        Triangle { p0, p1, p2 }
    }

    /// A triangle around the z axis at z = 5.
    fn facing_triangle(&mut self) -> Triangle {
        let mut corner = |x: f32, y: f32| [x + self.number() / 4.0, y + self.number() / 4.0, 5.0];
        Triangle {
            p0: corner(-1.0, -1.0),
            p1: corner(1.0, -1.0),
            p2: corner(0.0, 1.0),
        }
    }

    /// Rays of one origin, so that every function can take them.
    fn packet(&mut self) -> Packet<64> {
        let origin = self.point().map(|x| 3.0 * x);
        let mut packet = Packet::new();
        for ray in 0..64 {
            let target = self.point();
            let direction = [0, 1, 2].map(|axis| 0.6 * target[axis] - origin[axis]);
            packet.set_ray(ray, origin, direction, T_MAX);
        }
        packet
    }
}

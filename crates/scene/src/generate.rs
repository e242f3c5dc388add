//! The random scene of Kensler-Shirley's appendix, draw by draw.

use serde::{Deserialize, Serialize};

use crate::{
    Directions, Drand48, INITIAL_T, NO_HIT, Origin, PACKET_SIZE, Range, RayPacket, Triangle,
    Workload,
};

/// Lower bound of `t` in scenes that have one: a quarter of the hits come before it.
const T_MIN: f32 = 0.9;

/// Where segments end, in units of the appendix's direction, which lead into the triangles' midst:
/// many hits come after it.
const SEGMENT_END: f32 = 1.1;

/// What the appendix's benchmark draws. [`Generator::default`] has its constants, with seed 0.
///
/// The same generator makes the same bytes everywhere, and one that differs in `packets` alone
/// makes the same triangles and the same first packets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Generator {
    /// Where [`Drand48`] starts; the appendix takes the time of day.
    pub seed: u32,
    /// How many triangles.
    pub triangles: usize,
    /// How many packets of [`PACKET_SIZE`] rays.
    pub packets: usize,
    /// Whether the rays of a packet start in one point.
    pub origin: Origin,
    /// Between which ends hits count.
    pub range: Range,
    /// Whether directions are made as long as one. Then `t` is in other units, and what is said in units
    /// of the appendix's direction here is scaled with it.
    pub directions: Directions,
    /// Bound of a packet's eye in each coordinate.
    pub eye_range: f32,
    /// Bound of a packet's target in each coordinate.
    pub target_range: f32,
    /// Bound of what a ray's origin and direction deviate from the packet's, in each coordinate.
    pub ray_jitter: f32,
}

impl Default for Generator {
    fn default() -> Self {
        Self {
            seed: 0,
            triangles: 20_000,
            packets: 400,
            origin: Origin::General,
            range: Range::TMax,
            directions: Directions::Any,
            eye_range: 3.0,
            target_range: 0.6,
            ray_jitter: 0.04,
        }
    }
}

impl Generator {
    /// Draws the triangles, then the packets. About a quarter of all rays hit any one triangle.
    pub fn generate(&self) -> Workload {
        let mut random = Drand48::new(self.seed);
        Workload {
            triangles: (0..self.triangles).map(|_| triangle(&mut random)).collect(),
            packets: (0..self.packets)
                .map(|_| self.packet(&mut random))
                .collect(),
        }
    }

    /// Rays from near an eye to near a target.
    ///
    /// As in the appendix, sums and products with a draw are taken in `f64` and `target - eye` in
    /// `f32`, and what is stored is rounded to `f32`. The paper does not print its generator for a
    /// common origin; here the origin's jitter is drawn and dropped, so that both kinds of packet
    /// have the same eyes and directions.
    fn packet(&self, random: &mut Drand48) -> RayPacket {
        let mut point = |range: f32| -> [f32; 3] {
            std::array::from_fn(|_| (random.difference() * f64::from(range)) as f32)
        };
        let eye = point(self.eye_range);
        let target = point(self.target_range);
        let toward: [f32; 3] = std::array::from_fn(|axis| target[axis] - eye[axis]);

        let lanes = || [0.0; PACKET_SIZE];
        let (mut origins, mut directions) = ([lanes(); 3], [lanes(); 3]);
        for ray in 0..PACKET_SIZE {
            let mut jittered = |center: f32, jitter: f32| {
                (f64::from(center) + random.difference() * f64::from(jitter)) as f32
            };
            let origin_jitter = match self.origin {
                Origin::General => self.ray_jitter,
                Origin::Common => 0.0,
            };
            for axis in 0..3 {
                origins[axis][ray] = jittered(eye[axis], origin_jitter);
            }
            for axis in 0..3 {
                directions[axis][ray] = jittered(toward[axis], self.ray_jitter);
            }
        }
        let (mut t, mut t_min) = (INITIAL_T, lanes());
        match self.range {
            Range::TMax => {}
            Range::TMinMax => t_min = [T_MIN; PACKET_SIZE],
            Range::Segment => {
                t = 1.0;
                for (start, end) in origins.iter().zip(&mut directions) {
                    for (start, end) in start.iter().zip(end) {
                        *end = start + SEGMENT_END * *end;
                    }
                }
            }
        }
        if self.directions == Directions::Unit {
            for ray in 0..PACKET_SIZE {
                let direction = directions.map(|axis| f64::from(axis[ray]));
                let length = direction.map(|x| x * x).iter().sum::<f64>().sqrt();
                for (axis, x) in directions.iter_mut().zip(direction) {
                    axis[ray] = (x / length) as f32;
                }
                t_min[ray] *= length as f32;
            }
        }
        let ([ox, oy, oz], [dx, dy, dz]) = (origins, directions);
        RayPacket {
            ox,
            oy,
            oz,
            dx,
            dy,
            dz,
            t: [t; PACKET_SIZE],
            hit_t: [NO_HIT; PACKET_SIZE],
            t_min,
        }
    }
}

/// Three random vertices, moved so that their mean is the world's origin.
fn triangle(random: &mut Drand48) -> Triangle {
    let mut point = || -> [f32; 3] { std::array::from_fn(|_| random.difference() as f32) };
    let [p0, p1, p2] = [point(), point(), point()];
    let mean: [f32; 3] = std::array::from_fn(|axis| (p0[axis] + p1[axis] + p2[axis]) / 3.0);
    let centered = |p: [f32; 3]| std::array::from_fn(|axis| p[axis] - mean[axis]);
    Triangle {
        p0: centered(p0),
        p1: centered(p1),
        p2: centered(p2),
    }
}

#[cfg(test)]
mod tests {
    use super::{Directions, Generator, Origin};
    use crate::bounds::{BoundsCheck, OutOfBounds, Towards};
    use crate::{INITIAL_T, NO_HIT, Workload, rays};

    /// A small workload of this seed.
    fn small(seed: u32) -> Generator {
        Generator {
            seed,
            triangles: 100,
            packets: 3,
            ..Generator::default()
        }
    }

    /// Of all triangles, then of each packet's origins and directions: 64-bit FNV-1a.
    fn hash(workload: &Workload) -> u64 {
        let triangles = workload
            .triangles
            .iter()
            .flat_map(|t| [t.p0, t.p1, t.p2].concat());
        let packets = workload
            .packets
            .iter()
            .flat_map(|packet| rays(packet).map(|component| *component).concat());
        triangles
            .chain(packets)
            .flat_map(f32::to_le_bytes)
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            })
    }

    fn bits<const N: usize>(lanes: &[f32; N]) -> [u32; N] {
        lanes.map(f32::to_bits)
    }

    /// The hashes come from the appendix's C++ text, compiled by GCC with its draws put in order.
    #[test]
    fn makes_the_bytes_that_the_appendix_makes() {
        assert_eq!(hash(&small(7).generate()), 0x642e_4e5c_200b_e5dd);
        assert_eq!(hash(&small(0xfedc_ba98).generate()), 0x7804_b337_de55_8c79);
    }

    #[test]
    fn rays_start_unbounded() {
        for packet in small(1).generate().packets {
            assert_eq!(packet.t, [INITIAL_T; 64]);
            assert_eq!(packet.hit_t, [NO_HIT; 64]);
        }
    }

    #[test]
    fn more_packets_do_not_change_the_first_ones() {
        let few = small(2).generate();
        let mut many = Generator {
            packets: 9,
            ..small(2)
        }
        .generate();
        many.packets.truncate(few.packets.len());
        assert_eq!(hash(&few), hash(&many));
    }

    #[test]
    fn directions_may_be_as_long_as_one() {
        let bounds = BoundsCheck {
            coordinates: 4.0,
            edge: 1e-4,
            towards: Towards::UnitDirection,
        };
        let check = |directions| {
            let workload = Generator {
                directions,
                ..small(4)
            }
            .generate();
            let packets = workload.packets.iter();
            let mut rays = packets.flat_map(|packet| (0..64).map(move |ray| (packet, ray)));
            rays.try_for_each(|(packet, ray)| bounds.direction(packet, ray))
        };
        assert_eq!(check(Directions::Unit), Ok(()));
        assert_eq!(check(Directions::Any), Err(OutOfBounds::Direction(0)));
    }

    #[test]
    fn a_common_origin_keeps_the_directions_and_drops_the_jitter() {
        let general = small(3).generate();
        let common = Generator {
            origin: Origin::Common,
            ..small(3)
        }
        .generate();
        for (general, common) in general.packets.iter().zip(&common.packets) {
            let (general, common) = (rays(general), rays(common));
            for axis in 0..3 {
                let origin = common[axis][0];
                assert_eq!(bits(common[axis]), [origin.to_bits(); 64]);
                assert!(general[axis].iter().any(|&x| x != origin));
                assert!(general[axis].iter().all(|&x| (x - origin).abs() <= 0.0401));
                assert_eq!(bits(common[axis + 3]), bits(general[axis + 3]));
            }
        }
        assert_eq!(general.triangles.len(), common.triangles.len());
    }
}

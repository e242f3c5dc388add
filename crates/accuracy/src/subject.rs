//! What is judged: anything that tests rays against triangles.

use scene::{Hits, Packet, Ray, Regime, Triangle, answers, rays_mut};

/// A hit as it is reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Its place on the ray.
    pub t: f32,
    /// Barycentric coordinates of `p1` and `p2`, if the subject reports them.
    pub uv: Option<[f32; 2]>,
}

impl From<f32> for Hit {
    /// A hit of which `t` alone is reported.
    fn from(t: f32) -> Self {
        Self { t, uv: None }
    }
}

/// A way to test rays against triangles. Each thread has one of its own.
///
/// The harness calls it with up to [`BATCH_RAYS`] rays and [`BATCH_TRIANGLES`] triangles. A kernel
/// that takes packets goes through the triangles one by one, one that takes blocks of triangles
/// through the rays: see [`Packets`], [`Scalar`].
pub trait Subject {
    /// Tests each ray against each triangle, every pair by itself: a hit is `0 < t < ray.t_max`,
    /// and no hit shortens a ray for the triangles after it.
    ///
    /// `answers[triangle * rays.len() + ray]` becomes the reported hit, whatever its numbers are,
    /// or `None`. There are `rays.len() * triangles.len()` of them, with anything in them before.
    fn hits(&mut self, rays: &[Ray], triangles: &[Triangle], answers: &mut [Option<Hit>]);
}

/// Most rays of a call.
pub const BATCH_RAYS: usize = 64;

/// Most triangles of a call.
pub const BATCH_TRIANGLES: usize = 64;

/// A subject that tests one ray against one triangle.
///
/// ```
/// use accuracy::{Hit, Scalar, Subject};
/// # let triangle = scene::Triangle { p0: [0.0; 3], p1: [0.0; 3], p2: [0.0; 3] };
/// # let ray = scene::Ray { origin: [0.0; 3], direction: [0.0; 3], t_min: 0.0, t_max: 1.0 };
/// let mut blind = Scalar(|_: &scene::Ray, _: &scene::Triangle| None::<f32>);
/// let mut answers = [Some(Hit::from(1.0))];
/// blind.hits(&[ray], &[triangle], &mut answers);
/// assert_eq!(answers, [None]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Scalar<F>(
    /// A hit, or its `t`; or `None`.
    pub F,
);

impl<H: Into<Hit>, F: FnMut(&Ray, &Triangle) -> Option<H>> Subject for Scalar<F> {
    fn hits(&mut self, rays: &[Ray], triangles: &[Triangle], answers: &mut [Option<Hit>]) {
        for (triangle, row) in triangles.iter().zip(answers.chunks_mut(rays.len())) {
            for (ray, answer) in rays.iter().zip(row) {
                *answer = (self.0)(ray, triangle).map(Into::into);
            }
        }
    }
}

/// A subject that takes packets of `N` rays and a list of triangles.
///
/// It is called with one triangle at a time, and a ray counts as hit when the bits of its answer
/// have changed. Lanes without a ray are inactive: their `t` is 0.
#[derive(Clone, Copy, Debug)]
pub struct Packets<const N: usize, K> {
    /// The regime that the kernel was built for, which says where it stores its answers.
    pub regime: Regime,
    /// Whether it reports barycentric coordinates.
    pub uv: bool,
    /// The kernel.
    pub kernel: K,
}

impl<const N: usize, K: FnMut(&mut Packet<N>, &mut Hits<N>, &[Triangle])> Packets<N, K> {
    /// A kernel that was built for `regime` and reports `t` alone.
    pub fn new(regime: Regime, kernel: K) -> Self {
        let uv = false;
        Self { regime, uv, kernel }
    }
}

impl<const N: usize, K: FnMut(&mut Packet<N>, &mut Hits<N>, &[Triangle])> Subject
    for Packets<N, K>
{
    fn hits(&mut self, rays: &[Ray], triangles: &[Triangle], all: &mut [Option<Hit>]) {
        for (number, chunk) in rays.chunks(N).enumerate() {
            let initial = packet(chunk);
            let before = answers(self.regime, &initial);
            let (mut packet, mut hits) = (initial.clone(), no_hits());
            for (triangle, row) in triangles.iter().zip(all.chunks_mut(rays.len())) {
                (packet.t, packet.hit_t) = (initial.t, initial.hit_t);
                (self.kernel)(&mut packet, &mut hits, std::slice::from_ref(triangle));
                let after = answers(self.regime, &packet);
                for (lane, answer) in row[number * N..].iter_mut().take(chunk.len()).enumerate() {
                    let is_changed = before[lane].to_bits() != after[lane].to_bits();
                    *answer = is_changed.then(|| Hit {
                        t: after[lane],
                        uv: self.uv.then(|| [hits.u[lane], hits.v[lane]]),
                    });
                }
            }
        }
    }
}

/// At most `N` rays as a packet; the other lanes are inactive copies of the first ray.
fn packet<const N: usize>(rays: &[Ray]) -> Packet<N> {
    let mut packet = Packet {
        ox: [0.0; N],
        oy: [0.0; N],
        oz: [0.0; N],
        dx: [0.0; N],
        dy: [0.0; N],
        dz: [0.0; N],
        t: [0.0; N],
        hit_t: [scene::NO_HIT; N],
        t_min: [0.0; N],
    };
    for lane in 0..N {
        let ray = rays.get(lane).unwrap_or(&rays[0]);
        let values = [ray.origin, ray.direction].concat();
        for (component, value) in rays_mut(&mut packet).into_iter().zip(values) {
            component[lane] = value;
        }
        packet.t[lane] = rays.get(lane).map_or(0.0, |ray| ray.t_max);
    }
    packet
}

/// Nothing reported yet.
fn no_hits<const N: usize>() -> Hits<N> {
    Hits {
        u: [0.0; N],
        v: [0.0; N],
        triangle: [0; N],
        normal: [[0.0; N]; 3],
        point: [[0.0; N]; 3],
    }
}

/// Calls `subject` with batches of the size that it is promised, and `visit` with a ray's number, a
/// triangle's number and the hit for every one that it reports.
pub(crate) fn for_each_hit(
    subject: &mut impl Subject,
    rays: &[Ray],
    triangles: &[Triangle],
    mut visit: impl FnMut(usize, usize, Hit),
) {
    let mut answers = [None; BATCH_RAYS * BATCH_TRIANGLES];
    for (ray_batch, some_rays) in rays.chunks(BATCH_RAYS).enumerate() {
        for (triangle_batch, some_triangles) in triangles.chunks(BATCH_TRIANGLES).enumerate() {
            let answers = &mut answers[..some_rays.len() * some_triangles.len()];
            subject.hits(some_rays, some_triangles, answers);
            for (triangle, row) in answers.chunks(some_rays.len()).enumerate() {
                for (ray, answer) in row.iter().enumerate() {
                    if let Some(hit) = *answer {
                        let ray = ray_batch * BATCH_RAYS + ray;
                        visit(ray, triangle_batch * BATCH_TRIANGLES + triangle, hit);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Packets, Scalar, for_each_hit};
    use scene::{Hits, Packet, Ray, Regime, Triangle};

    /// Rays and triangles that are known by a number each.
    fn numbered(rays: usize, triangles: usize) -> (Vec<Ray>, Vec<Triangle>) {
        let ray = |number| Ray {
            origin: [number as f32, 0.0, 0.0],
            direction: [0.0; 3],
            t_min: 0.0,
            t_max: 1e9,
        };
        let triangle = |number| Triangle {
            p0: [number as f32; 3],
            p1: [0.0; 3],
            p2: [0.0; 3],
        };
        (
            (0..rays).map(ray).collect(),
            (0..triangles).map(triangle).collect(),
        )
    }

    /// A hit where the numbers differ by a multiple of three, at 1000 times the one and the other.
    fn answer(ray: f32, triangle: f32) -> Option<f32> {
        ((ray - triangle) % 3.0 == 0.0).then_some(1000.0 * ray + triangle)
    }

    #[test]
    fn every_pair_is_tested_once_whatever_the_batches() {
        let (rays, triangles) = numbered(131, 70);
        let mut expected = Vec::new();
        for ray in 0..131 {
            for triangle in 0..70 {
                if let Some(t) = answer(ray as f32, triangle as f32) {
                    expected.push((ray, triangle, t));
                }
            }
        }
        let check = |mut seen: Vec<(usize, usize, f32)>| {
            seen.sort_by_key(|&(ray, triangle, _)| (ray, triangle));
            assert_eq!(seen, expected);
        };

        let mut seen = Vec::new();
        let mut scalar =
            Scalar(|ray: &Ray, triangle: &Triangle| answer(ray.origin[0], triangle.p0[0]));
        for_each_hit(&mut scalar, &rays, &triangles, |ray, triangle, hit| {
            seen.push((ray, triangle, hit.t));
        });
        check(seen);

        let mut seen = Vec::new();
        let mut packets = Packets::new(
            Regime::Fixed,
            |packet: &mut Packet<24>, _: &mut Hits<24>, triangles: &[Triangle]| {
                for lane in 0..24 {
                    assert_eq!(triangles.len(), 1);
                    if let Some(t) = answer(packet.ox[lane], triangles[0].p0[0]) {
                        packet.hit_t[lane] = t;
                    }
                }
            },
        );
        for_each_hit(&mut packets, &rays, &triangles, |ray, triangle, hit| {
            assert_eq!(hit.uv, None);
            seen.push((ray, triangle, hit.t));
        });
        check(seen);
    }
}

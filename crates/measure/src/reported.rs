//! Whether what a kernel reports of a hit beside `t` is right.

use scene::{
    Expected, NO_HITS, Output, PACKET_SIZE, Ray, RayHits, RayPacket, SceneModel, Stored, Triangle,
    barycentric,
};

/// Roundings of 2^-24 that a normal's component may be off by, in units of the longest edge squared,
/// and a point's in units of its coordinates.
const ROUNDINGS: f64 = 16.0 / (1 << 24) as f64;

/// What reports of a packet's hits are held against.
pub(crate) struct Reports<'a> {
    pub scene: &'a SceneModel,
    pub rays: &'a RayPacket,
    pub triangles: &'a [Triangle],
    pub expected: &'a Expected,
}

impl Reports<'_> {
    /// The first ray of which something wrong is reported, and what; `answers` are those of all rays.
    pub fn first_error(
        &self,
        answers: &[f32; PACKET_SIZE],
        hits: &RayHits,
    ) -> Option<(usize, String)> {
        let untouched = NO_HITS;
        (0..PACKET_SIZE).find_map(|ray| {
            let mut meant = self.expected.triangles(ray, answers[ray]);
            if meant.is_empty() || !self.scene.has_hits() {
                let kept = of_ray(hits, ray) == of_ray(&untouched, ray);
                return (!kept).then(|| (ray, "a hit is reported, and there is none".into()));
            }
            if self.scene.reports(Output::Triangle) {
                let said = hits.triangle[ray] as usize;
                if !meant.contains(&said) {
                    let why = format!("triangle {said} is reported, and it was of {meant:?}");
                    return Some((ray, why));
                }
                meant = vec![said];
            }
            let wrong = |&triangle: &usize| self.wrong_of(ray, &self.triangles[triangle], hits);
            let complaints: Option<Vec<String>> = meant.iter().map(wrong).collect();
            complaints.map(|complaints| (ray, complaints.join("; ")))
        })
    }

    /// What is wrong if it was this triangle.
    fn wrong_of(&self, ray: usize, triangle: &Triangle, hits: &RayHits) -> Option<String> {
        let of_ray = Ray::of(self.rays, ray, self.scene.range);
        let ([u, v], off) = barycentric(&of_ray, triangle);
        let stored = Stored::EdgesAndNormal.of(&Triangle { ..*triangle });
        let wide = |vector: [f32; 3]| vector.map(f64::from);
        let (p0, edges) = (wide(triangle.p0), [wide(stored[1]), wide(stored[2])]);
        let longest = edges.iter().flatten().fold(0.0_f64, |a, b| a.max(b.abs()));

        let near = |what: &str, found: f32, right: f64, off: f64| {
            let is_near = (f64::from(found) - right).abs() <= off;
            (!is_near).then(|| format!("{what} = {found}, should be {right} within {off:.1e}"))
        };
        let (mut wrong, reports) = (None, |output| self.scene.reports(output));
        if reports(Output::Uv) {
            wrong = near("u", hits.u[ray], u, off).or(near("v", hits.v[ray], v, off));
        }
        for axis in 0..3 {
            if reports(Output::Normal) {
                let (found, right) = (hits.normal[axis][ray], f64::from(stored[3][axis]));
                let off = ROUNDINGS * longest * longest;
                wrong = wrong.or(near("normal", found, right, off));
            }
            if reports(Output::Point) {
                let right = p0[axis] + u * edges[0][axis] + v * edges[1][axis];
                let rounding = ROUNDINGS * (p0[axis].abs() + longest);
                let off = 2.0 * off * longest + rounding;
                wrong = wrong.or(near("point", hits.point[axis][ray], right, off));
            }
        }
        wrong
    }
}

/// What is reported of one ray, bit by bit.
fn of_ray(hits: &RayHits, ray: usize) -> [u32; 9] {
    let [nx, ny, nz] = hits.normal.map(|axis| axis[ray]);
    let [px, py, pz] = hits.point.map(|axis| axis[ray]);
    let numbers = [hits.u[ray], hits.v[ray], nx, ny, nz, px, py, pz].map(f32::to_bits);
    let mut all = [hits.triangle[ray]; 9];
    all[1..].copy_from_slice(&numbers);
    all
}

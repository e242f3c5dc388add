//! A picture, a row of tiles after the other: all primary rays of the row, then all shadow rays, then all others.

use glam::Vec3;
use indicatif::ProgressBar;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use raybreed::{Entry, Hits, Packet, Ray};

use crate::geometry::Geometry;
use crate::packets::{RAYS, SIDE};
use crate::score::Score;
use crate::trace::{Kernels, Obvhs};
use crate::view::{Surface, View, sky_colour};

/// Who traces what is seen, and how they fare.
pub struct Renderer<'a> {
    view: &'a View,
    geometry: &'a Geometry,
    kernels: Kernels<'a>,
    obvhs: Obvhs<'a>,
    samples: usize,
    /// How both fared with rays from the eye.
    pub primary: Score,
    /// … with rays to the light.
    pub shadow: Score,
    /// … with rays around a point.
    pub occlusion: Score,
}

impl<'a> Renderer<'a> {
    /// A renderer that sends so many rays around a point.
    pub fn new(view: &'a View, geometry: &'a Geometry, samples: usize) -> Self {
        Renderer {
            view,
            geometry,
            kernels: Kernels::new(geometry),
            obvhs: Obvhs(geometry),
            samples,
            primary: Score::new("primary"),
            shadow: Score::new("shadow"),
            occlusion: Score::new("ambient occlusion"),
        }
    }

    /// The kernels for rays of each kind.
    pub fn entries(&self) -> [&'static Entry; 3] {
        self.kernels.entries()
    }

    /// The colours of the picture's rays, from the top left.
    pub fn render(&mut self) -> Vec<Vec3> {
        let View { width, height, .. } = *self.view;
        let mut picture = vec![Vec3::ZERO; width * height];
        let bar = ProgressBar::new(height as u64);
        for (row, rows) in picture.chunks_mut(SIDE * width).enumerate() {
            let seen = self.row_of_tiles(row * SIDE);
            for (i, colour) in rows.iter_mut().enumerate() {
                let (x, y) = (i % width, i / width);
                *colour = seen[x / SIDE * RAYS + y * SIDE + x % SIDE];
            }
            bar.inc(SIDE as u64);
        }
        bar.finish_and_clear();
        picture
    }

    /// The colours of the rays of all tiles from here to the right.
    fn row_of_tiles(&mut self, top: usize) -> Vec<Vec3> {
        let lefts = (0..self.view.width).step_by(SIDE);
        let packets: Vec<_> = lefts.map(|left| self.view.tile(left, top)).collect();
        let directions = rays(&packets).into_iter().map(|ray| ray.direction.into());
        let seen = self.see(packets);
        let are_lit = self.light(&seen);
        let mut open = self.open(&seen, top as u64).into_iter();
        let shade = |((surface, is_lit), direction): ((Option<Surface>, bool), Vec3)| match surface
        {
            Some(surface) => self.view.shade(
                &surface,
                is_lit,
                open.next().expect("a share for every surface"),
            ),
            None => sky_colour(direction),
        };
        seen.into_iter()
            .zip(are_lit)
            .zip(directions)
            .map(shade)
            .collect()
    }

    /// What each ray of the packets hits first.
    fn see(&mut self, packets: Vec<Packet<RAYS>>) -> Vec<Option<Surface>> {
        let rays = rays(&packets);
        let start = (vec![Hits::new(); packets.len()], packets);
        let kernels = |(hits, packets): &mut (Vec<_>, Vec<_>)| {
            for (hits, packet) in hits.iter_mut().zip(&mut *packets) {
                self.kernels.closest(packet, hits);
            }
            are_lowered(packets, &rays)
        };
        let obvhs = || rays.iter().map(|ray| self.obvhs.has_closest(ray)).collect();
        let ((hits, _), are_hits) = self.primary.race(&rays, &start, kernels, obvhs);
        let surface = |i: usize| self.surface(&hits[i / RAYS], i % RAYS, &rays[i]);
        (0..rays.len())
            .map(|i| are_hits[i].then(|| surface(i)))
            .collect()
    }

    /// What ray number `i` of a packet has hit.
    fn surface(&self, hits: &Hits<RAYS>, i: usize, ray: &Ray) -> Surface {
        let mesh = &self.geometry.mesh;
        let triangle = hits.triangle[i] as usize;
        let point = mesh.point(triangle, hits.u[i], hits.v[i]);
        let normal = mesh.normal(triangle);
        let is_back = normal.dot(ray.direction.into()) > 0.0;
        Surface {
            point,
            normal: if is_back { -normal } else { normal },
            colour: mesh.paints[triangle].at(point),
        }
    }

    /// Which of the surfaces the light reaches, of those that are turned towards it.
    fn light(&mut self, seen: &[Option<Surface>]) -> Vec<bool> {
        let nothing = Ray::new(self.view.light, Vec3::Y).between(0.0, 0.0);
        let ray = |surface: &Option<Surface>| {
            surface
                .as_ref()
                .map_or(nothing, |surface| self.view.shadow_ray(surface))
        };
        let rays: Vec<Ray> = seen.iter().map(ray).collect();
        let packets: Vec<_> = rays.as_chunks().0.iter().map(Packet::of).collect();
        let kernels = |packets: &mut Vec<_>| {
            for packet in packets.iter_mut() {
                self.kernels.block(packet);
            }
            are_lowered(packets, &rays)
        };
        let obvhs = || rays.iter().map(|ray| self.obvhs.has_any(ray)).collect();
        let (_, are_blocked) = self.shadow.race(&rays, &packets, kernels, obvhs);
        are_blocked
            .into_iter()
            .map(|is_blocked| !is_blocked)
            .collect()
    }

    /// How much of the surroundings of each surface is open: the share of rays, more of them along the normal, that
    /// hit nothing near.
    fn open(&mut self, seen: &[Option<Surface>], seed: u64) -> Vec<f32> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let radius = self.view.radius;
        let rays: Vec<Ray> = (seen.iter().flatten())
            .flat_map(|surface| std::iter::repeat_n(surface, self.samples))
            .map(|surface| {
                let direction = around(surface.normal, random.random(), random.random());
                Ray::new(surface.point, direction).between(1e-4 * radius, 0.5 * radius)
            })
            .collect();
        let kernels = |_: &mut ()| {
            rays.iter()
                .map(|ray| self.kernels.is_occluded(ray))
                .collect()
        };
        let obvhs = || rays.iter().map(|ray| self.obvhs.has_any(ray)).collect();
        let (_, are_occluded) = self.occlusion.race(&rays, &(), kernels, obvhs);
        let share =
            |some: &[bool]| some.iter().filter(|it| !**it).count() as f32 / some.len() as f32;
        are_occluded.chunks(self.samples).map(share).collect()
    }
}

/// All rays of the packets.
fn rays(packets: &[Packet<RAYS>]) -> Vec<Ray> {
    packets
        .iter()
        .flat_map(|packet| (0..RAYS).map(|i| packet.ray(i)))
        .collect()
}

/// Which rays of the packets have a lower `t` than they had: these are the ones that hit.
fn are_lowered(packets: &[Packet<RAYS>], before: &[Ray]) -> Vec<bool> {
    before
        .iter()
        .enumerate()
        .map(|(i, ray)| packets[i / RAYS].t[i % RAYS] < ray.t)
        .collect()
}

/// A direction around a normal, by two random numbers; its density is as the cosine of the angle between them.
fn around(normal: Vec3, a: f32, b: f32) -> Vec3 {
    let (sine, cosine) = (std::f32::consts::TAU * a).sin_cos();
    let (right, up) = normal.any_orthonormal_pair();
    b.sqrt() * (cosine * right + sine * up) + (1.0 - b).sqrt() * normal
}

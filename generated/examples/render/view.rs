//! Where the eye and the light are, and what colour everything has from there.

use glam::Vec3;
use raybreed::{Packet, Ray};

use crate::packets::{RAYS, SIDE};

/// The eye, the light, and the rays of a picture.
pub struct View {
    /// Rays from left to right.
    pub width: usize,
    /// Rays from top to bottom.
    pub height: usize,
    /// Where the eye is.
    pub eye: Vec3,
    /// Where the light is.
    pub light: Vec3,
    /// Half the extent of what is looked at.
    pub radius: f32,
    forward: Vec3,
    right: Vec3,
    up: Vec3,
}

/// What the eye sees along a ray.
#[derive(Clone, Copy)]
pub struct Surface {
    /// The point.
    pub point: Vec3,
    /// The normal, of unit length, towards the eye.
    pub normal: Vec3,
    /// The colour of the surface.
    pub colour: Vec3,
}

impl View {
    /// A view of all between two corners, from above, with the light over the eye's left shoulder.
    pub fn of((low, high): (Vec3, Vec3), width: usize, height: usize) -> View {
        let (centre, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
        let aspect = width as f32 / height as f32;
        // The tangents of half the angles that the picture spans.
        let (across, upward) = (0.32 * aspect.max(1.0), 0.32 / aspect.min(1.0));
        let (across, upward) = (across.min(upward * aspect), upward.min(across / aspect));
        let forward = -Vec3::new(0.22, 0.3, 1.0).normalize();
        let right = forward.cross(Vec3::Y).normalize();
        View {
            width,
            height,
            eye: centre - forward * radius * 0.9 / across.min(upward),
            light: centre + radius * Vec3::new(-2.0, 3.2, 2.2),
            radius,
            forward,
            right: right * across,
            up: right.cross(forward) * upward,
        }
    }

    /// The rays of a tile, inactive where the picture has ended.
    pub fn tile(&self, left: usize, top: usize) -> Packet<RAYS> {
        let mut packet = Packet::new();
        for i in 0..RAYS {
            let (x, y) = (left + i % SIDE, top + i / SIDE);
            let t = if x < self.width && y < self.height {
                f32::INFINITY
            } else {
                0.0
            };
            packet.set(i, Ray::new(self.eye, self.direction(x, y)).between(0.0, t));
        }
        packet
    }

    /// The direction of a primary ray.
    fn direction(&self, x: usize, y: usize) -> Vec3 {
        let along = |place: usize, count: usize| (2 * place + 1) as f32 / count as f32 - 1.0;
        self.forward + along(x, self.width) * self.right - along(y, self.height) * self.up
    }

    /// The ray from a surface to the light, inactive if the surface is turned away.
    pub fn shadow_ray(&self, surface: &Surface) -> Ray {
        let towards = self.light - surface.point;
        let t = if surface.normal.dot(towards) > 0.0 {
            1.0
        } else {
            0.0
        };
        Ray::new(surface.point, towards).between(1e-4, t)
    }

    /// The colour of a surface which the light reaches or not, with so much of the sky above it open.
    pub fn shade(&self, surface: &Surface, is_lit: bool, open: f32) -> Vec3 {
        let towards = (self.light - surface.point).normalize();
        let sun = if is_lit {
            surface.normal.dot(towards).max(0.0)
        } else {
            0.0
        };
        let sky = open * (0.75 + 0.25 * surface.normal.y);
        let colour =
            surface.colour * (sun * Vec3::new(1.02, 0.94, 0.8) + sky * Vec3::new(0.42, 0.5, 0.62));
        // What is far fades into the horizon.
        let away = surface.point - self.eye;
        let far = (away.length() / (30.0 * self.radius)).clamp(0.0, 1.0);
        colour.lerp(sky_colour(away), far.sqrt() * far)
    }
}

/// The colour of the sky.
pub fn sky_colour(direction: Vec3) -> Vec3 {
    let height = direction.normalize().y.max(0.0).sqrt();
    Vec3::new(0.82, 0.87, 0.92).lerp(Vec3::new(0.24, 0.44, 0.76), height)
}

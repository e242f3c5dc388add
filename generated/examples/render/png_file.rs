//! A picture as a PNG file.

use std::fs::File;
use std::io::BufWriter;

use anyhow::Result;
use glam::Vec3;

/// Writes colours, `rays` by `rays` of them a pixel, as a picture of that width.
pub fn write(file: File, width: usize, rays: usize, colours: &[Vec3]) -> Result<()> {
    let height = colours.len() / (width * rays * rays);
    let mut bytes = Vec::with_capacity(3 * width * height);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let row = |dy| &colours[((y * rays + dy) * width + x) * rays..][..rays];
        let sum: Vec3 = (0..rays).flat_map(row).sum();
        bytes.extend((sum / (rays * rays) as f32).to_array().map(encode));
    }
    let mut encoder = png::Encoder::new(BufWriter::new(file), width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bytes)?;
    Ok(writer.finish()?)
}

/// A linear intensity as sRGB.
fn encode(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let curved = if linear <= 0.0031308 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    (255.0 * curved).round() as u8
}

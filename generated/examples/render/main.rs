//! A picture of a mesh by raybreed's kernels in obvhs's hierarchy, and how fast they are beside obvhs's own test:
//! `cargo run --release --package raybreed --example render -- MESH.obj`.
//!
//! Begin with `scenes.rs`: what a renderer requires of its tests.

mod geometry;
mod mesh;
mod packets;
mod png_file;
mod render;
mod scenes;
mod score;
mod shapes;
mod trace;
mod view;

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::Parser;
use glam::Vec3;
use indicatif::HumanCount;

use crate::geometry::Geometry;
use crate::mesh::{Mesh, Paint};
use crate::packets::RAYS;
use crate::render::Renderer;
use crate::score::Score;
use crate::shapes::scene;
use crate::view::View;

/// Renders a mesh, and times raybreed's kernels against obvhs's own triangle test on the same rays.
#[derive(Parser)]
#[command(
    after_help = "Example: cargo run --release --package raybreed --example render -- bunny.obj --out bunny.png"
)]
struct Arguments {
    /// The mesh, an OBJ file with y upwards; without one, a knot, a tower and spheres.
    mesh: Option<PathBuf>,
    /// Where the picture goes.
    #[arg(long, value_name = "FILE", default_value = "render.png")]
    out: PathBuf,
    /// Pixels of the picture, across and down.
    #[arg(long, value_name = "WxH", default_value = "800x500", value_parser = size)]
    size: (usize, usize),
    /// Primary rays along a side of a pixel.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=8))]
    antialias: u8,
    /// Ambient-occlusion rays around what a primary ray hits.
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u16).range(1..=4096))]
    ao_samples: u16,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// Renders, writes and prints.
fn run(arguments: &Arguments) -> Result<()> {
    let mut mesh = arguments
        .mesh
        .as_deref()
        .map_or_else(|| Ok(scene()), Mesh::load)?;
    let out = &arguments.out;
    let file = File::create(out).with_context(|| format!("cannot write {}", out.display()))?;

    let rays = usize::from(arguments.antialias);
    let (width, height) = arguments.size;
    let bounds = mesh.bounds();
    let view = View::of(bounds, rays * width, rays * height);
    let floor = ((bounds.0 + bounds.1) / 2.0).with_y(bounds.0.y);
    let checks = Paint::Checks(Vec3::splat(0.5), Vec3::splat(0.42), 0.25 * view.radius);
    mesh.push_floor(floor, 30.0 * view.radius, checks);
    let reach = 60.0 * view.radius + bounds.0.abs().max(bounds.1.abs()).max_element();
    let geometry = Geometry::new(mesh, reach);

    let mut renderer = Renderer::new(&view, &geometry, arguments.ao_samples.into());
    let colours = renderer.render();
    png_file::write(file, width, rays, &colours)
        .with_context(|| format!("cannot write {}", out.display()))?;
    print(&renderer, geometry.mesh.triangles.len(), out);
    Ok(())
}

/// Prints how the two fared.
fn print(renderer: &Renderer, triangles: usize, out: &Path) {
    println!(
        "{} triangles, one thread; written to {}\n",
        HumanCount(triangles as u64),
        out.display()
    );
    println!("{}  kernel", Score::head());
    let scores = [&renderer.primary, &renderer.shadow, &renderer.occlusion];
    for (score, kernel) in scores.into_iter().zip(renderer.entries()) {
        println!("{score}  {} for {}", kernel.name, kernel.isa);
    }
    println!(
        "\nBoth trace the same rays through the same hierarchy, each row of tiles twice by turns; the shorter\n\
         time of each counts. raybreed's primary and shadow rays go in packets of {RAYS}, all others one by one;\n\
         for ambient occlusion the test in the leaves is all that differs."
    );
}

/// A size such as 800x500.
fn size(text: &str) -> Result<(usize, usize), String> {
    let sides = text
        .split_once('x')
        .map(|(width, height)| (width.parse(), height.parse()));
    match sides {
        Some((Ok(width @ 1..=8192), Ok(height @ 1..=8192))) => Ok((width, height)),
        _ => Err("a size is two numbers from 1 to 8192, as in 800x500".to_owned()),
    }
}

//! One ray against one block of 4, 8 or 16 triangles, wherever things lie in memory: at 256 depths of the stack, 16
//! bytes apart, and with the block at each of the 64 lines of a page, 16,384 layouts. What a call takes should hang on
//! none of that.
//!
//! ```text
//! cargo bench --package raybreed --bench layouts [-- PART_OF_A_NAME]
//! ```

use std::hint::black_box;
use std::time::Instant;

use raybreed::{Block, Intersector, Isa, Lists, Ray, Scene, Watertight};
use scene::{DEPTH_STEP, DEPTHS, Generator, at_depth};

/// Lines of the cache in a page.
const LINES: usize = 64;

/// Rays of a run, one call each.
const RAYS: usize = 32;

/// How often each layout is run. The least time counts: all else is the machine's.
const PASSES: usize = 5;

/// A layout is slow in which a call takes so many times as long as in most.
const SLOW: f64 = 1.1;

/// A block that begins at a line. Of 64 that follow one another, each begins at another line of a page, for all of them
/// are an odd number of lines long.
#[derive(Clone)]
#[repr(align(64))]
struct OnALine<T>(T);

/// What calls take in all layouts, in nanoseconds.
struct Times(Vec<Cell>);

/// A layout, and what a call takes in it.
#[derive(Clone, Copy)]
struct Cell {
    nanoseconds: f64,
    depth: usize,
    line: usize,
}

impl Times {
    /// In most layouts.
    fn usual(&self) -> f64 {
        let mut times: Vec<f64> = self.0.iter().map(|cell| cell.nanoseconds).collect();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    }

    /// The slowest layout.
    fn worst(&self) -> Cell {
        let cells = self.0.iter().copied();
        let worst = cells.max_by(|one, other| one.nanoseconds.total_cmp(&other.nanoseconds));
        worst.expect("there are layouts")
    }

    /// The share of layouts that are slow.
    fn slow(&self) -> f64 {
        let limit = SLOW * self.usual();
        let slow = self.0.iter().filter(|cell| cell.nanoseconds > limit);
        slow.count() as f64 / self.0.len() as f64
    }
}

/// What this was asked.
struct Asked {
    /// Whether times are wanted, or only that everything runs once.
    times: bool,
    /// A part of the names that are wanted.
    filter: Option<String>,
}

impl Asked {
    fn read() -> Asked {
        let mut times = false;
        let mut filter = None;
        for argument in std::env::args().skip(1) {
            match argument.as_str() {
                "--bench" => times = true,
                flag if flag.starts_with("--") => {}
                name => filter = Some(name.to_owned()),
            }
        }
        Asked { times, filter }
    }
}

/// Times the test of a scene against blocks of `W`.
fn time<S: Scene, const W: usize>(asked: &Asked, promise: &str, isa: Isa) {
    let name = format!("ray-{promise}-{isa}-{W}");
    let is_wanted = asked.filter.as_ref().is_none_or(|part| name.contains(part));
    let Some(test) = Intersector::<S>::with_isa(isa).filter(|_| is_wanted) else {
        return;
    };
    let workload = Generator {
        triangles: W,
        packets: 1,
        ..Generator::default()
    };
    let workload = workload.generate();
    let triangles = workload
        .triangles
        .iter()
        .map(|triangle| raybreed::Triangle::new(triangle.p0, triangle.p1, triangle.p2));
    let block = Block::<W>::block(&triangles.collect::<Vec<_>>());
    let blocks = vec![OnALine(block); LINES];
    let packet = &workload.packets[0];
    let rays: [Ray; RAYS] = std::array::from_fn(|ray| {
        Ray::new(
            [packet.ox[ray], packet.oy[ray], packet.oz[ray]],
            [packet.dx[ray], packet.dy[ray], packet.dz[ray]],
        )
    });
    let run = |depth: usize, line: usize| {
        at_depth(depth, || {
            let blocks = std::slice::from_ref(&blocks[line].0);
            let mut rays = black_box(rays);
            let start = Instant::now();
            for ray in &mut rays {
                black_box(test.ray_closest(ray, black_box(blocks)));
            }
            start.elapsed().as_secs_f64() * 1e9 / RAYS as f64
        })
    };
    if !asked.times {
        run(0, 0);
        println!("{name}: runs");
        return;
    }
    let layouts = (0..DEPTHS).flat_map(|depth| (0..LINES).map(move |line| (depth, line)));
    let mut cells: Vec<Cell> = layouts
        .map(|(depth, line)| Cell {
            nanoseconds: f64::INFINITY,
            depth,
            line,
        })
        .collect();
    for _ in 0..PASSES {
        for cell in &mut cells {
            cell.nanoseconds = cell.nanoseconds.min(run(cell.depth, cell.line));
        }
    }
    let times = Times(cells);
    let (usual, worst) = (times.usual(), times.worst());
    println!(
        "{name:<28}{usual:>9.1}{:>9.1}{:>8.2}x{:>9.2}%   stack {:>4} bytes deeper, block at byte {:>4} of a page",
        worst.nanoseconds,
        worst.nanoseconds / usual,
        100.0 * times.slow(),
        worst.depth * DEPTH_STEP,
        blocks[worst.line].0.p0.as_ptr().addr() % 4096,
    );
}

/// What leaks, what is tight at edges, and what is fully.
enum Leaky {}
enum Edges {}
enum Full {}

impl Scene for Leaky {
    const LISTS: Lists = Lists::Short;
}

impl Scene for Edges {
    const WATERTIGHT: Watertight = Watertight::Edges;
}

impl Scene for Full {
    const WATERTIGHT: Watertight = Watertight::Full;
}

fn time_widths<S: Scene>(asked: &Asked, promise: &str, isa: Isa) {
    time::<S, 4>(asked, promise, isa);
    time::<S, 8>(asked, promise, isa);
    time::<S, 16>(asked, promise, isa);
}

fn main() {
    let asked = Asked::read();
    if asked.times {
        println!(
            "{:<28}{:>9}{:>9}{:>9}{:>10}   the worst layout",
            "kernel, block", "usual ns", "worst ns", "worst", "slow"
        );
    }
    for isa in Isa::ALL {
        if !isa.is_available() {
            eprintln!("skipped: {isa}, which this processor lacks");
        }
        time_widths::<Leaky>(&asked, "leaky", isa);
        time_widths::<Edges>(&asked, "edges", isa);
        time_widths::<Full>(&asked, "full", isa);
    }
}

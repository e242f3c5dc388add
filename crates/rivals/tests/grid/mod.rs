//! A uniform grid whose leaves share triangles, scenes in it, and packets that walk it front to back: as much
//! of a ray tracer as shows what a mailbox is worth.
//!
//! Rays walk together, as in Wald, Ize, Kensler, Knoll and Parker 2006, "Ray tracing animated scenes using
//! coherent grid traversal": from slice to slice along one axis, and in each slice through the rectangle of
//! cells that bounds those of all rays. A leaf's triangles are tested against all rays of the packet.

use rivals::Mailbox;
use rivals::methods::shevtsov::{self, Record};
use scene::{RayPacket, Triangle, rays};

mod scenes;

pub use scenes::all as scenes;

/// A point or a vector.
type Vec3 = [f64; 3];

/// How much wider a cell is taken to be, in cells: more than the rounding of whatever is compared with it.
const MARGIN: f64 = 1e-3;

/// Triangles in the leaves of a grid, and who walks it.
pub struct Scene {
    pub name: &'static str,
    pub triangles: Vec<Triangle>,
    /// Of each triangle.
    pub records: Vec<Record>,
    pub packets: Vec<RayPacket>,
    /// Cells along each axis of the cube from -1 to 1.
    cells: usize,
    /// For each cell, the numbers of the triangles that reach into it.
    leaves: Vec<Vec<u32>>,
}

impl Scene {
    /// About four cells a triangle.
    fn new(name: &'static str, triangles: Vec<Triangle>, packets: Vec<RayPacket>) -> Self {
        let cells = (4.0 * triangles.len() as f64).cbrt().round() as usize;
        let mut scene = Scene {
            name,
            records: triangles.iter().map(shevtsov::prepare).collect(),
            triangles,
            packets,
            cells,
            leaves: vec![Vec::new(); cells.pow(3)],
        };
        let side = 2.0 / cells as f64;
        for (number, triangle) in (0..).zip(&scene.triangles) {
            let corners = [triangle.p0, triangle.p1, triangle.p2].map(|p| p.map(f64::from));
            let [x, y, z] = [0, 1, 2].map(|axis| {
                let [a, b, c] = corners.map(|p| scene.place(p[axis]));
                scene.range(a.min(b).min(c), a.max(b).max(c))
            });
            let of_box = x.flat_map(|x| y.clone().map(move |y| (x, y)));
            for [x, y, z] in of_box.flat_map(|(x, y)| z.clone().map(move |z| [x, y, z])) {
                let center = [x, y, z].map(|cell| -1.0 + (cell as f64 + 0.5) * side);
                if reaches_into(&corners, center, side * (0.5 + MARGIN)) {
                    scene.leaves[(x * cells + y) * cells + z].push(number);
                }
            }
        }
        scene
    }

    /// A coordinate in cells.
    fn place(&self, coordinate: f64) -> f64 {
        (coordinate + 1.0) * 0.5 * self.cells as f64
    }

    /// The cells between two places.
    fn range(&self, low: f64, high: f64) -> std::ops::Range<usize> {
        // Conversions saturate, so what lies before the grid is no cell of it.
        let end = (high + MARGIN + 1.0).floor().max(0.0) as usize;
        (low - MARGIN).floor() as usize..end.min(self.cells)
    }

    /// Calls `test` with the packet and each triangle of each leaf that one of its rays may reach before it
    /// has hit something, as often as a leaf names it. All rays go the same way along the axis along which
    /// the first is longest, and start before the cube.
    pub fn walk(&self, packet: &mut RayPacket, mut test: impl FnMut(&mut RayPacket, u32)) {
        let component = rays(packet).map(|component| component.map(f64::from));
        let [along, p, q] = axes([3, 4, 5].map(|axis| component[axis][0]));
        let forward = component[3 + along][0] > 0.0;
        assert!(component[3 + along].iter().all(|&d| (d > 0.0) == forward));
        for step in 0..self.cells {
            let slice = if forward { step } else { self.cells - 1 - step };
            let planes = [slice + usize::from(!forward), slice + usize::from(forward)];
            let planes = planes.map(|plane| plane as f64 * 2.0 / self.cells as f64 - 1.0);
            let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
            let mut is_over = true;
            for (ray, &t) in packet.t.iter().enumerate() {
                let [o, d] = [along, along + 3].map(|axis| component[axis][ray]);
                let [near, far] = planes.map(|plane| (plane - o) / d);
                if f64::from(t) < near * (1.0 - MARGIN) {
                    continue;
                }
                is_over = false;
                for at in [near, far] {
                    for (side, axis) in [p, q].into_iter().enumerate() {
                        let place =
                            self.place(component[axis][ray] + at * component[axis + 3][ray]);
                        low[side] = low[side].min(place);
                        high[side] = high[side].max(place);
                    }
                }
            }
            if is_over {
                return;
            }
            let [rows, columns] = [0, 1].map(|side| self.range(low[side], high[side]));
            for (row, column) in rows.flat_map(|row| columns.clone().map(move |c| (row, c))) {
                let mut cell = [slice; 3];
                (cell[p], cell[q]) = (row, column);
                let [x, y, z] = cell;
                for &triangle in &self.leaves[(x * self.cells + y) * self.cells + z] {
                    test(packet, triangle);
                }
            }
        }
    }

    /// What walks of all packets find, each with a memory of its own, which says whether a triangle need
    /// not be tested: how many tests of a packet were made, and the closest hits.
    ///
    /// The division comes first: then a ray's hit is the least of numbers that each depend on one triangle,
    /// and neither the order of tests nor a test made twice changes it. Where `t` is compared before it is
    /// divided, either may, by its last bit.
    pub fn trace<Seen: FnMut(u32) -> bool>(&self, memory: impl Fn() -> Seen) -> Traced {
        let (mut tests, mut packets) = (0, self.packets.clone());
        for packet in &mut packets {
            let mut has_seen = memory();
            self.walk(packet, |packet, triangle| {
                if !has_seen(triangle) {
                    tests += 1;
                    test(packet, &self.records[triangle as usize]);
                }
            });
        }
        let hits = packets.iter().flat_map(|packet| packet.t.map(f32::to_bits));
        Traced {
            tests,
            hits: hits.collect(),
        }
    }
}

/// What each memory makes of a scene, from one that remembers nothing to one that forgets nothing: mailboxes of
/// several sizes, and hashed ones, which Shevtsov and others cite from Wald as less efficient.
pub fn traces(scene: &Scene) -> [(&'static str, Traced); 9] {
    [
        ("none", scene.trace(mailbox::<0>)),
        ("4", scene.trace(mailbox::<4>)),
        ("8", scene.trace(mailbox::<8>)),
        ("16", scene.trace(mailbox::<16>)),
        ("32", scene.trace(mailbox::<32>)),
        ("64", scene.trace(mailbox::<64>)),
        ("64, low bits", scene.trace(hashed::<LOW_BITS>)),
        ("64, hashed", scene.trace(hashed::<GOLDEN>)),
        ("ideal", scene.trace(|| ideal(scene.triangles.len()))),
    ]
}

/// What walks of all packets of a scene found.
pub struct Traced {
    /// Tests of a packet against a triangle.
    pub tests: usize,
    /// The bits of `t` of all rays.
    pub hits: Vec<u32>,
}

/// Tests a packet against a triangle, division first.
pub fn test(packet: &mut RayPacket, record: &Record) {
    // SAFETY: every x86-64 CPU has SSE2.
    unsafe { shevtsov::packet_divided::<64, false>(packet, std::slice::from_ref(record)) }
}

/// A mailbox as a memory.
pub fn mailbox<const N: usize>() -> impl FnMut(u32) -> bool {
    let mut mailbox = Mailbox::<N>::new();
    move |triangle| mailbox.has_seen(triangle)
}

/// The factor that leaves a number's lowest six bits uppermost.
pub const LOW_BITS: u32 = 1 << 26;
/// 2³² over the golden ratio, which spreads numbers that follow on one another.
pub const GOLDEN: u32 = 0x9e37_79b9;

/// 64 places, and of the triangles whose numbers times `FACTOR` have the same upper bits the newest.
pub fn hashed<const FACTOR: u32>() -> impl FnMut(u32) -> bool {
    let mut newest = [u32::MAX; 64];
    move |triangle| {
        let place = &mut newest[(triangle.wrapping_mul(FACTOR) >> 26) as usize];
        std::mem::replace(place, triangle) == triangle
    }
}

/// A memory that forgets nothing, of a flag a triangle: what any mailbox can save at most.
fn ideal(triangles: usize) -> impl FnMut(u32) -> bool {
    let mut seen = vec![false; triangles];
    move |triangle| std::mem::replace(&mut seen[triangle as usize], true)
}

/// The axis of which a vector has most, then the others.
fn axes(vector: Vec3) -> [usize; 3] {
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| vector[b].abs().total_cmp(&vector[a].abs()));
    axes
}

/// Whether a triangle and a cube with this center and half a side meet: none of the thirteen axes separates
/// them (Akenine-Möller 2001, "Fast 3D triangle-box overlap testing").
fn reaches_into(corners: &[Vec3; 3], center: Vec3, half: f64) -> bool {
    let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let edges = [0, 1, 2].map(|i| minus(corners[(i + 1) % 3], corners[i]));
    let crosses = edges.iter().flat_map(|&e| units.map(|unit| cross(e, unit)));
    let normal = cross(edges[0], edges[1]);
    units
        .into_iter()
        .chain([normal])
        .chain(crosses)
        .all(|axis| {
            let reach = half * axis.map(f64::abs).iter().sum::<f64>();
            let [a, b, c] = corners.map(|corner| dot(axis, minus(corner, center)));
            a.min(b).min(c) <= reach && -reach <= a.max(b).max(c)
        })
}

fn minus(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

//! One program as one Rust function.
//!
//! Every statement is printed in the loop of its rate. For packets that is once a call, once a ray,
//! once a triangle, or once for every vector of rays and triangle; for one ray once a call or once a
//! block of triangles. Within a loop the program's order is kept, but for values that are first used
//! after an exit: see [`Schedule`].

use std::path::PathBuf;

use program::Program;
use scene::{Grouping, Layout, Record, SceneModel};

use crate::in_scene::InScene;
use crate::isa::Isa;
use crate::schedule::Schedule;
use crate::statement::Printer;

/// A kernel's source, ready for a [`library`](crate::library()).
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Kernel {
    /// The instruction set whose lanes it uses.
    pub isa: Isa,
    /// The text of its module.
    pub source: String,
    /// The function in it, with generic arguments: what is called to run the kernel.
    pub function: String,
    /// What the function takes.
    pub signature: Signature,
    /// The function in it that makes a record of a triangle, if the kernel has its own:
    /// `fn(&Triangle) -> [f32; NUMBERS]`.
    pub prepare: Option<String>,
    /// Whether there is a check of bounds beside it.
    pub is_bounded: bool,
    /// Where it is compiled already, if it is no text: then `source` and `function` only say what it is.
    pub library: Option<InLibrary>,
}

/// A kernel in a library that somebody else compiled, under the symbols of a [`library`](crate::library())
/// of ours.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct InLibrary {
    /// The library's file.
    pub path: PathBuf,
    /// The kernel's place in it.
    pub index: usize,
}

/// What a kernel's function takes: `packet`, `hits` if it has them, which ray of the packet if it is
/// one, and a slice of records.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Signature {
    /// What is tested together.
    pub grouping: Grouping,
    /// Rays of a packet, as many as a library's callers have in one, or a divisor or a multiple of that.
    pub rays: usize,
    /// Whether it reports more than `t`.
    pub hits: bool,
    /// What a record is.
    pub layout: Layout,
}

impl Signature {
    /// That of the kernels of a scene.
    pub fn of(scene: &SceneModel, isa: Isa) -> Signature {
        Signature {
            grouping: scene.grouping,
            rays: scene::PACKET_SIZE,
            hits: scene.has_hits(),
            layout: scene.layout(isa.lane_count()),
        }
    }
}

impl Kernel {
    /// A kernel by hand that reports `t` alone: the text of its module, and its function with generic
    /// arguments.
    pub fn by_hand(isa: Isa, grouping: Grouping, source: String, function: String) -> Kernel {
        Kernel {
            isa,
            source,
            function,
            signature: Signature {
                grouping,
                rays: scene::PACKET_SIZE,
                hits: false,
                layout: Layout {
                    lanes: match grouping {
                        Grouping::Packet => 1,
                        Grouping::Single | Grouping::Scalar => isa.lane_count(),
                    },
                    ..Layout::VERTICES
                },
            },
            prepare: None,
            is_bounded: false,
            library: None,
        }
    }

    /// A kernel of one ray and one triangle at a time that is compiled already, by the name of what it calls.
    pub fn compiled(function: String, library: InLibrary) -> Kernel {
        let source = library.path.display().to_string();
        Kernel {
            library: Some(library),
            ..Kernel::by_hand(Isa::Scalar, Grouping::Single, source, function)
        }
    }

    /// The same kernel for packets of so many rays; it reports `t` alone.
    ///
    /// # Panics
    ///
    /// If that is no divisor and no multiple of the rays that callers have in a packet, if the kernel's vectors do
    /// not fill it, or if it reports more.
    #[must_use]
    pub fn of_packets(mut self, rays: usize) -> Kernel {
        let usual = scene::PACKET_SIZE;
        let fits = usual.is_multiple_of(rays) || rays.is_multiple_of(usual);
        assert!(fits && rays.is_multiple_of(self.isa.lane_count()) && !self.signature.hits);
        self.function = self
            .function
            .replacen(&format!("::<{usual}"), &format!("::<{rays}"), 1);
        self.signature.rays = rays;
        self
    }

    /// The same kernel, which takes triangles one at a time, whatever lanes its instruction set has.
    #[must_use]
    pub fn one_by_one(mut self) -> Kernel {
        self.signature.layout.lanes = 1;
        self
    }

    /// The same kernel, which takes what a function of its module makes of a triangle.
    #[must_use]
    pub fn preparing(mut self, numbers: usize, function: &str) -> Kernel {
        let of = blake3::hash(format!("{}{function}", self.source).as_bytes());
        let of = u64::from_le_bytes(of.as_bytes()[..8].try_into().expect("a hash has 32 bytes"));
        self.signature.layout.record = Record::Own { numbers, of };
        self.prepare = Some(function.to_owned());
        self
    }
}

/// Prints `program` as the function `name`.
///
/// In the fixed regime the kernel stores hits in `hit_t` and leaves `t` alone. `docs` stands above
/// the function as it is, so it must be made of nothing that a file says freely.
pub fn print_kernel(
    program: &Program,
    scene: &SceneModel,
    isa: Isa,
    name: &str,
    docs: &str,
) -> Kernel {
    let view = InScene {
        program,
        scene,
        is_open: false,
    };
    let printer = Printer { view, isa };
    let check = printer.check(name);
    let uses = match check.is_empty() {
        true => "",
        false => "use super::super::bounds::*;\n",
    };
    Kernel {
        isa,
        source: format!("{uses}{}{}", printer.function(name, docs), indented(&check)),
        function: format!("{name}::<{}>", scene::PACKET_SIZE),
        signature: Signature::of(scene, isa),
        prepare: None,
        is_bounded: scene.bounds.is_some(),
        library: None,
    }
}

/// Prints `program` as the function `name` of the package, generic over what its caller asks for.
///
/// Of `scene` it has what is tested together and where rays start.
pub(crate) fn print_generic(
    program: &Program,
    scene: &SceneModel,
    isa: Isa,
    name: &str,
    docs: &str,
) -> String {
    let view = InScene {
        program,
        scene,
        is_open: true,
    };
    Printer { view, isa }.function(name, docs)
}

impl Printer<'_> {
    /// The text of a module with the function.
    fn function(&self, name: &str, docs: &str) -> String {
        let schedule = Schedule::new(self.view, self.isa.rereads());
        let is_packet = self.view.scene.grouping == Grouping::Packet;
        let body = match is_packet {
            true => self.packet_body(&schedule),
            false => self.ray_body(&schedule),
        };
        let attribute = self.isa.attribute();
        let types = self.types();
        let generics = self.generics();
        let (rays, gives) = match self.takes_one_ray() {
            true => ("ray: &Ray", " -> f32"),
            false => ("packet: &mut Packet<N>", ""),
        };
        let hits = match (self.view.is_open, self.view.scene.has_hits()) {
            (true, _) => "hits: &mut Hits<M>, ",
            (false, true) => "hits: &mut Hits<N>, ",
            (false, false) => "",
        };
        let records = self.records();
        let misses = match self.view.is_open && is_packet {
            true => "use crate::triangle::is_degenerate;\n",
            false => "",
        };
        indented(&format!(
            "use super::lanes::*;\n\
             {misses}\
             use crate::{{{types}}};\n\
             \n\
             {docs}\
             {attribute}\
             pub fn {name}<{generics}>({rays}, {hits}{records}){gives} {{\n\
             align_frame();\n\
             {body}\
             }}\n"
        ))
    }

    /// The types of the ABI that the function names.
    fn types(&self) -> String {
        let scene = self.view.scene;
        let mut types = match (self.view.is_open, self.takes_one_ray()) {
            (true, false) => vec!["Culling", "Hits", "Packet", "Record", "Scene"],
            (true, true) => vec!["Culling", "Hits", "Ray", "Record", "Scene"],
            (false, _) => vec!["Packet", scene.stored.type_name()],
        };
        if scene.has_hits() && !self.view.is_open {
            types.push("Hits");
        }
        types.sort_unstable();
        types.join(", ")
    }

    /// What the function is generic over: the rays of a packet; and in the package how many hits are reported of,
    /// the query, the triangles of a block, the scene, and what is stored.
    fn generics(&self) -> &'static str {
        match (self.view.is_open, self.view.scene.grouping) {
            (false, _) => "const N: usize",
            (true, Grouping::Packet) => {
                "const N: usize, const M: usize, const ANY: bool, S: Scene, T: Record<f32>"
            }
            (true, Grouping::Single | Grouping::Scalar) => {
                "const M: usize, const ANY: bool, const W: usize, S: Scene, T: Record<[f32; W]>"
            }
        }
    }

    /// The parameters that say which ray of the packet, if it is one of them, and against what.
    fn records(&self) -> String {
        let stored = self.view.scene.stored.type_name();
        match (self.view.scene.grouping, self.view.is_open) {
            (Grouping::Packet, true) => "triangles: &[T]".into(),
            (Grouping::Packet, false) => format!("triangles: &[{stored}]"),
            (Grouping::Single | Grouping::Scalar, true) => "blocks: &[T]".into(),
            (Grouping::Single | Grouping::Scalar, false) => {
                format!("ray: usize, blocks: &[{stored}<[f32; LANES]>]")
            }
        }
    }

    /// The line that makes sure of whole vectors, and of hits that fit.
    fn assertion(&self) -> &'static str {
        match (self.view.is_open, self.view.scene.grouping) {
            (false, Grouping::Packet) => {
                "const { assert!(N > 0 && N.is_multiple_of(LANES), \"whole vectors of rays\") };\n"
            }
            (false, Grouping::Single | Grouping::Scalar) => "",
            (true, Grouping::Packet) => {
                "assert!(N.is_multiple_of(LANES) && (M == 0 || M == N), \"whole vectors of rays\");\n"
            }
            (true, Grouping::Single | Grouping::Scalar) => {
                "assert!(W.is_multiple_of(LANES) && M <= 1, \"whole vectors of triangles\");\n"
            }
        }
    }

    /// The loops over triangles and, in it, over rays.
    fn packet_body(&self, schedule: &Schedule) -> String {
        let once = self.statements(&schedule.once);
        let each_ray = self.each_ray(schedule);
        let each_triangle = self.statements(&schedule.each_triangle);
        let parts = (0..).zip(&schedule.parts);
        let each_row: String = parts
            .map(|(number, part)| self.part(number, part, schedule))
            .collect();
        let (head, number) = match (self.view.is_open, self.counts()) {
            (true, _) => (
                "for (place, triangle) in (0..).zip(triangles) {\n",
                "let number = splat(f32::from_bits(hits.first.wrapping_add(place)));\n",
            ),
            (false, true) => (
                "for (place, triangle) in (0..).zip(triangles) {\n",
                "let number = splat(f32::from_bits(place));\n",
            ),
            (false, false) => ("for triangle in triangles {\n", ""),
        };
        let assertion = self.assertion();
        let misses = match self.view.is_open {
            true => "if is_degenerate(triangle) {\ncontinue;\n}\n",
            false => "",
        };
        format!(
            "{assertion}\
             {once}\
             {each_ray}\
             {head}\
             {misses}\
             {number}\
             {each_triangle}\
             for row in 0..N / LANES {{\n\
             {each_row}\
             }}\n\
             }}\n"
        )
    }

    /// What depends on the ray alone, computed before the first triangle and kept.
    fn each_ray(&self, schedule: &Schedule) -> String {
        if schedule.kept.is_empty() {
            return String::new();
        }
        let mut text = String::new();
        let kept = |index: &usize| self.names(*index);
        for name in schedule.kept.iter().flat_map(kept) {
            text += &format!("let mut {name}_of_rays = OfRays([0.0; N]);\n");
        }
        text += "for row in 0..N / LANES {\n";
        text += &self.statements(&self.with_inputs(&schedule.each_ray));
        for name in schedule.kept.iter().flat_map(kept) {
            text += &format!("store(&mut {name}_of_rays.0, row, {name});\n");
        }
        text += "}\n";
        text
    }

    /// A part of the inner loop.
    fn part(&self, number: usize, part: &[usize], schedule: &Schedule) -> String {
        let afresh = self.view.scene.grouping == Grouping::Packet
            && number > 0
            && self.isa.overwrites()
            && part.iter().any(|&index| self.is_input(index));
        let mut text = String::new();
        if afresh {
            text += "let packet = afresh(packet);\n";
        }
        for index in part {
            match schedule.kept.contains(index) {
                true => {
                    for name in self.names(*index) {
                        text += &format!("let {name} = load(&{name}_of_rays.0, row);\n");
                    }
                }
                false => text += &self.statements(&[*index]),
            }
        }
        text
    }

    /// The loop over blocks, and the closest of the lanes after it.
    fn ray_body(&self, schedule: &Schedule) -> String {
        let once = self.statements(&self.with_inputs(&schedule.once));
        let parts = (0..).zip(&schedule.parts);
        let each_block: String = parts
            .map(|(number, part)| self.part(number, part, schedule))
            .collect();
        let (counter, head, number, end) = match (self.view.is_open, self.counts()) {
            // A block may be of several vectors.
            (true, _) => (
                "let mut place = 0;\n",
                "for block in blocks {\nfor row in 0..W / LANES {\n",
                "place += 1;\nlet number = splat(f32::from_bits(place));\n",
                "}\n}\n",
            ),
            (false, true) => (
                "",
                "for (place, block) in (1..).zip(blocks) {\n",
                "let number = splat(f32::from_bits(place));\n",
                "}\n",
            ),
            (false, false) => ("", "for block in blocks {\n", "", "}\n"),
        };
        let assertion = self.assertion();
        let renaming = self.renaming();
        let before = self.before_blocks();
        let after = self.after_blocks();
        format!(
            "{assertion}\
             {renaming}\
             {once}\
             {before}\
             {counter}\
             {head}\
             {number}\
             {each_block}\
             {end}\
             {after}"
        )
    }
}

/// The text with every line as far in as its braces say.
fn indented(text: &str) -> String {
    let mut indented = String::with_capacity(2 * text.len());
    let mut depth: usize = 0;
    for line in text.lines() {
        if line.starts_with('}') {
            depth = depth.saturating_sub(1);
        }
        if !line.is_empty() {
            for _ in 0..depth {
                indented += "    ";
            }
        }
        indented += line;
        indented.push('\n');
        if line.ends_with('{') {
            depth += 1;
        }
    }
    indented
}

//! The package's catalogue: what is known of every kernel, as data.

use program::{Degree, Tags, Watertight};
use scene::{Grouping, Numeric, Origin, Regime};

use super::entry::Entry;
use crate::isa::Isa;
use crate::recipe::{Share, Stability};

/// The text of its file.
pub(super) fn catalogue(kernels: &[Entry<'_>]) -> String {
    let of_isas = Isa::ALL.iter().flat_map(|&isa| {
        let of_isa = kernels.iter().filter(move |kernel| kernel.is_for(isa));
        of_isa.map(move |kernel| entry(kernel, isa))
    });
    let entries: String = of_isas.collect();
    let uses = match (entries.is_empty(), entries.contains("Some(Stability")) {
        (true, _) => "Entry",
        (false, false) => "Entry, Grouping, Scales, TError, Tags",
        (false, true) => "Entry, Grouping, Scales, Share, Stability, TError, Tags",
    };
    let words = match entries.is_empty() {
        true => "",
        false => "use crate::isa::Isa;\nuse crate::scene::{Lists, Numeric, Origin, Watertight};\n",
    };
    format!(
        "//! What the package holds.\n\n\
         use crate::entry::{{{uses}}};\n\
         {words}\n\
         /// Every kernel, by instruction set and name.\n\
         pub(crate) static CATALOGUE: &[Entry] = &[\n{entries}];\n"
    )
}

/// The entry of a kernel.
fn entry(kernel: &Entry<'_>, isa: Isa) -> String {
    let scene = &kernel.recipe.scene;
    let grouping = match scene.grouping {
        Grouping::Packet => "Packet",
        Grouping::Single | Grouping::Scalar => "Ray",
    };
    let origin = match scene.origin {
        Origin::General => "General",
        Origin::Common => "Common",
    };
    let numeric = match scene.numeric {
        Numeric::Fast => "Fast",
        Numeric::Portable => "Portable",
    };
    format!(
        "Entry {{ name: {:?}, isa: Isa::{isa:?}, grouping: Grouping::{grouping}, origin: Origin::{origin}, \
         numeric: Numeric::{numeric}, lists: Lists::{}, bytes: {}, operations: {:?}, ratio: {:?}, worst_layout: {:?}, \
         t_error: TError {{ hits: {}, median: {:?}, p99: {:?}, max: {:?} }}, stability: {}, tags: {}, \
         recipe: \"recipes/{}.json\" }},\n",
        kernel.kernel(isa),
        lists(scene.regime),
        scene.stored.bytes(),
        kernel.recipe.operations(),
        kernel.provenance.ratio,
        kernel.provenance.worst_layout,
        kernel.error.hits,
        kernel.error.median,
        kernel.error.p99,
        kernel.error.max,
        stability(kernel.recipe.stability.as_ref()),
        tags(&kernel.recipe.program.tags(isa.fuses())),
        kernel.recipe.name,
    )
}

/// The kernels of an instruction set as a table, a line of documentation each.
pub(super) fn table(kernels: &[&Entry<'_>], isa: Isa) -> String {
    let mut table = String::from(
        "//! Speed is in multiples of Möller-Trumbore's test of the same grouping, operations are of a ray and a triangle,\n\
         //! the error of `t` is the relative one that 9,999 of 10,000 are below, and leaks are those of rays aimed at\n\
         //! shared edges and vertices. All keep 36 bytes of a triangle, or what else is stored of it.\n//!\n\
         //! | kernel | speed | operations | error of `t` | leak at edges | at vertices |\n\
         //! |---|---:|---:|---:|---:|---:|\n",
    );
    for kernel in kernels {
        let found = kernel.recipe.stability.as_ref();
        let share =
            |of: fn(&Stability) -> Share| found.map_or("-".into(), |one| of(one).to_string());
        let error = found.map_or("-".into(), |one| format!("{:.1e}", one.t_p9999));
        table += &format!(
            "//! | [`{0}`]({0}()) | {1:.2} | {2:.1} | {error} | {3} | {4} |\n",
            kernel.function(isa),
            kernel.provenance.ratio,
            kernel.recipe.operations(),
            share(|one| one.edge_leak),
            share(|one| one.vertex_leak),
        );
    }
    table
}

/// The package's word for the lists that a kernel was bred on.
pub(super) fn lists(regime: Regime) -> &'static str {
    match regime {
        Regime::Leaf => "Short",
        Regime::Shrinking | Regime::Fixed => "Long",
    }
}

/// What the accuracy lab found.
fn stability(stability: Option<&Stability>) -> String {
    let share = |Share { events, samples }: Share| {
        format!("Share {{ events: {events}, samples: {samples} }}")
    };
    stability.map_or("None".into(), |one| {
        let [least, most] = one.scale;
        format!(
            "Some(Stability {{ edge_leak: {}, vertex_leak: {}, double: {}, t_p9999: {:?}, \
             uv_p9999: {:?}, scale: ({least}, {most}) }})",
            share(one.edge_leak),
            share(one.vertex_leak),
            share(one.double),
            one.t_p9999,
            one.uv_p9999,
        )
    })
}

/// What its statements say of a program, in order: of everything, of positions, of directions.
pub(super) fn safe_scales(tags: &Tags) -> [(i32, i32); 3] {
    [Degree::EVERYTHING, Degree::POSITIONS, Degree::DIRECTIONS].map(|weights| {
        let (least, most) = tags.safe_scales(weights).into_inner();
        (least, most)
    })
}

/// What a program's statements say of it.
fn tags(tags: &Tags) -> String {
    let [everything, positions, directions] = safe_scales(tags);
    format!(
        "Tags {{ watertight: Watertight::{}, translation_safe: {}, \
         scales: Scales {{ everything: {everything:?}, positions: {positions:?}, \
         directions: {directions:?} }} }}",
        watertight(tags.watertight),
        tags.translation_safe,
    )
}

/// The package's word for a class.
pub(super) fn watertight(watertight: Watertight) -> &'static str {
    match watertight {
        Watertight::No => "No",
        Watertight::Edges => "Edges",
        Watertight::Full => "Full",
    }
}

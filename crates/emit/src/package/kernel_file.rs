//! The file of a kernel: where it comes from, what is known of it, and its function.

use program::{Tags, Watertight};
use scene::{Grouping, Origin, SceneModel};

use super::catalogue::safe_scales;
use super::entry::Entry;
use crate::isa::Isa;
use crate::kernel::print_generic;
use crate::recipe::Stability;

/// The text of a kernel's file.
pub(super) fn kernel_file(entry: &Entry<'_>, isa: Isa) -> String {
    let name = entry.function(isa);
    let docs = docs(entry, isa);
    let (program, scene) = (&entry.recipe.program, &entry.recipe.scene);
    head(entry, isa) + &print_generic(program, scene, isa, &name, &docs)
}

/// Where it comes from.
fn head(entry: &Entry<'_>, isa: Isa) -> String {
    let provenance = entry.provenance;
    let search = &provenance.search;
    let objective = search.objective.as_ref();
    let objective = objective.map_or(String::new(), |name| format!(" --objective {name}"));
    let islands = search
        .islands
        .map_or(String::new(), |islands| format!(" --islands {islands}"));
    let improved = provenance.improved.as_ref().map_or(String::new(), |improved| {
        format!(
            "//! Then improved by `cargo xtask opcount --improve --model {}`: from {:.2} operations a \
             ray and triangle to {:.2}, from {:.2} times Möller-Trumbore to {:.2}.\n",
            improved.model,
            improved.cost_before,
            improved.cost,
            improved.ratio_before,
            provenance.ratio,
        )
    });
    format!(
        "//! The kernel `{}` for {isa}.\n\
         //!\n\
         //! Found by `cargo xtask evolve --scene {} --isa {} --regime {} \
         --strategy {}{objective} --population {} --elite {} --generations {}{islands} --seed {}`\n\
         //! in {} evaluations of {} different sources of graph {}.\n\
         {improved}\
         //! Timed on {} with rustc {}.\n\n",
        entry.kernel(isa),
        scene_flags(&entry.recipe.scene),
        isas(entry, ","),
        entry.recipe.scene.regime,
        search.strategy,
        search.population,
        search.elite,
        search.generations,
        search.seed,
        provenance.evaluations,
        provenance.distinct,
        provenance.graph,
        provenance.cpu,
        provenance.rustc,
    )
}

/// The value of `--scene`, and the flags that change a preset into the scene.
fn scene_flags(scene: &SceneModel) -> String {
    let mut flags = scene.name.clone();
    let Ok(preset) = SceneModel::preset(&scene.name) else {
        return flags + ".json";
    };
    let mut flag = |name: &str, word: &str, differs: bool| {
        if differs {
            flags += &format!(" --{name} {word}");
        }
    };
    flag(
        "grouping",
        scene.grouping.word(),
        scene.grouping != preset.grouping,
    );
    flag("origin", scene.origin.word(), scene.origin != preset.origin);
    flag(
        "numeric",
        scene.numeric.word(),
        scene.numeric != preset.numeric,
    );
    flag(
        "watertight",
        scene.watertight.word(),
        scene.watertight != preset.watertight,
    );
    flags
}

/// The names of the instruction sets that it was bred for.
fn isas(entry: &Entry<'_>, between: &str) -> String {
    let names = entry.recipe.isas.iter().map(|isa| isa.name());
    names.collect::<Vec<_>>().join(between)
}

/// What a kernel of one ray does.
const ONE_RAY: &str = "\
One ray against blocks of triangles. Gives `t` of the closest hit, or `ray.t` if there is none; where `ANY`, negative
/// infinity if there is a hit. Of the hit, the outputs of the scene are written to place 0 of `hits` if `M` is 1.";

/// What stands above the function.
fn docs(entry: &Entry<'_>, isa: Isa) -> String {
    let Entry {
        recipe,
        provenance,
        error,
    } = entry;
    let (what, reference) = match (recipe.scene.grouping, recipe.scene.origin) {
        (Grouping::Packet, Origin::General) => ("Rays of any origin against triangles.", "packet"),
        (Grouping::Packet, Origin::Common) => (
            "Rays of one origin, that of ray 0, against triangles.",
            "packet",
        ),
        (Grouping::Single | Grouping::Scalar, _) => (ONE_RAY, "one-ray"),
    };
    let on = match recipe.isas.len() {
        1 => format!("on {isa}"),
        _ => format!("(geometric mean of {})", isas(entry, ", ")),
    };
    let safety = match isa.features() {
        "" => String::new(),
        features => {
            let must = format!("/// The processor must have {features}.\n");
            format!("///\n/// # Safety\n///\n{must}")
        }
    };
    format!(
        "/// {what}\n\
         ///\n\
         /// - speed: {:.2}{} times Möller-Trumbore's {reference} test {on}, {} regime\n\
         {}\
         /// - relative error of t over {} clear hits: median {:.1e}, p99 {:.1e}, largest seen {:.1e}\n\
         {}{}{safety}",
        provenance.ratio,
        provenance.uncertainty.map_or(String::new(), |of| format!(" ± {:.2}", provenance.ratio * of)),
        recipe.scene.regime,
        provenance.worst_layout.map_or(String::new(), |worst| format!(
            "/// - where stack and rays lie worst in memory it takes {worst:.2} times as long as where they lie in most\n"
        )),
        error.hits,
        error.median,
        error.p99,
        error.max,
        recipe.stability.as_ref().map_or(String::new(), stability),
        tags(&recipe.program.tags(isa.fuses())),
    )
}

/// What the accuracy lab found, a line each.
fn stability(stability: &Stability) -> String {
    let Stability {
        edge_leak,
        vertex_leak,
        double,
        t_p9999,
        uv_p9999,
        scale: [least, most],
        ..
    } = stability;
    let uv = uv_p9999.map_or(String::new(), |uv| {
        format!("/// - error of u and v, where they are reported, at the same: p99.99 {uv:.1e}\n")
    });
    format!(
        "/// - rays at shared edges that go through: {edge_leak}\n\
         /// - rays at shared vertices that go through: {vertex_leak}\n\
         /// - rays at either that hit twice: {double}\n\
         /// - relative error of t at ordinary triangles, rays at their edges included: p99.99 {t_p9999:.1e}\n\
         {uv}\
         /// - safe scales: everything times 2^{least} to 2^{most} changes no verdict, nor t\n"
    )
}

/// What a program's statements say of it, a line each.
fn tags(tags: &Tags) -> String {
    let watertight = match tags.watertight {
        Watertight::No => "",
        Watertight::Edges => {
            "/// - by its statements no ray goes through at a shared edge within the scales below, unless it is at two sides at once\n"
        }
        Watertight::Full => {
            "/// - by its statements no ray goes through at a shared edge or vertex within the scales below\n"
        }
    };
    let place = match tags.translation_safe {
        true => "/// - by its statements it is as exact far from the world's origin as near it\n",
        false => "",
    };
    let scales = safe_scales(tags).map(|(least, most)| format!("2^{least} to 2^{most}"));
    let [everything, positions, directions] = scales;
    format!(
        "{watertight}{place}\
         /// - by its statements no verdict changes if everything is multiplied by {everything}, positions by \
         {positions} or\n///   directions by {directions}\n"
    )
}

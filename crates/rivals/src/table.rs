//! The table of rivals, in the order in which tables print them.

use emit::Isa;
use scene::Grouping;

use crate::{Precomputation, Rival};

const MT: &str = "Möller and Trumbore 1997, section 3, as adapted to packets in Kensler and Shirley 2006, table \
                  1, row MT";
const MT_SINGLE: &str = "Möller and Trumbore 1997, section 3, one ray against a block of triangles";
const KS: &str = "Kensler and Shirley 2006, appendix (GA+ for general packets)";
const KS_SINGLE: &str = "Kensler and Shirley 2006, appendix (GA+ for general packets), its statements with one \
                         ray against a block of triangles";
const KS_COMMON: &str = "Kensler and Shirley 2006, section 4 (the formulation for a common origin), with the \
                         appendix's tests";
const BADOUEL: &str = "Badouel 1990; Havel and Herout 2010, section I";
const BALDWIN: &str = "Baldwin and Weber 2016, sections 2.2 and 3";
const WALD: &str = "Wald 2004; Havel and Herout 2010, section II.A";
const WALD_DEFERRED: &str =
    "Wald 2004 with the division deferred; Havel and Herout 2010, sections II.A and V";
const SHEVTSOV: &str = "Shevtsov, Soupikov and Kapustin 2007; Havel and Herout 2010, section II.B";
const SHEVTSOV_DISTANCE: &str = "Shevtsov, Soupikov and Kapustin 2007, the distance tested first";
const SHEVTSOV_DIVIDED: &str = "Shevtsov, Soupikov and Kapustin 2007, the division not deferred; Havel and Herout \
                                2010, section V";
const SHEVTSOV_BRANCHLESS: &str =
    "Shevtsov, Soupikov and Kapustin 2007, section 2: without a branch";
const PLUECKER: &str =
    "Shevtsov, Soupikov and Kapustin 2007, section 3: Plücker coordinates of the sides";
const WOOP: &str = "Woop, Benthin and Wald 2013, appendix";
const BENTHIN: &str = "Benthin 2006; the common origin of Kensler and Shirley 2006, section 4";
const HAVEL: &str = "Havel and Herout 2010, section III, perpendicular planes";
const HAVEL_PARALLEL: &str = "Havel and Herout 2010, section III, planes parallel to an axis";
const HAVEL_DIVIDED: &str = "Havel and Herout 2010, section III, perpendicular planes, the division not deferred \
                             (section V)";
const HAVEL_DOT: &str = "Havel and Herout 2010, section IV: one triangle at a time, by dpps";

pub const RIVALS: [Rival; 32] = {
    use Grouping::{Packet, Single};
    const PLANES: &str = include_str!("methods/havel_herout.rs");
    const PROJECTED: &str = include_str!("methods/shevtsov.rs");
    const LINES: &str = include_str!("methods/pluecker.rs");
    const WALDS: &str = include_str!("methods/wald.rs");
    [
        vertices(
            "moller-trumbore",
            Packet,
            MT,
            include_str!("packet/moller_trumbore.rs"),
            "moller_trumbore",
        ),
        vertices(
            "kensler-shirley",
            Packet,
            KS,
            include_str!("packet/kensler_shirley.rs"),
            "kensler_shirley",
        ),
        Rival {
            common_origin: true,
            ..vertices(
                "kensler-shirley-common",
                Packet,
                KS_COMMON,
                include_str!("methods/kensler_shirley.rs"),
                "common_origin",
            )
        },
        record(
            "badouel",
            Packet,
            BADOUEL,
            include_str!("methods/badouel.rs"),
            "packet",
            ("prepare", 11),
        ),
        record("wald", Packet, WALD, WALDS, "packet", ("prepare", 10)),
        record(
            "wald-deferred",
            Packet,
            WALD_DEFERRED,
            WALDS,
            "packet_deferred",
            ("prepare", 10),
        ),
        record(
            "shevtsov",
            Packet,
            SHEVTSOV,
            PROJECTED,
            "packet",
            ("prepare", 10),
        ),
        record(
            "shevtsov-distance-first",
            Packet,
            SHEVTSOV_DISTANCE,
            PROJECTED,
            "packet_distance_first",
            ("prepare", 10),
        ),
        record(
            "shevtsov-divided",
            Packet,
            SHEVTSOV_DIVIDED,
            PROJECTED,
            "packet_divided",
            ("prepare", 10),
        ),
        record(
            "shevtsov-branchless",
            Packet,
            SHEVTSOV_BRANCHLESS,
            PROJECTED,
            "packet_branchless",
            ("prepare", 10),
        ),
        record(
            "havel-herout",
            Packet,
            HAVEL,
            PLANES,
            "packet",
            ("prepare", 12),
        ),
        record(
            "havel-herout-parallel",
            Packet,
            HAVEL_PARALLEL,
            PLANES,
            "packet",
            ("prepare_parallel", 12),
        ),
        record(
            "havel-herout-divided",
            Packet,
            HAVEL_DIVIDED,
            PLANES,
            "packet_divided",
            ("prepare", 12),
        ),
        record(
            "baldwin-weber",
            Packet,
            BALDWIN,
            PLANES,
            "packet_divided",
            ("prepare_transformation", 12),
        ),
        record(
            "pluecker",
            Packet,
            PLUECKER,
            LINES,
            "packet",
            ("prepare", 19),
        ),
        vertices(
            "woop",
            Packet,
            WOOP,
            include_str!("methods/woop.rs"),
            "packet",
        ),
        Rival {
            common_origin: true,
            ..vertices(
                "benthin",
                Packet,
                BENTHIN,
                include_str!("methods/benthin.rs"),
                "packet",
            )
        },
        vertices(
            "moller-trumbore",
            Single,
            MT_SINGLE,
            include_str!("single/moller_trumbore.rs"),
            "moller_trumbore",
        ),
        vertices(
            "kensler-shirley",
            Single,
            KS_SINGLE,
            include_str!("single/kensler_shirley.rs"),
            "kensler_shirley",
        ),
        record(
            "badouel",
            Single,
            BADOUEL,
            include_str!("methods/badouel.rs"),
            "single",
            ("prepare", 11),
        ),
        record("wald", Single, WALD, WALDS, "single", ("prepare", 10)),
        record(
            "wald-deferred",
            Single,
            WALD_DEFERRED,
            WALDS,
            "single_deferred",
            ("prepare", 10),
        ),
        record(
            "shevtsov",
            Single,
            SHEVTSOV,
            PROJECTED,
            "single",
            ("prepare", 10),
        ),
        record(
            "shevtsov-distance-first",
            Single,
            SHEVTSOV_DISTANCE,
            PROJECTED,
            "single_distance_first",
            ("prepare", 10),
        ),
        record(
            "shevtsov-divided",
            Single,
            SHEVTSOV_DIVIDED,
            PROJECTED,
            "single_divided",
            ("prepare", 10),
        ),
        record(
            "shevtsov-branchless",
            Single,
            SHEVTSOV_BRANCHLESS,
            PROJECTED,
            "single_branchless",
            ("prepare", 10),
        ),
        record(
            "havel-herout",
            Single,
            HAVEL,
            PLANES,
            "single",
            ("prepare", 12),
        ),
        record(
            "havel-herout-parallel",
            Single,
            HAVEL_PARALLEL,
            PLANES,
            "single",
            ("prepare_parallel", 12),
        ),
        record(
            "havel-herout-divided",
            Single,
            HAVEL_DIVIDED,
            PLANES,
            "single_divided",
            ("prepare", 12),
        ),
        Rival {
            only_on: Some(Isa::Sse41),
            ..record(
                "havel-herout-dpps",
                Single,
                HAVEL_DOT,
                PLANES,
                "dot_product",
                ("prepare", 12),
            )
        },
        record(
            "baldwin-weber",
            Single,
            BALDWIN,
            PLANES,
            "single_divided",
            ("prepare_transformation", 12),
        ),
        vertices(
            "woop",
            Single,
            WOOP,
            include_str!("methods/woop.rs"),
            "single",
        ),
    ]
};

/// A rival that takes triangles by their vertices.
const fn vertices(
    name: &'static str,
    grouping: Grouping,
    reference: &'static str,
    source: &'static str,
    function: &'static str,
) -> Rival {
    Rival {
        name,
        grouping,
        reference,
        source,
        precomputation: None,
        common_origin: false,
        only_on: None,
        function,
    }
}

/// A rival with records of its own.
const fn record(
    name: &'static str,
    grouping: Grouping,
    reference: &'static str,
    source: &'static str,
    function: &'static str,
    (prepare, numbers): (&'static str, usize),
) -> Rival {
    Rival {
        precomputation: Some(Precomputation {
            function: prepare,
            numbers,
        }),
        ..vertices(name, grouping, reference, source, function)
    }
}

//! The papers' tables again, from today's machine, beside the printed figures.

use super::figures::Figures;

/// Prints the tables for which anything was timed.
pub fn print(figures: &[Figures]) {
    let today = Today(figures);
    kensler_shirley(today);
    havel_herout(today);
}

/// Where a kernel was timed.
#[derive(Clone, Copy)]
struct Place {
    grouping: &'static str,
    origin: &'static str,
    regime: &'static str,
}

const PACKETS: Place = Place {
    grouping: "packet",
    origin: "general",
    regime: "shrinking",
};
const COMMON: Place = Place {
    origin: "common",
    ..PACKETS
};
const PACKETS_WORST: Place = Place {
    regime: "fixed",
    ..PACKETS
};
const SINGLE: Place = Place {
    grouping: "single",
    ..PACKETS
};
const SINGLE_WORST: Place = Place {
    regime: "fixed",
    ..SINGLE
};

/// What was timed today.
#[derive(Clone, Copy)]
struct Today<'a>(&'a [Figures]);

impl<'a> Today<'a> {
    fn all(self, isa: &'a str, place: Place) -> impl Iterator<Item = &'a Figures> {
        let here = move |one: &&Figures| {
            one.of.isa == isa
                && one.of.grouping == place.grouping
                && one.of.origin == place.origin
                && one.of.regime == place.regime
                && one.of.query == "closest"
        };
        self.0.iter().filter(here)
    }

    fn of(self, kernel: &str, isa: &'a str, place: Place) -> Option<&'a Figures> {
        self.all(isa, place).find(|one| one.of.kernel == kernel)
    }

    /// The fastest kernel of the library: those that are no rivals.
    fn bred(self, isa: &'a str, place: Place) -> Option<&'a Figures> {
        let is_rival = |name: &str| rivals::all().iter().any(|rival| rival.name == name);
        self.all(isa, place).find(|one| !is_rival(&one.of.kernel))
    }
}

/// Kensler and Shirley's Table 1: the average of its eight columns, in millions of tests a second.
const TABLE_1: [(&str, f64); 5] = [
    ("GA", 134.780),
    ("GA+", 152.284),
    ("GA (co)", 178.882),
    ("GA+ (co)", 191.680),
    ("MT", 88.499),
];

fn kensler_shirley(today: Today<'_>) {
    let mut isas: Vec<&str> = Vec::new();
    for one in today.0 {
        if today.all(&one.of.isa, PACKETS).next().is_some() && !isas.contains(&one.of.isa.as_str())
        {
            isas.push(&one.of.isa);
        }
    }
    if isas.is_empty() {
        return;
    }
    println!("\nKensler and Shirley 2006, Table 1, in millions of tests a second (of MT):");
    let heads: String = isas.iter().map(|isa| format!("{isa:>15}")).collect();
    println!("{:8}  {:>15}{heads}", "Prog", "printed");
    let (_, printed_mt) = TABLE_1[4];
    for (row, printed) in TABLE_1 {
        let cells: String = isas
            .iter()
            .map(|isa| {
                let figures = match row {
                    "GA" => today.bred(isa, PACKETS),
                    "GA+" => today.of("kensler-shirley", isa, PACKETS),
                    "GA (co)" => today.bred(isa, COMMON),
                    "GA+ (co)" => today.of("kensler-shirley-common", isa, COMMON),
                    _ => today.of("moller-trumbore", isa, PACKETS),
                };
                match figures.and_then(|one| Some((one.speed?, one.ratio?))) {
                    Some((speed, ratio)) => format!("{:>15}", format!("{speed:.0} ({ratio:.2})")),
                    None => format!("{:>15}", "-"),
                }
            })
            .collect();
        let printed = format!("{printed:.0} ({:.2})", printed / printed_mt);
        println!("{row:8}  {printed:>15}{cells}");
    }
    println!(
        "printed: the average of eight machines and compilers of 2006; GA, GA (co): the paper does not print \
         the code, today's is the fastest kernel of the library; GA+ (co): its formulation with the \
         appendix's tests"
    );
}

/// Havel and Herout's methods, as this repository names them.
const METHODS: [(&str, &str); 4] = [
    ("Wald", "wald-deferred"),
    ("Shevtsov", "shevtsov"),
    ("New", "havel-herout"),
    ("New SSE4", "havel-herout-dpps"),
];

/// A row of Havel and Herout's Table I: its name, what was printed for Microsoft's compiler in the order of
/// [`METHODS`], and where it is timed today.
type Row = (&'static str, [Option<f64>; 4], Place);

const TABLE_I: [Row; 4] = [
    (
        "Single rays",
        [Some(109.0), Some(107.0), Some(115.0), Some(149.0)],
        SINGLE,
    ),
    (
        "Single worst",
        [Some(44.0), Some(46.0), Some(44.0), Some(48.0)],
        SINGLE_WORST,
    ),
    (
        "Ray packets",
        [Some(390.0), Some(391.0), Some(427.0), None],
        PACKETS,
    ),
    (
        "Packets worst",
        [Some(173.0), Some(179.0), Some(177.0), None],
        PACKETS_WORST,
    ),
];

/// Its Table II: millions of triangles a second, printed for Microsoft's compiler.
const TABLE_II: [Option<f64>; 4] = [Some(26.0), Some(32.1), Some(35.5), Some(50.3)];

fn havel_herout(today: Today<'_>) {
    // Single rays were compiled as scalar code, packets of four rays as SSE.
    let isa = |kernel: &str, place: Place| match (kernel, place.grouping) {
        ("havel-herout-dpps", _) => "sse4.1",
        (_, "single") => "scalar",
        _ => "sse2",
    };
    let find = |kernel: &str, place: Place| today.of(kernel, isa(kernel, place), place);
    let any = TABLE_I.iter().any(|&(_, _, place)| {
        let mut methods = METHODS.iter();
        methods.any(|(_, kernel)| find(kernel, place).is_some())
    });
    if !any {
        return;
    }
    println!("\nHavel and Herout 2010, printed and today (single rays: scalar; packets: sse2):");
    let heads: String = METHODS
        .iter()
        .map(|(name, _)| format!("{name:>16}"))
        .collect();
    println!("{:24}{heads}", "");
    let row = |name: &str, printed: [Option<f64>; 4], today: [Option<String>; 4]| {
        let cells: String = std::iter::zip(printed, today)
            .map(|(printed, today)| {
                let printed = printed.map_or("-".into(), |printed| match printed < 1e-3 {
                    true => format!("{printed:e}"),
                    false => printed.to_string(),
                });
                let today = today.unwrap_or("-".into());
                format!("{:>16}", format!("{printed} {today:>6}"))
            })
            .collect();
        println!("{name:24}{cells}");
    };
    for (name, printed, place) in TABLE_I {
        let speeds = METHODS.map(|(_, kernel)| find(kernel, place)?.speed);
        let name = format!("{name}, M tests/s");
        row(
            &name,
            printed,
            speeds.map(|speed| Some(format!("{:.0}", speed?))),
        );
    }
    let speeds = METHODS.map(|(_, kernel)| {
        let place = if kernel == "havel-herout-dpps" {
            SINGLE
        } else {
            PACKETS
        };
        find(kernel, place)?.precomputation
    });
    let speeds = speeds.map(|speed| Some(format!("{:.1}", speed?)));
    row("Precomputation, M tri/s", TABLE_II, speeds);
    let errors = METHODS.map(|(_, kernel)| {
        let place = if kernel == "havel-herout-dpps" {
            SINGLE
        } else {
            PACKETS
        };
        find(kernel, place)?.t_error_mean_square
    });
    let errors = errors.map(|error| Some(format!("{error:.0e}", error = error?)));
    row("Mean square error", [Some(1e-8); 4], errors);
    println!(
        "printed for Microsoft's compiler on a Core 2 Duo E8200; the error is that of t here, of the hit's \
         coordinates there (about 1e-8); all with the division deferred"
    );
}

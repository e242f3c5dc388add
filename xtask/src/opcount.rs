//! `cargo xtask opcount`: the formulations with fewest operations, by exhaustive search.

use std::io::{self, BufWriter, ErrorKind, Write};
use std::num::NonZeroU16;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use clap::builder::TypedValueParser;
use serde::{Serialize, Serializer};
use volumes::{Count, Formulation};

/// Counts the operations of every formulation and prints the cheapest ones.
///
/// A formulation chooses one triple product for each of V (or V0), Va, V1 and V2: 36*384*36*36 are
/// priced a case. An edge costs 3 operations, a cross product 9, a dot product 5, and each distinct
/// one counts once (Kensler and Shirley 2006, section 4).
#[derive(clap::Args)]
#[command(after_help = "Example:\n  cargo xtask opcount --case packet --volume V")]
pub struct Opcount {
    /// Which rays share work [default: all three, one after the other]
    #[arg(long, value_enum)]
    case: Option<Case>,

    /// The volume computed besides Va, V1 and V2 [default: both, one after the other]
    #[arg(long, value_enum)]
    volume: Option<Volume>,

    /// Rays in a packet: shared work counts one part in as many
    #[arg(long, value_name = "RAYS", default_value = "64", value_parser = packet_size())]
    packet_size: NonZeroU16,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Opcount {
    /// Runs the searches and prints what they find.
    pub fn run(self) -> anyhow::Result<()> {
        let rows = self.rows();
        let out = BufWriter::new(io::stdout().lock());
        let printed = if self.json {
            print_json(out, &rows)
        } else {
            print_text(out, &rows)
        };
        match printed {
            // Whoever reads has seen enough, as `head` does.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            printed => Ok(printed?),
        }
    }

    fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        for &case in only_or_all(&self.case) {
            for &volume in only_or_all(&self.volume) {
                let start = Instant::now();
                let count = volumes::cheapest(case.priced(self.packet_size), volume.with_others());
                rows.push(Row {
                    case,
                    volume,
                    count,
                    time: start.elapsed(),
                });
            }
        }
        rows
    }
}

/// Which rays share work.
#[derive(Clone, Copy, ValueEnum)]
enum Case {
    /// Rays alone
    Single,
    /// Packets that share work on the triangle
    Packet,
    /// Packets that share their origin too, and all work without the direction
    CommonOrigin,
}

impl Case {
    const fn priced(self, packet_size: NonZeroU16) -> volumes::Case {
        match self {
            Self::Single => volumes::Case::SINGLE,
            Self::Packet => volumes::Case::packet(packet_size),
            Self::CommonOrigin => volumes::Case::common_origin(packet_size),
        }
    }
}

/// The volume computed besides Va, V1 and V2.
#[derive(Clone, Copy, ValueEnum)]
enum Volume {
    /// The sum of V0, V1 and V2
    #[value(name = "V")]
    V,
    /// The volume opposite p0
    #[value(name = "V0")]
    V0,
}

impl Volume {
    const fn with_others(self) -> [volumes::Volume; 4] {
        match self {
            Self::V => Formulation::WITH_V,
            Self::V0 => Formulation::WITH_V0,
        }
    }
}

/// A search and how long it took.
struct Row {
    case: Case,
    volume: Volume,
    count: Count,
    time: Duration,
}

/// From this many formulations on, each is printed on one line.
const MANY: usize = 16;

/// Characters of the longest triple product, `((p1-p0) × (p2-p0)) · (p0-a)`.
const WIDTH: usize = 28;

fn print_text(mut out: impl Write, rows: &[Row]) -> io::Result<()> {
    writeln!(
        out,
        "{:13}  {:6}  {:12}  {:>12}  {:>12}  {:>12}",
        "case", "volume", "cost", "formulations", "combinations", "milliseconds"
    )?;
    for row in rows {
        writeln!(
            out,
            "{:13}  {:6}  {:12}  {:12}  {:12}  {:12.1}",
            word(row.case),
            word(row.volume),
            row.count.cost,
            row.count.formulations.len(),
            row.count.combinations,
            row.time.as_secs_f64() * 1e3
        )?;
    }
    for row in rows {
        print_formulations(&mut out, row)?;
    }
    out.flush()
}

fn print_formulations(mut out: impl Write, row: &Row) -> io::Result<()> {
    let formulations = &row.count.formulations;
    let (case, volume) = (word(row.case), word(row.volume));
    writeln!(out, "\n{case}, {volume}: {}", row.count.cost)?;
    if formulations.len() < MANY {
        for formulation in formulations {
            writeln!(out)?;
            for line in formulation.to_string().lines() {
                writeln!(out, "  {line}")?;
            }
        }
        return Ok(());
    }
    writeln!(out)?;
    for formulation in formulations {
        let columns = formulation.products.map(|(volume, product)| {
            let product = product.to_string();
            format!("{volume} = {product:WIDTH$}")
        });
        writeln!(out, "  {}", columns.join("  ").trim_end())?;
    }
    Ok(())
}

fn print_json(mut out: impl Write, rows: &[Row]) -> io::Result<()> {
    let rows: Vec<_> = rows.iter().map(JsonRow::new).collect();
    serde_json::to_writer_pretty(&mut out, &rows)?;
    writeln!(out)?;
    out.flush()
}

/// A row as other programs read it.
#[derive(Serialize)]
struct JsonRow {
    case: String,
    volume: String,
    model: &'static str,
    combinations: u64,
    cost: f64,
    count: usize,
    formulations: Vec<JsonFormulation>,
}

impl JsonRow {
    fn new(row: &Row) -> Self {
        let formulations = &row.count.formulations;
        Self {
            case: word(row.case),
            volume: word(row.volume),
            model: "paper",
            combinations: row.count.combinations,
            cost: row.count.cost.operations(),
            count: formulations.len(),
            formulations: formulations.iter().copied().map(JsonFormulation).collect(),
        }
    }
}

/// Formulas by volume, in the formulation's order.
struct JsonFormulation(Formulation);

impl Serialize for JsonFormulation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let formulas = self.0.products;
        serializer.collect_map(
            formulas.map(|(volume, product)| (volume.to_string(), product.to_string())),
        )
    }
}

/// The chosen value, or all there are.
fn only_or_all<T: ValueEnum>(chosen: &Option<T>) -> &[T] {
    chosen
        .as_ref()
        .map_or(T::value_variants(), std::slice::from_ref)
}

/// The word that stands for a value on the command line.
fn word(value: impl ValueEnum) -> String {
    let value = value.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}

fn packet_size() -> impl TypedValueParser<Value = NonZeroU16> {
    clap::value_parser!(u16)
        .range(1..)
        .try_map(NonZeroU16::try_from)
}

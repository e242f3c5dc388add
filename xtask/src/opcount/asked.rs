//! What is asked for: cases, volumes and cost models, by flags.

use std::num::NonZeroU16;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use clap::builder::TypedValueParser;
use emit::Recipe;
use volumes::{Count, Formulation, Rate, cheapest, read_ports};

use crate::failure::bad_input;

/// Flags of the counts.
#[derive(clap::Args)]
pub struct Asked {
    /// Which rays share work [default: single, packet and common-origin, one after the other]
    #[arg(long, value_enum)]
    case: Option<Case>,

    /// The volumes that are computed beside Va [default: V and V0, one after the other]
    #[arg(long, value_enum)]
    volume: Option<Volumes>,

    /// Rays in a packet, or triangles that a ray meets: shared work counts one part in as many
    #[arg(long, value_name = "N", default_value = "64", value_parser = packet_size())]
    packet_size: NonZeroU16,

    /// Work that is shared, by what it changes with [default: the case's]
    #[arg(long, value_enum, value_delimiter = ',', value_name = "RATE,...")]
    amortise: Vec<How>,

    /// What the triangle's vertices change with [default: the case's, the triangle]
    #[arg(long, value_enum, value_name = "RATE")]
    vertices: Option<How>,

    /// What the ray's origin changes with [default: the case's]
    #[arg(long, value_enum, value_name = "RATE")]
    origin: Option<How>,

    /// What the ray's direction changes with: packet for parallel rays [default: the case's, the ray]
    #[arg(long, value_enum, value_name = "RATE")]
    direction: Option<How>,

    /// Store what changes with the triangle only: it costs nothing but its bytes, which break ties
    #[arg(long)]
    stored: bool,

    /// What operations cost
    #[arg(long, value_enum, default_value = "paper")]
    model: Model,

    /// What a processor's ports do in a cycle, for --model ports: kinds of mul, add, fma, div, test
    #[arg(long, value_name = "TABLE", default_value = ZEN_4)]
    ports: String,
}

/// Zen 4 without FMA: multiplications on two pipes, additions on two others, whatever their width.
const ZEN_4: &str = "mul=2,add=2";

/// Which rays share work.
#[derive(Clone, Copy, ValueEnum)]
pub enum Case {
    /// Rays alone
    Single,
    /// Packets that share work on the triangle
    Packet,
    /// Packets that share their origin too, and all work without the direction
    CommonOrigin,
    /// One ray against many triangles, which share work on the ray
    Triangles,
}

impl Case {
    /// Those of the paper.
    const PAPER: [Case; 3] = [Case::Single, Case::Packet, Case::CommonOrigin];
}

/// The volumes that are computed beside Va.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub enum Volumes {
    /// V, V1 and V2
    #[value(name = "V")]
    V,
    /// V0, V1 and V2, of which V is the sum
    #[value(name = "V0")]
    V0,
    /// V, V0 and V2
    #[value(name = "without-V1")]
    WithoutV1,
    /// V, V0 and V1
    #[value(name = "without-V2")]
    WithoutV2,
    /// Any three of the four, one set after the other
    #[value(name = "any")]
    Any,
}

impl Volumes {
    const PAPER: [Volumes; 2] = [Volumes::V, Volumes::V0];
    const ALL: [Volumes; 4] = [
        Volumes::V,
        Volumes::V0,
        Volumes::WithoutV1,
        Volumes::WithoutV2,
    ];

    /// Them and Va.
    fn computed(self) -> [volumes::Volume; 4] {
        match self {
            Volumes::V | Volumes::Any => Formulation::WITH_V,
            Volumes::V0 => Formulation::WITH_V0,
            Volumes::WithoutV1 => Formulation::WITHOUT_V1,
            Volumes::WithoutV2 => Formulation::WITHOUT_V2,
        }
    }
}

/// What a value changes with.
#[derive(Clone, Copy, ValueEnum)]
enum How {
    Constant,
    Triangle,
    Packet,
    PacketTriangle,
    Ray,
    RayTriangle,
}

impl How {
    fn rate(self) -> Rate {
        Rate::ALL[self as usize]
    }
}

/// What operations cost.
#[derive(Clone, Copy, ValueEnum)]
enum Model {
    /// Every operation counts one
    Paper,
    /// The same, and a multiplication with the addition behind it is one operation
    Fma,
    /// Cycles of the busiest port
    Ports,
}

/// A search, what it found and how long it took.
pub struct Row {
    /// The case by its name.
    pub case_name: String,
    /// The case.
    pub case: volumes::Case,
    /// The volumes' name.
    pub volume: String,
    /// The model by its name.
    pub model_name: String,
    /// The model.
    pub model: volumes::Model,
    /// What was found.
    pub count: Count,
    /// How long that took.
    pub time: Duration,
}

impl Asked {
    /// Does the searches.
    pub fn rows(&self) -> anyhow::Result<Vec<Row>> {
        let cases = match &self.case {
            None => &Case::PAPER[..],
            Some(case) => std::slice::from_ref(case),
        };
        let volumes = match &self.volume {
            None => &Volumes::PAPER[..],
            Some(Volumes::Any) => &Volumes::ALL[..],
            Some(volumes) => std::slice::from_ref(volumes),
        };
        let model = self.model()?;
        let mut rows = Vec::new();
        for &case in cases {
            for &volume in volumes {
                let start = Instant::now();
                let priced = self.case(case);
                let count = cheapest(priced, &model, volume.computed());
                rows.push(Row {
                    case_name: self.case_name(case),
                    case: priced,
                    volume: word(volume),
                    model_name: self.model_name(),
                    model: model.clone(),
                    count,
                    time: start.elapsed(),
                });
            }
        }
        Ok(rows)
    }

    /// The cost model.
    pub fn model(&self) -> anyhow::Result<volumes::Model> {
        Ok(match self.model {
            Model::Paper => volumes::Model::paper(),
            Model::Fma => volumes::Model::fma(),
            Model::Ports => {
                let ports = read_ports(&self.ports);
                volumes::Model::ports(ports.map_err(|e| bad_input(format!("--ports: {e}")))?)
            }
        })
    }

    /// Its name.
    pub fn model_name(&self) -> String {
        word(self.model)
    }

    /// The case of a recipe's scene.
    pub fn case_of(&self, recipe: &Recipe) -> volumes::Case {
        volumes::Case {
            rates: recipe.scene.rates(),
            stored: self.stored,
            ..volumes::Case::packet(self.packet_size)
        }
    }

    fn case(&self, case: Case) -> volumes::Case {
        let size = self.packet_size;
        let mut priced = match case {
            Case::Single => volumes::Case::SINGLE,
            Case::Packet => volumes::Case::packet(size),
            Case::CommonOrigin => volumes::Case::common_origin(size),
            Case::Triangles => volumes::Case::triangles(size),
        };
        if !self.amortise.is_empty() {
            priced.sharers = size;
            priced.shared = [false; Rate::ALL.len()];
            for amortised in &self.amortise {
                priced.shared[amortised.rate() as usize] = true;
            }
        }
        let rates = &mut priced.rates;
        for (rate, asked) in [
            (&mut rates.vertices, self.vertices),
            (&mut rates.origin, self.origin),
            (&mut rates.direction, self.direction),
        ] {
            *rate = asked.map_or(*rate, How::rate);
        }
        priced.stored = self.stored;
        priced
    }

    /// The case and what was changed of it.
    fn case_name(&self, case: Case) -> String {
        let mut name = word(case);
        if !self.amortise.is_empty() {
            let rates: Vec<String> = self.amortise.iter().map(|&rate| word(rate)).collect();
            name += &format!("/{}", rates.join("+"));
        }
        for (input, asked) in [
            ("vertices", self.vertices),
            ("origin", self.origin),
            ("direction", self.direction),
        ] {
            if let Some(rate) = asked {
                name += &format!("/{input}={}", word(rate));
            }
        }
        if self.stored {
            name += "/stored";
        }
        name
    }
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

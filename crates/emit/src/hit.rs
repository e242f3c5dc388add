//! What is done with a hit: the part of a kernel that a scene's query and outputs decide.

use program::{On, Op, Side};
use scene::{Grouping, Output, Range};

use crate::in_scene::Coordinate;
use crate::statement::{Printer, exit};
use crate::when::When;
use crate::words::{AXES, variable};

/// A number of a hit that is reported beside `t`.
struct Reported {
    /// What must be asked for.
    output: Output,
    /// The field of `Hits`.
    field: String,
    /// What is written there.
    value: String,
    /// Whether it is an integer's bits.
    bits: bool,
}

impl Printer<'_> {
    /// The lines of the store, statement `index`.
    pub fn hit(&self, index: usize) -> Vec<String> {
        let left = index
            .checked_sub(1)
            .map(|before| &self.view.program.statements()[before]);
        let just_left = left.is_some_and(|statement| statement.op == Op::Exit);
        let mut lines = self.looked_at_again();
        if !just_left || !lines.is_empty() {
            // Not worth a branch where nothing but `t` is written.
            let leaves = match self.view.decides(When::AnyHit) {
                Some(true) => exit().to_vec(),
                Some(false) => When::Hits.only(self.view, exit().to_vec()),
                None => {
                    let head = "if (ANY || M > 0) && is_empty(mask) {".to_owned();
                    [head]
                        .into_iter()
                        .chain(exit().into_iter().skip(1))
                        .collect()
                }
            };
            lines.extend(leaves);
        }
        let (any, closest) = match self.view.scene.grouping {
            Grouping::Packet => (
                vec![
                    "store(&mut packet.t, row, select(mask, splat(f32::NEG_INFINITY), t_max));",
                    "if packet.t.iter().all(|&t| t <= 0.0 || t.is_nan()) {",
                    "return;",
                    "}",
                ],
                self.keep_in_packet(),
            ),
            Grouping::Single | Grouping::Scalar => (
                match self.takes_one_ray() {
                    true => vec!["return f32::NEG_INFINITY;"],
                    false => vec!["packet.t[ray] = f32::NEG_INFINITY;", "return;"],
                },
                self.keep_in_lanes(),
            ),
        };
        let any = any.into_iter().map(String::from).collect();
        lines.extend(When::AnyHit.lines(self.view, any, closest));
        lines
    }

    /// The lines by which the package looks again at where `t` is, if it was told by its products alone: rounded, it
    /// may be at an end, and where products are infinite it is nowhere.
    fn looked_at_again(&self) -> Vec<String> {
        let mut statements = self.view.program.statements().iter();
        let by_products =
            |op| matches!(op, Op::Near(On::Product | On::Signs) | Op::Far(On::Product));
        match self.view.is_open && statements.any(|statement| by_products(statement.op)) {
            true => vec![
                "// t_min < t < t_max, once it is rounded".into(),
                "let mask = both(mask, both(less(t_min, t), less(t, t_max)));".into(),
            ],
            false => Vec::new(),
        }
    }

    /// Where a packet keeps its closest hits, or in the fixed regime its last ones.
    fn keep_in_packet(&self) -> Vec<String> {
        let mut lines = match self.view.scene.range {
            _ if self.view.is_fixed() => vec![
                "let hit_t = load(&packet.hit_t, row);".to_owned(),
                "store(&mut packet.hit_t, row, select(mask, t, hit_t));".to_owned(),
            ],
            // The bound may have been less than what the caller brought.
            Range::Segment => vec![
                "let t_before = load(&packet.t, row);".to_owned(),
                "store(&mut packet.t, row, select(mask, t, t_before));".to_owned(),
            ],
            Range::TMax | Range::TMinMax => {
                vec!["store(&mut packet.t, row, select(mask, t, t_max));".to_owned()]
            }
        };
        let mut hits = self.coordinates();
        for output in self.outputs() {
            let mut kept = self.values(output);
            for Reported {
                field, value, bits, ..
            } in self.reported(output, "number")
            {
                let (load, store) = match bits {
                    true => ("load_bits", "store_bits"),
                    false => ("load", "store"),
                };
                kept.push(format!("let before = {load}(&hits.{field}, row);"));
                kept.push(format!(
                    "{store}(&mut hits.{field}, row, select(mask, {value}, before));"
                ));
            }
            hits.extend(When::Reports(output).only(self.view, kept));
        }
        lines.extend(When::Hits.only(self.view, hits));
        lines
    }

    /// Where the lanes of one ray keep theirs.
    fn keep_in_lanes(&self) -> Vec<String> {
        let mut lines = vec![match self.view.is_fixed() {
            true => "hit_t = select(mask, t, hit_t);".to_owned(),
            false => "t_max = select(mask, t, t_max);".to_owned(),
        }];
        let mut hits = Vec::new();
        if self.counts() {
            hits.push("block_of_hit = select(mask, number, block_of_hit);".into());
        }
        hits.extend(self.coordinates());
        for output in self.outputs() {
            let mut kept = self.values(output);
            for (place, Reported { value, .. }) in self
                .kept_in_lanes()
                .filter(|(_, kept)| kept.output == output)
            {
                kept.push(format!(
                    "reported_{place} = select(mask, {value}, reported_{place});"
                ));
            }
            if !kept.is_empty() {
                hits.extend(When::Reports(output).only(self.view, kept));
            }
        }
        // In the fixed regime the block says whether there is a hit.
        match self.view.is_fixed() {
            true => lines.extend(hits),
            false => lines.extend(When::Hits.only(self.view, hits)),
        }
        lines
    }

    /// What one ray's lanes begin with.
    pub fn before_blocks(&self) -> String {
        let mut lines: Vec<String> = self.lower_bound().into_iter().collect();
        let closest = self.view.decides(When::AnyHit) != Some(true);
        let changes = closest && !self.view.is_fixed();
        let bound = self.bound();
        let variable = if changes { "mut t_max" } else { "t_max" };
        lines.push(format!("let {variable} = {bound};"));
        if !closest {
            return joined(lines);
        }
        if self.view.is_fixed() {
            lines.push("let mut hit_t = zeros();".into());
        }
        if self.counts() {
            lines.push("let mut block_of_hit = zeros();".into());
        }
        for (place, _) in self.kept_in_lanes() {
            lines.push(format!("let mut reported_{place} = zeros();"));
        }
        joined(lines)
    }

    /// The lane whose hit counts, after all blocks, and what it reports.
    pub fn after_blocks(&self) -> String {
        if self.view.decides(When::AnyHit) == Some(true) {
            return String::new();
        }
        let mut lines: Vec<String> = Vec::new();
        let fixed = self.view.is_fixed();
        let (ray, unhit) = match self.takes_one_ray() {
            true => ("0", "return ray.t;"),
            false => ("ray", "return;"),
        };
        if !fixed {
            let any = match self.view.may(When::AnyHit) {
                true => "ANY || ",
                false => "",
            };
            let bound = self.bound();
            lines.push(format!("if {any}is_empty(less(t_max, {bound})) {{"));
            lines.push(unhit.into());
            lines.push("}".into());
        }
        let mut hits = Vec::new();
        if self.counts() {
            hits.push("let blocks_of_hits = to_array(block_of_hit).map(f32::to_bits);".to_owned());
        }
        if fixed {
            hits.push("let lane = last_of_most(blocks_of_hits);".into());
            hits.push("if blocks_of_hits[lane] == 0 {".into());
            hits.push("return;".into());
            hits.push("}".into());
            hits.push("packet.hit_t[ray] = to_array(hit_t)[lane];".into());
        } else {
            lines.push("let t = least(to_array(t_max));".into());
            if !self.takes_one_ray() {
                lines.push("packet.t[ray] = t;".into());
            }
            if self.counts() {
                hits.push("let closest = bits(at_most(t_max, splat(t)));".into());
                hits.push("let lane = first_of_least(blocks_of_hits, closest);".into());
            }
        }
        let mut place = 0;
        for output in self.outputs() {
            let mut written = Vec::new();
            for Reported { field, bits, .. } in self.reported(output, "") {
                written.push(match bits {
                    true => {
                        let number = "(blocks_of_hits[lane] - 1) * LANES as u32 + lane as u32";
                        let number = match self.view.is_open {
                            true => format!("hits.first.wrapping_add({number})"),
                            false => number.to_owned(),
                        };
                        format!("hits.{field}[{ray}] = {number};")
                    }
                    false => format!("hits.{field}[{ray}] = to_array(reported_{place})[lane];"),
                });
                place += usize::from(!bits);
            }
            hits.extend(When::Reports(output).only(self.view, written));
        }
        match fixed {
            true => lines.extend(hits),
            false => lines.extend(When::Hits.only(self.view, hits)),
        }
        if self.takes_one_ray() {
            lines.push("t".into());
        }
        joined(lines)
    }

    /// Outputs that may be asked for, beside `t`.
    fn outputs(&self) -> impl Iterator<Item = Output> {
        let outputs = Output::ALL.iter().copied();
        outputs.filter(|&output| output != Output::T && self.view.may(When::Reports(output)))
    }

    /// What lanes keep of all outputs, numbered.
    fn kept_in_lanes(&self) -> impl Iterator<Item = (usize, Reported)> {
        let reported = self.outputs().flat_map(|output| self.reported(output, ""));
        reported.filter(|reported| !reported.bits).enumerate()
    }

    /// The lines that compute what several outputs are made of.
    fn coordinates(&self) -> Vec<String> {
        match self.view.reports_coordinates() {
            true => vec![
                format!("let u = {};", self.coordinate(Side::S1)),
                format!("let v = {};", self.coordinate(Side::S2)),
            ],
            false => Vec::new(),
        }
    }

    /// The lines that compute an output of the values at hand.
    fn values(&self, output: Output) -> Vec<String> {
        match output {
            Output::T | Output::Uv | Output::Triangle => Vec::new(),
            Output::Normal => self.normal_lines(),
            Output::Point => {
                let axes = (0..3).zip(AXES);
                axes.map(|(place, axis)| {
                    let p0 = self.of_triangle("p0", &place.to_string());
                    let [edge1, edge2] = ["1", "2"].map(|edge| self.edge(edge, place));
                    format!("let point_{axis} = add({p0}, add(mul(u, {edge1}), mul(v, {edge2})));")
                })
                .collect()
            }
        }
    }

    /// What is reported of an output, by values at hand.
    fn reported(&self, output: Output, number: &str) -> Vec<Reported> {
        let one = |field: String, value: String, bits: bool| Reported {
            output,
            field,
            value,
            bits,
        };
        let vector = |name: &str| {
            let axes = (0..3).zip(AXES);
            let of_axis =
                |(place, axis)| one(format!("{name}[{place}]"), format!("{name}_{axis}"), false);
            axes.map(of_axis).collect()
        };
        match output {
            Output::T => Vec::new(),
            Output::Uv => ["u", "v"]
                .map(|name| one(name.into(), name.into(), false))
                .into(),
            Output::Triangle => vec![one("triangle".into(), number.into(), true)],
            Output::Normal => vector("normal"),
            Output::Point => vector("point"),
        }
    }

    fn coordinate(&self, side: Side) -> String {
        let name = |index: usize| variable(self.view.program.quantities()[index]);
        match self.view.barycentric(side) {
            Coordinate::There(index) => name(index),
            Coordinate::Product(a, b) => format!("mul({}, {})", name(a), name(b)),
            Coordinate::Quotient(a, b) => format!("div({}, {})", name(a), name(b)),
        }
    }

    /// The normal, from the triangle, from the program, or anew.
    fn normal_lines(&self) -> Vec<String> {
        let own = self.view.normal().map(|(index, opposite)| {
            let name = variable(self.view.program.quantities()[index]);
            (name, opposite)
        });
        let axes = (0..3).zip(AXES);
        axes.map(|(place, axis)| {
            let stored = self.of_triangle("normal", &place.to_string());
            let computed = match &own {
                Some((name, false)) => format!("{name}_{axis}"),
                Some((name, true)) => format!("sub(zeros(), {name}_{axis})"),
                None => {
                    let (j, k) = ((place + 1) % 3, (place + 2) % 3);
                    let [[j1, k1], [j2, k2]] =
                        ["1", "2"].map(|edge| [j, k].map(|axis| self.edge(edge, axis)));
                    format!("sub(mul({j1}, {k2}), mul({k1}, {j2}))")
                }
            };
            let value = When::StoredNormal.value(self.view, stored, computed);
            format!("let normal_{axis} = {value};")
        })
        .collect()
    }

    /// A component of `p1-p0` or `p2-p0`.
    fn edge(&self, number: &str, axis: usize) -> String {
        let axis = axis.to_string();
        let stored = self.of_triangle(&format!("edge{number}"), &axis);
        let to = self.of_triangle(&format!("p{number}"), &axis);
        let from = self.of_triangle("p0", &axis);
        When::StoredEdges.value(self.view, stored, format!("sub({to}, {from})"))
    }
}

fn joined(lines: Vec<String>) -> String {
    lines.into_iter().map(|line| line + "\n").collect()
}

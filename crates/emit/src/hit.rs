//! What is done with a hit: the part of a kernel that a scene's query and outputs decide.

use program::{Op, Side};
use scene::{Grouping, Output, Query, Range, Regime, Stored};

use crate::in_scene::Coordinate;
use crate::statement::{Printer, exit};
use crate::words::{AXES, variable};

/// A number of a hit that is reported beside `t`.
struct Reported {
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
        let scene = self.view.scene;
        let mut lines = Vec::new();
        let left = index
            .checked_sub(1)
            .map(|before| &self.view.program.statements()[before]);
        let just_left = left.is_some_and(|statement| statement.op == Op::Exit);
        let one_ray = scene.grouping != Grouping::Packet;
        if !just_left && (scene.has_hits() || scene.query == Query::Any) {
            lines.extend(exit());
        }
        match (scene.query, one_ray) {
            (Query::Closest, false) => lines.extend(self.keep_in_packet()),
            (Query::Closest, true) => lines.extend(self.keep_in_lanes()),
            (Query::Any, false) => lines.extend(
                [
                    "store(&mut packet.t, row, select(mask, splat(f32::NEG_INFINITY), t_max));",
                    "if packet.t.iter().all(|&t| t <= 0.0 || t.is_nan()) {",
                    "return;",
                    "}",
                ]
                .map(String::from),
            ),
            (Query::Any, true) => {
                lines.extend(["packet.t[ray] = f32::NEG_INFINITY;", "return;"].map(String::from));
            }
        }
        lines
    }

    /// Where a packet keeps its closest hits, or in the fixed regime its last ones.
    fn keep_in_packet(&self) -> Vec<String> {
        let mut lines = match (self.view.scene.regime, self.view.scene.range) {
            (Regime::Fixed, _) => vec![
                "let hit_t = load(&packet.hit_t, row);".to_owned(),
                "store(&mut packet.hit_t, row, select(mask, t, hit_t));".to_owned(),
            ],
            // The bound may have been less than what the caller brought.
            (_, Range::Segment) => vec![
                "let t_before = load(&packet.t, row);".to_owned(),
                "store(&mut packet.t, row, select(mask, t, t_before));".to_owned(),
            ],
            _ => vec!["store(&mut packet.t, row, select(mask, t, t_max));".to_owned()],
        };
        let (coordinates, reported) = self.reported("number");
        lines.extend(coordinates);
        for Reported { field, value, bits } in reported {
            let (load, store) = match bits {
                true => ("load_bits", "store_bits"),
                false => ("load", "store"),
            };
            lines.push(format!("let before = {load}(&hits.{field}, row);"));
            lines.push(format!(
                "{store}(&mut hits.{field}, row, select(mask, {value}, before));"
            ));
        }
        lines
    }

    /// Where the lanes of one ray keep theirs.
    fn keep_in_lanes(&self) -> Vec<String> {
        let mut lines = vec![match self.view.scene.regime {
            Regime::Fixed => "hit_t = select(mask, t, hit_t);".to_owned(),
            Regime::Shrinking | Regime::Leaf => "t_max = select(mask, t, t_max);".to_owned(),
        }];
        if self.counts() {
            lines.push("block_of_hit = select(mask, number, block_of_hit);".into());
        }
        let (coordinates, reported) = self.reported("");
        lines.extend(coordinates);
        for (place, reported) in reported.iter().enumerate() {
            if !reported.bits {
                let value = &reported.value;
                lines.push(format!(
                    "reported_{place} = select(mask, {value}, reported_{place});"
                ));
            }
        }
        lines
    }

    /// What one ray's lanes begin with.
    pub fn before_blocks(&self) -> String {
        let mut lines: Vec<String> = self.lower_bound().into_iter().collect();
        let closest = self.view.scene.query == Query::Closest;
        let changes = closest && self.view.scene.regime != Regime::Fixed;
        let bound = self.bound();
        if changes {
            lines.push(format!("let t_before = {bound};"));
            lines.push("let mut t_max = t_before;".into());
        } else {
            lines.push(format!("let t_max = {bound};"));
        }
        if !closest {
            return joined(lines);
        }
        if self.view.scene.regime == Regime::Fixed {
            lines.push("let mut hit_t = zeros();".into());
        }
        if self.counts() {
            lines.push("let mut block_of_hit = zeros();".into());
        }
        for (place, reported) in self.reported("").1.iter().enumerate() {
            if !reported.bits {
                lines.push(format!("let mut reported_{place} = zeros();"));
            }
        }
        joined(lines)
    }

    /// The lane whose hit counts, after all blocks, and what it reports.
    pub fn after_blocks(&self) -> String {
        if self.view.scene.query == Query::Any {
            return String::new();
        }
        let mut lines: Vec<String> = Vec::new();
        let fixed = self.view.scene.regime == Regime::Fixed;
        if !fixed {
            lines.push("if is_empty(less(t_max, t_before)) {".into());
            lines.push("return;".into());
            lines.push("}".into());
        }
        if self.counts() {
            lines.push("let blocks_of_hits = to_array(block_of_hit).map(f32::to_bits);".into());
        }
        if fixed {
            lines.push("let lane = last_of_most(blocks_of_hits);".into());
            lines.push("if blocks_of_hits[lane] == 0 {".into());
            lines.push("return;".into());
            lines.push("}".into());
            lines.push("packet.hit_t[ray] = to_array(hit_t)[lane];".into());
        } else {
            lines.push("let t = least(to_array(t_max));".into());
            lines.push("packet.t[ray] = t;".into());
            if self.counts() {
                lines.push("let closest = bits(at_most(t_max, splat(t)));".into());
                lines.push("let lane = first_of_least(blocks_of_hits, closest);".into());
            }
        }
        for (place, Reported { field, bits, .. }) in self.reported("").1.iter().enumerate() {
            lines.push(match bits {
                true => format!(
                    "hits.{field}[ray] = (blocks_of_hits[lane] - 1) * LANES as u32 + lane as u32;"
                ),
                false => format!("hits.{field}[ray] = to_array(reported_{place})[lane];"),
            });
        }
        joined(lines)
    }

    /// What is reported beside `t`, and the lines that compute it of the values at hand.
    fn reported(&self, number: &str) -> (Vec<String>, Vec<Reported>) {
        let scene = self.view.scene;
        let mut lines = Vec::new();
        let mut reported = Vec::new();
        let mut report = |field: String, value: String, bits: bool| {
            reported.push(Reported { field, value, bits });
        };
        if scene.reports(Output::Uv) || scene.reports(Output::Point) {
            lines.push(format!("let u = {};", self.coordinate(Side::S1)));
            lines.push(format!("let v = {};", self.coordinate(Side::S2)));
        }
        if scene.reports(Output::Uv) {
            report("u".into(), "u".into(), false);
            report("v".into(), "v".into(), false);
        }
        if scene.reports(Output::Triangle) {
            report("triangle".into(), number.into(), true);
        }
        if scene.reports(Output::Normal) {
            lines.extend(self.normal_lines());
            for (place, axis) in AXES.iter().enumerate() {
                report(format!("normal[{place}]"), format!("normal_{axis}"), false);
            }
        }
        if scene.reports(Output::Point) {
            for (place, axis) in AXES.iter().enumerate() {
                let p0 = self.of_triangle("p0", place);
                let [edge1, edge2] = ["1", "2"].map(|edge| self.edge(edge, place));
                lines.push(format!(
                    "let point_{axis} = add({p0}, add(mul(u, {edge1}), mul(v, {edge2})));"
                ));
                report(format!("point[{place}]"), format!("point_{axis}"), false);
            }
        }
        (lines, reported)
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
        let scene = self.view.scene;
        let is_stored = matches!(
            scene.stored,
            Stored::VerticesAndNormal | Stored::EdgesAndNormal
        );
        let own = self.view.normal().map(|(index, opposite)| {
            let name = variable(self.view.program.quantities()[index]);
            (name, opposite)
        });
        let axes = (0..3).zip(AXES);
        axes.map(|(place, axis)| match &own {
            _ if is_stored => format!("let normal_{axis} = {};", self.of_triangle("normal", place)),
            Some((name, false)) => format!("let normal_{axis} = {name}_{axis};"),
            Some((name, true)) => format!("let normal_{axis} = sub(zeros(), {name}_{axis});"),
            None => {
                let (j, k) = ((place + 1) % 3, (place + 2) % 3);
                let [[j1, k1], [j2, k2]] =
                    ["1", "2"].map(|edge| [j, k].map(|axis| self.edge(edge, axis)));
                format!("let normal_{axis} = sub(mul({j1}, {k2}), mul({k1}, {j2}));")
            }
        })
        .collect()
    }

    /// A component of `p1-p0` or `p2-p0`.
    fn edge(&self, number: &str, axis: usize) -> String {
        match self.view.scene.stored {
            Stored::Edges | Stored::EdgesAndNormal => {
                self.of_triangle(&format!("edge{number}"), axis)
            }
            Stored::Vertices | Stored::VerticesAndNormal => {
                let to = self.of_triangle(&format!("p{number}"), axis);
                let from = self.of_triangle("p0", axis);
                format!("sub({to}, {from})")
            }
        }
    }
}

fn joined(lines: Vec<String>) -> String {
    lines.into_iter().map(|line| line + "\n").collect()
}

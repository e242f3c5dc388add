//! Statements as lines of Rust.

use program::{Axis, Definition, Expr, Op, Quantity, Rounding, SameSign, Shear, Statement};
use scene::{Culling, Grouping, Query, Range, Regime};
use volumes::{Point, Rate, TripleProduct};

use crate::in_scene::{InScene, StoredAs};
use crate::isa::Isa;
use crate::schedule;
use crate::words::{AXES, binary, intermediate, ternary, unary, variable};

/// Prints the statements of one program in one scene.
pub(crate) struct Printer<'a> {
    pub view: InScene<'a>,
    pub isa: Isa,
}

impl Printer<'_> {
    /// Statements in this order.
    pub fn statements(&self, statements: &[usize]) -> String {
        let lines = statements.iter().flat_map(|&index| self.statement(index));
        lines.map(|line| line + "\n").collect()
    }

    /// The variables that hold a statement's value.
    pub fn names(&self, index: usize) -> Vec<String> {
        let quantity = self.view.program.quantities()[index];
        let name = variable(quantity);
        match quantity.is_vector() {
            true => AXES.map(|axis| format!("{name}_{axis}")).to_vec(),
            false => vec![name],
        }
    }

    /// Whether a statement reads what the caller brings.
    pub fn is_input(&self, index: usize) -> bool {
        self.op(index).is_input()
    }

    /// Statements with the inputs that they work on before them.
    pub fn with_inputs(&self, statements: &[usize]) -> Vec<usize> {
        let mut all: Vec<usize> = Vec::new();
        for &index in statements {
            let operands = self.view.operands(index).into_iter();
            all.extend(
                operands.filter(|&operand| self.is_input(operand) && self.is_of_ray(operand)),
            );
            all.push(index);
        }
        schedule::in_order(self.view, all.into_iter())
    }

    fn is_of_ray(&self, index: usize) -> bool {
        let rates = self.view.program.rates(self.view.scene.rates());
        rates[index] == Rate::Ray
    }

    fn op(&self, index: usize) -> Op {
        self.view.program.statements()[index].op
    }

    /// The lines of one statement.
    fn statement(&self, index: usize) -> Vec<String> {
        let statement = &self.view.program.statements()[index];
        let quantity = self.view.program.quantities()[index];
        if let Some(from) = self.view.stored_as(index) {
            return self.stored(&variable(quantity), from);
        }
        let mut lines: Vec<String> = self.comment(statement).into_iter().collect();
        if let Some(line) = self.with_renamed_axes(index) {
            lines.push(line);
            return lines;
        }
        match statement.op.definition() {
            Definition::Input => lines.extend(self.input(statement.op)),
            Definition::Constant(0) => {
                lines.push(format!("let {} = zeros();", variable(quantity)));
            }
            Definition::Constant(constant) => {
                lines.push(format!("let {} = splat({constant}.0);", variable(quantity)));
            }
            Definition::AllTrue => lines.extend(match self.culled() {
                Some(lines) => lines,
                None => vec!["let mask = all_true();".into()],
            }),
            Definition::Vector(components) => {
                let name = variable(quantity);
                lines.extend(AXES.iter().zip(&components).map(|(axis, expr)| {
                    format!("let {name}_{axis} = {};", self.expression(index, expr))
                }));
            }
            Definition::Scalar(expr) => {
                let value = self.expression(index, &expr);
                lines.push(format!("let {} = {value};", variable(quantity)));
            }
            Definition::ScalarVia {
                intermediate: via,
                result,
            } => {
                let first = self.expression(index, &via);
                let then = self.expression(index, &result);
                lines.push(format!("let {} = {first};", intermediate(statement.op)));
                lines.push(format!("let {} = {then};", variable(quantity)));
            }
            Definition::Keep(expr) => lines.extend(self.test(index, &expr)),
            Definition::Exit => lines.extend(exit()),
            Definition::Store => lines.extend(self.hit(index)),
            Definition::Nothing => unreachable!("a program has only statements"),
        }
        lines
    }

    /// The lines of a test.
    fn test(&self, index: usize, expr: &Expr) -> Vec<String> {
        let op = self.op(index);
        let kept = match op {
            Op::Near(program::On::Quotient) if self.view.bounds_below(op) => {
                "less(t_min, t)".to_owned()
            }
            _ if self.view.bounds_below(op) => "less(mul(t_min, v_squared), va_times_v)".to_owned(),
            _ => self.expression(index, expr),
        };
        if !self.view.program.begins_mask(index) {
            return vec![format!("let mask = both(mask, {kept});")];
        }
        match self.culled() {
            None => vec![format!("let mask = {kept};")],
            Some(mut lines) => {
                lines.push(format!("let mask = both(mask, {kept});"));
                lines
            }
        }
    }

    /// The mask of those that see the side of the triangle that is there, if one is not.
    fn culled(&self) -> Option<Vec<String>> {
        let (comment, kept) = match self.view.scene.culling {
            Culling::None => return None,
            Culling::Back => ("// from the front", "less(zeros(), volume_v)"),
            Culling::Front => ("// from the back", "less(volume_v, zeros())"),
        };
        Some(vec![comment.into(), format!("let mask = {kept};")])
    }

    /// What a name does not say: the formula of a volume, the meaning of a test.
    fn comment(&self, statement: &Statement) -> Option<String> {
        let operand =
            |index: usize| self.view.program.quantities()[statement.operands[index] as usize];
        match statement.op {
            Op::Volume(volume, _) => match (operand(0), operand(1)) {
                (Quantity::Cross(cross), Quantity::Vector(dot)) => {
                    Some(format!("// {volume} = {}", TripleProduct { cross, dot }))
                }
                _ => unreachable!("checked programs have fitting operands"),
            },
            op @ Op::Near(_) if self.view.bounds_below(op) => Some("// t > t_min".into()),
            Op::Shear(Shear::Volume(side, difference)) if difference.has_exact_sign() => {
                Some(format!("// {}, its sign exact", side.volume()))
            }
            Op::SameSign(SameSign::Rounded) => {
                Some("// V0, V1, V2 of the same sign, if they are not zero".into())
            }
            Op::DifferenceOfEnds => Some("// V = Va - Vb".into()),
            Op::Ends => Some("// a and b are not on one side of the plane".into()),
            Op::Near(_) => Some("// t > 0".into()),
            Op::Far(_) => Some("// t < t_max".into()),
            Op::Side(side, _) => Some(format!("// {} >= 0", side.barycentric())),
            Op::SameSign(_) => Some("// V0, V1, V2 of the same sign".into()),
            _ => None,
        }
    }

    /// What a kernel of one ray begins with if it renames the axes: `x`, `y` and `z` are then the
    /// numbers of the axes that are called so.
    pub fn renaming(&self) -> String {
        if !self.view.renames_axes() {
            return String::new();
        }
        let components = |of: &str| {
            AXES.map(|axis| format!("packet.{of}{axis}[ray]"))
                .join(", ")
        };
        let (origin, direction) = (components("o"), components("d"));
        let direction = match self.view.scene.range {
            Range::Segment => {
                format!(
                    "let end = [{direction}];\nlet direction = [0, 1, 2].map(|axis| end[axis] - origin[axis]);\n"
                )
            }
            Range::TMax | Range::TMinMax => format!("let direction = [{direction}];\n"),
        };
        format!(
            "let origin = [{origin}];\n\
             {direction}\
             // the ray is longest along z\n\
             let [x, y, z] = axes_along(direction);\n"
        )
    }

    /// The line of a statement that is shorter if the axes are renamed.
    fn with_renamed_axes(&self, index: usize) -> Option<String> {
        let Op::Shear(shear) = self.op(index) else {
            return None;
        };
        if !self.view.renames_axes() {
            return None;
        }
        let statement = &self.view.program.statements()[index];
        let name = variable(self.view.program.quantities()[index]);
        match shear {
            Shear::Row(Axis::Z) => Some(format!("let {name} = div(splat(1.0), d_z);")),
            Shear::Row(axis) => Some(format!("let {name} = sub(zeros(), div(d_{axis}, d_z));")),
            Shear::Coordinate(axis, rounding) => {
                let operand = |number: usize| {
                    let operand = statement.operands[number] as usize;
                    variable(self.view.program.quantities()[operand])
                };
                let (row, edge) = (operand(0), operand(1));
                let value = match (axis, rounding) {
                    (Axis::Z, _) => format!("mul({row}, {edge}_z)"),
                    (_, Rounding::Each) => format!("add({edge}_{axis}, mul({row}, {edge}_z))"),
                    (_, Rounding::Fused) => format!("mul_add({row}, {edge}_z, {edge}_{axis})"),
                };
                Some(format!("let {name} = {value};"))
            }
            _ => None,
        }
    }

    /// The lines that read an input.
    fn input(&self, op: Op) -> Vec<String> {
        let axes = AXES.iter();
        let (grouping, range) = (self.view.scene.grouping, self.view.scene.range);
        let renames = self.view.renames_axes();
        let of_ray = |array: &str| match grouping {
            Grouping::Packet => format!("load(&packet.{array}, row)"),
            Grouping::Single | Grouping::Scalar => format!("splat(packet.{array}[ray])"),
        };
        match op {
            Op::Load(Point::A) => axes
                .map(|axis| {
                    let array = format!("o{axis}");
                    let common = self.view.scene.rates().origin == Rate::Packet;
                    match (grouping, common) {
                        _ if renames => format!("let a_{axis} = splat(origin[{axis}]);"),
                        (Grouping::Packet, true) => {
                            format!("let a_{axis} = splat(packet.{array}[0]);")
                        }
                        _ => format!("let a_{axis} = {};", of_ray(&array)),
                    }
                })
                .collect(),
            Op::Load(Point::B) => axes
                .map(|axis| format!("let b_{axis} = {};", of_ray(&format!("d{axis}"))))
                .collect(),
            Op::Load(point) => (0..3)
                .zip(AXES)
                .map(|(place, axis)| {
                    let value = match renames {
                        true => format!("load(&block.{point}[{axis}], 0)"),
                        false => self.of_triangle(&point.to_string(), place),
                    };
                    format!("let {point}_{axis} = {value};")
                })
                .collect(),
            Op::LoadDirection if renames => axes
                .map(|axis| format!("let d_{axis} = splat(direction[{axis}]);"))
                .collect(),
            Op::LoadDirection => axes
                .map(|axis| {
                    let value = of_ray(&format!("d{axis}"));
                    match range {
                        Range::Segment => format!("let d_{axis} = sub({value}, a_{axis});"),
                        Range::TMax | Range::TMinMax => format!("let d_{axis} = {value};"),
                    }
                })
                .collect(),
            // For one ray it is what the blocks before have left.
            Op::LoadTMax if grouping != Grouping::Packet => Vec::new(),
            Op::LoadTMax => {
                let mut lines = vec![format!("let t_max = {};", self.bound())];
                lines.extend(self.lower_bound());
                lines
            }
            _ => unreachable!("{op} is no input"),
        }
    }

    /// The upper bound of `t` as the caller brings it.
    pub fn bound(&self) -> String {
        let t = match self.view.scene.grouping {
            Grouping::Packet => "load(&packet.t, row)",
            Grouping::Single | Grouping::Scalar => "splat(packet.t[ray])",
        };
        match self.view.scene.range {
            // The second if either is NaN.
            Range::Segment => format!("min(splat(1.0), {t})"),
            Range::TMax | Range::TMinMax => t.to_owned(),
        }
    }

    /// The line that reads the lower bound of `t`, if there is one.
    pub fn lower_bound(&self) -> Option<String> {
        let t_min = match self.view.scene.grouping {
            Grouping::Packet => "load(&packet.t_min, row)",
            Grouping::Single | Grouping::Scalar => "splat(packet.t_min[ray])",
        };
        // The second if either is NaN, and no t is after that.
        let bounded = self.view.scene.range == Range::TMinMax;
        bounded.then(|| format!("let t_min = max(zeros(), {t_min});"))
    }

    /// The lines that read a vector that is stored with the triangle.
    fn stored(&self, name: &str, from: StoredAs) -> Vec<String> {
        let field = match from {
            StoredAs::Edge1 => "edge1",
            StoredAs::Edge2 => "edge2",
            StoredAs::Normal | StoredAs::OppositeNormal => "normal",
        };
        let axes = (0..3).zip(AXES);
        axes.map(|(place, axis)| {
            let value = self.of_triangle(field, place);
            match from {
                StoredAs::OppositeNormal => {
                    format!("let {name}_{axis} = sub(zeros(), {value});")
                }
                _ => format!("let {name}_{axis} = {value};"),
            }
        })
        .collect()
    }

    /// A component of what is stored with the triangle, or of the triangles of a block.
    pub fn of_triangle(&self, field: &str, axis: usize) -> String {
        match self.view.scene.grouping {
            Grouping::Packet => format!("splat(triangle.{field}[{axis}])"),
            Grouping::Single | Grouping::Scalar => format!("load(&block.{field}[{axis}], 0)"),
        }
    }

    /// Whether the kernel must know the place of a triangle, or of a block, in the slice.
    pub fn counts(&self) -> bool {
        let scene = self.view.scene;
        let one_ray = scene.grouping != Grouping::Packet;
        let of_hit = scene.reports(scene::Output::Triangle);
        // Of equally close hits in two lanes it is the first in the slice that counts, and in the
        // fixed regime the last.
        let which =
            scene.query == Query::Closest && (scene.has_hits() || scene.regime == Regime::Fixed);
        of_hit || one_ray && which
    }

    fn expression(&self, index: usize, expr: &Expr) -> String {
        let program = self.view.program;
        let name = |operand| variable(program.quantities()[program.operand(index, operand)]);
        match expr {
            Expr::Operand(operand) => name(*operand),
            Expr::Component(operand, axis) => format!("{}_{}", name(*operand), AXES[*axis]),
            Expr::Intermediate => intermediate(self.op(index)).into(),
            Expr::Unary(op, a) => format!("{}({})", unary(*op), self.expression(index, a)),
            Expr::Binary(op, a, b) => {
                let [a, b] = [a, b].map(|expr| self.expression(index, expr));
                format!("{}({a}, {b})", binary(*op))
            }
            Expr::Select(operands) => {
                let [mask, one, other] =
                    operands.each_ref().map(|expr| self.expression(index, expr));
                format!("select({mask}, {one}, {other})")
            }
            Expr::ExactDifference(operands) => {
                let [a, b, c, d] = operands.each_ref().map(|expr| self.expression(index, expr));
                format!("exact_difference({a}, {b}, {c}, {d})")
            }
            Expr::Ternary(op, operands) => {
                let [a, b, c] = operands.each_ref().map(|expr| self.expression(index, expr));
                format!("{}({a}, {b}, {c})", ternary(*op))
            }
        }
    }
}

/// The lines that leave what no ray hits.
pub(crate) fn exit() -> [String; 3] {
    ["if is_empty(mask) {".into(), "continue;".into(), "}".into()]
}

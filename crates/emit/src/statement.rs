//! Statements as lines of Rust.

use program::{Definition, Expr, Op, Quantity, SameSign, Shear, Statement};
use scene::{Culling, Grouping};
use volumes::{Point, Rate, TripleProduct};

use crate::in_scene::{InScene, StoredAs};
use crate::isa::Isa;
use crate::schedule;
use crate::when::When;
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

    /// Statements with the inputs of the ray that they work on before them.
    pub fn with_inputs(&self, statements: &[usize]) -> Vec<usize> {
        let rates = self.view.program.rates(self.view.scene.rates());
        let of_ray = match self.view.scene.grouping {
            Grouping::Packet => Rate::Ray,
            Grouping::Single | Grouping::Scalar => Rate::Packet,
        };
        let mut all = statements.to_vec();
        let mut next = 0;
        while let Some(&index) = all.get(next) {
            next += 1;
            let operands = self.view.operands(index).into_iter();
            let inputs = operands.filter(|&one| self.is_input(one) && rates[one] == of_ray);
            all.extend(inputs.filter(|one| !statements.contains(one)));
        }
        schedule::in_order(self.view, all.into_iter())
    }

    /// A statement's operation.
    pub fn op(&self, index: usize) -> Op {
        self.view.program.statements()[index].op
    }

    /// The lines of one statement.
    fn statement(&self, index: usize) -> Vec<String> {
        let statement = &self.view.program.statements()[index];
        let quantity = self.view.program.quantities()[index];
        if let Some(from) = self.view.stored_as(index) {
            return self.stored(index, from);
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
            Definition::AllTrue => lines.push("let mask = all_true();".into()),
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
        let expression = || self.expression(index, expr);
        let kept = match op {
            Op::Near(program::On::Quotient) if self.view.bounds_below(op) => {
                "less(t_min, t)".to_owned()
            }
            _ if self.view.bounds_below(op) => {
                let product = "less(mul(t_min, v_squared), va_times_v)".to_owned();
                When::LowerBound.value(self.view, product, expression())
            }
            _ => expression(),
        };
        let begins = self.view.program.begins_mask(index);
        let mut lines = Vec::new();
        if self.view.first_test_of_v() == index {
            lines.extend(self.culled(begins));
        }
        lines.push(match begins && lines.is_empty() {
            true => format!("let mask = {kept};"),
            false => format!("let mask = both(mask, {kept});"),
        });
        lines
    }

    /// The lines that leave of a mask, which begins here or has begun, those that see the side of the triangle
    /// that is there.
    fn culled(&self, begins: bool) -> Vec<String> {
        let kept = |culling| {
            let test = match culling {
                Culling::None if begins => return "all_true()".to_owned(),
                Culling::None => return "mask".to_owned(),
                Culling::Back => "less(zeros(), volume_v)",
                Culling::Front => "less(volume_v, zeros())",
            };
            match begins {
                true => test.to_owned(),
                false => format!("both(mask, {test})"),
            }
        };
        if !self.view.is_open {
            let side = match self.view.scene.culling {
                Culling::None => return Vec::new(),
                Culling::Back => "front",
                Culling::Front => "back",
            };
            let kept = kept(self.view.scene.culling);
            return vec![format!("// from the {side}"), format!("let mask = {kept};")];
        }
        let arm = |&culling| format!("Culling::{culling:?} => {},", kept(culling));
        let arms = Culling::ALL.iter().map(arm);
        let head = "let mask = match S::CULLING {".to_owned();
        [head]
            .into_iter()
            .chain(arms)
            .chain(["};".to_owned()])
            .collect()
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

    /// The lines of a vector that may be stored with the triangle.
    fn stored(&self, index: usize, from: StoredAs) -> Vec<String> {
        let field = match from {
            StoredAs::Edge1 => "edge1",
            StoredAs::Edge2 => "edge2",
            StoredAs::Normal | StoredAs::OppositeNormal => "normal",
        };
        let name = variable(self.view.program.quantities()[index]);
        let definition = self.op(index).definition();
        let axes = (0..3).zip(AXES);
        axes.map(|(place, axis)| {
            let stored = self.of_triangle(field, &place.to_string());
            let stored = match from {
                StoredAs::OppositeNormal => format!("sub(zeros(), {stored})"),
                _ => stored,
            };
            let value = match &definition {
                Definition::Vector(components) => {
                    let computed = self.expression(index, &components[place]);
                    from.when().value(self.view, stored, computed)
                }
                // An edge that is nowhere but there.
                _ => stored,
            };
            format!("let {name}_{axis} = {value};")
        })
        .collect()
    }

    /// A component of a triangle's vertex, which may have to be computed of its edges.
    pub fn vertex(&self, point: Point, axis: &str) -> String {
        let there = self.of_triangle(&point.to_string(), axis);
        let edge = match point {
            Point::P1 => "edge1",
            Point::P2 => "edge2",
            _ => return there,
        };
        let p0 = self.of_triangle("p0", axis);
        let computed = format!("add({p0}, {})", self.of_triangle(edge, axis));
        When::StoredEdges.value(self.view, computed, there)
    }

    /// A component of what is stored with the triangle, or of the triangles of a block.
    pub fn of_triangle(&self, field: &str, axis: &str) -> String {
        let (of_any, row) = match self.view.is_open {
            true => ("()", "row"),
            false => ("", "0"),
        };
        match self.view.scene.grouping {
            Grouping::Packet => format!("splat(triangle.{field}{of_any}[{axis}])"),
            Grouping::Single | Grouping::Scalar => {
                format!("load(&block.{field}{of_any}[{axis}], {row})")
            }
        }
    }

    /// Whether the kernel must know the place of a triangle, or of a block, in the slice.
    pub fn counts(&self) -> bool {
        let one_ray = self.view.scene.grouping != Grouping::Packet;
        let of_hit = self.view.may(When::Reports(scene::Output::Triangle));
        // Of equally close hits in two lanes it is the first in the slice that counts, and in the
        // fixed regime the last.
        let is_closest = self.view.decides(When::AnyHit) != Some(true);
        let which = is_closest && (self.view.may(When::Hits) || self.view.is_fixed());
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

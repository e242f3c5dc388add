//! One program as one Rust function.
//!
//! Every statement is printed in the loop of its rate: once a call, once a triangle, or once for
//! every vector of rays. Within a loop the program's order is kept, but for values that are first
//! used after an exit: see [`Schedule`].

use program::{Binary, Definition, Expr, Op, Program, Quantity, Statement, Ternary, Unary};
use scene::Regime;
use volumes::{Edge, Point, Rate, Rates, TripleProduct, Vector};

use crate::isa::Isa;
use crate::schedule::Schedule;

/// A kernel's source, ready for a [`library`](crate::library()).
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Kernel {
    /// The instruction set whose lanes it uses.
    pub isa: Isa,
    /// The text of its module.
    pub source: String,
    /// The function in it, with generic arguments: what is called to run the kernel.
    pub function: String,
}

/// Prints `program` as the function `name`.
///
/// `rates` says how often the scene's inputs change. In the fixed regime the kernel stores hits
/// in `hit_t` and leaves `t` alone. `docs` stands above the function as it is, so it must be made
/// of nothing that a file says freely.
pub fn print_kernel(
    program: &Program,
    rates: Rates,
    regime: Regime,
    isa: Isa,
    name: &str,
    docs: &str,
) -> Kernel {
    let printer = Printer {
        program,
        rates,
        regime,
        isa,
    };
    let attribute = isa.attribute();
    let schedule = Schedule::new(program, rates);
    let once = printer.statements("    ", &schedule.once);
    let each_triangle = printer.statements("        ", &schedule.each_triangle);
    let each_row: String = (0..)
        .zip(&schedule.parts)
        .map(|(number, part)| printer.part(number, part))
        .collect();
    let source = format!(
        "use super::lanes::*;\n\
         use crate::{{Packet, Triangle}};\n\
         \n\
         {docs}\
         {attribute}\
         pub fn {name}<const N: usize>(packet: &mut Packet<N>, triangles: &[Triangle]) {{\n    \
             const {{ assert!(N > 0 && N.is_multiple_of(LANES), \"whole vectors of rays\") }};\n\
         {once}    \
             for triangle in triangles {{\n\
         {each_triangle}        \
                 for row in 0..N / LANES {{\n\
         {each_row}        \
                 }}\n    \
             }}\n\
         }}\n"
    );
    Kernel {
        isa,
        source,
        function: format!("{name}::<{}>", scene::PACKET_SIZE),
    }
}

struct Printer<'a> {
    program: &'a Program,
    rates: Rates,
    regime: Regime,
    isa: Isa,
}

impl Printer<'_> {
    /// Statements in their order.
    fn statements(&self, indent: &str, statements: &[usize]) -> String {
        let lines = statements.iter().flat_map(|&index| self.statement(index));
        lines.map(|line| format!("{indent}{line}\n")).collect()
    }

    /// A part of the loop over rays.
    fn part(&self, number: usize, part: &[usize]) -> String {
        let indent = "            ";
        let op = |index: &usize| self.program.statements()[*index].op;
        let loads = part.iter().map(op).any(Op::is_input);
        let again = format!("{indent}let packet = afresh(packet);\n");
        let again = match number > 0 && loads && self.isa.overwrites() {
            true => &again,
            false => "",
        };
        format!("{again}{}", self.statements(indent, part))
    }

    /// The lines of one statement.
    fn statement(&self, index: usize) -> Vec<String> {
        let statement = &self.program.statements()[index];
        let quantity = self.program.quantities()[index];
        let mut lines: Vec<String> = self.comment(statement).into_iter().collect();
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
                intermediate,
                result,
            } => {
                let first = self.expression(index, &intermediate);
                let then = self.expression(index, &result);
                lines.push(format!("let {INTERMEDIATE} = {first};"));
                lines.push(format!("let {} = {then};", variable(quantity)));
            }
            Definition::Keep(expr) => {
                let kept = self.expression(index, &expr);
                let mask = match self.program.begins_mask(index) {
                    true => kept,
                    false => format!("both(mask, {kept})"),
                };
                lines.push(format!("let mask = {mask};"));
            }
            Definition::Exit => {
                lines.push("if is_empty(mask) {".into());
                lines.push("    continue;".into());
                lines.push("}".into());
            }
            Definition::Store => match self.regime {
                Regime::Shrinking | Regime::Leaf => {
                    lines.push("store(&mut packet.t, row, select(mask, t, t_max));".into());
                }
                Regime::Fixed => {
                    lines.push("let hit_t = load(&packet.hit_t, row);".into());
                    lines.push("store(&mut packet.hit_t, row, select(mask, t, hit_t));".into());
                }
            },
            Definition::Nothing => unreachable!("a program has only statements"),
        }
        lines
    }

    /// What a name does not say: the formula of a volume, the meaning of a test.
    fn comment(&self, statement: &Statement) -> Option<String> {
        let operand = |index: usize| self.program.quantities()[statement.operands[index] as usize];
        match statement.op {
            Op::Volume(volume, _) => match (operand(0), operand(1)) {
                (Quantity::Cross(cross), Quantity::Vector(dot)) => {
                    Some(format!("// {volume} = {}", TripleProduct { cross, dot }))
                }
                _ => unreachable!("checked programs have fitting operands"),
            },
            Op::Near(_) => Some("// t > 0".into()),
            Op::Far(_) => Some("// t < t_max".into()),
            Op::Side(side, _) => Some(format!("// {} >= 0", side.barycentric())),
            Op::SameSign(_) => Some("// V0, V1, V2 of the same sign".into()),
            _ => None,
        }
    }

    fn input(&self, op: Op) -> Vec<String> {
        let axes = AXES.iter();
        match op {
            Op::Load(Point::A) if self.rates.origin == Rate::Packet => axes
                .map(|axis| format!("let a_{axis} = splat(packet.o{axis}[0]);"))
                .collect(),
            Op::Load(Point::A) => axes
                .map(|axis| format!("let a_{axis} = load(&packet.o{axis}, row);"))
                .collect(),
            Op::Load(point) => axes
                .enumerate()
                .map(|(index, axis)| {
                    format!("let {point}_{axis} = splat(triangle.{point}[{index}]);")
                })
                .collect(),
            Op::LoadEdge(stored) => {
                let Edge { to, from } = stored.edge();
                axes.enumerate()
                    .map(|(index, axis)| {
                        format!(
                            "let edge_{to}_{from}_{axis} = splat(triangle.{to}_{from}[{index}]);"
                        )
                    })
                    .collect()
            }
            Op::LoadDirection => axes
                .map(|axis| format!("let d_{axis} = load(&packet.d{axis}, row);"))
                .collect(),
            Op::LoadTMax => vec!["let t_max = load(&packet.t, row);".into()],
            _ => unreachable!("{op} is no input"),
        }
    }

    fn expression(&self, index: usize, expr: &Expr) -> String {
        let name =
            |operand| variable(self.program.quantities()[self.program.operand(index, operand)]);
        match expr {
            Expr::Operand(operand) => name(*operand),
            Expr::Component(operand, axis) => format!("{}_{}", name(*operand), AXES[*axis]),
            Expr::Intermediate => INTERMEDIATE.into(),
            Expr::Unary(op, a) => format!("{}({})", unary(*op), self.expression(index, a)),
            Expr::Binary(op, a, b) => {
                let [a, b] = [a, b].map(|expr| self.expression(index, expr));
                format!("{}({a}, {b})", binary(*op))
            }
            Expr::Ternary(op, operands) => {
                let [a, b, c] = operands.each_ref().map(|expr| self.expression(index, expr));
                format!("{}({a}, {b}, {c})", ternary(*op))
            }
        }
    }
}

/// The word for an operation of one number.
fn unary(op: Unary) -> &'static str {
    match op {
        Unary::Estimate => "estimate_reciprocal",
        Unary::SignIsClear => "sign_is_clear",
    }
}

/// The word for an operation of two.
fn binary(op: Binary) -> &'static str {
    match op {
        Binary::Add => "add",
        Binary::Sub => "sub",
        Binary::Mul => "mul",
        Binary::Div => "div",
        Binary::Min => "min",
        Binary::Max => "max",
        Binary::Less => "less",
        Binary::AtMost => "at_most",
        Binary::Either => "either",
        Binary::BitOr => "bit_or",
        Binary::BitXor => "bit_xor",
    }
}

/// The word for an operation of three.
fn ternary(op: Ternary) -> &'static str {
    match op {
        Ternary::MulAdd => "mul_add",
        Ternary::MulSub => "mul_sub",
        Ternary::NegMulAdd => "neg_mul_add",
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// The only intermediate value that any definition has is the reciprocal's estimate.
const INTERMEDIATE: &str = "estimate";

/// The variable that holds a quantity; vectors have a component's letter behind it.
fn variable(quantity: Quantity) -> String {
    let vector = |vector: Vector| match vector {
        Vector::Edge(edge) => format!("{}_{}", edge.to, edge.from),
        Vector::Direction => "d".into(),
    };
    match quantity {
        Quantity::Point(point) => point.to_string(),
        Quantity::Vector(Vector::Direction) => "d".into(),
        Quantity::Vector(edge) => format!("edge_{}", vector(edge)),
        Quantity::Cross(cross) => {
            format!("cross_{}_by_{}", vector(cross.left), vector(cross.right))
        }
        Quantity::Volume(volume) => format!("volume_{}", volume.name()),
        Quantity::PairSum(side) => {
            let [j, k] = side.others().map(|other| other.volume().name());
            format!("volumes_{j}_{k}")
        }
        Quantity::SquareOfV => "v_squared".into(),
        Quantity::ProductVaV => "va_times_v".into(),
        Quantity::ReciprocalOfV => "reciprocal".into(),
        Quantity::T => "t".into(),
        Quantity::Barycentric(side) => side.barycentric().into(),
        Quantity::TMax => "t_max".into(),
        Quantity::Zero => "zero".into(),
        Quantity::One => "one".into(),
        Quantity::Mask | Quantity::Tested(_) => "mask".into(),
        Quantity::Stored => unreachable!("nothing reads a store"),
    }
}

//! What a kernel reads of its rays: origins, directions and the bounds of `t`, and of triangles their vertices.

use program::{Axis, Op, Rounding, Shear};
use scene::{Grouping, Range};
use volumes::{Point, Rate};

use crate::statement::Printer;
use crate::when::When;
use crate::words::{AXES, variable};

impl Printer<'_> {
    /// What a kernel of one ray begins with if it renames the axes: `x`, `y` and `z` are then the
    /// numbers of the axes that are called so.
    pub fn renaming(&self) -> String {
        if !self.view.renames_axes() {
            return String::new();
        }
        let components = |of: char| {
            AXES.map(|axis| format!("read(&{})", self.component(of, axis)))
                .join(", ")
        };
        let (origin, direction) = (components('o'), components('d'));
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
    pub fn with_renamed_axes(&self, index: usize) -> Option<String> {
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
    pub fn input(&self, op: Op) -> Vec<String> {
        let axes = AXES.iter();
        let (grouping, range) = (self.view.scene.grouping, self.view.scene.range);
        let renames = self.view.renames_axes();
        let of_ray = |of: char, axis: &str| match grouping {
            Grouping::Packet => format!("load(&packet.{of}{axis}, row)"),
            Grouping::Single | Grouping::Scalar => {
                format!("splat(read(&{}))", self.component(of, axis))
            }
        };
        match op {
            Op::Load(Point::A) => axes
                .map(|axis| {
                    let common = self.view.scene.rates().origin == Rate::Packet;
                    match (grouping, common) {
                        _ if renames => format!("let a_{axis} = splat(origin[{axis}]);"),
                        (Grouping::Packet, true) => {
                            format!("let a_{axis} = splat(packet.o{axis}[0]);")
                        }
                        _ => format!("let a_{axis} = {};", of_ray('o', axis)),
                    }
                })
                .collect(),
            Op::Load(Point::B) => axes
                .map(|axis| format!("let b_{axis} = {};", of_ray('d', axis)))
                .collect(),
            Op::Load(point) => (0..3)
                .zip(AXES)
                .map(|(place, axis)| {
                    let place = match renames {
                        true => axis.to_string(),
                        false => place.to_string(),
                    };
                    format!("let {point}_{axis} = {};", self.vertex(point, &place))
                })
                .collect(),
            Op::LoadDirection if renames => axes
                .map(|axis| format!("let d_{axis} = splat(direction[{axis}]);"))
                .collect(),
            Op::LoadDirection => axes
                .map(|axis| {
                    let value = of_ray('d', axis);
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

    /// Whether the kernel takes a ray by itself, and gives its `t`: in the package. A candidate is told which ray of
    /// a packet, so that all groupings are timed on the same workload.
    pub fn takes_one_ray(&self) -> bool {
        self.view.is_open && self.view.scene.grouping != Grouping::Packet
    }

    /// A component of the one ray's origin, `o`, or direction, `d`.
    fn component(&self, of: char, axis: &str) -> String {
        match self.takes_one_ray() {
            true => {
                let field = if of == 'o' { "origin" } else { "direction" };
                let place = AXES.iter().position(|&one| one == axis);
                format!("ray.{field}[{}]", place.expect("one of three axes"))
            }
            false => format!("packet.{of}{axis}[ray]"),
        }
    }

    /// The upper bound of `t` as the caller brings it.
    pub fn bound(&self) -> String {
        let t = match self.view.scene.grouping {
            Grouping::Packet => "load(&packet.t, row)",
            Grouping::Single | Grouping::Scalar if self.takes_one_ray() => "splat(read(&ray.t))",
            Grouping::Single | Grouping::Scalar => "splat(read(&packet.t[ray]))",
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
            Grouping::Single | Grouping::Scalar if self.takes_one_ray() => {
                "splat(read(&ray.t_min))"
            }
            Grouping::Single | Grouping::Scalar => "splat(read(&packet.t_min[ray]))",
        };
        // The second if either is NaN, and no t is after that.
        let bound = format!("max(zeros(), {t_min})");
        let bound = When::LowerBound.value(self.view, bound, "zeros()".into());
        let bounded = self.view.may(When::LowerBound);
        bounded.then(|| format!("let t_min = {bound};"))
    }
}

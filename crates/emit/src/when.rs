//! What a kernel has only under some condition, and whether the condition is known where it is printed.
//!
//! A candidate is printed for one scene, which decides every condition: what does not hold leaves no trace. A
//! kernel of the package is printed for any: each condition becomes one of constants, which the compiler decides for
//! whoever calls the kernel.

use scene::{Output, Query, Range, Stored};

use crate::in_scene::InScene;

/// A condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum When {
    /// It is asked whether there is any hit, not for the closest.
    AnyHit,
    /// More is reported of a hit than `t`.
    Hits,
    /// This is reported.
    Reports(Output),
    /// There is a lower bound of `t`.
    LowerBound,
    /// A triangle's edges are stored, and not its second and third vertex.
    StoredEdges,
    /// Its normal is stored.
    StoredNormal,
}

impl When {
    /// The condition, of what a kernel of the package is generic over.
    fn in_package(self) -> &'static str {
        match self {
            When::AnyHit => "ANY",
            When::Hits => "M > 0",
            When::Reports(Output::T) => "true",
            When::Reports(Output::Uv) => "S::UV",
            When::Reports(Output::Triangle) => "S::TRIANGLE",
            When::Reports(Output::Normal) => "S::NORMAL",
            When::Reports(Output::Point) => "S::POINT",
            When::LowerBound => "S::T_MIN",
            When::StoredEdges => "T::EDGES",
            When::StoredNormal => "T::NORMAL",
        }
    }

    /// One of two values.
    pub fn value(self, view: InScene<'_>, then: String, otherwise: String) -> String {
        match view.decides(self) {
            Some(true) => then,
            Some(false) => otherwise,
            None => format!(
                "if {} {{ {then} }} else {{ {otherwise} }}",
                self.in_package()
            ),
        }
    }

    /// These lines or those.
    pub fn lines(
        self,
        view: InScene<'_>,
        then: Vec<String>,
        otherwise: Vec<String>,
    ) -> Vec<String> {
        let condition = self.in_package();
        match view.decides(self) {
            Some(true) => then,
            Some(false) => otherwise,
            None if then.is_empty() => block(format!("if !({condition}) {{"), otherwise),
            None if otherwise.is_empty() => block(format!("if {condition} {{"), then),
            None => {
                let mut lines = block(format!("if {condition} {{"), then);
                lines.pop();
                lines.extend(block("} else {".into(), otherwise));
                lines
            }
        }
    }

    /// These lines or none.
    pub fn only(self, view: InScene<'_>, then: Vec<String>) -> Vec<String> {
        self.lines(view, then, Vec::new())
    }
}

/// Lines in braces.
fn block(head: String, lines: Vec<String>) -> Vec<String> {
    let mut block = vec![head];
    block.extend(lines);
    block.push("}".into());
    block
}

impl InScene<'_> {
    /// Whether a condition holds, if that is known.
    pub fn decides(self, when: When) -> Option<bool> {
        let scene = self.scene;
        (!self.is_open).then(|| match when {
            When::AnyHit => scene.query == Query::Any,
            When::Hits => scene.has_hits(),
            When::Reports(output) => scene.reports(output),
            When::LowerBound => scene.range == Range::TMinMax,
            When::StoredEdges => matches!(scene.stored, Stored::Edges | Stored::EdgesAndNormal),
            When::StoredNormal => {
                matches!(
                    scene.stored,
                    Stored::VerticesAndNormal | Stored::EdgesAndNormal
                )
            }
        })
    }

    /// Whether it may hold.
    pub fn may(self, when: When) -> bool {
        self.decides(when) != Some(false)
    }
}

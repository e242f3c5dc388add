//! The check that goes with a kernel of a scene that has bounds.

use scene::bounds::{BoundsCheck, Towards};
use scene::{Grouping, Origin, Stored};

use crate::statement::Printer;

impl Printer<'_> {
    /// The function that refuses rays and triangles which are out of the bounds that the kernel `name`
    /// was made for; nothing for scenes without bounds.
    pub fn check(&self, name: &str) -> String {
        let scene = self.view.scene;
        let Some(BoundsCheck {
            coordinates,
            edge,
            towards,
        }) = scene.bounds_check()
        else {
            return String::new();
        };
        let towards = match towards {
            Towards::Direction => "Direction",
            Towards::UnitDirection => "UnitDirection",
            Towards::End => "End",
        };
        let type_name = scene.stored.type_name();
        let (parameters, rays) = match (scene.grouping, scene.origin) {
            (Grouping::Packet, Origin::General) => (
                format!("packet: &Packet<N>, triangles: &[{type_name}]"),
                "for ray in (0..N).filter(|&ray| is_active(packet, ray)) {\n\
                 bounds.origin(packet, ray)?;\n\
                 bounds.direction(packet, ray)?;\n\
                 }\n",
            ),
            (Grouping::Packet, Origin::Common) => (
                format!("packet: &Packet<N>, triangles: &[{type_name}]"),
                "bounds.origin(packet, 0)?;\n\
                 for ray in 0..N {\n\
                 bounds.direction(packet, ray)?;\n\
                 }\n",
            ),
            (Grouping::Single | Grouping::Scalar, _) => (
                format!("packet: &Packet<N>, ray: usize, blocks: &[{type_name}<[f32; LANES]>]"),
                "bounds.origin(packet, ray)?;\n\
                 bounds.direction(packet, ray)?;\n",
            ),
        };
        let (function, fields) = match scene.stored {
            Stored::Vertices | Stored::VerticesAndNormal => ("vertices", ["p0", "p1", "p2"]),
            Stored::Edges | Stored::EdgesAndNormal => ("edges", ["p0", "edge1", "edge2"]),
        };
        let vectors = |of: &str| fields.map(|field| format!("{of}.{field}")).join(", ");
        let triangles = match scene.grouping {
            Grouping::Packet => format!(
                "for (number, triangle) in triangles.iter().enumerate() {{\n\
                 bounds.{function}(number, [{}])?;\n\
                 }}\n",
                vectors("triangle")
            ),
            Grouping::Single | Grouping::Scalar => format!(
                "for (number, block) in blocks.iter().enumerate() {{\n\
                 for lane in 0..LANES {{\n\
                 let vectors = [{}].map(|vector| vector.map(|axis| axis[lane]));\n\
                 bounds.{function}(number * LANES + lane, vectors)?;\n\
                 }}\n\
                 }}\n",
                vectors("block")
            ),
        };
        format!(
            "\n\
             /// Checks that rays and triangles keep to the bounds that [`{name}`] was made for.\n\
             ///\n\
             /// # Errors\n\
             ///\n\
             /// What is out of bounds first.\n\
             pub fn check_{name}<const N: usize>({parameters}) -> Result<(), OutOfBounds> {{\n\
             let bounds = BoundsCheck {{ coordinates: {coordinates:?}, edge: {edge:?}, towards: \
             Towards::{towards} }};\n\
             {rays}\
             {triangles}\
             Ok(())\n\
             }}\n"
        )
    }
}

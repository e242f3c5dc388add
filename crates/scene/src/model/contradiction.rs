//! Models that no kernel can follow.

use super::{Culling, Grouping, Origin, Output, Query, Regime, SceneModel, Stored, Watertight};

/// What a scene model asks for and cannot have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Contradiction {
    /// One ray with a common origin.
    #[error(
        "a common origin is shared by the rays of a packet, and there is only one ray: leave the \
         origin general, or take the grouping packet"
    )]
    OriginOfOneRay,
    /// A query that reports nothing, with outputs.
    #[error(
        "a query for any hit reports no hit: leave the outputs empty, or ask for the closest one"
    )]
    OutputsOfAny,
    /// A query that is over with the first hit, and goes on.
    #[error(
        "a query for any hit is over with the first one, and in the regime fixed a ray goes on after \
         it: take the regime leaf or shrinking"
    )]
    FixedAny,
    /// An output twice.
    #[error("the output {0} is named twice")]
    OutputTwice(Output),
    /// Edge functions of vertices that are not stored.
    #[error(
        "what is watertight compares vertices as the ray sees them, so they must be stored: take \
         vertices instead of {0}"
    )]
    WatertightWithoutVertices(Stored),
    /// Bounds that hold no triangle.
    #[error(
        "within the bounds no triangle has such an edge: give a smaller edge, or greater coordinates"
    )]
    EmptyBounds,
    /// Bounds that `f32` cannot serve.
    #[error(
        "the smallest edge is less than what f32 tells apart at these coordinates: give a greater edge, or \
         smaller coordinates"
    )]
    BoundsBelowRounding,
    /// Segments with directions of a known length.
    #[error(
        "a segment has another end and no direction: leave the length of directions any, or take another range"
    )]
    UnitSegment,
    /// Bounds in which f32 overflows.
    #[error(
        "within the bounds volumes may be greater than the greatest f32: give smaller coordinates"
    )]
    InfiniteVolumes,
    /// A normal that nothing needs.
    #[error(
        "a fully watertight kernel has no use for a triangle's normal: store vertices instead of {0}"
    )]
    NormalUnused(Stored),
}

impl SceneModel {
    /// Whether some kernel can be what the model asks for.
    ///
    /// # Errors
    ///
    /// [`Contradiction`] says what cannot be had together.
    pub fn check(&self) -> Result<(), Contradiction> {
        if self.grouping != Grouping::Packet && self.origin == Origin::Common {
            return Err(Contradiction::OriginOfOneRay);
        }
        if self.query == Query::Any && !self.outputs.is_empty() {
            return Err(Contradiction::OutputsOfAny);
        }
        if self.query == Query::Any && self.regime == Regime::Fixed {
            return Err(Contradiction::FixedAny);
        }
        self.check_bounds()?;
        let twice = |&(place, output): &(usize, &Output)| self.outputs[..place].contains(output);
        if let Some((_, &output)) = self.outputs.iter().enumerate().find(twice) {
            return Err(Contradiction::OutputTwice(output));
        }
        match (self.watertight, self.stored) {
            (Watertight::None, _) | (_, Stored::Vertices) => Ok(()),
            (Watertight::Edges, Stored::VerticesAndNormal) => Ok(()),
            (Watertight::Full, stored @ Stored::VerticesAndNormal)
                if !self.reports(Output::Normal) =>
            {
                Err(Contradiction::NormalUnused(stored))
            }
            (Watertight::Full, Stored::VerticesAndNormal) => Ok(()),
            (_, stored) => Err(Contradiction::WatertightWithoutVertices(stored)),
        }
    }
}

impl Culling {
    /// Whether a ray goes through from this side: `facing` is the sign of what the ray's direction
    /// has of the normal `(p1-p0) × (p2-p0)`, negative from the front.
    pub fn lets_through(self, facing: f64) -> bool {
        match self {
            Culling::None => false,
            Culling::Back => facing > 0.0,
            Culling::Front => facing < 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Range;

    fn model() -> SceneModel {
        SceneModel::preset("packet").unwrap()
    }

    #[test]
    fn what_cannot_be_had_together_is_said() {
        let mut one_ray = model();
        one_ray.grouping = Grouping::Single;
        one_ray.origin = Origin::Common;
        assert_eq!(one_ray.check(), Err(Contradiction::OriginOfOneRay));

        let mut any = model();
        any.query = Query::Any;
        assert_eq!(any.check(), Ok(()));
        any.outputs = vec![Output::Uv];
        assert_eq!(any.check(), Err(Contradiction::OutputsOfAny));

        any.outputs = vec![];
        any.regime = Regime::Fixed;
        assert_eq!(any.check(), Err(Contradiction::FixedAny));

        let mut twice = model();
        twice.outputs = vec![Output::Uv, Output::Normal, Output::Uv];
        assert_eq!(twice.check(), Err(Contradiction::OutputTwice(Output::Uv)));

        for watertight in [Watertight::Edges, Watertight::Full] {
            for &stored in Stored::ALL {
                let mut scene = model();
                (scene.watertight, scene.stored) = (watertight, stored);
                let sound = stored == Stored::Vertices
                    || watertight == Watertight::Edges && stored == Stored::VerticesAndNormal;
                assert_eq!(scene.check().is_ok(), sound, "{watertight}, {stored}");
            }
        }
    }

    #[test]
    fn bounds_that_hold_nothing_are_refused() {
        let bounded = |bounds: &str| {
            let mut scene = model();
            scene.bounds = Some(bounds.parse().unwrap());
            scene
        };
        for (bounds, expected) in [
            ("coordinates=1,edge=3.4", Ok(())),
            ("coordinates=1,edge=3.5", Err(Contradiction::EmptyBounds)),
            ("coordinates=1000,edge=0.001", Ok(())),
            (
                "coordinates=1e6,edge=0.1",
                Err(Contradiction::BoundsBelowRounding),
            ),
            ("coordinates=1e18,edge=1e14,directions=unit", Ok(())),
            (
                "coordinates=1e19,edge=1e14,directions=unit",
                Err(Contradiction::InfiniteVolumes),
            ),
            ("coordinates=1e19,edge=1e14,directions=any", Ok(())),
        ] {
            assert_eq!(bounded(bounds).check(), expected, "{bounds}");
        }
        let mut segment = bounded("coordinates=1,edge=0.1,directions=unit");
        assert_eq!(segment.check(), Ok(()));
        segment.range = Range::Segment;
        assert_eq!(segment.check(), Err(Contradiction::UnitSegment));
    }

    #[test]
    fn every_other_field_goes_with_every_other() {
        for &range in Range::ALL {
            for &culling in Culling::ALL {
                for &query in Query::ALL {
                    for &grouping in Grouping::ALL {
                        let scene = SceneModel {
                            range,
                            culling,
                            query,
                            grouping,
                            ..model()
                        };
                        assert_eq!(scene.check(), Ok(()));
                    }
                }
            }
        }
    }
}

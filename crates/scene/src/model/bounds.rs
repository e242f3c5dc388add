//! The bounds of a scene, and what they prove.
//!
//! Without bounds a kernel is for ordinary scenes: it misses where a volume is infinite, and where a
//! square of one is zero or infinite it may be wrong. Within bounds it is neither, and tests that only
//! guard against infinite volumes are left out.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::{Contradiction, Directions, Range, SceneModel, UnknownWord};
use crate::bounds::{BoundsCheck, Towards};

/// What all rays and triangles of a scene keep to. The check that is emitted with a kernel refuses
/// others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bounds {
    /// No coordinate of a vertex, of an origin or of the other end of a segment is greater in magnitude.
    pub coordinates: Length,
    /// No side of a triangle is shorter.
    pub edge: Length,
    /// How long directions are.
    #[serde(default)]
    pub directions: Directions,
}

/// A length: finite and positive.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(try_from = "f32", into = "f32")]
pub struct Length(f32);

/// A number that is no length.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{0} is no length; give a positive number")]
pub struct NoLength(f32);

impl TryFrom<f32> for Length {
    type Error = NoLength;

    fn try_from(number: f32) -> Result<Length, NoLength> {
        let is_length = number.is_finite() && number > 0.0;
        is_length.then_some(Length(number)).ok_or(NoLength(number))
    }
}

impl From<Length> for f32 {
    fn from(length: Length) -> f32 {
        length.0
    }
}

impl Eq for Length {}

impl Hash for Length {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.to_bits().hash(state);
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Bounds {
            coordinates,
            edge,
            directions,
        } = self;
        write!(
            f,
            "coordinates={coordinates},edge={edge},directions={directions}"
        )
    }
}

/// Text that is no bounds.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoBounds {
    /// A part that is none.
    #[error(
        "{0:?} is no part of bounds; give coordinates=LENGTH,edge=LENGTH and perhaps directions=unit"
    )]
    Part(String),
    /// A part that is missing.
    #[error("bounds without {0}; give coordinates=LENGTH,edge=LENGTH and perhaps directions=unit")]
    Missing(&'static str),
    /// A word that is none.
    #[error(transparent)]
    Word(#[from] UnknownWord),
}

impl FromStr for Bounds {
    type Err = NoBounds;

    /// Reads what is displayed.
    fn from_str(text: &str) -> Result<Bounds, NoBounds> {
        let (mut coordinates, mut edge, mut directions) = (None, None, Directions::default());
        for part in text.split(',') {
            let unknown = || NoBounds::Part(part.chars().take(40).collect());
            let (name, value) = part.split_once('=').ok_or_else(unknown)?;
            let length = || {
                value
                    .parse::<f32>()
                    .ok()
                    .and_then(|number| Length::try_from(number).ok())
            };
            match name {
                "coordinates" => coordinates = Some(length().ok_or_else(unknown)?),
                "edge" => edge = Some(length().ok_or_else(unknown)?),
                "directions" => directions = value.parse()?,
                _ => return Err(unknown()),
            }
        }
        Ok(Bounds {
            coordinates: coordinates.ok_or(NoBounds::Missing("coordinates"))?,
            edge: edge.ok_or(NoBounds::Missing("edge"))?,
            directions,
        })
    }
}

/// Half of the range of `f32`, as exponents go: the square of what is between `1 / LEAST_SQUARED` and
/// this is neither zero nor infinite.
const MOST_SQUARED: f64 = (1u64 << 63) as f64;

/// Rounding leaves of a volume that is zero about this part of its terms.
const ROUNDING: f64 = 1.0 / (1 << 24) as f64;

/// What can be said of the volumes of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VolumeBounds {
    /// None is infinite.
    pub are_finite: bool,
    /// The square of none is infinite, and none has a square of zero but those that are nothing but
    /// rounding error. None if that is not known.
    pub have_squares: Option<bool>,
}

impl VolumeBounds {
    /// Of scenes of which nothing is known.
    pub const UNKNOWN: VolumeBounds = VolumeBounds {
        are_finite: false,
        have_squares: None,
    };
}

impl SceneModel {
    /// What the bounds prove of the scene's volumes.
    ///
    /// With coordinates up to `M` an edge has components up to `2M`, a cross of two edges up to `8M²`.
    /// With a direction of components up to `D`, which is 1 or for segments `2M`, a volume of the
    /// direction is at most `24M²D`, three of them together `72M²D`, and what the ends of a segment have
    /// between them `96M³`; volumes of sheared vertices, whose coordinates are up to `4M`, are at most
    /// `96M²` together. So none is greater than `100M²D`, whichever way it is written, rounding included.
    ///
    /// Volumes have no least magnitude, since a ray may be parallel to a triangle. But what is smaller
    /// than the rounding error of its own terms says nothing, and these are at least about `e²` for a
    /// direction of length 1, with sides of at least `e`.
    pub fn volume_bounds(&self) -> VolumeBounds {
        let Some(bounds) = self.bounds else {
            return VolumeBounds::UNKNOWN;
        };
        let [coordinates, edge] =
            [bounds.coordinates, bounds.edge].map(|length| f64::from(length.0));
        let direction = match (self.range, bounds.directions) {
            (Range::Segment, _) => 2.0 * coordinates,
            (_, Directions::Unit) => 1.0,
            (_, Directions::Any) => return VolumeBounds::UNKNOWN,
        };
        let greatest = 100.0 * coordinates * coordinates * direction.max(1.0);
        let survive = edge * edge * ROUNDING >= 1.0 / MOST_SQUARED;
        VolumeBounds {
            are_finite: greatest < f64::from(f32::MAX),
            have_squares: Some(
                greatest < MOST_SQUARED && (survive || self.range == Range::Segment),
            ),
        }
    }

    /// The check that goes with a kernel, if the scene has bounds.
    pub fn bounds_check(&self) -> Option<BoundsCheck> {
        let bounds = self.bounds?;
        Some(BoundsCheck {
            coordinates: bounds.coordinates.0,
            edge: bounds.edge.0,
            towards: match (self.range, bounds.directions) {
                (Range::Segment, _) => Towards::End,
                (_, Directions::Unit) => Towards::UnitDirection,
                (_, Directions::Any) => Towards::Direction,
            },
        })
    }

    /// Whether the bounds hold any scene that `f32` can tell anything about.
    pub(super) fn check_bounds(&self) -> Result<(), Contradiction> {
        let Some(bounds) = self.bounds else {
            return Ok(());
        };
        let Bounds {
            coordinates: Length(coordinates),
            edge: Length(edge),
            directions,
        } = bounds;
        let (coordinates, edge) = (f64::from(coordinates), f64::from(edge));
        if edge > 12f64.sqrt() * coordinates {
            return Err(Contradiction::EmptyBounds);
        }
        if edge < 4.0 * ROUNDING * coordinates {
            return Err(Contradiction::BoundsBelowRounding);
        }
        if self.range == Range::Segment && directions == Directions::Unit {
            return Err(Contradiction::UnitSegment);
        }
        let volumes = self.volume_bounds();
        if volumes != VolumeBounds::UNKNOWN && !volumes.are_finite {
            return Err(Contradiction::InfiniteVolumes);
        }
        Ok(())
    }
}

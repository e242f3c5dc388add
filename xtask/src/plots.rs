//! What plots that are drawn by `plotters` have in common.

use plotters::style::RGBColor;

/// Colours that people with any kind of sight tell apart, after Okabe and Ito.
pub const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 0, 0),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(204, 121, 167),
];

/// A plot that cannot be drawn.
pub fn undrawn(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow::anyhow!("cannot draw the plot: {error}")
}

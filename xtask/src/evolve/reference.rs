//! The reference before a search: in fresh processes, and against itself.

use measure::{Calibrated, MeasureError};

use super::course::Course;
use crate::benches::Benches;
use crate::progress::{say, with_spinner};

/// An uncertainty of the reference against itself that is worth a warning.
const NOISY: f64 = 0.03;

/// Times the reference in fresh processes, and says how fast it is in each.
pub fn calibrate(bench: &mut Benches, cores: usize) -> Result<Calibrated, MeasureError> {
    let calibrated = with_spinner("timing the reference in fresh processes", || {
        bench.calibrate(&Course::rounds(), cores)
    })?;
    let speeds = calibrated.speeds.iter().map(|speed| format!("{speed:.0}"));
    let worst = match calibrated.sweep.is_sound() {
        true => format!(
            "; in its worst memory layout {:.2} times as slow as in most",
            calibrated.sweep.worst()
        ),
        false => String::new(),
    };
    say(&format!(
        "reference  {} M tests/s in {} fresh processes{worst}",
        speeds.collect::<Vec<_>>().join(", "),
        calibrated.speeds.len(),
    ));
    Ok(calibrated)
}

/// Relative uncertainty of an evaluation, from the reference against a copy of itself.
pub fn noise(bench: &mut Benches, cores: usize) -> Result<f64, MeasureError> {
    let verdicts = with_spinner("timing the reference against itself", || {
        bench.measure(&[], &Course::noise_plan(cores))
    })?;
    let summary = verdicts.first().and_then(|verdict| verdict.summary());
    let floor = summary.map_or(0.0, |summary| summary.uncertainty);
    say(&format!(
        "noise      a copy of the reference times at 1.00 ±{:.1}%, on {cores} core{} at once",
        floor * 100.0,
        if cores == 1 { "" } else { "s" }
    ));
    if floor > NOISY {
        say("noise      that is much: something else is running, and close ratios will be luck");
    }
    Ok(floor)
}

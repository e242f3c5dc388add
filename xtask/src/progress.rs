//! What a user sees of things that take a while, on standard error.

use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

/// A bar for so many steps, with the time that is left. Where there is no terminal to draw it on, `what` is said once.
pub fn bar(steps: usize, what: &str) -> ProgressBar {
    let bar = ProgressBar::new(steps as u64);
    let style = "{bar:24} {msg}, {elapsed} so far, ETA {eta}";
    bar.set_style(ProgressStyle::with_template(style).expect("a fixed template"));
    if bar.is_hidden() {
        eprintln!("{what}");
    }
    bar.set_message(what.to_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// Says on standard error that something takes a while, for as long as `work` runs.
pub fn with_spinner<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let spinner = ProgressBar::new_spinner();
    if spinner.is_hidden() {
        eprintln!("{what}");
    }
    spinner.set_style(
        ProgressStyle::with_template("{spinner} {msg} ({elapsed})").expect("a fixed template"),
    );
    spinner.set_message(what.to_owned());
    spinner.enable_steady_tick(Duration::from_millis(100));
    let done = work();
    spinner.finish_and_clear();
    done
}

/// Tells the user something beside the result.
pub fn say(line: &str) {
    eprintln!("{line}");
}

/// A duration as `2m10s`.
pub fn short(duration: Duration) -> String {
    let seconds = duration.as_secs_f64().round() as u64;
    match (seconds / 3600, seconds / 60 % 60, seconds % 60) {
        (0, 0, s) => format!("{s}s"),
        (0, m, s) => format!("{m}m{s:02}s"),
        _ => HumanDuration(duration).to_string(),
    }
}

//! Formatting of what is checked in.

use std::io::Write;
use std::process::{Command, Stdio};

/// A text that could not be formatted.
#[derive(Debug, thiserror::Error)]
pub enum RustfmtError {
    /// No rustfmt.
    #[error("cannot run rustfmt ({0}); add it with `rustup component add rustfmt`")]
    Missing(std::io::Error),
    /// rustfmt does not take the text.
    #[error("rustfmt refuses the emitted text: {0}")]
    Refused(String),
}

/// Formats a Rust source text.
///
/// # Errors
///
/// [`RustfmtError`] if there is no rustfmt, or it does not take the text.
pub fn rustfmt(text: &str) -> Result<String, RustfmtError> {
    let mut child = Command::new("rustfmt")
        .args(["--edition", "2024", "--emit", "stdout", "--quiet"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(RustfmtError::Missing)?;
    let mut stdin = child.stdin.take().expect("stdin is piped");
    // rustfmt reads all of its input before it writes, so this cannot block for ever; a broken
    // pipe shows in its exit status.
    let _ = stdin.write_all(text.as_bytes());
    drop(stdin);
    let output = child.wait_with_output().map_err(RustfmtError::Missing)?;
    let said = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
    if !output.status.success() {
        return Err(RustfmtError::Refused(said(&output.stderr)));
    }
    String::from_utf8(output.stdout).map_err(|_| RustfmtError::Refused("no UTF-8".into()))
}

//! Names that may be printed: of recipes, processors and functions.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A name of `[a-z0-9._-]` without `..`, 1 to 100 characters long.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Name(String);

/// A text that is no [`Name`].
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[error("{0:?} is not a name of [a-z0-9._-] without \"..\"")]
pub struct NotAName(String);

impl Name {
    /// Checks a name.
    ///
    /// # Errors
    ///
    /// [`NotAName`] if it has another character, two dots in a row, or the wrong length.
    pub fn new(text: impl Into<String>) -> Result<Name, NotAName> {
        let text = text.into();
        let allowed = |c: u8| c.is_ascii_lowercase() || c.is_ascii_digit() || b"._-".contains(&c);
        let harmless =
            (1..=100).contains(&text.len()) && text.bytes().all(allowed) && !text.contains("..");
        if harmless {
            Ok(Name(text))
        } else {
            Err(NotAName(text.chars().take(100).collect()))
        }
    }

    /// The nearest name to any text: lower case, everything else a hyphen, `unknown` if nothing
    /// is left.
    pub fn of(text: &str) -> Name {
        let lower = text.to_ascii_lowercase();
        let words = lower.split(|c: char| !c.is_ascii_alphanumeric());
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let slug: String = words.join("-").chars().take(100).collect();
        Name::new(slug).unwrap_or_else(|_| Name("unknown".into()))
    }

    /// The name as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The name as a Rust identifier.
    pub fn identifier(&self) -> String {
        let word = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let identifier: String = self.0.chars().map(word).collect();
        match identifier.as_bytes()[0] {
            b'0'..=b'9' => format!("_{identifier}"),
            _ => identifier,
        }
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.0)
    }
}

impl TryFrom<String> for Name {
    type Error = NotAName;

    fn try_from(text: String) -> Result<Name, NotAName> {
        Name::new(text)
    }
}

impl From<Name> for String {
    fn from(name: Name) -> String {
        name.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_no_paths_and_no_code() {
        for text in ["../../x", "a/b", "a..b", "", "A", "a b", "a\n", "a;", "é"] {
            assert!(Name::new(text).is_err(), "{text:?}");
        }
        assert_eq!(
            Name::new("packet-sse2.1").unwrap().identifier(),
            "packet_sse2_1"
        );
    }

    #[test]
    fn any_text_has_a_nearest_name() {
        assert_eq!(
            Name::of("Intel(R) Xeon(R) @ 2.0GHz").as_str(),
            "intel-r-xeon-r-2-0ghz"
        );
        assert_eq!(Name::of("\u{202e}").as_str(), "unknown");
    }
}

//! The name of a new crate.
//!
//! Input: the argument. Output: a name that cargo accepts for a package with a program, or a message with a suggestion.

use std::str::FromStr;

/// A name of ASCII letters, digits, `-` and `_`.
#[derive(Clone, Debug)]
pub(crate) struct CrateName(pub(crate) String);

/// What cargo rejects: keywords of Rust, crates that every program has, and names of devices on Windows. `fragbuf` would depend on itself.
const RESERVED: &str = "abstract alloc as async await become box break const continue core crate do dyn else enum extern false final \
    fn for fragbuf gen if impl in let loop macro match mod move mut override priv proc_macro pub ref return self Self static std struct \
    super test trait true try type typeof union unsafe unsized use virtual where while yield _ con prn aux nul build deps examples \
    incremental";

impl FromStr for CrateName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let problem = if text.is_empty() {
            "a name is empty"
        } else if text.starts_with(|first: char| first.is_ascii_digit()) {
            "a name does not begin with a digit"
        } else if !text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_') {
            "a name begins with a letter"
        } else if !text.chars().all(is_allowed) {
            "a name has letters, digits, `-` and `_`"
        } else if is_reserved(text) {
            "the name is reserved"
        } else {
            return Ok(CrateName(text.to_owned()));
        };
        Err(format!("{problem}: for example `{}`", suggestion(text)))
    }
}

impl CrateName {
    /// Returns the name of the buffer: `my-glass` is `MyGlass`.
    pub(super) fn in_camel_case(&self) -> String {
        let capitalised = |part: &str| -> String {
            let mut letters = part.chars();
            letters.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(letters).collect()
        };
        let name: String = self.0.split(['-', '_']).map(capitalised).collect();
        // A name such as `_1` has no letter to begin with.
        if name.starts_with(|first: char| first.is_ascii_alphabetic()) { name } else { format!("Buffer{name}") }
    }
}

fn is_allowed(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '-' || letter == '_'
}

fn is_reserved(text: &str) -> bool {
    RESERVED.split_whitespace().any(|reserved| reserved == text || reserved == text.to_ascii_lowercase())
}

/// Returns a valid name that is like the text.
fn suggestion(text: &str) -> String {
    let last = text.rsplit(['/', '\\']).next().unwrap_or_default();
    let letters: String = last.chars().map(|letter| if is_allowed(letter) { letter } else { '-' }).collect();
    let name = letters.trim_matches('-');
    match name.chars().next() {
        None => "glass".to_owned(),
        Some(first) if first.is_ascii_digit() || is_reserved(name) => format!("buffer-{name}"),
        Some(_) => name.to_owned(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_that_cargo_accepts() {
        for (text, camel) in [("glass", "Glass"), ("my-glass_2", "MyGlass2"), ("_1", "Buffer1"), ("Wine", "Wine")] {
            assert_eq!(text.parse::<CrateName>().unwrap().in_camel_case(), camel);
        }
        for (text, suggested) in [
            ("", "glass"),
            ("2d", "buffer-2d"),
            ("-x", "x"),
            ("my glass", "my-glass"),
            ("../out", "out"),
            ("größe", "gr--e"),
            ("match", "buffer-match"),
            ("fragbuf", "buffer-fragbuf"),
            ("Test", "buffer-Test"),
        ] {
            let error = text.parse::<CrateName>().unwrap_err();
            assert!(error.ends_with(&format!("`{suggested}`")), "{text}: {error}");
            assert!(suggested.parse::<CrateName>().is_ok(), "{suggested}");
        }
    }
}

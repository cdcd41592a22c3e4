//! Texts with a placeholder in place of the name that a user is typing, and what the type checker offers for it.
//!
//! Input: a text and the bytes of the name. Output: candidates. A text that does not parse is repaired or cut off behind the name.

use std::ops::Range;

use fragbuf_syntax::{Candidate, PLACEHOLDER, inspect};

use super::scan::{Kind, partner, repaired, tokens};

/// Returns the names that can be in place of a word in a function.
pub(super) fn candidates(text: &str, path: &str, word: &Range<usize>) -> Vec<Candidate> {
    let before = text.get(..word.start).unwrap_or_default();
    let after = text.get(word.end..).unwrap_or_default();
    let texts: [&dyn Fn() -> String; 5] = [
        &|| repaired(&format!("{before}{PLACEHOLDER}{after}")),
        &|| repaired(&format!("{before}{PLACEHOLDER};{after}")),
        &|| cut(before, "", ";"),
        &|| cut(before, "", ""),
        &|| cut(before, " {}", ";"),
    ];
    let mut found = texts.iter().map(|text| inspect(&text(), path).candidates);
    found.find(|candidates| !candidates.is_empty()).unwrap_or_default()
}

/// Returns the text up to the placeholder, with the missing closing brackets. `end` is written before each `}` of a function.
fn cut(before: &str, after: &str, end: &str) -> String {
    let mut text = repaired_start(before);
    let mut open: Vec<&str> = Vec::new();
    for token in tokens(&text) {
        match token.kind {
            Kind::Open => open.push(partner(token.of(&text))),
            Kind::Close => drop(open.pop()),
            _ => {}
        }
    }
    let closing: String = open
        .iter()
        .skip(1)
        .rev()
        .map(|close| match *close {
            "}" => format!("{end}\n}}"),
            close => close.to_owned(),
        })
        .collect();
    text.push_str(PLACEHOLDER);
    text.push_str(after);
    text.push_str(&closing);
    // The item may be one that ends with `;`, and the buffer ends.
    text.push_str(";\n}");
    text
}

/// Returns the text without stray brackets, and without the closing brackets that a repair adds.
fn repaired_start(before: &str) -> String {
    let mut text = repaired(before);
    text.truncate(before.len());
    text
}

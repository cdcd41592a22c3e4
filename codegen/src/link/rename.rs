//! Renames tokens. Members of structs keep their names.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::token::{Token, TokenKind, tokens};

/// A map from old names to new ones.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Renames(BTreeMap<String, String>);

impl Renames {
    /// Creates renames that put `prefix` before each of `names`; none if the prefix is empty.
    pub(crate) fn prefix<'a>(prefix: &str, names: impl Iterator<Item = &'a str>) -> Self {
        if prefix.is_empty() {
            return Renames::default();
        }
        Renames(names.map(|name| (name.to_owned(), format!("{prefix}{name}"))).collect())
    }

    /// Adds a rename.
    pub(crate) fn insert(&mut self, old: impl Into<String>, new: impl Into<String>) {
        self.0.insert(old.into(), new.into());
    }

    /// Returns `text` with the new names.
    pub(crate) fn apply<'a>(&self, text: &'a str) -> Cow<'a, str> {
        if self.0.is_empty() {
            return Cow::Borrowed(text);
        }
        let (all, _) = tokens(text);
        let mut out = String::with_capacity(text.len() * 2);
        let mut copied = 0;
        let mut in_struct = false;
        for (index, token) in all.iter().enumerate() {
            in_struct = match token.text {
                "struct" => true,
                "}" => false,
                _ => in_struct,
            };
            if token.kind != TokenKind::Name || is_member(&all, index, in_struct) {
                continue;
            }
            if let Some(new) = self.0.get(token.text) {
                out.push_str(&text[copied..token.at]);
                out.push_str(new);
                copied = token.at + token.text.len();
            }
        }
        out.push_str(&text[copied..]);
        Cow::Owned(out)
    }
}

/// Tests whether a name follows a dot or is declared in a struct.
fn is_member(all: &[Token<'_>], index: usize, in_struct: bool) -> bool {
    let after_dot = index > 0 && all[index - 1].text == ".";
    let declared = in_struct && all.get(index + 1).is_some_and(|next| next.text == ":");
    after_dot || declared
}

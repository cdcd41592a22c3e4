//! What is chosen on an axis: a value with its options, and what to take where a target cannot express it.
//!
//! In: words of the registry, unchecked. Out: a choice of the model, each word at the place where the program says it.

use fragbuf_model::{Alternative, Choice, OptionValue, Spanned};

use super::here;

/// `value { option: number } else value`; a plain word is one too.
#[derive(Clone, Debug)]
#[must_use = "a value is to be chosen: `.choose(axis, value)`"]
pub struct Value {
    before: Vec<Alternative>,
    last: Alternative,
}

/// A value of some axis.
#[track_caller]
pub fn value(word: impl Into<String>) -> Value {
    Value { before: Vec::new(), last: Alternative { value: here(word.into()), options: Vec::new() } }
}

impl Value {
    /// `{ name: value }` behind the value said last: a number or a word.
    #[track_caller]
    pub fn option(mut self, name: impl Into<String>, value: impl Into<OptionValue>) -> Self {
        self.last.options.push((here(name.into()), here(value.into())));
        self
    }

    /// `else value`: taken on targets that cannot express those before.
    #[track_caller]
    pub fn or_else(mut self, other: impl Into<Value>) -> Self {
        let other = other.into();
        self.before.push(self.last);
        self.before.extend(other.before);
        Value { before: self.before, last: other.last }
    }

    pub(crate) fn on(self, axis: Spanned<String>) -> Choice {
        let alternatives = self.before.into_iter().chain([self.last]).collect();
        Choice { axis, alternatives }
    }
}

impl From<&str> for Value {
    #[track_caller]
    fn from(word: &str) -> Self {
        value(word)
    }
}

impl From<String> for Value {
    #[track_caller]
    fn from(word: String) -> Self {
        value(word)
    }
}

//! The choice on an axis: a value with its options, and alternatives for targets that do not support it.
//!
//! Input: keys of the registry, unchecked. Output: a choice of the model, in which each key has the span of the call.

use fragbuf_model::{Alternative, Choice, OptionValue, Spanned};

use super::at_caller;

/// `value { option: number } else value`; a key alone converts to it.
#[derive(Clone, Debug)]
#[must_use = "pass the value to `.choose(axis, value)`"]
pub struct Value {
    earlier: Vec<Alternative>,
    last: Alternative,
}

/// Creates a value of an axis.
#[track_caller]
pub fn value(key: impl Into<String>) -> Value {
    Value { earlier: Vec::new(), last: Alternative { value: at_caller(key.into()), options: Vec::new() } }
}

impl Value {
    /// Adds the option `{ name: value }` to the last alternative; its value is a number or a name.
    #[track_caller]
    pub fn option(mut self, name: impl Into<String>, value: impl Into<OptionValue>) -> Self {
        self.last.options.push((at_caller(name.into()), at_caller(value.into())));
        self
    }

    /// Adds `else value`: targets that do not support the earlier alternatives take it.
    #[track_caller]
    pub fn or_else(mut self, other: impl Into<Value>) -> Self {
        let other = other.into();
        self.earlier.push(self.last);
        self.earlier.extend(other.earlier);
        Value { earlier: self.earlier, last: other.last }
    }

    pub(super) fn on(self, axis: Spanned<String>) -> Choice {
        let alternatives = self.earlier.into_iter().chain([self.last]).collect();
        Choice { axis, alternatives }
    }
}

impl From<&str> for Value {
    #[track_caller]
    fn from(key: &str) -> Self {
        value(key)
    }
}

impl From<String> for Value {
    #[track_caller]
    fn from(key: String) -> Self {
        value(key)
    }
}

//! Functions that a program gives to the builder: as tokens of the program's source, or as generated source.
//!
//! Input: tokens that `closure!` and `function!` captured, or a string. Output: the tokens with their spans. The grammar
//! checks later that they are a closure or a function.

use fragbuf_syntax::CapturedTokens;

use super::at_caller;

/// A closure `|f, u| …`; `closure!` captures one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Closure(pub(crate) CapturedTokens);

impl Closure {
    /// Wraps tokens of the program's source; `closure!` expands to this call.
    pub const fn captured(tokens: CapturedTokens) -> Self {
        Closure(tokens)
    }

    /// Wraps generated source. Every diagnostic in it has the span of this call.
    #[track_caller]
    pub fn text(text: impl Into<String>) -> Self {
        Closure(CapturedTokens::from_source(text, &at_caller(()).span))
    }
}

/// A function `fn name(…) -> … { … }`; `function!` captures one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function(pub(crate) CapturedTokens);

impl Function {
    /// Wraps tokens of the program's source; `function!` expands to this call.
    pub const fn captured(tokens: CapturedTokens) -> Self {
        Function(tokens)
    }

    /// Wraps generated source. Every diagnostic in it has the span of this call.
    #[track_caller]
    pub fn text(text: impl Into<String>) -> Self {
        Function(CapturedTokens::from_source(text, &at_caller(()).span))
    }
}

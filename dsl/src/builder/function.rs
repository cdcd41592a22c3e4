//! Functions of a description that a program hands over: as tokens of its own source, or as text that it made.
//!
//! In: what `closure!` and `function!` captured, or text. Out: the tokens with their places. Whether they are a closure or
//! a function at all is the grammar's to say.

use fragbuf_syntax::Captured;

use super::here;

/// `|f, u| …`, as `closure!` makes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Closure(pub(crate) Captured);

impl Closure {
    /// Tokens of the program's own source; what `closure!` expands to.
    pub const fn captured(tokens: Captured) -> Self {
        Closure(tokens)
    }

    /// Text that the program made. Every mistake in it stands where it is handed over.
    #[track_caller]
    pub fn text(text: impl Into<String>) -> Self {
        Closure(Captured::made(text, &here(()).origin))
    }
}

/// `fn name(…) -> … { … }`, as `function!` makes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function(pub(crate) Captured);

impl Function {
    /// Tokens of the program's own source; what `function!` expands to.
    pub const fn captured(tokens: Captured) -> Self {
        Function(tokens)
    }

    /// Text that the program made. Every mistake in it stands where it is handed over.
    #[track_caller]
    pub fn text(text: impl Into<String>) -> Self {
        Function(Captured::made(text, &here(()).origin))
    }
}

//! Printed expressions with their precedence, which decides where parentheses are needed.

/// The precedence of a printed expression, from loose to tight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Precedence {
    Ternary,
    LogicalOr,
    LogicalAnd,
    BitOr,
    BitXor,
    BitAnd,
    Equality,
    Relation,
    Shift,
    Sum,
    Product,
    Unary,
    Primary,
}

/// A printed expression.
#[derive(Clone, Debug)]
pub struct Text {
    pub text: String,
    pub precedence: Precedence,
}

impl Text {
    /// Returns an expression that never needs parentheses.
    pub fn primary(text: impl Into<String>) -> Self {
        Self { text: text.into(), precedence: Precedence::Primary }
    }

    /// Returns an expression of the given precedence.
    pub fn new(text: impl Into<String>, precedence: Precedence) -> Self {
        Self { text: text.into(), precedence }
    }

    /// Returns the expression as an operand that must bind at least as tightly as `precedence`.
    pub fn at_least(self, precedence: Precedence) -> String {
        if self.precedence < precedence { format!("({})", self.text) } else { self.text }
    }

    /// Returns the expression as an operand that must bind more tightly than `precedence`.
    pub fn above(self, precedence: Precedence) -> String {
        if self.precedence <= precedence { format!("({})", self.text) } else { self.text }
    }
}

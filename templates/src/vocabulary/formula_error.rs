//! Errors of formulas.

use std::fmt;

/// See [`Limit::Depth`].
pub(super) const MAX_DEPTH: usize = 40;

/// See [`Limit::Operators`].
pub(super) const MAX_OPERATORS: usize = 100;

/// See [`Limit::Terms`].
pub(super) const MAX_TERMS: usize = 1000;

/// An error of a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FormulaError {
    /// The text is not a formula; `at` counts bytes from 0.
    Malformed {
        /// The whole text.
        text: String,
        /// The position of the syntax error.
        at: usize,
    },
    /// The text compares the result of a comparison, as in `1 < k < 9`.
    Chained(String),
    /// The formula exceeds a limit.
    TooLarge(Limit),
    /// A symbol has no value yet.
    Unbound(String),
    /// A division by zero, or a result below zero or beyond 64 bits.
    Overflow(String),
    /// A number does not fit in a 32-bit word, in a formula that shaders compute.
    Word(u64),
}

/// A limit on formulas, so that parsing and printing are bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// The nesting of parentheses and functions.
    Depth,
    /// The number of operators and functions.
    Operators,
    /// The number of products after expansion, or the length of one of their factors.
    Terms,
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FormulaError::Malformed { text, at } => write!(f, "`{text}` is not a formula: syntax error at byte {at}"),
            FormulaError::Chained(text) => write!(f, "`{text}` compares the result of a comparison"),
            FormulaError::TooLarge(Limit::Depth) => write!(f, "the formula is nested more than {MAX_DEPTH} deep"),
            FormulaError::TooLarge(Limit::Operators) => {
                write!(f, "the formula has more than {MAX_OPERATORS} operators and functions")
            }
            FormulaError::TooLarge(Limit::Terms) => {
                write!(f, "the expanded formula has more than {MAX_TERMS} products, or one that is too long")
            }
            FormulaError::Unbound(symbol) => write!(f, "`{symbol}` has no value yet"),
            FormulaError::Overflow(text) => {
                write!(f, "`{text}` has no value: it divides by zero, or is below zero or beyond 64 bits")
            }
            FormulaError::Word(number) => write!(f, "{number} does not fit in a 32-bit word"),
        }
    }
}

impl FormulaError {
    /// Returns the fix, as an instruction.
    pub fn help(&self) -> &'static str {
        match self {
            FormulaError::Malformed { .. } => "use only numbers, symbols, operators and functions",
            FormulaError::Chained(_) => "combine two comparisons with `&&`: `1 < k && k < 9`",
            FormulaError::TooLarge(Limit::Depth) => "nest fewer parentheses and functions",
            FormulaError::TooLarge(Limit::Operators) => {
                "shorten the formula; operators in the divisor of a `ceil_div` count twice"
            }
            FormulaError::TooLarge(Limit::Terms) => "multiply fewer sums",
            FormulaError::Unbound(_) => "use a symbol that has a value here",
            FormulaError::Overflow(_) => {
                "divide by 1 or more, and keep differences at 0 or more and numbers below 2^64"
            }
            FormulaError::Word(_) => "keep every number below 2^32; `keep` is 2^32 for `keep all`",
        }
    }
}

impl std::error::Error for FormulaError {}

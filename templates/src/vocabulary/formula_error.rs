//! Why a formula has no value. In: what reading and computing find. Out: messages, each with a way out.

use std::fmt;

/// See [`Limit::Depth`].
pub(super) const MOST_DEPTH: usize = 40;

/// See [`Limit::Operators`].
pub(super) const MOST_OPERATORS: usize = 100;

/// See [`Limit::Terms`].
pub(super) const MOST_TERMS: usize = 1000;

/// Why a formula has no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FormulaError {
    /// The text is no formula; `at` counts bytes from 0.
    Malformed {
        /// The whole text.
        text: String,
        /// Where reading stopped.
        at: usize,
    },
    /// The text compares what a comparison came to, as `1 < k < 9` does.
    Chained(String),
    /// The formula is longer or deeper than one may be.
    TooLarge(Limit),
    /// A symbol has no value yet.
    Unbound(String),
    /// A division by zero, or a result below zero or beyond 64 bits.
    Overflow(String),
    /// A number that a 32-bit word cannot hold, in a formula that shaders compute.
    Word(u64),
}

/// What bounds a formula, so that neither reading nor writing one goes on without end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// Parentheses and functions inside each other.
    Depth,
    /// Operators and functions.
    Operators,
    /// The products that are left once all parentheses are multiplied out, or the length of one of their factors.
    Terms,
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FormulaError::Malformed { text, at } => write!(f, "`{text}` is no formula from byte {at} on"),
            FormulaError::Chained(text) => write!(f, "`{text}` compares what a comparison came to"),
            FormulaError::TooLarge(Limit::Depth) => write!(f, "the formula is nested more than {MOST_DEPTH} deep"),
            FormulaError::TooLarge(Limit::Operators) => {
                write!(f, "the formula has more than {MOST_OPERATORS} operators and functions")
            }
            FormulaError::TooLarge(Limit::Terms) => {
                write!(f, "the formula, multiplied out, has more than {MOST_TERMS} products, or one that is too long")
            }
            FormulaError::Unbound(symbol) => write!(f, "`{symbol}` has no value yet"),
            FormulaError::Overflow(text) => {
                write!(f, "`{text}` has no value: it divides by zero, or is below zero or beyond 64 bits")
            }
            FormulaError::Word(number) => write!(f, "{number} does not fit into a word of 32 bits"),
        }
    }
}

impl FormulaError {
    /// The way out, as an instruction.
    pub fn hint(&self) -> &'static str {
        match self {
            FormulaError::Malformed { .. } => "write it of numbers, symbols, operators and functions",
            FormulaError::Chained(_) => "join two comparisons by `&&`: `1 < k && k < 9`",
            FormulaError::TooLarge(Limit::Depth) => "write it with fewer parentheses and functions inside each other",
            FormulaError::TooLarge(Limit::Operators) => {
                "write it shorter; what stands in the divisor of a `ceil_div` counts twice"
            }
            FormulaError::TooLarge(Limit::Terms) => "write it with fewer sums that are multiplied with each other",
            FormulaError::Unbound(_) => "name a symbol that has a value there",
            FormulaError::Overflow(_) => "divide by 1 or more, keep differences at 0 or more, and numbers below 2^64",
            FormulaError::Word(_) => "write it so that every number in it is below 2^32; `keep` is 2^32 for `keep all`",
        }
    }
}

impl std::error::Error for FormulaError {}

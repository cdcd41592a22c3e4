//! Definitions of rows that give no value. In: what the table of symbols finds. Out: messages, each with a way out.

use std::fmt;

use fragbuf_templates::vocabulary::{Formula, FormulaError};

/// A definition of a row that gives its symbol no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Misdefined {
    /// What is defined.
    pub(crate) symbol: String,
    /// As what.
    pub(crate) formula: Formula,
    /// What is wrong.
    pub(crate) problem: Misdefinition,
}

/// What is wrong with a definition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Misdefinition {
    /// There is no such symbol.
    Unknown,
    /// The description, or another row, gives the symbol its value.
    Twice,
    /// It rests on itself.
    Circular,
    /// The formula cannot be read, or can have no value.
    NoFormula(FormulaError),
}

impl fmt::Display for Misdefined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let symbol = &self.symbol;
        match &self.problem {
            Misdefinition::Unknown => write!(f, "there is no symbol `{symbol}` to define"),
            Misdefinition::Twice => write!(f, "`{symbol}` has a value already"),
            Misdefinition::Circular => write!(f, "the value of `{symbol}` rests on itself"),
            Misdefinition::NoFormula(error) => error.fmt(f),
        }
    }
}

impl Misdefined {
    /// The way out, as an instruction.
    pub(crate) fn hint(&self) -> &'static str {
        match &self.problem {
            Misdefinition::Unknown | Misdefinition::Twice => "leave the definition out",
            Misdefinition::Circular => "define it over `width` and `height` alone",
            Misdefinition::NoFormula(error) => error.hint(),
        }
    }
}

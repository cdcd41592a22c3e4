//! Errors in definitions of symbols by rows.

use std::fmt;

use fragbuf_templates::vocabulary::{Formula, FormulaError};

/// An error in a row's definition of a symbol.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DefinitionError {
    /// The symbol.
    pub(crate) symbol: String,
    /// The formula.
    pub(crate) formula: Formula,
    /// The reason.
    pub(crate) problem: DefinitionProblem,
}

/// The reason why a definition is invalid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum DefinitionProblem {
    /// The symbol does not exist.
    Unknown,
    /// The description or another row defines the symbol.
    Duplicate,
    /// The definition depends on itself.
    Circular,
    /// The formula is invalid.
    InvalidFormula(FormulaError),
}

/// The name of a parameter's constant has another meaning in formulas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NameTaken;

impl fmt::Display for DefinitionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let symbol = &self.symbol;
        match &self.problem {
            DefinitionProblem::Unknown => write!(f, "there is no symbol `{symbol}` to define"),
            DefinitionProblem::Duplicate => write!(f, "`{symbol}` has a value already"),
            DefinitionProblem::Circular => write!(f, "the definition of `{symbol}` depends on itself"),
            DefinitionProblem::InvalidFormula(error) => error.fmt(f),
        }
    }
}

impl DefinitionError {
    /// Returns the help text.
    pub(crate) fn help(&self) -> &'static str {
        match &self.problem {
            DefinitionProblem::Unknown | DefinitionProblem::Duplicate => "leave the definition out",
            DefinitionProblem::Circular => "define it over `width` and `height` alone",
            DefinitionProblem::InvalidFormula(error) => error.help(),
        }
    }
}

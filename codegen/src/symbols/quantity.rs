//! Formulas over the symbols of one plan: as written, with handles, and with their known parts evaluated.

use std::fmt;

use fragbuf_templates::vocabulary::Formula;

use super::SymbolId;

/// A formula over the symbols of one plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    pub(super) text: Formula,
    pub(super) resolved: Term,
    /// The term after evaluation of the parts whose values are known at generation.
    pub(super) folded: Term,
}

/// Tests whether the result of an operator is a Boolean, which is a separate type in generated code.
pub fn is_boolean(operator: &str) -> bool {
    matches!(operator, "==" | "!=" | "<" | "<=" | ">" | ">=" | "&&" | "||")
}

/// A formula with resolved symbols.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Term {
    /// A whole number.
    Number(u64),
    /// A symbol.
    Symbol(SymbolId),
    /// An operator or a function, by its spelling.
    Apply(&'static str, Vec<Term>),
}

impl Term {
    pub(super) fn greatest_number(&self) -> Option<u64> {
        match self {
            Term::Number(number) => Some(*number),
            Term::Symbol(_) => None,
            Term::Apply(_, arguments) => arguments.iter().filter_map(Term::greatest_number).max(),
        }
    }
}

impl Quantity {
    /// Returns the formula as written.
    pub fn formula(&self) -> &Formula {
        &self.text
    }

    /// Returns the resolved formula for generated code, after evaluation of the parts whose values are known at generation.
    pub fn term(&self) -> &Term {
        &self.folded
    }

    /// Tests whether the formula names the symbol.
    pub fn mentions(&self, id: SymbolId) -> bool {
        self.symbols().contains(&id)
    }

    /// Returns the symbols that the formula names.
    pub fn symbols(&self) -> Vec<SymbolId> {
        fn collect(term: &Term, symbols: &mut Vec<SymbolId>) {
            match term {
                Term::Number(_) => {}
                Term::Symbol(id) => symbols.push(*id),
                Term::Apply(_, arguments) => arguments.iter().for_each(|argument| collect(argument, symbols)),
            }
        }
        let mut symbols = Vec::new();
        collect(&self.resolved, &mut symbols);
        symbols
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.text.fmt(f)
    }
}

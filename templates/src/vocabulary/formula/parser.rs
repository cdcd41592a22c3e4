//! Parses formulas. Input: text. Output: an expression, or the place of the error. Nesting and length are limited, so no text exhausts the stack.

use super::Expression;
use crate::vocabulary::formula_error::{FormulaError, Limit, MAX_DEPTH, MAX_OPERATORS};

/// The functions and their numbers of arguments.
const FUNCTIONS: [(&str, usize); 5] = [("min", 2), ("max", 2), ("ceil_div", 2), ("pow2", 1), ("log2_ceil", 1)];

/// The operators in increasing precedence. An operator precedes its prefixes.
const OPERATORS: [&[&str]; 5] = [&["||"], &["&&"], &["==", "!=", "<=", ">=", "<", ">"], &["+", "-"], &["*", "/"]];

/// Returns whether a function of formulas has this name.
pub(in crate::vocabulary) fn is_function(name: &str) -> bool {
    FUNCTIONS.iter().any(|(function, _)| *function == name)
}

/// Parses a whole formula.
pub(super) fn parse(text: &str) -> Result<Expression, FormulaError> {
    let mut reader = Reader { text, at: 0, depth: 0, operators: 0 };
    let expression = reader.operation(0)?;
    reader.skip_spaces();
    if reader.at < text.len() { Err(reader.malformed()) } else { Ok(expression) }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    /// The number of open parentheses and functions.
    depth: usize,
    /// The number of operators and functions so far.
    operators: usize,
}

impl Reader<'_> {
    /// Parses operands of the operators of this precedence, which are left-associative.
    fn operation(&mut self, precedence: usize) -> Result<Expression, FormulaError> {
        let Some(operators) = OPERATORS.get(precedence) else { return self.atom() };
        let mut left = self.operation(precedence + 1)?;
        let mut compares = false;
        while let Some(operator) = operators.iter().find(|operator| self.take(operator)) {
            // `1 < k < 9` would compare the result of the first comparison.
            if std::mem::replace(&mut compares, operators.contains(&"==")) {
                return Err(FormulaError::Chained(self.text.to_owned()));
            }
            self.count(1)?;
            left = Expression::Apply(operator, vec![left, self.operation(precedence + 1)?]);
        }
        Ok(left)
    }

    fn atom(&mut self) -> Result<Expression, FormulaError> {
        if self.take("(") {
            let inner = self.inside()?;
            return if self.take(")") { Ok(inner) } else { Err(self.malformed()) };
        }
        let name = self.identifier();
        if name.is_empty() {
            return Err(self.malformed());
        }
        if name.starts_with(|c: char| c.is_ascii_digit()) {
            return name.parse().map(Expression::Number).map_err(|_| self.malformed());
        }
        match FUNCTIONS.iter().find(|(function, _)| *function == name) {
            Some((function, arity)) if self.take("(") => self.arguments(function, *arity),
            _ => Ok(Expression::Symbol(name)),
        }
    }

    fn arguments(&mut self, name: &'static str, arity: usize) -> Result<Expression, FormulaError> {
        self.count(1)?;
        let mut arguments = vec![self.inside()?];
        while self.take(",") {
            let before = self.operators;
            arguments.push(self.inside()?);
            // Shaders have no such function, and its replacement contains the divisor twice.
            self.count(if name == "ceil_div" { self.operators - before } else { 0 })?;
        }
        if arguments.len() != arity || !self.take(")") {
            return Err(self.malformed());
        }
        Ok(Expression::Apply(name, arguments))
    }

    /// Parses the inside of parentheses.
    fn inside(&mut self) -> Result<Expression, FormulaError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(FormulaError::TooLarge(Limit::Depth));
        }
        let inner = self.operation(0)?;
        self.depth -= 1;
        Ok(inner)
    }

    fn count(&mut self, more: usize) -> Result<(), FormulaError> {
        self.operators += more;
        if self.operators > MAX_OPERATORS { Err(FormulaError::TooLarge(Limit::Operators)) } else { Ok(()) }
    }

    fn identifier(&mut self) -> String {
        self.skip_spaces();
        let rest = self.text.get(self.at..).unwrap_or("");
        let length = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
        self.at += length;
        rest[..length].to_owned()
    }

    fn take(&mut self, sign: &str) -> bool {
        self.skip_spaces();
        let found = self.text.get(self.at..).is_some_and(|rest| rest.starts_with(sign));
        self.at += if found { sign.len() } else { 0 };
        found
    }

    fn skip_spaces(&mut self) {
        while self.text.as_bytes().get(self.at) == Some(&b' ') {
            self.at += 1;
        }
    }

    fn malformed(&self) -> FormulaError {
        FormulaError::Malformed { text: self.text.to_owned(), at: self.at }
    }
}

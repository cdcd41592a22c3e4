//! Evaluates the formulas of a manifest: whole numbers with `+ - * /`, `min`, `max`, `ceil_div`,
//! `pow2` and `log2_ceil` over symbols.

use crate::Error;

/// Returns the value of a formula. `symbol` returns the value of a symbol, or `None` if it has none.
pub fn evaluate(formula: &str, symbol: &dyn Fn(&str) -> Option<u64>) -> Result<u64, Error> {
    let mut parser = Parser { rest: formula, depth: 0, symbol };
    let value = parser.sum().filter(|_| parser.rest.trim().is_empty());
    value.ok_or_else(|| Error(format!("the formula `{formula}` has no value")))
}

/// Returns the names in a formula, those of functions as well.
pub(crate) fn names(formula: &str) -> impl Iterator<Item = &str> {
    formula.split(|c: char| !is_of_name(c)).filter(|name| !name.is_empty())
}

fn is_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The greatest depth of parentheses. A manifest from anywhere must not exhaust the stack.
const DEEPEST: u32 = 64;

struct Parser<'a> {
    rest: &'a str,
    depth: u32,
    symbol: &'a dyn Fn(&str) -> Option<u64>,
}

impl<'a> Parser<'a> {
    fn sum(&mut self) -> Option<u64> {
        let mut value = self.product()?;
        loop {
            if self.takes('+') {
                value = value.checked_add(self.product()?)?;
            } else if self.takes('-') {
                value = value.checked_sub(self.product()?)?;
            } else {
                return Some(value);
            }
        }
    }

    fn product(&mut self) -> Option<u64> {
        let mut value = self.factor()?;
        loop {
            if self.takes('*') {
                value = value.checked_mul(self.factor()?)?;
            } else if self.takes('/') {
                value = value.checked_div(self.factor()?)?;
            } else {
                return Some(value);
            }
        }
    }

    fn factor(&mut self) -> Option<u64> {
        self.depth += 1;
        let value = if self.depth > DEEPEST { None } else { self.operand() };
        self.depth -= 1;
        value
    }

    fn operand(&mut self) -> Option<u64> {
        if self.takes('(') {
            let value = self.sum()?;
            return self.takes(')').then_some(value);
        }
        let word = self.word();
        if self.takes('(') {
            return self.call(word);
        }
        word.parse().ok().or_else(|| (self.symbol)(word))
    }

    fn call(&mut self, function: &str) -> Option<u64> {
        let mut arguments = vec![self.sum()?];
        while self.takes(',') {
            arguments.push(self.sum()?);
        }
        if !self.takes(')') {
            return None;
        }
        match (function, arguments.as_slice()) {
            ("min", [a, b]) => Some(*a.min(b)),
            ("max", [a, b]) => Some(*a.max(b)),
            ("ceil_div", [a, b]) => (*b != 0).then(|| a.div_ceil(*b)),
            ("pow2", [a]) => 1u64.checked_shl((*a).try_into().ok()?),
            ("log2_ceil", [a]) => Some(a.checked_next_power_of_two()?.ilog2().into()),
            _ => None,
        }
    }

    /// Takes a name or a number.
    fn word(&mut self) -> &'a str {
        let text = self.rest.trim_start();
        let end = text.find(|c| !is_of_name(c)).unwrap_or(text.len());
        self.rest = &text[end..];
        &text[..end]
    }

    fn takes(&mut self, wanted: char) -> bool {
        match self.rest.trim_start().strip_prefix(wanted) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::evaluate;

    #[test]
    fn formulas_have_values_or_are_errors() {
        let symbol = |name: &str| (name == "width").then_some(13);
        assert_eq!(evaluate("ceil_div(width, 4) * (2 + max(1, 3)) - 1", &symbol).ok(), Some(19));
        for wrong in ["height", "1 - 2", "1 / 0", "(1", "min(1)", "1 1", "", "pow2(64)", "18446744073709551615 + 1"] {
            assert!(evaluate(wrong, &symbol).is_err(), "{wrong}");
        }
        let nested = |depth: usize| format!("{}1{}", "(".repeat(depth), ")".repeat(depth));
        assert_eq!(evaluate(&nested(60), &symbol).ok(), Some(1));
        assert!(evaluate(&nested(1_000_000), &symbol).is_err());
    }
}

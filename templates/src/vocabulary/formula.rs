//! Formulas of sizes and conditions: the same text in a row, in the dump of a plan and in the manifest.
//!
//! Grammar: whole numbers, symbols, `+ - * / ( )` and the functions `min max ceil_div pow2 log2_ceil`; then, with
//! decreasing precedence, the comparisons `== != < <= > >=`, `&&`, and `||`. `/` rounds down. True is 1 and false is
//! 0; every other number counts as true. All values are unsigned. Parentheses and functions nest up to 40 deep, and a
//! formula has up to 100 operators and functions; every generated form of a formula stays within these limits.
//!
//! Symbols are those of [`SYMBOLS`](super::SYMBOLS), and parameters of the chosen rows by their constants, such as
//! `PAGE_ENTRIES`. Conditions use the symbols of a description ([`DescriptionValues`](super::DescriptionValues)).

mod parser;

use std::borrow::Cow;
use std::fmt;

pub(super) use parser::is_function;

use super::Polynomial;
use super::formula_error::{FormulaError, Limit, MAX_TERMS};

/// A formula as written in a row.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Formula(pub Cow<'static, str>);

impl From<&'static str> for Formula {
    fn from(text: &'static str) -> Self {
        Formula(Cow::Borrowed(text))
    }
}

impl From<String> for Formula {
    fn from(text: String) -> Self {
        Formula(Cow::Owned(text))
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A parsed formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expression {
    /// A whole number.
    Number(u64),
    /// A symbol.
    Symbol(String),
    /// An operator, or a function of one or two arguments, by its name.
    Apply(&'static str, Vec<Expression>),
}

/// The greatest length of a symbol that stands for a function in a [`Polynomial`].
const MAX_SYMBOL_LENGTH: usize = 4000;

impl Formula {
    /// Returns whether the value depends on this symbol.
    pub fn mentions(&self, symbol: &str) -> bool {
        self.0.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).any(|word| word == symbol)
    }

    /// Parses the text.
    pub fn read(&self) -> Result<Expression, FormulaError> {
        parser::parse(&self.0)
    }

    /// Parses the text and computes its value; `value` returns the value of a symbol.
    pub fn evaluate(&self, value: &dyn Fn(&str) -> Option<u64>) -> Result<u64, FormulaError> {
        self.read()?.evaluate(value)
    }
}

impl Expression {
    /// Computes the value; `value` returns the value of a symbol.
    pub fn evaluate(&self, value: &dyn Fn(&str) -> Option<u64>) -> Result<u64, FormulaError> {
        match self {
            Expression::Number(number) => Ok(*number),
            Expression::Symbol(name) => value(name).ok_or_else(|| FormulaError::Unbound(name.clone())),
            Expression::Apply(operator, arguments) => {
                let mut values = Vec::with_capacity(2);
                for argument in arguments {
                    values.push(argument.evaluate(value)?);
                }
                apply_checked(operator, &values)
            }
        }
    }

    /// Returns the symbols of the expression.
    pub fn symbols(&self) -> Vec<&str> {
        match self {
            Expression::Number(_) => Vec::new(),
            Expression::Symbol(name) => vec![name],
            Expression::Apply(_, arguments) => arguments.iter().flat_map(Expression::symbols).collect(),
        }
    }

    /// Computes every part whose symbols have values. A part that cannot have a value for any remaining symbols is an
    /// error: a division by 0, or numbers whose difference is below zero.
    pub fn folded(&self, value: &dyn Fn(&str) -> Option<u64>) -> Result<Expression, FormulaError> {
        let Expression::Apply(operator, arguments) = self else {
            return Ok(match self {
                Expression::Symbol(name) => value(name).map_or_else(|| self.clone(), Expression::Number),
                _ => self.clone(),
            });
        };
        let parts = arguments.iter().map(|argument| argument.folded(value)).collect::<Result<Vec<_>, _>>()?;
        let numbers: Option<Vec<u64>> = parts.iter().map(Expression::as_number).collect();
        let divides_by_zero = matches!(*operator, "/" | "ceil_div") && parts[1].as_number() == Some(0);
        match numbers {
            Some(numbers) => apply_checked(operator, &numbers).map(Expression::Number),
            None if divides_by_zero => Err(FormulaError::Overflow(format!("{operator} 0"))),
            None => Ok(Expression::Apply(operator, parts)),
        }
    }

    fn as_number(&self) -> Option<u64> {
        match self {
            Expression::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// Returns the formula as a sum of products. Divisions and functions that are not constant become symbols.
    pub fn polynomial(&self, value: &dyn Fn(&str) -> Option<u64>) -> Result<Polynomial, FormulaError> {
        match self {
            Expression::Number(number) => constant(*number),
            Expression::Symbol(name) => value(name).map_or_else(|| Ok(Polynomial::symbol(name)), constant),
            Expression::Apply(operator, arguments) => {
                let parts = arguments.iter().map(|a| a.polynomial(value)).collect::<Result<Vec<_>, _>>()?;
                let sum = match (*operator, parts.as_slice()) {
                    ("+", [a, b]) => a.plus(b, 1),
                    ("-", [a, b]) => a.plus(b, -1),
                    ("*", [a, b]) if a.terms() * b.terms() > MAX_TERMS => {
                        return Err(FormulaError::TooLarge(Limit::Terms));
                    }
                    ("*", [a, b]) => a.times(b),
                    (operator, parts) => opaque(operator, parts)?,
                };
                if sum.is_saturated() { Err(FormulaError::Overflow(operator.to_string())) } else { Ok(sum) }
            }
        }
    }
}

fn constant(number: u64) -> Result<Polynomial, FormulaError> {
    let number = i64::try_from(number).map_err(|_| FormulaError::Overflow(number.to_string()))?;
    Ok(Polynomial::number(number))
}

fn apply_checked(operator: &str, values: &[u64]) -> Result<u64, FormulaError> {
    apply(operator, values).ok_or_else(|| FormulaError::Overflow(format_call(operator, values)))
}

/// Formats an operator or a function with its arguments.
fn format_call<T: fmt::Display>(operator: &str, arguments: &[T]) -> String {
    match arguments {
        [a, b] if !operator.starts_with(|sign: char| sign.is_ascii_alphabetic()) => format!("{a} {operator} {b}"),
        _ => {
            let texts: Vec<String> = arguments.iter().map(T::to_string).collect();
            format!("{operator}({})", texts.join(", "))
        }
    }
}

/// Applies an operator or function; returns `None` for a division by zero, or a result below zero or beyond 64 bits.
pub fn apply(operator: &str, values: &[u64]) -> Option<u64> {
    match (operator, values) {
        ("+", [a, b]) => a.checked_add(*b),
        ("-", [a, b]) => a.checked_sub(*b),
        ("*", [a, b]) => a.checked_mul(*b),
        ("/", [a, b]) => a.checked_div(*b),
        ("min", [a, b]) => Some(*a.min(b)),
        ("max", [a, b]) => Some(*a.max(b)),
        ("ceil_div", [a, b]) => (*b > 0).then(|| a.div_ceil(*b)),
        ("==", [a, b]) => Some(u64::from(a == b)),
        ("!=", [a, b]) => Some(u64::from(a != b)),
        ("<", [a, b]) => Some(u64::from(a < b)),
        ("<=", [a, b]) => Some(u64::from(a <= b)),
        (">", [a, b]) => Some(u64::from(a > b)),
        (">=", [a, b]) => Some(u64::from(a >= b)),
        ("&&", [a, b]) => Some(u64::from(*a != 0 && *b != 0)),
        ("||", [a, b]) => Some(u64::from(*a != 0 || *b != 0)),
        ("log2_ceil", [a]) => a.checked_next_power_of_two().map(|power| u64::from(power.trailing_zeros())),
        ("pow2", [a]) => u32::try_from(*a).ok().and_then(|a| 1u64.checked_shl(a)),
        _ => None,
    }
}

/// Returns the value of a function of numbers, or a symbol named by the text of the function.
fn opaque(operator: &str, parts: &[Polynomial]) -> Result<Polynomial, FormulaError> {
    let numbers: Option<Vec<u64>> = parts.iter().map(Polynomial::as_number).collect();
    if let Some(numbers) = numbers {
        return constant(apply_checked(operator, &numbers)?);
    }
    let texts: Vec<String> = parts.iter().map(Polynomial::to_string).collect();
    let name = match (operator, texts.as_slice()) {
        ("/", [_, one]) if one == "1" => return Ok(parts[0].clone()),
        ("/", [a, b]) => format!("({a}/{b})"),
        (sign, [_, _]) if !sign.starts_with(|c: char| c.is_ascii_alphabetic()) => {
            format!("({})", format_call(sign, &texts))
        }
        _ => format_call(operator, &texts),
    };
    if name.len() > MAX_SYMBOL_LENGTH {
        return Err(FormulaError::TooLarge(Limit::Terms));
    }
    Ok(Polynomial::symbol(&name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &'static str) -> Result<u64, FormulaError> {
        Formula::from(text).evaluate(&|name| (name == "k").then_some(8))
    }

    #[test]
    fn values_follow_precedence() {
        assert_eq!(value("2 * k + 2"), Ok(18));
        assert_eq!(value("2 * (k + 2) / 3"), Ok(6));
        assert_eq!(value("k - 3 - 2"), Ok(3));
        assert_eq!(value("ceil_div(k, 3) + pow2(k) + min(k, 3)"), Ok(262));
    }

    #[test]
    fn true_is_one() {
        assert_eq!(value("k == 8 && k != 3"), Ok(1));
        assert_eq!(value("k < 8 || k <= 7 || k > 8"), Ok(0));
        assert_eq!(value("k - 1 >= 7 && 2"), Ok(1));
        assert_eq!(value("(k > 3) * 4 + (k < 3)"), Ok(4));
        assert_eq!(value("log2_ceil(k) + log2_ceil(k + 1) + log2_ceil(1)"), Ok(7));
    }

    #[test]
    fn a_formula_without_a_value_is_an_error() {
        assert_eq!(value("n"), Err(FormulaError::Unbound("n".into())));
        assert!(matches!(value("k / 0"), Err(FormulaError::Overflow(_))));
        assert!(matches!(value("3 - k"), Err(FormulaError::Overflow(_))));
        for text in ["", "k +", "(k", "min(k)", "k k", "4é", "k =", "k && ", "k = 8"] {
            assert!(matches!(value(text), Err(FormulaError::Malformed { .. })), "{text}");
        }
        for text in ["1 < k < 9", "k == 1 != 0"] {
            assert!(matches!(value(text), Err(FormulaError::Chained(_))), "{text}");
        }
    }

    #[test]
    fn nesting_and_length_are_limited() {
        let read = |text: String| Formula::from(text).read().map(|_| ());
        let nested = |open: &str, close: &str, count| format!("{}k{}", open.repeat(count), close.repeat(count));
        for (open, close) in [("(", ")"), ("pow2(", ")"), ("(1 + min(2, ", "))"), ("k * (", ")")] {
            assert_eq!(read(nested(open, close, 100_000)), Err(FormulaError::TooLarge(Limit::Depth)), "{open}");
        }
        assert_eq!(read(nested("(", ")", 40)), Ok(()));
        assert_eq!(read(nested("(", ")", 41)), Err(FormulaError::TooLarge(Limit::Depth)));
        assert_eq!(read(nested("", " + 1", 100)), Ok(()));
        assert_eq!(read(nested("", " + 1", 100_000)), Err(FormulaError::TooLarge(Limit::Operators)));
        // The replacement of `ceil_div` would contain each divisor twice.
        assert_eq!(read(nested("ceil_div(k, ", ")", 30)), Err(FormulaError::TooLarge(Limit::Operators)));
        for signs in ["!", "-", "("] {
            assert!(read(signs.repeat(100_000)).is_err(), "{signs}");
        }
    }

    #[test]
    fn products_of_sums_are_expanded_up_to_a_limit() {
        let form = |text: &str| Formula::from(text.to_owned()).read().and_then(|e| e.polynomial(&|_| None));
        let sum = |letter: &str| format!("({})", [1, 2, 3, 4].map(|number| format!("{letter}{number}")).join(" + "));
        let product = |letters: &[&str]| letters.iter().map(|letter| sum(letter)).collect::<Vec<_>>().join(" * ");
        assert_eq!(form(&product(&["a", "b", "c", "d"])).map(|sum| sum.terms()), Ok(256));
        assert_eq!(form(&product(&["a", "b", "c", "d", "e", "f"])), Err(FormulaError::TooLarge(Limit::Terms)));
        // Symbols of functions would grow in the same way.
        let mut name = "a".to_owned();
        for _ in 0..8 {
            name = format!("min({name}, 9) * (b + c + d + e + f + g)");
        }
        assert_eq!(form(&name), Err(FormulaError::TooLarge(Limit::Terms)));
        for text in ["a * 9223372036854775807 * 3", "18446744073709551615", "pow2(63)", "a + 1 / 0", "min(1, 0 / 0)"] {
            assert!(matches!(form(text), Err(FormulaError::Overflow(_))), "{text}");
        }
    }

    #[test]
    fn parts_with_a_value_are_folded() {
        let form = |text: &'static str| {
            Formula::from(text).read().and_then(|e| e.folded(&|name| (name == "w").then_some(1 << 32)))
        };
        assert_eq!(form("w / pow2(30) - 3"), Ok(Expression::Number(1)));
        assert_eq!(form("k * (w > 2)"), form("k * 1"));
        for text in ["k / (w - w)", "ceil_div(k, 0)", "k + (1 - 2)", "w * w"] {
            assert!(matches!(form(text), Err(FormulaError::Overflow(_))), "{text}");
        }
    }

    #[test]
    fn fractions_of_a_symbol_are_found_among_other_terms() {
        let sum = Formula::from("(a / 4 + p) * 9 + 2 * a + p / 4").read().and_then(|sum| sum.polynomial(&|_| None));
        let fractions = |name| sum.clone().map(|sum| sum.fractions(name, "f").to_string());
        assert_eq!(fractions("a"), Ok("9f/4".into()));
        assert_eq!(fractions("b"), Ok("0".into()));
    }

    #[test]
    fn polynomials_have_one_form() {
        let form = |text: &'static str| {
            let value = |name: &str| (name == "w").then_some(2);
            Formula::from(text).read().and_then(|e| e.polynomial(&value)).map(|form| form.to_string())
        };
        assert_eq!(form("(k * w + 1) * pixels + pixels"), Ok("2k*pixels+2pixels".into()));
        assert_eq!(form("3 * f - 3 * f"), Ok("0".into()));
        assert_eq!(form("ceil_div(pixels, 1024) + 1"), Ok("ceil_div(pixels, 1024)+1".into()));
        assert_eq!(form("w / 2 * k"), Ok("k".into()));
        assert_eq!(form("3 * (f / 1)"), Ok("3f".into()));
    }
}

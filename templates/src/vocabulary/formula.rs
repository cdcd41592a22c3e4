//! Sizes and conditions as formulas: the same text in a row, in a plan's dump and in the manifest.
//!
//! Grammar: whole numbers, symbols, `+ - * / ( )`, and the functions `min max ceil_div pow2 log2_ceil`; then the comparisons
//! `== != < <= > >=`, then `&&`, then `||`, which bind ever more weakly. `/` rounds down. What holds is 1 and what does not
//! is 0; any other number than 0 counts as holding. All values are unsigned.
//! Symbols are those of [`SYMBOLS`](super::SYMBOLS), and parameters of the chosen rows by their constants, such as
//! `PAGE_ENTRIES`; conditions are over those that a description gives ([`Given`](super::Given)).

use std::borrow::Cow;
use std::fmt;

use super::Polynomial;

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
    /// A symbol has no value yet.
    Unbound(String),
    /// A division by zero, or a result beyond 64 bits.
    Overflow(String),
}

impl fmt::Display for FormulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FormulaError::Malformed { text, at } => write!(f, "`{text}` is no formula from byte {at} on"),
            FormulaError::Unbound(symbol) => write!(f, "`{symbol}` has no value yet"),
            FormulaError::Overflow(text) => write!(f, "`{text}` divides by zero or exceeds 64 bits"),
        }
    }
}

impl std::error::Error for FormulaError {}

/// A formula, read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expression {
    /// A whole number.
    Number(u64),
    /// A named value.
    Symbol(String),
    /// An operator, or a function of one or two arguments, by its spelling.
    Apply(&'static str, Vec<Expression>),
}

/// The functions and their number of arguments.
const FUNCTIONS: [(&str, usize); 5] = [("min", 2), ("max", 2), ("ceil_div", 2), ("pow2", 1), ("log2_ceil", 1)];

/// The operators from the weakest to the strongest. Of two with the same beginning the longer comes first.
const OPERATORS: [&[&str]; 5] = [&["||"], &["&&"], &["==", "!=", "<=", ">=", "<", ">"], &["+", "-"], &["*", "/"]];

impl Formula {
    /// Whether the value depends on this symbol.
    pub fn mentions(&self, symbol: &str) -> bool {
        self.0.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).any(|word| word == symbol)
    }

    /// Reads the text.
    pub fn read(&self) -> Result<Expression, FormulaError> {
        let mut reader = Reader { text: &self.0, at: 0 };
        let expression = reader.operation(0)?;
        reader.skip_spaces();
        if reader.at < self.0.len() { Err(reader.malformed()) } else { Ok(expression) }
    }

    /// Reads the text and computes its value; `value` gives each symbol's.
    pub fn evaluate(&self, value: &dyn Fn(&str) -> Option<u64>) -> Result<u64, FormulaError> {
        self.read()?.evaluate(value)
    }
}

impl Expression {
    /// The value, where `value` gives each symbol's.
    pub fn evaluate(&self, value: &dyn Fn(&str) -> Option<u64>) -> Result<u64, FormulaError> {
        match self {
            Expression::Number(number) => Ok(*number),
            Expression::Symbol(name) => value(name).ok_or_else(|| FormulaError::Unbound(name.clone())),
            Expression::Apply(operator, arguments) => {
                let mut values = Vec::with_capacity(2);
                for argument in arguments {
                    values.push(argument.evaluate(value)?);
                }
                apply(operator, &values).ok_or_else(|| FormulaError::Overflow(format!("{operator}{values:?}")))
            }
        }
    }

    /// The formula as a sum of products. Divisions and functions that do not reduce to a number stay whole, as symbols.
    pub fn polynomial(&self, value: &dyn Fn(&str) -> Option<u64>) -> Polynomial {
        match self {
            Expression::Number(number) => Polynomial::number(*number as i64),
            Expression::Symbol(name) => match value(name) {
                Some(number) => Polynomial::number(number as i64),
                None => Polynomial::symbol(name),
            },
            Expression::Apply(operator, arguments) => {
                let parts: Vec<Polynomial> = arguments.iter().map(|a| a.polynomial(value)).collect();
                match (*operator, parts.as_slice()) {
                    ("+", [a, b]) => a.plus(b, 1),
                    ("-", [a, b]) => a.plus(b, -1),
                    ("*", [a, b]) => a.times(b),
                    (operator, parts) => opaque(operator, parts),
                }
            }
        }
    }
}

/// An operator or function of formulas, applied; `None`: a division by zero, or a result beyond 64 bits.
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

/// A function whose arguments are all numbers is a number; any other is one symbol, named by its text.
fn opaque(operator: &str, parts: &[Polynomial]) -> Polynomial {
    let numbers: Option<Vec<u64>> = parts.iter().map(Polynomial::as_number).collect();
    if let Some(result) = numbers.and_then(|numbers| apply(operator, &numbers)) {
        return Polynomial::number(result as i64);
    }
    let texts: Vec<String> = parts.iter().map(Polynomial::to_string).collect();
    match (operator, texts.as_slice()) {
        ("/", [_, one]) if one == "1" => parts[0].clone(),
        ("/", [a, b]) => Polynomial::symbol(&format!("({a}/{b})")),
        (sign, [a, b]) if !sign.starts_with(|c: char| c.is_ascii_alphabetic()) => {
            Polynomial::symbol(&format!("({a} {sign} {b})"))
        }
        _ => Polynomial::symbol(&format!("{operator}({})", texts.join(", "))),
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
}

impl Reader<'_> {
    /// Operands of the operators of this strength, joined from the left.
    fn operation(&mut self, strength: usize) -> Result<Expression, FormulaError> {
        let Some(operators) = OPERATORS.get(strength) else { return self.atom() };
        let mut left = self.operation(strength + 1)?;
        let (mut compares, begin) = (false, self.at);
        while let Some(operator) = operators.iter().find(|operator| self.take(operator)) {
            // `1 < k < 9` would compare what the first comparison came to.
            if std::mem::replace(&mut compares, operators.contains(&"==")) {
                return Err(FormulaError::Malformed { text: self.text.to_owned(), at: begin });
            }
            left = Expression::Apply(operator, vec![left, self.operation(strength + 1)?]);
        }
        Ok(left)
    }

    fn atom(&mut self) -> Result<Expression, FormulaError> {
        if self.take("(") {
            let inner = self.operation(0)?;
            return if self.take(")") { Ok(inner) } else { Err(self.malformed()) };
        }
        let word = self.word();
        if word.is_empty() {
            return Err(self.malformed());
        }
        if word.starts_with(|c: char| c.is_ascii_digit()) {
            return word.parse().map(Expression::Number).map_err(|_| self.malformed());
        }
        match FUNCTIONS.iter().find(|(name, _)| *name == word) {
            Some((name, arity)) if self.take("(") => self.arguments(name, *arity),
            _ => Ok(Expression::Symbol(word)),
        }
    }

    fn arguments(&mut self, name: &'static str, arity: usize) -> Result<Expression, FormulaError> {
        let mut arguments = vec![self.operation(0)?];
        while self.take(",") {
            arguments.push(self.operation(0)?);
        }
        if arguments.len() != arity || !self.take(")") {
            return Err(self.malformed());
        }
        Ok(Expression::Apply(name, arguments))
    }

    fn word(&mut self) -> String {
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
    fn what_holds_is_one() {
        assert_eq!(value("k == 8 && k != 3"), Ok(1));
        assert_eq!(value("k < 8 || k <= 7 || k > 8"), Ok(0));
        assert_eq!(value("k - 1 >= 7 && 2"), Ok(1));
        assert_eq!(value("(k > 3) * 4 + (k < 3)"), Ok(4));
        assert_eq!(value("log2_ceil(k) + log2_ceil(k + 1) + log2_ceil(1)"), Ok(7));
    }

    #[test]
    fn what_has_no_value_says_why() {
        assert_eq!(value("n"), Err(FormulaError::Unbound("n".into())));
        assert!(matches!(value("k / 0"), Err(FormulaError::Overflow(_))));
        assert!(matches!(value("3 - k"), Err(FormulaError::Overflow(_))));
        for text in ["", "k +", "(k", "min(k)", "k k", "4é", "k =", "k && ", "k = 8", "1 < k < 9", "k == 1 != 0"] {
            assert!(matches!(value(text), Err(FormulaError::Malformed { .. })), "{text}");
        }
    }

    #[test]
    fn fractions_of_a_symbol_are_found_among_other_terms() {
        let sum = Formula::from("(a / 4 + p) * 9 + 2 * a + p / 4").read().map(|sum| sum.polynomial(&|_| None));
        let fractions = |name| sum.clone().map(|sum| sum.fractions(name, "f").to_string());
        assert_eq!(fractions("a"), Ok("9f/4".into()));
        assert_eq!(fractions("b"), Ok("0".into()));
    }

    #[test]
    fn polynomials_have_one_form() {
        let form = |text: &'static str| {
            Formula::from(text).read().map(|e| e.polynomial(&|name| (name == "w").then_some(2)).to_string())
        };
        assert_eq!(form("(k * w + 1) * pixels + pixels"), Ok("2k*pixels+2pixels".into()));
        assert_eq!(form("3 * f - 3 * f"), Ok("0".into()));
        assert_eq!(form("ceil_div(pixels, 1024) + 1"), Ok("ceil_div(pixels, 1024)+1".into()));
        assert_eq!(form("w / 2 * k"), Ok("k".into()));
        assert_eq!(form("3 * (f / 1)"), Ok("3f".into()));
    }
}

//! Formulas in normal form, with the operations on them and a text in the notation of the papers. No symbol has a value
//! here.

use std::collections::BTreeMap;
use std::fmt;

/// A sum of products of symbols, in normal form: equal formulas have equal polynomials.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Polynomial(BTreeMap<Vec<String>, i64>);

impl Polynomial {
    /// Makes the constant `number`.
    pub fn number(number: i64) -> Self {
        let mut terms = BTreeMap::new();
        if number != 0 {
            terms.insert(Vec::new(), number);
        }
        Polynomial(terms)
    }

    /// Makes the symbol `name`.
    pub fn symbol(name: &str) -> Self {
        Polynomial(BTreeMap::from([(vec![name.to_owned()], 1)]))
    }

    /// Returns `self + factor * other`. Coefficients saturate at the bounds of `i64`.
    pub fn plus(&self, other: &Polynomial, factor: i64) -> Polynomial {
        let mut terms = self.0.clone();
        for (symbols, coefficient) in &other.0 {
            add(&mut terms, symbols.clone(), coefficient.saturating_mul(factor));
        }
        terms.retain(|_, coefficient| *coefficient != 0);
        Polynomial(terms)
    }

    /// Returns `self * other`. Coefficients saturate at the bounds of `i64`.
    pub fn times(&self, other: &Polynomial) -> Polynomial {
        let mut terms = BTreeMap::new();
        for (left, a) in &self.0 {
            for (right, b) in &other.0 {
                let mut symbols = [left.as_slice(), right.as_slice()].concat();
                symbols.sort();
                add(&mut terms, symbols, a.saturating_mul(*b));
            }
        }
        terms.retain(|_, coefficient| *coefficient != 0);
        Polynomial(terms)
    }

    /// Returns the number of terms.
    pub fn terms(&self) -> usize {
        self.0.len()
    }

    /// Returns whether a coefficient has reached the bounds of `i64`, and may be wrong.
    pub(super) fn is_saturated(&self) -> bool {
        self.0.values().any(|coefficient| matches!(*coefficient, i64::MIN | i64::MAX))
    }

    /// Returns the coefficient of `name`: every term that contains `name`, divided by one factor `name`.
    pub fn coefficient(&self, name: &str) -> Polynomial {
        let mut terms = BTreeMap::new();
        for (symbols, coefficient) in &self.0 {
            if let Some(index) = symbols.iter().position(|symbol| symbol == name) {
                let mut rest = symbols.clone();
                rest.remove(index);
                terms.insert(rest, *coefficient);
            }
        }
        Polynomial(terms)
    }

    /// Returns the terms that contain a fraction of the symbol `name`, with `other` in its place: `8(a/4)` is `8b/4`
    /// for `a` and `b`.
    pub fn fractions(&self, name: &str, other: &str) -> Polynomial {
        let renamed = |symbol: &String| {
            let below = symbol.strip_prefix('(')?.strip_prefix(name)?.strip_prefix('/')?.strip_suffix(')')?;
            below.parse::<u32>().is_ok().then(|| format!("{other}/{below}"))
        };
        let mut terms = BTreeMap::new();
        for (symbols, coefficient) in &self.0 {
            if symbols.iter().any(|symbol| renamed(symbol).is_some()) {
                let symbols = symbols.iter().map(|symbol| renamed(symbol).unwrap_or_else(|| symbol.clone()));
                terms.insert(symbols.collect(), *coefficient);
            }
        }
        Polynomial(terms)
    }

    /// Returns whether the polynomial is zero.
    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn as_number(&self) -> Option<u64> {
        match self.0.iter().next() {
            None => Some(0),
            Some((symbols, number)) if symbols.is_empty() && self.0.len() == 1 => u64::try_from(*number).ok(),
            Some(_) => None,
        }
    }
}

fn add(terms: &mut BTreeMap<Vec<String>, i64>, symbols: Vec<String>, more: i64) {
    let coefficient = terms.entry(symbols).or_insert(0);
    *coefficient = coefficient.saturating_add(more);
}

impl fmt::Display for Polynomial {
    /// Writes the notation of the papers: `2k+2`, `3f+1`. Products of symbols are joined by `*`, and the constant is
    /// last.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str("0");
        }
        let mut terms: Vec<_> = self.0.iter().collect();
        terms.sort_by_key(|(symbols, _)| std::cmp::Reverse(symbols.len()));
        for (index, (symbols, coefficient)) in terms.into_iter().enumerate() {
            let sign = if *coefficient < 0 {
                "-"
            } else if index > 0 {
                "+"
            } else {
                ""
            };
            let magnitude = coefficient.unsigned_abs();
            let product = symbols.join("*");
            match (magnitude, product.as_str()) {
                (_, "") => write!(f, "{sign}{magnitude}")?,
                (1, _) => write!(f, "{sign}{product}")?,
                _ => write!(f, "{sign}{magnitude}{product}")?,
            }
        }
        Ok(())
    }
}

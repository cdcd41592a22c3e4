//! What rows require of the description itself: how many fragments it keeps, by what, and what they carry.
//!
//! In: formulas of rows, and what a description gives. Out: whether they hold. Facts are what rows offer each other, and
//! capabilities what targets offer; neither stands here.

use super::{Formula, SYMBOLS, Symbol, Text, When};

/// A requirement on the description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    /// What must hold, over [`Given::symbols`].
    pub formula: Formula,
    /// What it means, as the object of "requires".
    pub meaning: Text,
    /// How a user meets it, as an instruction.
    pub hint: Text,
}

impl Condition {
    /// A requirement with its meaning and its hint.
    pub fn new(formula: impl Into<Formula>, meaning: impl Into<Text>, hint: impl Into<Text>) -> Self {
        Condition { formula: formula.into(), meaning: meaning.into(), hint: hint.into() }
    }
}

/// What a description gives to the conditions of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Given {
    /// The number on the `keep` line; `None`: every fragment is kept.
    pub keep: Option<u32>,
    /// 32-bit words of the payload, with those that rows carry.
    pub payload_words: u32,
    /// Whether a criterion, and not depth, decides which fragment is worst.
    pub has_criterion: bool,
    /// Whether there is an attribute `color` of a format that effects read.
    pub has_color: bool,
}

impl Given {
    /// What the formula of a condition may use: the symbols that a description gives their values.
    pub fn symbols() -> impl Iterator<Item = &'static Symbol> {
        SYMBOLS.iter().filter(|symbol| symbol.when == When::Description)
    }

    /// The value of such a symbol.
    pub fn value(&self, symbol: &str) -> Option<u64> {
        Some(match symbol {
            "keep" => self.keep.map_or(1 << 32, u64::from),
            "limited" => u64::from(self.keep.is_some()),
            "payload_words" => u64::from(self.payload_words),
            "entry_words" => self.entry_words(),
            "beside_words" => self.entry_words().saturating_sub(1),
            "depth_key" => u64::from(!self.has_criterion),
            "color" => u64::from(self.has_color),
            _ => return None,
        })
    }

    /// Whether a formula over these symbols holds. One that has no value does not.
    pub fn meets(&self, formula: &Formula) -> bool {
        formula.evaluate(&|symbol| self.value(symbol)).is_ok_and(|value| value != 0)
    }

    fn entry_words(&self) -> u64 {
        u64::from(self.payload_words) + u64::from(self.has_criterion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_symbol_of_a_description_has_a_value() {
        let given = Given { keep: Some(8), payload_words: 3, has_criterion: true, has_color: false };
        for symbol in Given::symbols() {
            let value = given.value(symbol.name);
            assert!(value.is_some_and(|value| (symbol.range.0..=symbol.range.1).contains(&value)), "{}", symbol.name);
        }
        assert_eq!((given.value("entry_words"), given.value("width")), (Some(4), None));
    }
}

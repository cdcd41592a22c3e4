//! Conditions of rows on the description: how many fragments it keeps, by which criterion, and with which payload.
//!
//! Input: formulas of rows and values of a description. Output: whether the formulas hold.

use super::{BindingTime, Formula, SYMBOLS, Symbol, Text};

/// A requirement on the description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    /// The formula that must hold, over [`DescriptionValues::symbols`].
    pub formula: Formula,
    /// The meaning, as the object of "requires".
    pub meaning: Text,
    /// The fix, as an instruction.
    pub help: Text,
}

impl Condition {
    /// Makes a condition.
    pub fn new(formula: impl Into<Formula>, meaning: impl Into<Text>, help: impl Into<Text>) -> Self {
        Condition { formula: formula.into(), meaning: meaning.into(), help: help.into() }
    }
}

/// Values of a description that conditions of rows can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DescriptionValues {
    /// The number on the `keep` line; `None`: every fragment is kept.
    pub keep: Option<u32>,
    /// 32-bit words of the payload, including the words that rows add.
    pub payload_words: u32,
    /// Whether a criterion, not depth, is the key.
    pub has_criterion: bool,
    /// Whether the payload has an attribute `color` of a format that effects can read.
    pub has_color: bool,
    /// Whether the effect is a closure that can be interrupted between two fragments.
    pub is_resumable: bool,
    /// 32-bit words that the effect keeps between the iterations of peeling.
    pub resumed_words: u32,
}

impl DescriptionValues {
    /// Returns the symbols that the formula of a condition can use: those whose values a description gives.
    pub fn symbols() -> impl Iterator<Item = &'static Symbol> {
        SYMBOLS.iter().filter(|symbol| symbol.when == BindingTime::Description)
    }

    /// Returns the value of a symbol of [`DescriptionValues::symbols`].
    pub fn value(&self, symbol: &str) -> Option<u64> {
        Some(match symbol {
            "keep" => self.keep.map_or(1 << 32, u64::from),
            "limited" => u64::from(self.keep.is_some()),
            "payload_words" => u64::from(self.payload_words),
            "entry_words" => self.entry_words(),
            "value_words" => self.entry_words().saturating_sub(1),
            "depth_key" => u64::from(!self.has_criterion),
            "color" => u64::from(self.has_color),
            "resumable" => u64::from(self.is_resumable),
            "resumed_words" => u64::from(self.resumed_words),
            _ => return None,
        })
    }

    /// Returns whether a formula over these symbols holds. A formula without a value does not hold.
    pub fn meets(&self, formula: &Formula) -> bool {
        formula.evaluate(&|symbol| self.value(symbol)).is_ok_and(|value| value != 0)
    }

    fn entry_words(&self) -> u64 {
        u64::from(self.payload_words) + u64::from(self.has_criterion)
    }
}

impl Formula {
    /// Returns the condition that the formula is not 0, for messages.
    pub fn in_words(&self) -> String {
        let symbol = DescriptionValues::symbols().find(|symbol| *symbol.name == *self.0);
        let meaning = symbol.and_then(|symbol| symbol.meaning.strip_prefix("1 if ")?.split(';').next());
        meaning.map_or_else(|| format!("`{self}` holds"), str::to_owned)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_symbol_of_a_description_has_a_value() {
        let given = DescriptionValues {
            keep: Some(8),
            payload_words: 3,
            has_criterion: true,
            has_color: false,
            is_resumable: false,
            resumed_words: 4,
        };
        for symbol in DescriptionValues::symbols() {
            let value = given.value(symbol.name);
            assert!(value.is_some_and(|value| (symbol.range.0..=symbol.range.1).contains(&value)), "{}", symbol.name);
        }
        assert_eq!((given.value("entry_words"), given.value("width")), (Some(4), None));
    }
}

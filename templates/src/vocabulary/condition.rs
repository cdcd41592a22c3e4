//! What rows require of the description itself: how many fragments it keeps, by what, and what they carry.
//!
//! In: formulas of rows, and what a description gives. Out: whether they hold. Facts are what rows offer each other, and
//! capabilities what targets offer; neither stands here.

use super::{Formula, Text};

/// A requirement on the description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    /// What must hold, over [`Given::SYMBOLS`].
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

/// A symbol of conditions: its name, its meaning, its value.
type Symbol = (&'static str, &'static str, fn(&Given) -> u64);

impl Given {
    /// What the formula of a condition may use.
    pub const SYMBOLS: [Symbol; 7] = [
        (
            "keep",
            "the number on the `keep` line; for `keep all` more than any number that can be written there",
            |given| given.keep.map_or(1 << 32, u64::from),
        ),
        ("limited", "1 where the description keeps no more than k fragments; 0 for `keep all`", |given| {
            u64::from(given.keep.is_some())
        }),
        ("payload_words", "32-bit words of the payload, depth included, with those that rows add", |given| {
            u64::from(given.payload_words)
        }),
        ("entry_words", "32-bit words of a stored fragment: the payload, and a criterion's word", |given| {
            given.entry_words()
        }),
        ("beside_words", "those words without the key", |given| given.entry_words().saturating_sub(1)),
        ("depth_key", "1 where depth decides which fragment is worst; 0 with a criterion", |given| {
            u64::from(!given.has_criterion)
        }),
        ("color", "1 where the payload has a `color` of format rgba8, rgba16 or vec4; else 0", |given| {
            u64::from(given.has_color)
        }),
    ];

    /// The value of a symbol.
    pub fn value(&self, symbol: &str) -> Option<u64> {
        Self::SYMBOLS.iter().find(|(name, ..)| *name == symbol).map(|(_, _, value)| value(self))
    }

    /// Whether a formula over these symbols holds. One that has no value does not.
    pub fn meets(&self, formula: &Formula) -> bool {
        formula.evaluate(&|symbol| self.value(symbol)).is_ok_and(|value| value != 0)
    }

    fn entry_words(&self) -> u64 {
        u64::from(self.payload_words) + u64::from(self.has_criterion)
    }
}

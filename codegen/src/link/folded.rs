//! The result of folding a function.

use super::fold::Substitute;

/// A function after folding.
#[derive(Clone, Debug)]
pub(super) struct FoldedFunction {
    pub(super) text: String,
    /// For each line, its line in the item before folding, from 0.
    pub(super) lines: Vec<usize>,
    pub(super) mentions: Vec<String>,
    pub(super) substitute: Substitute,
    pub(super) has_effects: bool,
}

//! The words that a property observes at every instant.
//!
//! Input: a property. Output: whether an access is to such a word. A search of a reduced set of interleavings follows both orders
//! of two writes of watched words, because memory between them differs.

use fragbuf_interpreter::Access;

use crate::context::SearchContext;
use crate::search::Property;

/// Per ordered word, whether the property observes it at every instant.
pub(crate) struct WatchedWords(Vec<bool>);

impl WatchedWords {
    /// Returns the words that a property observes.
    pub(crate) fn new(context: &SearchContext<'_>, property: &dyn Property) -> Self {
        let mut watched = vec![false; context.ordered];
        for range in property.watched() {
            watched[range.start.min(context.ordered)..range.end.min(context.ordered)].fill(true);
        }
        WatchedWords(watched)
    }

    /// Returns whether the property observes a word of an access.
    pub(crate) fn contains(&self, context: &SearchContext<'_>, access: &Access) -> bool {
        let Some(first) = context.word(access.address) else { return false };
        (first..first + usize::from(access.words)).any(|word| self.0.get(word).copied().unwrap_or(false))
    }
}

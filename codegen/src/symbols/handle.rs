//! The handles of symbols. Those that every plan has are constants, checked by the compiler against the vocabulary.

use fragbuf_templates::vocabulary::SYMBOLS;

/// The handle of a symbol of a plan: its index in the [`SymbolTable`](super::SymbolTable).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SymbolId(pub(super) u16);

impl SymbolId {
    /// Columns of the frame.
    pub const WIDTH: SymbolId = builtin("width");
    /// Rows of the frame, or of a slice.
    pub const HEIGHT: SymbolId = builtin("height");
    /// The first row of a slice.
    pub const FIRST_ROW: SymbolId = builtin("first_row");
    /// Pixels of the frame and of its padding.
    pub const PIXELS: SymbolId = builtin("pixels");
    /// Fragments that a pixel keeps.
    pub const K: SymbolId = builtin("k");
    /// Slots of each pixel in a fixed array.
    pub const N: SymbolId = builtin("n");
    /// Fragments that fit in a pool.
    pub const FRAGMENTS: SymbolId = builtin("fragments");
    /// Fragments that fit in exact regions.
    pub const KEPT: SymbolId = builtin("kept");
    /// The iteration of the innermost loop.
    pub const ITERATION: SymbolId = builtin("iteration");
    /// The largest k that the code supports.
    pub const CAPACITY: SymbolId = builtin("capacity");
    /// Words of a stored fragment.
    pub const ENTRY_WORDS: SymbolId = builtin("entry_words");
    /// Words of a stored fragment without its key.
    pub const VALUE_WORDS: SymbolId = builtin("value_words");

    /// Returns the index in the table.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// Returns the handle of a symbol that every plan has. A name that is not in the table does not compile.
const fn builtin(name: &str) -> SymbolId {
    let mut index = 0;
    while index < SYMBOLS.len() {
        if is_equal(SYMBOLS[index].name.as_bytes(), name.as_bytes()) {
            return SymbolId(index as u16);
        }
        index += 1;
    }
    // Evaluated only by the compiler, which reports the panic as an error.
    #[allow(clippy::panic, reason = "an error at compile time")]
    {
        panic!("not a symbol of the vocabulary")
    }
}

const fn is_equal(a: &[u8], b: &[u8]) -> bool {
    let mut index = 0;
    while index < a.len() && index < b.len() && a[index] == b[index] {
        index += 1;
    }
    index == a.len() && index == b.len()
}

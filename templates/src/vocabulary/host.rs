//! What the host decides between two submissions: a step of a frame, and the function behind it.
//!
//! In: words that passes have left, and the values of symbols. Out: new values of symbols. A function is a row of the axis
//! `host`, so that a row of one's own can bring one; it allocates nothing and sees no device.

use std::fmt;

use super::Formula;

/// A decision of the host between two submissions.
#[derive(Clone, Debug, PartialEq)]
pub struct Host {
    /// The function, a key of the axis `host`.
    pub function: String,
    /// The words that it reads back, in order.
    pub reads: Vec<Read>,
    /// The symbols that it sets, in order.
    pub sets: Vec<String>,
}

/// Words of a resource.
#[derive(Clone, Debug, PartialEq)]
pub struct Read {
    /// The resource.
    pub resource: String,
    /// Which of its words.
    pub words: Words,
}

/// Which words of a resource the host reads.
#[derive(Clone, Debug, PartialEq)]
pub enum Words {
    /// All of them.
    All,
    /// Some, by the index of the first and their number.
    Some {
        /// The first.
        first: Formula,
        /// How many.
        count: Formula,
    },
}

impl Host {
    /// A step that calls `function`.
    pub fn new(function: &str) -> Self {
        Host { function: function.to_owned(), reads: Vec::new(), sets: Vec::new() }
    }

    /// Reads one word of `resource`.
    pub fn reads_word(self, resource: &str, index: impl Into<Formula>) -> Self {
        self.reads_some(resource, index, "1")
    }

    /// Reads `count` words of `resource` from `first` on.
    pub fn reads_some(mut self, resource: &str, first: impl Into<Formula>, count: impl Into<Formula>) -> Self {
        let words = Words::Some { first: first.into(), count: count.into() };
        self.reads.push(Read { resource: resource.to_owned(), words });
        self
    }

    /// Reads all words of `resource`.
    pub fn reads_all(mut self, resource: &str) -> Self {
        self.reads.push(Read { resource: resource.to_owned(), words: Words::All });
        self
    }

    /// Sets `symbol`.
    pub fn sets(mut self, symbol: &str) -> Self {
        self.sets.push(symbol.to_owned());
        self
    }
}

/// What a host function is given.
pub struct HostCall<'a> {
    /// The words of each read, in the order of [`Host::reads`].
    pub reads: Vec<&'a [u32]>,
    /// The value of a symbol, the parameters of the chosen rows by their constants included; `None`: it has none.
    pub symbol: &'a dyn Fn(&str) -> Option<u64>,
}

/// A host function: from what it is given to one value per symbol of [`Host::sets`]. Values that are missing leave their
/// symbols as they are; values beyond a symbol's range are refused by the frame.
#[derive(Clone, Copy)]
pub struct HostFunction(pub fn(&HostCall<'_>) -> Vec<u64>);

impl fmt::Debug for HostFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("HostFunction")
    }
}

/// Rows are compared by what they say; a function's address says nothing.
impl PartialEq for HostFunction {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

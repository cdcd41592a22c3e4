//! Decisions of the host between two submissions: a step of a frame, and the function that it calls.
//!
//! Input: words that passes wrote, and values of symbols. Output: new values of symbols. A function is a row of the
//! axis `host`, so a user row can supply one. It allocates nothing and has no access to a device.

use std::fmt;

use super::Formula;

/// A decision of the host between two submissions.
#[derive(Clone, Debug, PartialEq)]
pub struct Host {
    /// The function: a key of the axis `host`.
    pub function: String,
    /// The words to read back, in order.
    pub reads: Vec<Read>,
    /// The symbols to set, in order.
    pub sets: Vec<String>,
    /// Whether a frame may use the values that the words of an earlier frame gave, so that it need not wait for its own: any values in
    /// the range of the symbols must give a correct frame.
    pub may_lag: bool,
}

/// A range of words of a resource that the host reads back.
#[derive(Clone, Debug, PartialEq)]
pub struct Read {
    /// The resource.
    pub resource: String,
    /// The words.
    pub words: Words,
}

/// The words of a resource that the host reads.
#[derive(Clone, Debug, PartialEq)]
pub enum Words {
    /// All words.
    All,
    /// A range.
    Some {
        /// The index of the first word.
        first: Formula,
        /// The number of words.
        count: Formula,
    },
}

impl Host {
    /// Makes a step that calls `function`.
    pub fn new(function: &str) -> Self {
        Host { function: function.to_owned(), reads: Vec::new(), sets: Vec::new(), may_lag: false }
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

    /// Allows the values of an earlier frame ([`Host::may_lag`]).
    pub fn lags(mut self) -> Self {
        self.may_lag = true;
        self
    }
}

/// The arguments of a host function.
pub struct HostCall<'a> {
    /// The words of each read, in the order of [`Host::reads`].
    pub reads: Vec<&'a [u32]>,
    /// Returns the value of a symbol, including parameters of the chosen rows by their constants; `None` if it has
    /// none.
    pub symbol: &'a dyn Fn(&str) -> Option<u64>,
    /// Returns the bytes of all buffers of the frame, or of a slice, if these symbols had these values; `None` if a size has no
    /// value. Textures, and the memory that a device needs beside the plan's resources, are not included.
    pub bytes: &'a BytesOf<'a>,
}

/// Returns bytes for assumed values of symbols.
pub type BytesOf<'a> = dyn Fn(&[(&str, u64)]) -> Option<u64> + 'a;

/// A host function. It returns one value per symbol of [`Host::sets`], or why the frame cannot go on and how to fix it. A missing
/// value leaves its symbol unchanged; the frame rejects values beyond a symbol's range.
#[derive(Clone, Copy)]
pub struct HostFunction(pub fn(&HostCall<'_>) -> Result<Vec<u64>, String>);

impl fmt::Debug for HostFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("HostFunction")
    }
}

/// All host functions are equal: rows are compared by their data, and the address of a function is no data.
impl PartialEq for HostFunction {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

//! The history of one word: its writes in modification order, and the accesses that a later one must not race with.

use std::cell::Cell;
use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use std::rc::Rc;

use crate::fingerprint::Lanes;

use super::view::View;

/// How many writes of one value to one word memory keeps. A loop that writes the same values again and again would otherwise have
/// infinitely many states. Every older write of the word is forgotten, too, so a search in which that occurs is not exhaustive.
pub(crate) const REPEATED: usize = 6;

/// The history of one word. Position 0 is the oldest write that a running fragment may still observe.
#[derive(Clone, Debug)]
pub(crate) struct History {
    pub(crate) writes: Vec<Write>,
    /// The accesses since the last plain write that a later one may race with.
    pub(crate) accesses: Vec<Recorded>,
    /// The hash of both, or 0 if it is not computed yet.
    hash: Cell<u128>,
}

impl PartialEq for History {
    fn eq(&self, other: &Self) -> bool {
        self.writes == other.writes && self.accesses == other.accesses
    }
}

impl Eq for History {}

impl Hash for History {
    fn hash<H: Hasher>(&self, state: &mut H) {
        if self.hash.get() == 0 {
            let mut lanes = Lanes::default();
            (&self.writes, &self.accesses).hash(&mut lanes);
            self.hash.set(lanes.both().max(1));
        }
        state.write_u128(self.hash.get());
    }
}

/// One write.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Write {
    pub(crate) value: u64,
    /// Whether it is a read-modify-write of the write before it, so that no write comes between them.
    pub(crate) follows: bool,
    /// What a reader has observed after its next fence.
    pub(crate) view: View,
    /// For a plain write, its writer.
    pub(crate) plain: Option<Accessor>,
}

/// A fragment, and whether it was inside of the interlock's critical section.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Accessor {
    pub(crate) fragment: u8,
    pub(crate) in_section: bool,
}

/// The kind of a recorded access. Plain writes are in the history itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum AccessKind {
    PlainRead,
    /// Only of words that also have plain accesses, as `AtomicWrite`.
    AtomicRead,
    AtomicWrite,
}

/// A recorded access.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Recorded {
    pub(crate) kind: AccessKind,
    pub(crate) accessor: Accessor,
    /// The epoch of the accessor: how many of its fences came before, as far as that matters.
    pub(crate) epoch: u32,
}

impl History {
    /// Returns a history of one write, which every fragment has observed.
    pub(crate) fn new(value: u64) -> Self {
        History {
            writes: vec![Write { value, follows: false, view: View::default(), plain: None }],
            accesses: Vec::new(),
            hash: Cell::new(0),
        }
    }

    /// Returns a shared history to change.
    pub(crate) fn to_change(shared: &mut Rc<History>) -> &mut History {
        let history = Rc::make_mut(shared);
        history.hash.set(0);
        history
    }

    /// Returns whether it holds nothing but a value.
    pub(crate) fn is_trivial(&self) -> bool {
        matches!(&self.writes[..], [write] if write.view.is_empty()) && self.accesses.is_empty()
    }

    pub(crate) fn last(&self) -> u32 {
        self.writes.len() as u32 - 1
    }

    /// Returns whether the write after a position is a read-modify-write of the write there.
    pub(crate) fn is_followed(&self, at: u32) -> bool {
        self.writes.get(at as usize + 1).is_some_and(|next| next.follows)
    }

    /// Returns the least position from which on no value was written more than [`REPEATED`] times. Plain writes stay, because a
    /// later access may race with them.
    pub(crate) fn repeated_before(&self) -> u32 {
        if self.writes.len() <= REPEATED {
            return 0;
        }
        let (mut counts, mut first) = (HashMap::new(), self.writes.len());
        while first > 0 {
            let count = counts.entry(self.writes[first - 1].value).or_insert(0);
            *count += 1;
            if *count > REPEATED {
                break;
            }
            first -= 1;
        }
        let plain = self.writes[1..].iter().position(|write| write.plain.is_some());
        first.min(plain.unwrap_or(first)) as u32
    }

    /// Removes the writes before a position.
    pub(crate) fn forget_before(&mut self, at: u32) {
        self.writes.drain(..at as usize);
        self.writes[0].follows = false;
        if self.writes.len() == 1 {
            self.writes[0].plain = None;
        }
    }
}

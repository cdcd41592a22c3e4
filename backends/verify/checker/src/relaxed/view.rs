//! Views: what a fragment, or a reader of a write, must have observed.

use std::hash::{Hash, Hasher};
use std::rc::Rc;

use crate::fingerprint::Lanes;

/// A map from a key to a number, where absent keys have 0. Keys are words, with positions in their histories, and the clocks of
/// fragments, with epochs. Entries are sorted by key. Copies share them until one changes; an empty map has none.
#[derive(Clone, Debug, Default)]
pub(crate) struct View(Option<Rc<Entries>>);

/// The entries of a view that is not empty.
#[derive(Clone, Debug, Default)]
struct Entries {
    sorted: Vec<(u32, u32)>,
    /// The sum of the hashes of all entries.
    hash: u128,
}

/// Returns the hash of an entry, spread over all bits. An entry of the number 0 is absent, and has the hash 0.
fn entry_hash((key, number): (u32, u32)) -> u128 {
    if number == 0 {
        return 0;
    }
    let mut lanes = Lanes::default();
    lanes.write_u64(u64::from(key) << 32 | u64::from(number));
    lanes.write_u64(0);
    lanes.write_u64(0);
    lanes.both()
}

impl PartialEq for View {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (None, None) => true,
            (Some(one), Some(other)) => {
                Rc::ptr_eq(one, other) || (one.hash == other.hash && one.sorted == other.sorted)
            }
            _ => false,
        }
    }
}

impl Eq for View {}

impl Hash for View {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u128(self.0.as_ref().map_or(0, |entries| entries.hash));
    }
}

/// The memory that a workgroup barrier may order by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MemoryKind {
    Storage,
    Workgroup,
}

impl MemoryKind {
    pub(crate) const ALL: [MemoryKind; 2] = [MemoryKind::Storage, MemoryKind::Workgroup];
}

/// The least key of a clock. Words have lower keys.
const CLOCKS: u32 = 1 << 31;

/// The key of a fragment's clock, which numbers its plain reads of one kind of memory.
pub(crate) fn clock(fragment: usize, kind: MemoryKind) -> u32 {
    CLOCKS | (kind as u32) << 16 | fragment as u32
}

/// Returns the kind of memory of a clock. `None`: the key is a word.
pub(crate) fn kind_of_clock(key: u32) -> Option<MemoryKind> {
    (key >= CLOCKS).then(|| MemoryKind::ALL[(key >> 16 & 1) as usize])
}

/// Returns whether a key is a clock of a fragment.
pub(crate) fn is_clock_of(key: u32, fragment: usize) -> bool {
    key >= CLOCKS && key & 0xffff == fragment as u32
}

/// Returns the fragment of a clock. `None`: the key is a word.
pub(crate) fn fragment_of_clock(key: u32) -> Option<usize> {
    (key >= CLOCKS).then_some((key & 0xffff) as usize)
}

impl View {
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_none()
    }

    fn entries(&self) -> &[(u32, u32)] {
        self.0.as_ref().map_or(&[], |entries| &entries.sorted)
    }

    fn find(&self, key: u32) -> Result<usize, usize> {
        self.entries().binary_search_by_key(&key, |entry| entry.0)
    }

    pub(crate) fn get(&self, key: u32) -> u32 {
        self.find(key).map_or(0, |at| self.entries()[at].1)
    }

    /// Raises the number of a key to at least `to`.
    pub(crate) fn raise(&mut self, key: u32, to: u32) {
        if to == 0 {
            return;
        }
        let found = self.find(key);
        if found.is_ok_and(|at| self.entries()[at].1 >= to) {
            return;
        }
        let Entries { sorted, hash } = Rc::make_mut(self.0.get_or_insert_default());
        match found {
            Ok(at) => {
                *hash = hash.wrapping_sub(entry_hash(sorted[at]));
                sorted[at].1 = to;
            }
            Err(at) => sorted.insert(at, (key, to)),
        }
        *hash = hash.wrapping_add(entry_hash((key, to)));
    }

    pub(crate) fn join(&mut self, other: &View) {
        self.join_where(other, |_| true);
    }

    /// Joins the keys of `other` that satisfy a condition.
    pub(crate) fn join_where(&mut self, other: &View, condition: impl Fn(u32) -> bool) {
        if self.is_empty() && other.entries().iter().all(|(key, _)| condition(*key)) {
            self.0.clone_from(&other.0);
            return;
        }
        for (key, to) in other.entries().iter().filter(|(key, _)| condition(*key)) {
            self.raise(*key, *to);
        }
    }

    /// Raises both clocks of a fragment to at least `epoch`.
    pub(crate) fn raise_clocks(&mut self, fragment: usize, epoch: u32) {
        MemoryKind::ALL.iter().for_each(|kind| self.raise(clock(fragment, *kind), epoch));
    }

    /// Returns whether no number of `other` is greater than that of the same key here, except for one key.
    pub(crate) fn covers_except(&self, other: &View, key: u32) -> bool {
        other.entries().iter().all(|(other, to)| *other == key || self.get(*other) >= *to)
    }

    /// Keeps the entries that are greater than those of `other`.
    pub(crate) fn keep_above(&mut self, other: &View) {
        self.map_all(|key, number| if other.get(key) < number { number } else { 0 });
    }

    /// Makes room for a write at a position of a word's history.
    pub(crate) fn shift(&mut self, word: u32, from: u32) {
        self.map_all(|key, position| position + u32::from(key == word && position >= from));
    }

    /// Returns whether a function of the entries changes a number.
    pub(crate) fn is_changed_by(&self, new: impl Fn(u32, u32) -> u32) -> bool {
        self.entries().iter().any(|(key, number)| new(*key, *number) != *number)
    }

    /// Replaces every number by a function of its key and itself.
    pub(crate) fn map_all(&mut self, new: impl Fn(u32, u32) -> u32) {
        if !self.is_changed_by(&new) {
            return;
        }
        let Entries { sorted, hash } = Rc::make_mut(self.0.get_or_insert_default());
        for entry in sorted.iter_mut() {
            let number = new(entry.0, entry.1);
            if number != entry.1 {
                *hash = hash.wrapping_sub(entry_hash(*entry));
                entry.1 = number;
                *hash = hash.wrapping_add(entry_hash(*entry));
            }
        }
        sorted.retain(|(_, number)| *number != 0);
        if sorted.is_empty() {
            self.0 = None;
        }
    }
}

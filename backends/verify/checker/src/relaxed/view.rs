//! Views: what a fragment, or a reader of a write, must have observed.

/// A map from a key to a number, where absent keys have 0. Keys are words, with positions in their histories, and the clocks of
/// fragments, with epochs.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct View(Vec<(u32, u32)>);

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

impl View {
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn get(&self, key: u32) -> u32 {
        self.0.binary_search_by_key(&key, |entry| entry.0).map_or(0, |at| self.0[at].1)
    }

    /// Raises the number of a key to at least `to`.
    pub(crate) fn raise(&mut self, key: u32, to: u32) {
        if to == 0 {
            return;
        }
        match self.0.binary_search_by_key(&key, |entry| entry.0) {
            Ok(at) => self.0[at].1 = self.0[at].1.max(to),
            Err(at) => self.0.insert(at, (key, to)),
        }
    }

    pub(crate) fn join(&mut self, other: &View) {
        self.join_where(other, |_| true);
    }

    /// Joins the keys of `other` that satisfy a condition.
    pub(crate) fn join_where(&mut self, other: &View, condition: impl Fn(u32) -> bool) {
        for (key, to) in other.0.iter().filter(|(key, _)| condition(*key)) {
            self.raise(*key, *to);
        }
    }

    /// Raises both clocks of a fragment to at least `epoch`.
    pub(crate) fn raise_clocks(&mut self, fragment: usize, epoch: u32) {
        MemoryKind::ALL.iter().for_each(|kind| self.raise(clock(fragment, *kind), epoch));
    }

    /// Returns whether no number of `other` is greater than that of the same key here, except for one key.
    pub(crate) fn covers_except(&self, other: &View, key: u32) -> bool {
        other.0.iter().all(|(other, to)| *other == key || self.get(*other) >= *to)
    }

    /// Keeps the entries that are greater than those of `other`.
    pub(crate) fn keep_above(&mut self, other: &View) {
        self.0.retain(|(key, to)| other.get(*key) < *to);
    }

    /// Makes room for a write at a position of a word's history.
    pub(crate) fn shift(&mut self, word: u32, from: u32) {
        if let Ok(at) = self.0.binary_search_by_key(&word, |entry| entry.0)
            && self.0[at].1 >= from
        {
            self.0[at].1 += 1;
        }
    }

    /// Replaces the number of a key by a function of it.
    pub(crate) fn map(&mut self, key: u32, new: impl Fn(u32) -> u32) {
        if let Ok(at) = self.0.binary_search_by_key(&key, |entry| entry.0) {
            match new(self.0[at].1) {
                0 => {
                    self.0.remove(at);
                }
                number => self.0[at].1 = number,
            }
        }
    }
}

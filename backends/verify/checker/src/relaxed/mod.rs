//! Relaxed memory: which writes an access may observe, and which accesses are data races.
//!
//! Each word that is accessed has a history of writes in modification order, and each fragment has a view: per word, the
//! oldest write that it may still observe. Nothing but views orders accesses.
//!
//! * An atomic load observes any write from its view on.
//! * An atomic store takes any position after its view, so a store may come before stores that were executed earlier.
//! * An atomic read-modify-write observes any such write that no other read-modify-write has taken, and comes right after it.
//! * A compare-exchange that fails is a load. A weak one may also fail although it observes the expected value.
//! * A fence adds the views of all observed writes to the fragment's view, and passes that view on with all later atomic
//!   writes. A read-modify-write also passes on the view of the write that it observes (release sequences).
//! * A plain access must have every write of its word in its view, and a plain write must come after every plain read.
//!   Otherwise it is a data race. No fence adds words that are not coherent to a view.
//! * A word with both kinds of accesses records the atomic ones, too: a plain access and an atomic one of which one writes are a
//!   data race unless they are ordered.
//! * A workgroup barrier adds the views of all members of the workgroup to each, for the memory that it orders.
//! * The interlock adds what fragments have accessed inside of their critical sections, until the section ends.

mod history;
mod order;
mod races;
mod view;

use std::rc::Rc;

use fragbuf_interpreter::{Access, Atomic, Operation};

pub(crate) use history::REPEATED;
use history::{History, Write};
use view::{MemoryKind, View};

/// The memory of all words whose order matters.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct RelaxedMemory {
    /// The histories that hold more than the value of their word, by word.
    histories: Vec<(u32, Rc<History>)>,
    fragments: Vec<Views>,
    /// What fragments have accessed inside of critical sections.
    sections: View,
    /// The first word of workgroup memory. Words before it are in storage buffers.
    first_of_workgroups: u32,
}

/// The views of a fragment.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
struct Views {
    /// The oldest write that the fragment may observe.
    current: View,
    /// The views of observed writes, which the next fence adds to `current`.
    observed: View,
    /// What the fragment's writes pass on.
    released: View,
    /// Inside of a critical section, the view without what the interlock has added.
    outside: Option<View>,
    /// The number of the fragment's fences, as far as it distinguishes recorded accesses.
    epoch: u32,
}

impl Views {
    /// Returns the view that remains after the critical section.
    fn lasting(&self) -> &View {
        self.outside.as_ref().unwrap_or(&self.current)
    }
}

/// One way to perform an access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// A load of the write at this position.
    Load(u32),
    /// A store at this position.
    Store(u32),
    /// A read-modify-write of the write at this position.
    Modify(u32),
    /// A compare-exchange that observes the write at this position and fails.
    Fail(u32),
}

/// What an access has observed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Observed {
    Value(u64),
    /// A compare-exchange has failed although the word holds this value, which it expects.
    Spurious(u64),
    /// The access and one of this fragment are a data race.
    Race(usize),
}

impl RelaxedMemory {
    /// Returns memory that every fragment has observed. `first_of_workgroups`: its first word of workgroup memory.
    pub(crate) fn new(fragments: usize, first_of_workgroups: u32) -> Self {
        let views = Views { epoch: 1, ..Views::default() };
        let fragments = vec![views; fragments];
        RelaxedMemory { histories: Vec::new(), fragments, sections: View::default(), first_of_workgroups }
    }

    fn kind(&self, word: u32) -> MemoryKind {
        if word < self.first_of_workgroups { MemoryKind::Storage } else { MemoryKind::Workgroup }
    }

    /// Returns whether no access has left anything that orders, or may race with, another.
    pub(crate) fn is_trivial(&self) -> bool {
        self.histories.is_empty() && self.fragments.iter().all(|views| views.epoch == 1 && views.outside.is_none())
    }

    /// Returns in how many ways an access can be performed; `value` is the last value of the word. `is_weak`: a compare-exchange
    /// may fail for no reason.
    pub(crate) fn count_ways(&self, fragment: usize, word: u32, access: &Access, value: u64, is_weak: bool) -> u32 {
        let mut count = 0;
        self.each_way(fragment, word, access, (value, is_weak), |_| count += 1);
        count
    }

    /// Returns the way of a number, the latest write first. Numbers beyond the last way mean the last.
    pub(crate) fn way(&self, fragment: usize, word: u32, access: &Access, of: (u64, bool), number: u32) -> Option<Way> {
        let (mut count, mut found) = (0, None);
        self.each_way(fragment, word, access, of, |way| {
            if count <= number {
                found = Some(way);
            }
            count += 1;
        });
        found
    }

    /// Calls `visit` with each way in which an atomic access can be performed, the latest write first. A plain access can be
    /// performed in one way.
    fn each_way(
        &self,
        fragment: usize,
        word: u32,
        access: &Access,
        (value, is_weak): (u64, bool),
        mut visit: impl FnMut(Way),
    ) {
        let history = self.history(word);
        let last = history.map_or(0, History::last);
        let is_followed = |at: u32| history.is_some_and(|history| history.is_followed(at));
        let oldest = self.fragments[fragment].current.get(word);
        let observable = (oldest..=last).rev();
        match access.operation {
            Operation::Load if access.is_atomic => observable.map(Way::Load).for_each(visit),
            Operation::Load => visit(Way::Load(last)),
            Operation::Store if !access.is_atomic => visit(Way::Store(last + 1)),
            Operation::Store => observable.filter(|at| !is_followed(*at)).for_each(|at| visit(Way::Store(at + 1))),
            Operation::Atomic(Atomic::CompareExchange) => {
                for at in observable {
                    let found = history.map_or(value, |history| history.writes[at as usize].value);
                    let succeeds = truncated(found, access) == truncated(access.expected, access);
                    if succeeds && !is_followed(at) {
                        visit(Way::Modify(at));
                    }
                    if !succeeds || is_weak {
                        visit(Way::Fail(at));
                    }
                }
            }
            Operation::Atomic(_) => observable.filter(|at| !is_followed(*at)).for_each(|at| visit(Way::Modify(at))),
        }
    }

    /// Performs an access in one of its ways. `is_mixed`: the word has both plain and atomic accesses.
    pub(crate) fn perform(
        &mut self,
        fragment: usize,
        (word, is_mixed): (u32, bool),
        access: &Access,
        value: u64,
        way: Way,
    ) -> Observed {
        // An atomic load of a word without a history leaves nothing, unless a plain access may race with it.
        let loads = access.is_atomic && matches!(way, Way::Load(_) | Way::Fail(_));
        if loads && !is_mixed && self.history(word).is_none() {
            let value = truncated(value, access);
            let is_spurious = matches!(way, Way::Fail(_)) && value == truncated(access.expected, access);
            return if is_spurious { Observed::Spurious(value) } else { Observed::Value(value) };
        }
        let at = self.materialise(word, value);
        if let Some(other) = self.racing(fragment, (word, is_mixed), at, access) {
            return Observed::Race(other);
        }
        self.record(fragment, at, access, is_mixed);
        match way {
            Way::Load(position) | Way::Fail(position) => {
                let write = &self.histories[at].1.writes[position as usize];
                let value = truncated(write.value, access);
                if access.is_atomic {
                    let view = write.view.clone();
                    self.fragments[fragment].observed.join(&view);
                }
                self.advance(fragment, word, position);
                let is_spurious = matches!(way, Way::Fail(_)) && value == truncated(access.expected, access);
                if is_spurious { Observed::Spurious(value) } else { Observed::Value(value) }
            }
            Way::Store(position) => {
                let view = if access.is_atomic { self.fragments[fragment].released.clone() } else { View::default() };
                let plain = (!access.is_atomic).then(|| self.accessor(fragment));
                if plain.is_none() || !self.overwrite(fragment, word, at, access.value) {
                    self.insert(
                        fragment,
                        (word, at),
                        position,
                        Write { value: access.value, follows: false, view, plain },
                    );
                }
                if plain.is_some() {
                    History::to_change(&mut self.histories[at].1).accesses.clear();
                }
                Observed::Value(0)
            }
            Way::Modify(position) => {
                let read = self.histories[at].1.writes[position as usize].clone();
                let old = truncated(read.value, access);
                let value = access.new_value(old);
                let views = &mut self.fragments[fragment];
                let mut view = views.released.clone();
                views.observed.join(&read.view);
                view.join(&read.view);
                // A write that repeats the value and passes on nothing more cannot be told from the write before it.
                match value == read.value && read.view.covers_except(&view, word) {
                    true => self.advance(fragment, word, position),
                    false => {
                        let write = Write { value, follows: true, view, plain: None };
                        self.insert(fragment, (word, at), position + 1, write);
                    }
                }
                Observed::Value(old)
            }
        }
    }

    /// Performs an access at once, where every atomic operation synchronises; `value` is the last value of the word. `is_done`:
    /// it is no compare-exchange that fails for no reason. Returns a fragment with an access that this one is a data race with.
    pub(crate) fn perform_at_once(
        &mut self,
        fragment: usize,
        (word, is_mixed): (u32, bool),
        access: &Access,
        value: u64,
        is_done: bool,
    ) -> Option<usize> {
        if !access.is_atomic {
            let last = self.history(word).map_or(0, History::last);
            let way = if access.writes() { Way::Store(last + 1) } else { Way::Load(last) };
            return match self.perform(fragment, (word, is_mixed), access, value, way) {
                Observed::Race(other) => Some(other),
                _ => None,
            };
        }
        if !access.writes() && !is_mixed && self.history(word).is_none() {
            return None;
        }
        let at = self.materialise(word, value);
        if let Some(other) = self.racing(fragment, (word, is_mixed), at, access) {
            return Some(other);
        }
        self.record(fragment, at, access, is_mixed);
        if access.operation != Operation::Store {
            self.acquire(fragment, at);
        }
        let exchanges = access.operation == Operation::Atomic(Atomic::CompareExchange);
        if access.writes() && is_done && (!exchanges || value == truncated(access.expected, access)) {
            self.release(fragment, at);
        }
        None
    }

    /// Returns whether another write of a value to a word may remove a write that a fragment can observe.
    pub(crate) fn may_forget(&self, word: u32, value: u64) -> bool {
        let count = |history: &History| history.writes.iter().filter(|write| write.value == value).count();
        self.history(word).is_some_and(|history| count(history) >= REPEATED)
    }

    /// Returns the last value of a word that has a history.
    pub(crate) fn last(&self, word: u32) -> Option<u64> {
        self.history(word)?.writes.last().map(|write| write.value)
    }

    fn history(&self, word: u32) -> Option<&History> {
        let at = self.histories.binary_search_by_key(&word, |entry| entry.0).ok()?;
        Some(&self.histories[at].1)
    }

    /// Returns the index of a word's history, which is made if it is not there.
    fn materialise(&mut self, word: u32, value: u64) -> usize {
        self.histories.binary_search_by_key(&word, |entry| entry.0).unwrap_or_else(|at| {
            self.histories.insert(at, (word, Rc::new(History::new(value))));
            at
        })
    }

    /// Records that a fragment has observed or written the write at a position.
    fn advance(&mut self, fragment: usize, word: u32, position: u32) {
        let views = &mut self.fragments[fragment];
        views.current.raise(word, position);
        if let Some(outside) = &mut views.outside {
            outside.raise(word, position);
            self.sections.raise(word, position);
        }
    }

    /// Replaces the value of the fragment's own last plain write, if no other fragment can have its position in a view.
    fn overwrite(&mut self, fragment: usize, word: u32, at: usize, value: u64) -> bool {
        let (accessor, position) = (self.accessor(fragment), self.histories[at].1.last());
        let has = |view: &View| view.get(word) >= position;
        let is_known = has(&self.fragments[fragment].released)
            || self.fragments.iter().enumerate().any(|(other, views)| {
                other != fragment && (has(&views.current) || views.outside.as_ref().is_some_and(has))
            });
        let own = |write: &Write| write.plain == Some(accessor) && !is_known;
        if !self.histories[at].1.writes.last().is_some_and(own) {
            return false;
        }
        let last = History::to_change(&mut self.histories[at].1).writes.last_mut();
        last.map(|write| write.value = value).is_some()
    }

    fn insert(&mut self, fragment: usize, (word, at): (u32, usize), position: u32, mut write: Write) {
        // No view has a position beyond the last write.
        if position <= self.histories[at].1.last() {
            self.each_view(|key, number| number + u32::from(key == word && number >= position));
            write.view.shift(word, position);
        }
        if write.plain.is_none() {
            write.view.raise(word, position);
        }
        History::to_change(&mut self.histories[at].1).writes.insert(position as usize, write);
        self.advance(fragment, word, position);
    }

    /// Replaces every number in every view by a function of its key and itself.
    fn each_view(&mut self, new: impl Fn(u32, u32) -> u32) {
        for (_, history) in &mut self.histories {
            if history.writes.iter().any(|write| write.view.is_changed_by(&new)) {
                History::to_change(history).writes.iter_mut().for_each(|write| write.view.map_all(&new));
            }
        }
        for views in &mut self.fragments {
            let Views { current, observed, released, outside, .. } = views;
            [current, observed, released].into_iter().chain(outside).for_each(|view| view.map_all(&new));
        }
        self.sections.map_all(&new);
    }
}

/// Returns as much of a value as the access is wide.
fn truncated(value: u64, access: &Access) -> u64 {
    if access.words == 2 { value } else { value & u64::from(u32::MAX) }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests;

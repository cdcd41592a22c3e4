//! Data races: which accesses of a word are recorded, and which earlier one a new access races with.
//!
//! A plain write is a part of the word's history, which the views of fragments order. The other accesses are recorded with the epoch of
//! their fragment, and the clocks in views order them.

use fragbuf_interpreter::Access;

use super::RelaxedMemory;
use super::history::{AccessKind, Accessor, History, Recorded};
use super::view::clock;

impl RelaxedMemory {
    pub(super) fn accessor(&self, fragment: usize) -> Accessor {
        Accessor { fragment: fragment as u8, in_section: self.fragments[fragment].outside.is_some() }
    }

    /// Returns a fragment with an earlier access that this one is a data race with.
    pub(super) fn racing(
        &self,
        fragment: usize,
        (word, is_mixed): (u32, bool),
        at: usize,
        access: &Access,
    ) -> Option<usize> {
        if access.is_atomic && !is_mixed {
            return None;
        }
        let history = &self.histories[at].1;
        let views = &self.fragments[fragment];
        let unseen = history.writes.iter().skip(views.current.get(word) as usize + 1);
        let writer = unseen.filter_map(|write| write.plain).next();
        let is_ordered = |one: &Recorded| {
            let other = usize::from(one.accessor.fragment);
            other == fragment
                || views.current.get(clock(other, self.kind(word))) >= one.epoch
                || (one.accessor.in_section && views.outside.is_some())
        };
        let conflicts = |one: &Recorded| match one.kind {
            AccessKind::PlainRead => access.writes(),
            AccessKind::AtomicRead => access.writes() && !access.is_atomic,
            AccessKind::AtomicWrite => !access.is_atomic,
        };
        let other = history.accesses.iter().find(|one| conflicts(one) && !is_ordered(one));
        writer.or(other.map(|one| one.accessor)).map(|accessor| usize::from(accessor.fragment))
    }

    /// Records an access that a later one may race with.
    pub(super) fn record(&mut self, fragment: usize, at: usize, access: &Access, is_mixed: bool) {
        let kind = match (access.is_atomic, access.writes()) {
            (false, false) => AccessKind::PlainRead,
            (true, false) if is_mixed => AccessKind::AtomicRead,
            (true, true) if is_mixed => AccessKind::AtomicWrite,
            _ => return,
        };
        let (accessor, epoch) = (self.accessor(fragment), self.fragments[fragment].epoch);
        let is_known = |one: &Recorded| one.accessor == accessor && one.kind == kind && one.epoch == epoch;
        if self.histories[at].1.accesses.iter().any(is_known) {
            return;
        }
        let accesses = &mut History::to_change(&mut self.histories[at].1).accesses;
        match accesses.iter_mut().find(|one| one.accessor == accessor && one.kind == kind) {
            Some(one) => one.epoch = epoch,
            None => {
                accesses.push(Recorded { kind, accessor, epoch });
                accesses.sort_unstable_by_key(|one| (one.accessor.fragment, one.accessor.in_section, one.kind));
            }
        }
    }
}

//! Fences, barriers and critical sections of relaxed memory, and the removal of what no fragment can observe.

use fragbuf_interpreter::{Barrier, Event};

use super::history::{History, Recorded};
use super::view::{MemoryKind, View, clock, fragment_of_clock, is_clock_of, kind_of_clock};
use super::{RelaxedMemory, Views};

impl RelaxedMemory {
    /// Performs an event that is not an access. `is_private`: the word is neither atomic nor coherent.
    pub(crate) fn order(&mut self, fragment: usize, event: &Event, is_private: impl Fn(usize) -> bool) {
        let views = &mut self.fragments[fragment];
        let is_shared = |key: u32| match kind_of_clock(key) {
            None => !is_private(key as usize),
            Some(_) => !is_clock_of(key, fragment),
        };
        match event {
            Event::Fence => {
                views.current.join_where(&views.observed, is_shared);
                if let Some(outside) = &mut views.outside {
                    outside.join_where(&views.observed, is_shared);
                }
                views.observed = View::default();
                views.released = View::default();
                views.released.join_where(&views.current, is_shared);
                views.released.raise_clocks(fragment, views.epoch);
                views.epoch += 1;
            }
            Event::CriticalBegin => {
                views.outside = Some(views.current.clone());
                views.current.join_where(&self.sections, is_shared);
            }
            Event::CriticalEnd => {
                if let Some(outside) = views.outside.take() {
                    views.current = outside;
                }
            }
            Event::Access(_) | Event::Barrier(_) => {}
        }
    }

    /// Performs a workgroup barrier: each member has observed what any member has observed or accessed before it.
    pub(crate) fn barrier(&mut self, members: &[usize], barrier: Barrier) {
        let is_ordered = |kind: MemoryKind| match kind {
            MemoryKind::Storage => barrier.storage,
            MemoryKind::Workgroup => barrier.workgroup,
        };
        let mut all = View::default();
        for &member in members {
            let epoch = self.fragments[member].epoch;
            for kind in MemoryKind::ALL.into_iter().filter(|kind| is_ordered(*kind)) {
                all.raise(clock(member, kind), epoch);
            }
            let kind = |key: u32| kind_of_clock(key).unwrap_or(self.kind(key));
            all.join_where(&self.fragments[member].current, |key| is_ordered(kind(key)));
            self.fragments[member].epoch += 1;
        }
        for &member in members {
            let views = &mut self.fragments[member];
            for view in std::iter::once(&mut views.current).chain(&mut views.outside) {
                view.join_where(&all, |key| !is_clock_of(key, member));
            }
        }
    }

    /// Adds the view of the last write of a word to a fragment's view.
    pub(super) fn acquire(&mut self, fragment: usize, at: usize) {
        let RelaxedMemory { histories, fragments, .. } = self;
        let Some(write) = histories[at].1.writes.last() else { return };
        let views = &mut fragments[fragment];
        for view in std::iter::once(&mut views.current).chain(&mut views.outside) {
            view.join_where(&write.view, |key| !is_clock_of(key, fragment));
        }
    }

    /// Passes a fragment's view on with the last write of a word.
    pub(super) fn release(&mut self, fragment: usize, at: usize) {
        let views = &mut self.fragments[fragment];
        if let Some(write) = History::to_change(&mut self.histories[at].1).writes.last_mut() {
            write.view = views.current.clone();
            write.view.raise_clocks(fragment, views.epoch);
            views.epoch += 1;
        }
    }

    /// Removes what no running fragment can observe, so that equal behaviour means equal memory. Returns whether it also
    /// removed a write that one can observe, because the word has been given the same value too often since.
    pub(crate) fn forget(&mut self, is_running: impl Fn(usize) -> bool) -> bool {
        if self.histories.is_empty() {
            // No word has more than one write, so views hold nothing but clocks, and there is no access that a clock could order.
            for views in &mut self.fragments {
                let outside = views.outside.take().map(|_| View::default());
                *views = Views { epoch: 1, outside, ..Views::default() };
            }
            self.sections = View::default();
        }
        for (fragment, views) in self.fragments.iter_mut().enumerate() {
            if !is_running(fragment) {
                *views = Views { epoch: 1, ..Views::default() };
            }
        }
        self.forget_accesses(&is_running);
        let forgets = self.forget_writes(&is_running);
        for views in &mut self.fragments {
            let Views { observed, outside, current, .. } = views;
            observed.keep_above(outside.as_ref().unwrap_or(current));
        }
        self.histories.retain(|(_, history)| !history.is_trivial());
        forgets
    }

    fn forget_writes(&mut self, is_running: impl Fn(usize) -> bool) -> bool {
        let mut forgets = false;
        for at in 0..self.histories.len() {
            let word = self.histories[at].0;
            let views = self.fragments.iter().enumerate().filter(|(fragment, _)| is_running(*fragment));
            let oldest = views.map(|(_, views)| views.lasting().get(word)).min();
            let history = &self.histories[at].1;
            let observable = oldest.unwrap_or(history.last());
            let oldest = observable.max(history.repeated_before());
            forgets |= oldest > observable;
            if oldest > 0 {
                History::to_change(&mut self.histories[at].1).forget_before(oldest);
                self.each_view(|key, position| if key == word { position.saturating_sub(oldest) } else { position });
            }
        }
        forgets
    }

    /// Removes recorded accesses that every other running fragment is ordered after, and numbers the epochs of the others densely.
    fn forget_accesses(&mut self, is_running: impl Fn(usize) -> bool) {
        let has_accesses = self.histories.iter().any(|(_, history)| !history.accesses.is_empty());
        if !has_accesses && self.fragments.iter().all(|views| views.epoch == 1) {
            return;
        }
        let known: Vec<[Option<u32>; 2]> =
            (0..self.fragments.len()).map(|accessor| self.known_epochs(accessor, &is_running)).collect();
        let first_of_workgroups = self.first_of_workgroups;
        let is_lasting = |word: u32, one: &Recorded| {
            let known = known[usize::from(one.accessor.fragment)][usize::from(word >= first_of_workgroups)];
            known.is_some_and(|known| one.epoch > known)
        };
        let mut epochs: Vec<Vec<u32>> = vec![Vec::new(); self.fragments.len()];
        for (word, history) in &self.histories {
            for one in history.accesses.iter().filter(|one| is_lasting(*word, one)) {
                epochs[usize::from(one.accessor.fragment)].push(one.epoch);
            }
        }
        for epochs in &mut epochs {
            epochs.sort_unstable();
            epochs.dedup();
        }
        let dense = |fragment: usize, epoch: u32| epochs[fragment].partition_point(|other| *other <= epoch) as u32;
        let numbered = |one: &Recorded| dense(usize::from(one.accessor.fragment), one.epoch);
        for (word, history) in &mut self.histories {
            if history.accesses.iter().all(|one| is_lasting(*word, one) && numbered(one) == one.epoch) {
                continue;
            }
            let accesses = &mut History::to_change(history).accesses;
            accesses.retain(|one| is_lasting(*word, one));
            accesses.iter_mut().for_each(|one| one.epoch = numbered(one));
        }
        self.each_view(|key, epoch| fragment_of_clock(key).map_or(epoch, |fragment| dense(fragment, epoch)));
        for (views, epochs) in self.fragments.iter_mut().zip(&epochs) {
            views.epoch = epochs.partition_point(|other| *other < views.epoch) as u32 + 1;
        }
    }

    /// Returns, per kind of memory, the last epoch of a fragment that every other running fragment is ordered after. `None`: no
    /// other fragment runs.
    fn known_epochs(&self, accessor: usize, is_running: &impl Fn(usize) -> bool) -> [Option<u32>; 2] {
        MemoryKind::ALL.map(|kind| {
            let others = self.fragments.iter().enumerate();
            let others = others.filter(|(other, _)| *other != accessor && is_running(*other));
            others.map(|(_, views)| views.lasting().get(clock(accessor, kind))).min()
        })
    }
}

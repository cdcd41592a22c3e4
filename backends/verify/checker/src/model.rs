//! Memory models: which writes a load may observe.
//!
//! *Sequential*: every access is performed at once, in the order of the schedule.
//!
//! *Relaxed*: each word has a history of writes, and each fragment has a view, which is per word the oldest write that it
//! may still observe. A load observes any write from there on. A store takes any position after the view in the word's
//! history, so it may become visible after writes that were made later. Nothing but views orders accesses:
//! a fence joins the views of all observed writes into the fragment's view, and passes that view on with all later writes;
//! an interlock passes the view to its next holder; the end of a pass orders everything. Words that are neither atomic nor
//! declared coherent are ordered for other fragments by the end of the pass only. An atomic read-modify-write operates on
//! the last write and passes on that write's view. This is the relaxed part of the memory models of C++, Vulkan and WGSL,
//! without load buffering: no load observes a store that is executed later.

use fragbuf_interpreter::{Access, Event, Operation};

/// A memory model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// Sequential consistency: every access is performed at once.
    Sequential,
    /// A store may become visible later, and stores to different words may be reordered.
    Relaxed,
}

/// Per word, an index in its history.
type View = Vec<u8>;

/// The histories of all words whose order matters under the relaxed model.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct RelaxedMemory {
    histories: Vec<Vec<Write>>,
    fragments: Vec<Views>,
    /// The view that the interlock passes to its next holder.
    interlock: View,
    /// Words that are neither atomic nor coherent: only the end of the pass makes them visible to another fragment.
    private: Vec<bool>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Write {
    value: u64,
    /// Whether it is an atomic operation on the write before it, so that no write comes between them.
    follows: bool,
    view: View,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Views {
    /// The oldest write that the fragment may observe.
    current: View,
    /// The views of observed writes, which the next fence joins into `current`.
    observed: View,
    /// The view that the fragment's writes pass on.
    released: View,
}

impl RelaxedMemory {
    /// Returns histories of one write each.
    ///
    /// A word of 64 bits has the history of its lower half. No access covers only one half, because every position in a
    /// buffer has one type.
    pub(crate) fn new(words: &[u32], fragments: usize, private: Vec<bool>, wide: &[bool]) -> Self {
        let zero = vec![0; words.len()];
        let views = Views { current: zero.clone(), observed: zero.clone(), released: zero.clone() };
        let next_words = words.iter().skip(1).chain(&[0]);
        let high = next_words.zip(wide).map(|(word, is_wide)| if *is_wide { u64::from(*word) << 32 } else { 0 });
        let values = words.iter().zip(high).map(|(low, high)| u64::from(*low) | high);
        let history = |value| vec![Write { value, follows: false, view: zero.clone() }];
        let histories = values.map(history).collect();
        RelaxedMemory { histories, fragments: vec![views; fragments], interlock: zero.clone(), private }
    }

    /// Returns in how many ways the access can be performed.
    pub(crate) fn choices(&self, fragment: usize, word: usize, access: &Access) -> u32 {
        let oldest = usize::from(self.fragments[fragment].current[word]);
        match access.operation {
            Operation::Load => (self.histories[word].len() - oldest) as u32,
            Operation::Store => self.store_positions(fragment, word).count() as u32,
            Operation::Atomic(_) => 1,
        }
    }

    /// Returns the positions in the history that a store of this fragment may take, the last first.
    fn store_positions(&self, fragment: usize, word: usize) -> impl Iterator<Item = usize> {
        let history = &self.histories[word];
        let first = usize::from(self.fragments[fragment].current[word]) + 1;
        (first..=history.len()).rev().filter(|at| history.get(*at).is_none_or(|write| !write.follows))
    }

    /// Performs the access in the way of this number; returns the old value.
    pub(crate) fn perform(&mut self, fragment: usize, word: usize, access: &Access, choice: u32) -> u64 {
        match access.operation {
            Operation::Load => {
                let at = self.histories[word].len() - 1 - choice as usize;
                self.observe(fragment, word, at);
                truncated(self.histories[word][at].value, access)
            }
            Operation::Store => {
                let last = self.histories[word].len();
                let at = self.store_positions(fragment, word).nth(choice as usize).unwrap_or(last);
                let view = self.fragments[fragment].released.clone();
                self.insert(fragment, word, at, Write { value: access.value, follows: false, view });
                0
            }
            Operation::Atomic(_) => {
                let last = self.histories[word].len() - 1;
                self.observe(fragment, word, last);
                let old = truncated(self.histories[word][last].value, access);
                let mut view = self.fragments[fragment].released.clone();
                join(&mut view, &self.histories[word][last].view);
                let value = access.new_value(old);
                self.insert(fragment, word, last + 1, Write { value, follows: true, view });
                old
            }
        }
    }

    fn observe(&mut self, fragment: usize, word: usize, at: usize) {
        let views = &mut self.fragments[fragment];
        views.current[word] = views.current[word].max(at as u8);
        join(&mut views.observed, &self.histories[word][at].view);
        views.observed[word] = views.observed[word].max(at as u8);
    }

    fn insert(&mut self, fragment: usize, word: usize, at: usize, mut write: Write) {
        let shift = |view: &mut View| view[word] += u8::from(usize::from(view[word]) >= at);
        self.each_view(shift);
        shift(&mut write.view);
        write.view[word] = at as u8;
        self.histories[word].insert(at, write);
        self.fragments[fragment].current[word] = at as u8;
    }

    fn each_view(&mut self, change: impl Fn(&mut View)) {
        self.histories.iter_mut().flatten().for_each(|write| change(&mut write.view));
        for views in &mut self.fragments {
            change(&mut views.current);
            change(&mut views.observed);
            change(&mut views.released);
        }
        change(&mut self.interlock);
    }

    /// Performs an event that is not an access.
    pub(crate) fn order(&mut self, fragment: usize, event: &Event) {
        let views = &mut self.fragments[fragment];
        match event {
            Event::Fence => {
                let observed = views.observed.clone();
                join_shared(&mut views.current, &observed, &self.private);
                views.released.clone_from(&views.current);
            }
            Event::CriticalBegin => {
                join_shared(&mut views.current, &self.interlock, &self.private);
                views.released.clone_from(&views.current);
            }
            Event::CriticalEnd => join(&mut self.interlock, &views.current),
            Event::Access(_) | Event::Barrier => {}
        }
    }

    /// Removes writes that no running fragment can observe.
    pub(crate) fn forget(&mut self, running: &[bool]) {
        for word in 0..self.histories.len() {
            let views = self.fragments.iter().zip(running).filter(|(_, running)| **running);
            let Some(oldest) = views.map(|(views, _)| views.current[word]).min().filter(|oldest| *oldest > 0) else {
                continue;
            };
            self.histories[word].drain(..usize::from(oldest));
            self.histories[word][0].follows = false;
            self.each_view(|view| view[word] = view[word].saturating_sub(oldest));
        }
        // A fragment that has ended observes nothing more, so its views must not distinguish states.
        for (views, _) in self.fragments.iter_mut().zip(running).filter(|(_, running)| !**running) {
            views.current.fill(0);
            views.observed.fill(0);
            views.released.fill(0);
        }
    }

    /// Returns the last write of a word.
    pub(crate) fn last(&self, word: usize) -> u64 {
        self.histories[word].last().map_or(0, |write| write.value)
    }
}

/// Returns as much of a value as the access is wide.
fn truncated(value: u64, access: &Access) -> u64 {
    if access.words == 2 { value } else { value & u64::from(u32::MAX) }
}

/// Joins another view into `view`, for words that fragments share.
fn join_shared(view: &mut View, other: &View, private: &[bool]) {
    for ((one, other), _) in view.iter_mut().zip(other).zip(private).filter(|(_, private)| !**private) {
        *one = (*one).max(*other);
    }
}

fn join(view: &mut View, other: &View) {
    for (one, other) in view.iter_mut().zip(other) {
        *one = (*one).max(*other);
    }
}

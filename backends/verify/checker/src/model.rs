//! Models of memory: what an access may see, and when a write is seen.
//!
//! *Sequential*: every access happens at once, in the order of the schedule.
//!
//! *Late*: a word has a history of writes, and every fragment a view: per word, the oldest write that it may still see. A
//! load sees any write from there on; a store takes any place behind the view in the order of the word's writes, so that
//! it may become visible after writes that were made later. Only what the view orders is ordered:
//! a fence takes the views of all writes seen before it into the fragment's own, and gives its own to all writes after it;
//! an interlock hands the view on; the end of a pass orders all. Words that are neither atomic nor declared coherent are not
//! ordered for others by anything but the end of the pass. An atomic operation that reads and writes works on the
//! last write and hands the view of that on. This is the relaxed part of the memory models of C++, Vulkan and WGSL, except
//! that no load sees a store that its own fragment, or a later cause, has yet to make.

use fragbuf_interpreter::{Access, Event, Operation};

/// How memory behaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// Every access happens at once.
    Sequential,
    /// Stores become visible late, in any order but per word.
    Late,
}

/// Per word, a number in its history.
type View = Vec<u8>;

/// The histories of all words that the late model tells apart.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Late {
    words: Vec<Vec<Write>>,
    fragments: Vec<Views>,
    critical: View,
    /// Words that are neither atomic nor coherent: nothing but the end of the pass makes another fragment see them.
    private: Vec<bool>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Write {
    value: u64,
    /// Whether it belongs to the write before it: nothing comes between them.
    follows: bool,
    view: View,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Views {
    /// What it may no longer see behind.
    own: View,
    /// What a fence will take in.
    seen: View,
    /// What writes give on.
    given: View,
}

impl Late {
    /// Histories of one write each; `private` words are no fragment's but the writer's until the pass ends.
    ///
    /// A word of 64 bits has the history of its lower half: no access takes either half alone, because every place in a
    /// buffer has one type.
    pub(crate) fn new(words: &[u32], fragments: usize, private: Vec<bool>, wide: &[bool]) -> Self {
        let zero = vec![0; words.len()];
        let views = Views { own: zero.clone(), seen: zero.clone(), given: zero.clone() };
        let behind = words.iter().skip(1).chain(&[0]);
        let high = behind.zip(wide).map(|(word, is_wide)| if *is_wide { u64::from(*word) << 32 } else { 0 });
        let values = words.iter().zip(high).map(|(low, high)| u64::from(*low) | high);
        let history = |value| vec![Write { value, follows: false, view: zero.clone() }];
        let words = values.map(history).collect();
        Late { words, fragments: vec![views; fragments], critical: zero.clone(), private }
    }

    /// In how many ways the access can happen.
    pub(crate) fn choices(&self, fragment: usize, word: usize, access: &Access) -> u32 {
        let oldest = usize::from(self.fragments[fragment].own[word]);
        match access.operation {
            Operation::Load => (self.words[word].len() - oldest) as u32,
            Operation::Store => self.places(fragment, word).count() as u32,
            Operation::Atomic(_) => 1,
        }
    }

    /// Places in the history where a store of this fragment may stand, the last first.
    fn places(&self, fragment: usize, word: usize) -> impl Iterator<Item = usize> {
        let history = &self.words[word];
        let first = usize::from(self.fragments[fragment].own[word]) + 1;
        (first..=history.len()).rev().filter(|at| history.get(*at).is_none_or(|write| !write.follows))
    }

    /// Lets the access happen in the way of this number; the old value.
    pub(crate) fn perform(&mut self, fragment: usize, word: usize, access: &Access, choice: u32) -> u64 {
        match access.operation {
            Operation::Load => {
                let at = self.words[word].len() - 1 - choice as usize;
                self.see(fragment, word, at);
                narrowed(self.words[word][at].value, access)
            }
            Operation::Store => {
                let at = self.places(fragment, word).nth(choice as usize).unwrap_or(self.words[word].len());
                let view = self.fragments[fragment].given.clone();
                self.insert(fragment, word, at, Write { value: access.value, follows: false, view });
                0
            }
            Operation::Atomic(_) => {
                let last = self.words[word].len() - 1;
                self.see(fragment, word, last);
                let old = narrowed(self.words[word][last].value, access);
                let mut view = self.fragments[fragment].given.clone();
                join(&mut view, &self.words[word][last].view);
                let value = access.new_value(old);
                self.insert(fragment, word, last + 1, Write { value, follows: true, view });
                old
            }
        }
    }

    fn see(&mut self, fragment: usize, word: usize, at: usize) {
        let views = &mut self.fragments[fragment];
        views.own[word] = views.own[word].max(at as u8);
        join(&mut views.seen, &self.words[word][at].view);
        views.seen[word] = views.seen[word].max(at as u8);
    }

    fn insert(&mut self, fragment: usize, word: usize, at: usize, mut write: Write) {
        let later = |view: &mut View| view[word] += u8::from(usize::from(view[word]) >= at);
        self.each_view(later);
        later(&mut write.view);
        write.view[word] = at as u8;
        self.words[word].insert(at, write);
        self.fragments[fragment].own[word] = at as u8;
    }

    fn each_view(&mut self, change: impl Fn(&mut View)) {
        self.words.iter_mut().flatten().for_each(|write| change(&mut write.view));
        for views in &mut self.fragments {
            change(&mut views.own);
            change(&mut views.seen);
            change(&mut views.given);
        }
        change(&mut self.critical);
    }

    /// Lets an event happen that is no access.
    pub(crate) fn order(&mut self, fragment: usize, event: &Event) {
        let views = &mut self.fragments[fragment];
        match event {
            Event::Fence => {
                let seen = views.seen.clone();
                join_shared(&mut views.own, &seen, &self.private);
                views.given.clone_from(&views.own);
            }
            Event::CriticalBegin => {
                join_shared(&mut views.own, &self.critical, &self.private);
                views.given.clone_from(&views.own);
            }
            Event::CriticalEnd => join(&mut self.critical, &views.own),
            Event::Access(_) | Event::Barrier => {}
        }
    }

    /// Forgets writes that no fragment which still runs can see.
    pub(crate) fn forget(&mut self, running: &[bool]) {
        for word in 0..self.words.len() {
            let views = self.fragments.iter().zip(running).filter(|(_, running)| **running);
            let Some(oldest) = views.map(|(views, _)| views.own[word]).min().filter(|oldest| *oldest > 0) else {
                continue;
            };
            self.words[word].drain(..usize::from(oldest));
            self.words[word][0].follows = false;
            self.each_view(|view| view[word] = view[word].saturating_sub(oldest));
        }
        // What has ended sees nothing more: its views tell no states apart.
        for (views, _) in self.fragments.iter_mut().zip(running).filter(|(_, running)| !**running) {
            views.own.fill(0);
            views.seen.fill(0);
            views.given.fill(0);
        }
    }

    /// The last write of a word.
    pub(crate) fn last(&self, word: usize) -> u64 {
        self.words[word].last().map_or(0, |write| write.value)
    }
}

/// As much of a value as an access is wide.
fn narrowed(value: u64, access: &Access) -> u64 {
    if access.words == 2 { value } else { value & u64::from(u32::MAX) }
}

/// Takes in what another view says of words that fragments share.
fn join_shared(view: &mut View, other: &View, private: &[bool]) {
    for ((own, other), _) in view.iter_mut().zip(other).zip(private).filter(|(_, private)| !**private) {
        *own = (*own).max(*other);
    }
}

fn join(view: &mut View, other: &View) {
    for (own, other) in view.iter_mut().zip(other) {
        *own = (*own).max(*other);
    }
}

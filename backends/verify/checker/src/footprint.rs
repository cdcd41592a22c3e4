//! Footprints: what a step accesses, and whether the order of two steps of different fragments matters.
//!
//! Input: a fragment's next event. Output: its footprint. [`Summaries`] hold, per state, the footprints of all steps that follow it.

use fragbuf_interpreter::Event;

use crate::context::SearchContext;
use crate::watched::WatchedWords;

/// What a step accesses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Footprint {
    /// The word, or the interlock. `None`: the step affects its fragment only.
    object: Option<u32>,
    writes: bool,
    /// Whether the property that is checked at every instant depends on the word that is written.
    is_watched: bool,
}

impl Footprint {
    /// The footprint of a step that affects its fragment only.
    pub(crate) const LOCAL: Footprint = Footprint { object: None, writes: false, is_watched: false };

    /// Returns the footprint of a fragment's next event.
    pub(crate) fn new(context: &SearchContext<'_>, fragment: usize, event: &Event, watched: &WatchedWords) -> Self {
        let is_helper = context.helper == Some(fragment);
        match event {
            Event::Access(access) => {
                let Some(word) = context.word(access.address) else { return Footprint::LOCAL };
                let writes = access.writes() && !is_helper;
                let is_watched = writes && watched.contains(context, access);
                Footprint { object: Some(word as u32), writes, is_watched }
            }
            Event::CriticalBegin | Event::CriticalEnd if !is_helper => {
                Footprint { object: Some(context.ordered as u32), writes: true, is_watched: false }
            }
            Event::Barrier(_) => {
                let workgroup = context.workgroups.get(fragment).copied().unwrap_or(0);
                Footprint { object: Some(context.ordered as u32 + 1 + workgroup), writes: true, is_watched: false }
            }
            _ => Footprint::LOCAL,
        }
    }

    /// Returns whether the order of this step and one of another fragment matters.
    pub(crate) fn conflicts(self, other: Footprint) -> bool {
        let same = self.object.is_some() && self.object == other.object;
        (same && (self.writes || other.writes)) || (self.is_watched && other.is_watched)
    }
}

/// The footprints of the steps of each fragment after a state, as bits: per fragment, whether it reads and whether it writes
/// each object, and whether it writes a watched word. Objects share bits if there are many, so that states stay small.
#[derive(Clone, Debug)]
pub(crate) struct Summaries {
    fragments: usize,
    bits: Vec<u128>,
}

/// The number of objects with bits of their own.
const OBJECTS: u32 = 63;

/// Returns the bit of a read of an object. That of a write follows.
fn bit(object: u32) -> u32 {
    1 + 2 * (object % OBJECTS)
}

impl Summaries {
    /// Returns no summaries, for states of so many fragments.
    pub(crate) fn new(fragments: usize) -> Self {
        Summaries { fragments, bits: Vec::new() }
    }

    /// Appends the empty summary of the next state.
    pub(crate) fn push(&mut self) {
        self.bits.resize(self.bits.len() + self.fragments, 0);
    }

    fn index(&self, state: u32, fragment: usize) -> usize {
        state as usize * self.fragments + fragment
    }

    /// Adds a step of a fragment to the summary of a state.
    pub(crate) fn add(&mut self, state: u32, fragment: usize, footprint: Footprint) {
        let accessed = footprint.object.map_or(0, |object| 1 << (bit(object) + u32::from(footprint.writes)));
        let index = self.index(state, fragment);
        self.bits[index] |= accessed | u128::from(footprint.is_watched);
    }

    /// Adds the summary of one state to that of another.
    pub(crate) fn join(&mut self, to: u32, from: u32) {
        for fragment in 0..self.fragments {
            let (to, from) = (self.index(to, fragment), self.index(from, fragment));
            self.bits[to] |= self.bits[from];
        }
    }

    /// Returns whether a step of a fragment after a state may conflict with any other.
    pub(crate) fn has_steps(&self, state: u32, fragment: usize) -> bool {
        self.bits[self.index(state, fragment)] != 0
    }

    /// Returns whether a step of a fragment after a state may conflict with a step before it.
    pub(crate) fn conflicts(&self, state: u32, fragment: usize, earlier: Footprint) -> bool {
        let bits = self.bits[self.index(state, fragment)];
        let meets = earlier.object.is_some_and(|object| {
            let (reads, writes) = (bits >> bit(object) & 1 == 1, bits >> (bit(object) + 1) & 1 == 1);
            writes || (earlier.writes && reads)
        });
        meets || (earlier.is_watched && bits & 1 == 1)
    }
}

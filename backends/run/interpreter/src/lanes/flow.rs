//! Divergence: the lanes that run, and those that wait for them.
//!
//! Of all lanes, those at the first instruction run. An instruction that is executed later has a greater number, except after a jump back,
//! so the lanes of both branches meet again at the first instruction after them, and lanes that have left a loop wait for the others behind it.

use super::set::{LaneSet, Lanes};

/// Lanes at an instruction.
#[derive(Clone, Copy, Debug)]
struct Front {
    at: u32,
    lanes: LaneSet,
}

/// The state of the lanes of a group.
#[derive(Clone, Debug, Default)]
pub(super) struct Flow {
    /// The lanes that run.
    pub(super) active: LaneSet,
    /// The same as a mask per lane.
    pub(super) mask: Lanes,
    /// Whether all lanes run whose words have a use, so that words are written without a mask.
    pub(super) is_full: bool,
    /// The first instruction at which other lanes wait; `u32::MAX`: none wait.
    pub(super) join: u32,
    /// The lanes that have ended.
    pub(super) ended: LaneSet,
    /// The lanes at a barrier.
    stopped: Vec<Front>,
    /// The lanes that have not been discarded.
    kept: LaneSet,
    /// The waiting lanes; the first instruction is the last here.
    waiting: Vec<Front>,
    /// Lanes that wait until the others have ended, or have repeated a loop as often as they have.
    parked: Vec<Front>,
}

impl Flow {
    /// Places the lanes of a group before the first instruction.
    pub(super) fn start(&mut self, lanes: LaneSet) {
        self.waiting.clear();
        self.parked.clear();
        self.stopped.clear();
        (self.ended, self.kept) = (LaneSet::default(), lanes);
        self.join = u32::MAX;
        self.waiting.extend((!lanes.is_empty()).then_some(Front { at: 0, lanes }));
    }

    /// Lets the active lanes arrive at an instruction. Returns the instruction that runs next.
    pub(super) fn arrive(&mut self, at: u32) -> u32 {
        self.wait(Front { at, lanes: self.active });
        self.next().unwrap_or(at)
    }

    /// Lets some of the active lanes wait at an instruction. The others stay active.
    #[inline]
    pub(super) fn divide(&mut self, lanes: LaneSet, at: u32) {
        self.wait(Front { at, lanes });
        self.join = self.join.min(at);
        self.run(self.active.without(lanes));
    }

    /// Ends the active lanes. Returns the next instruction of the others; `None`: there are none.
    pub(super) fn end(&mut self) -> Option<u32> {
        self.ended = self.ended.or(self.active);
        self.next()
    }

    /// Discards the active lanes. Returns the next instruction of the others; `None`: there are none.
    pub(super) fn discard(&mut self) -> Option<u32> {
        self.kept = self.kept.without(self.active);
        self.next()
    }

    /// Stops the active lanes at a barrier. Returns the next instruction of the others; `None`: there are none.
    pub(super) fn stop(&mut self, at: u32) -> Option<u32> {
        self.stopped.push(Front { at, lanes: self.active });
        self.next()
    }

    /// Returns the lanes at barriers.
    pub(super) fn stopped(&self) -> LaneSet {
        self.stopped.iter().fold(LaneSet::default(), |all, front| all.or(front.lanes))
    }

    /// Lets all stopped lanes continue behind their barriers. Returns the instruction that runs next; `None`: no lane was stopped.
    pub(super) fn resume(&mut self) -> Option<u32> {
        while let Some(front) = self.stopped.pop() {
            self.wait(Front { at: front.at + 1, ..front });
        }
        self.next()
    }

    /// Lets the active lanes wait at an instruction until the others have made progress. Returns the instruction that runs next.
    pub(super) fn park(&mut self, at: u32) -> u32 {
        if self.waiting.is_empty() {
            std::mem::swap(&mut self.waiting, &mut self.parked);
        }
        if self.waiting.is_empty() {
            return at;
        }
        self.parked.push(Front { at, lanes: self.active });
        self.next().unwrap_or(at)
    }

    fn next(&mut self) -> Option<u32> {
        if self.waiting.is_empty() {
            let parked = std::mem::take(&mut self.parked);
            parked.into_iter().for_each(|front| self.wait(front));
        }
        let front = self.waiting.pop()?;
        self.join = self.waiting.last().map_or(u32::MAX, |next| next.at);
        self.run(front.lanes);
        Some(front.at)
    }

    fn wait(&mut self, front: Front) {
        let after = self.waiting.iter().rposition(|other| other.at >= front.at);
        match after.and_then(|position| self.waiting.get_mut(position)) {
            Some(other) if other.at == front.at => other.lanes = other.lanes.or(front.lanes),
            _ => self.waiting.insert(after.map_or(0, |position| position + 1), front),
        }
    }

    fn run(&mut self, lanes: LaneSet) {
        self.active = lanes;
        self.mask = lanes.mask();
        self.is_full = lanes == self.kept;
    }
}

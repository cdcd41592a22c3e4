//! The steps from the first state to the present one, which a reduced search compares with each later step.
//!
//! Input: a step and its footprint. Output: the states in which another fragment must be followed too, because a later step of it
//! conflicts with the step that was followed there, and nothing orders the two. Clocks say what orders them.

use crate::footprint::Footprint;

/// The steps that are followed in a state on the way to the present one.
pub(crate) struct Followed {
    /// The fragments that can take a step, and those to follow, a bit each.
    pub(crate) able: u32,
    pub(crate) to_follow: u32,
    /// Whether the step of one fragment can come first, so that no other need be followed.
    pub(crate) is_alone: bool,
    /// The fragment that is followed, and the footprint of its step.
    pub(crate) fragment: u8,
    pub(crate) footprint: Footprint,
}

/// The steps, by the depth of their states.
pub(crate) struct Trail {
    pub(crate) steps: Vec<Followed>,
    fragments: usize,
    /// Per state, fragment and other fragment, the last step of the other that happens before the next of the fragment. A step's
    /// number is its depth plus one.
    clocks: Vec<u32>,
    /// Per state and fragment, the clock of the step that is followed.
    step_clocks: Vec<u32>,
}

impl Trail {
    /// Returns the trail before the first state of so many fragments.
    pub(crate) fn new(fragments: usize) -> Self {
        Trail { steps: Vec::new(), fragments, clocks: Vec::new(), step_clocks: Vec::new() }
    }

    /// Appends a state to which the step of the last state leads. `first`: the fragments to follow.
    pub(crate) fn push(&mut self, able: u32, first: u32, is_alone: bool) {
        let count = self.fragments;
        match self.steps.last().map(|step| usize::from(step.fragment)) {
            None => self.clocks.resize(count * count, 0),
            Some(fragment) => {
                let top = self.steps.len() - 1;
                self.clocks.extend_from_within(top * count * count..);
                let row = ((top + 1) * count + fragment) * count;
                self.clocks[row..row + count].copy_from_slice(&self.step_clocks[top * count..]);
            }
        }
        self.step_clocks.resize(self.step_clocks.len() + count, 0);
        let footprint = Footprint::LOCAL;
        self.steps.push(Followed { able, to_follow: first, is_alone, fragment: 0, footprint });
    }

    /// Removes the last state.
    pub(crate) fn pop(&mut self) {
        self.steps.pop();
        let (depth, count) = (self.steps.len(), self.fragments);
        self.clocks.truncate(depth * count * count);
        self.step_clocks.truncate(depth * count);
    }

    /// Follows a fragment in the last state, and lets it be followed in every state whose step conflicts with this one.
    pub(crate) fn follow(&mut self, fragment: usize, footprint: Footprint) {
        let Some(top) = self.steps.len().checked_sub(1) else { return };
        (self.steps[top].fragment, self.steps[top].footprint) = (fragment as u8, footprint);
        let count = self.fragments;
        let row = (top * count + fragment) * count;
        let known = &self.clocks[row..row + count];
        let (earlier_clocks, clock) = self.step_clocks.split_at_mut(top * count);
        clock.copy_from_slice(known);
        for (earlier, other) in self.steps[..top].iter().zip(earlier_clocks.chunks_exact(count)) {
            // A step that can come first does not order the steps that conflict with it.
            if !earlier.is_alone && earlier.footprint.conflicts(footprint) {
                clock.iter_mut().zip(other).for_each(|(one, other)| *one = (*one).max(*other));
            }
        }
        clock[fragment] = top as u32 + 1;
        follow_before(&mut self.steps[..top], fragment, known, |earlier| earlier.conflicts(footprint));
    }

    /// Lets a fragment be followed in every state whose step conflicts with a step of it after the last state's step.
    pub(crate) fn follow_later(&mut self, fragment: usize, conflicts: impl Fn(Footprint) -> bool) {
        let Some(top) = self.steps.len().checked_sub(1) else { return };
        let count = self.fragments;
        let row = (top * count + fragment) * count;
        let known = match fragment == usize::from(self.steps[top].fragment) {
            true => &self.step_clocks[top * count..],
            false => &self.clocks[row..row + count],
        };
        follow_before(&mut self.steps, fragment, known, conflicts);
    }

    /// Follows every fragment in the states from a depth on.
    pub(crate) fn follow_all(&mut self, depth: usize) {
        for step in &mut self.steps[depth..] {
            step.is_alone = false;
            step.to_follow |= step.able;
        }
    }
}

/// Lets a fragment be followed in every state whose step conflicts with a later step of the fragment, unless the one happens
/// before the other. `clock`: the steps that happen before the later one, per fragment.
fn follow_before(steps: &mut [Followed], fragment: usize, clock: &[u32], conflicts: impl Fn(Footprint) -> bool) {
    for (depth, earlier) in steps.iter_mut().enumerate() {
        let other = usize::from(earlier.fragment);
        if other != fragment && !earlier.is_alone && clock[other] <= depth as u32 && conflicts(earlier.footprint) {
            let is_able = earlier.able >> fragment & 1 == 1;
            earlier.to_follow |= if is_able { 1 << fragment } else { earlier.able };
        }
    }
}

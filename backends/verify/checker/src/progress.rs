//! Progress: whether a fragment comes back to a status in which it has been.
//!
//! Input: a state and a fragment. Output: the next state, in which an attempt of a retry loop that has changed nothing does not
//! count. So a fragment that waits in a loop does not reach the loop's limit while another fragment can still change what it
//! reads. [`SearchContext::run_on`] counts every attempt, for states that no other fragment changes any more.

use std::rc::Rc;

use fragbuf_interpreter::Reply;

use crate::context::SearchContext;
use crate::runner::{Runner, Stop};
use crate::search::{FailureKind, RUN_ON, Step};
use crate::state::{State, Status, StepError};

/// An earlier status of a fragment, since which the fragment has changed nothing (Brent's algorithm finds its cycles).
#[derive(Clone, Debug)]
pub(crate) struct Anchor {
    stop: Rc<Stop>,
    /// Steps since.
    steps: u32,
    /// After so many steps the anchor moves to the present status.
    limit: u32,
}

/// The result of a step.
pub(crate) struct Stepped {
    pub(crate) state: State,
    /// The reply to the event.
    pub(crate) reply: Reply,
    /// Whether the step has changed anything but the status of its fragment.
    pub(crate) has_effect: bool,
    /// Whether the fragment has come back to an earlier status without having changed anything.
    pub(crate) recurs: bool,
}

/// What comes of a fragment that runs while no other does.
pub(crate) enum RunOn {
    /// It changes something, leaves its loop or ends.
    Moved(State),
    /// It waits: it cannot take a step, or comes back to a status in which it has been.
    Waits,
    /// It has done neither after the greatest number of steps that is followed.
    TooLong,
    /// A step fails.
    Failed(FailureKind),
}

/// The most steps of [`SearchContext::run_on`]. A loop may have more attempts: rows allow up to 2^24.
const LONGEST: u32 = 1 << 17;

impl<'p> SearchContext<'p> {
    /// Performs a fragment's event in the way of this number.
    pub(crate) fn step(
        &self,
        runner: &mut Runner<'p>,
        before: &State,
        fragment: usize,
        choice: u32,
    ) -> Result<Stepped, StepError> {
        let (mut state, reply) = self.step_exactly(runner, before, fragment, choice)?;
        let has_effect = !state.has_memory_of(before);
        let recurs = self.anchor(before, &mut state, fragment, has_effect);
        Ok(Stepped { state, reply, has_effect, recurs })
    }

    /// Sets the anchor of a fragment after a step; returns whether the fragment is back there.
    fn anchor(&self, before: &State, after: &mut State, fragment: usize, has_effect: bool) -> bool {
        let Status::Before { stop, anchor } = &mut after.fragments[fragment] else { return false };
        if !self.program.is_in_loop(stop.at) {
            return false;
        }
        let earlier = match &before.fragments[fragment] {
            Status::Before { anchor: Some(anchor), .. } => Some(anchor.clone()),
            Status::Before { stop, .. } => Some(Anchor { stop: Rc::clone(stop), steps: 0, limit: 2 }),
            Status::Ended(_) => None,
        };
        let Some(earlier) = earlier.filter(|_| !has_effect) else { return false };
        if self.program.is_same_attempt(&earlier.stop.saved, &stop.saved) {
            *stop = Rc::clone(&earlier.stop);
            *anchor = Some(Anchor { steps: 0, ..earlier });
            return true;
        }
        *anchor = Some(match earlier.steps + 1 >= earlier.limit {
            true => Anchor { stop: Rc::clone(stop), steps: 0, limit: earlier.limit.saturating_mul(2) },
            false => Anchor { steps: earlier.steps + 1, ..earlier },
        });
        false
    }

    /// Runs a fragment while no other runs, until it changes something, leaves its loop or ends. Its accesses observe the latest
    /// writes.
    pub(crate) fn run_on(&self, runner: &mut Runner<'p>, state: &State, fragment: usize) -> RunOn {
        let mut now = state.clone();
        let (mut earlier, mut limit) = (now.fragments[fragment].clone(), 1);
        for steps in 0..LONGEST {
            match &now.fragments[fragment] {
                Status::Before { stop, .. } if steps == 0 || self.program.is_in_loop(stop.at) => {}
                _ => return RunOn::Moved(now),
            }
            if self.choices(&now, fragment) == 0 {
                return RunOn::Waits;
            }
            let next = match self.step_exactly(runner, &now, fragment, 0) {
                Ok((next, _)) => next,
                Err(error) => return RunOn::Failed(FailureKind::Step(fragment, error)),
            };
            let has_effect = !next.has_memory_of(&now);
            now = next;
            if has_effect {
                return RunOn::Moved(now);
            }
            if now.fragments[fragment] == earlier {
                return RunOn::Waits;
            }
            if steps == limit {
                (earlier, limit) = (now.fragments[fragment].clone(), 2 * limit);
            }
        }
        RunOn::TooLong
    }

    /// Performs a step of a schedule again. `None`: it fails.
    pub(crate) fn replay(&self, runner: &mut Runner<'p>, state: &State, step: Step) -> Option<State> {
        match step {
            (fragment, RUN_ON) => match self.run_on(runner, state, fragment) {
                RunOn::Moved(next) => Some(next),
                RunOn::Waits | RunOn::TooLong | RunOn::Failed(_) => None,
            },
            (fragment, choice) => self.step(runner, state, fragment, choice).ok().map(|stepped| stepped.state),
        }
    }

    /// Returns whether a helper invocation waits in the worst case, in which it never observes the value that would end its wait.
    pub(crate) fn helper_waits(&self, runner: &mut Runner<'p>, state: &State, fragment: usize) -> bool {
        let mut now = state.clone();
        if let Status::Before { anchor, .. } = &mut now.fragments[fragment] {
            *anchor = None;
        }
        // One attempt of a wait accesses no more words than this.
        for _ in 0..64 {
            let Status::Before { stop, .. } = &now.fragments[fragment] else { return false };
            if !self.program.is_in_loop(stop.at) {
                return false;
            }
            let worst = self.choices(&now, fragment).saturating_sub(1);
            match self.step(runner, &now, fragment, worst) {
                Ok(stepped) if stepped.recurs => return true,
                Ok(stepped) => now = stepped.state,
                Err(_) => return false,
            }
        }
        false
    }
}

//! One state of a search: the words in memory, and the status of each fragment.
//!
//! Input: a state and a choice. Output: the next state. A search runs machines only here. Between two states exactly one
//! shared access, fence or interlock event is performed.

use std::hash::{Hash, Hasher};

use fragbuf_interpreter::{Access, Event, Exit, Machine, Operation};

use crate::context::SearchContext;
use crate::model::{Model, RelaxedMemory};
use crate::pausing::{Pausing, perform, value};

/// One state.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct State {
    /// The words that the program can write, as the last write left them.
    pub(crate) words: Vec<u32>,
    pub(crate) fragments: Vec<Status>,
    /// The fragment inside the interlock.
    in_interlock: Option<usize>,
    /// The fragments that have left an ordered interlock, a bit each.
    left_interlock: u32,
    /// The fragment that has started and not ended, where fragments run one by one.
    started: Option<usize>,
    relaxed: Option<Box<RelaxedMemory>>,
}

/// The status of a fragment.
#[derive(Clone, Debug)]
pub(crate) enum Status {
    /// It has stopped before an event.
    Before {
        event: Event,
        at: u32,
        /// The words from which a machine is restored.
        saved: Vec<u32>,
    },
    /// It has ended; whether its sample passes.
    Ended(bool),
}

// The saved words determine the event.
impl PartialEq for Status {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Status::Before { saved, .. }, Status::Before { saved: other, .. }) => saved == other,
            (Status::Ended(passes), Status::Ended(other)) => passes == other,
            _ => false,
        }
    }
}

impl Eq for Status {}

impl Hash for Status {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Status::Before { saved, .. } => saved.hash(state),
            Status::Ended(passes) => state.write_u8(1 + u8::from(*passes)),
        }
    }
}

impl Status {
    /// Returns whether the fragment has ended.
    pub(crate) fn has_ended(&self) -> bool {
        matches!(self, Status::Ended(_))
    }
}

impl State {
    /// Returns the words of a final state. Where a loop waits for samples, the number of samples that passed is appended.
    pub(crate) fn final_words(&self, context: &SearchContext<'_>) -> Vec<u32> {
        let mut words = self.words.clone();
        if context.counts_samples {
            let passes = |(number, status): (usize, &Status)| {
                u32::from(*status == Status::Ended(true) && context.helper != Some(number))
            };
            words.push(self.fragments.iter().enumerate().map(passes).sum());
        }
        words
    }
}

/// What can go wrong in one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StepError {
    /// An index is out of bounds, at this instruction.
    OutOfBounds(u32),
    /// A fragment loops without accessing memory and does not end.
    Endless,
    /// A fragment reaches a barrier, which only workgroups have.
    Barrier,
}

impl SearchContext<'_> {
    /// Returns the state in which each machine has stopped before its first event.
    pub(crate) fn start(&self, words: Vec<u32>, machines: Vec<Machine<'_>>) -> Result<State, StepError> {
        let relaxed = (self.model == Model::Relaxed).then(|| {
            // A word that is neither atomic nor coherent is private.
            let private = self.each_ordered(|buffer| !buffer.is_coherent);
            let wide = self.each_ordered(|buffer| buffer.is_wide);
            Box::new(RelaxedMemory::new(&words[..self.ordered], machines.len(), private, &wide))
        });
        let mut state =
            State { words, fragments: Vec::new(), in_interlock: None, left_interlock: 0, started: None, relaxed };
        for (fragment, mut machine) in machines.into_iter().enumerate() {
            let status = self.run(&mut machine, fragment, None, &mut state.words)?;
            state.fragments.push(status);
        }
        Ok(state)
    }

    /// Runs a machine to its next event.
    fn run(
        &self,
        machine: &mut Machine<'_>,
        fragment: usize,
        reply: Option<u64>,
        words: &mut [u32],
    ) -> Result<Status, StepError> {
        machine.is_helper = self.helper == Some(fragment);
        let is_helper = machine.is_helper;
        let exit = machine.run(&mut Pausing { context: self, reply, words, is_helper });
        if let Some(access) = machine.out_of_bounds.take() {
            return Err(StepError::OutOfBounds(access.at));
        }
        match exit {
            Exit::Ended => Ok(Status::Ended(true)),
            Exit::Discarded => Ok(Status::Ended(!self.counts_samples)),
            Exit::Endless => Err(StepError::Endless),
            Exit::Stopped(Event::Barrier) => Err(StepError::Barrier),
            Exit::Stopped(event) => {
                let mut saved = Vec::new();
                machine.save(&mut saved);
                Ok(Status::Before { event, at: machine.at(), saved })
            }
        }
    }

    /// Returns the fragments that have not ended and may take a step.
    pub(crate) fn running(&self, state: &State) -> Vec<usize> {
        let has_ended = |at: &usize| state.fragments[*at].has_ended();
        match state.started {
            Some(fragment) => vec![fragment],
            None => (0..state.fragments.len()).filter(|at| !has_ended(at)).collect(),
        }
    }

    /// Returns in how many ways a fragment's event can be performed. 0: it has ended, or must wait for the interlock.
    pub(crate) fn choices(&self, state: &State, fragment: usize) -> u32 {
        let Status::Before { event, .. } = &state.fragments[fragment] else { return 0 };
        match (event, &state.relaxed) {
            (Event::Access(access), _) if self.helper == Some(fragment) && access.writes() => 2,
            // A helper invocation passes the interlock, and its loads return what memory holds.
            _ if self.helper == Some(fragment) => 1,
            (Event::CriticalBegin, _) => u32::from(state.in_interlock.is_none() && self.is_next(state, fragment)),
            (Event::Access(access), Some(relaxed)) => {
                self.word(access.address).map_or(1, |word| relaxed.choices(fragment, word, access))
            }
            _ => 1,
        }
    }

    /// Returns whether all earlier fragments have left the interlock, if it is ordered.
    fn is_next(&self, state: &State, fragment: usize) -> bool {
        let has_left = |other: usize| state.left_interlock >> other & 1 == 1 || state.fragments[other].has_ended();
        !self.by_submission || (0..fragment).all(has_left)
    }

    /// Performs a fragment's event in the way of this number; returns the next state and the value that the event observed.
    pub(crate) fn step(
        &self,
        machine: &mut Machine<'_>,
        state: &State,
        fragment: usize,
        choice: u32,
    ) -> Result<(State, u64), StepError> {
        let Status::Before { event, saved, .. } = &state.fragments[fragment] else { return Ok((state.clone(), 0)) };
        let mut next = state.clone();
        let old = self.perform(&mut next, fragment, event, choice);
        machine.load(saved);
        next.fragments[fragment] = self.run(machine, fragment, Some(old), &mut next.words)?;
        next.started = Some(fragment).filter(|at| self.one_by_one && !next.fragments[*at].has_ended());
        if let Some(relaxed) = &mut next.relaxed {
            let running: Vec<bool> = next.fragments.iter().map(|status| !status.has_ended()).collect();
            relaxed.forget(&running);
        }
        Ok((next, old))
    }

    fn perform(&self, state: &mut State, fragment: usize, event: &Event, choice: u32) -> u64 {
        if self.helper == Some(fragment) {
            return self.observed_by_helper(state, event, choice);
        }
        match event {
            Event::CriticalBegin => state.in_interlock = Some(fragment),
            Event::CriticalEnd => {
                state.in_interlock = None;
                state.left_interlock |= u32::from(self.by_submission) << fragment;
            }
            _ => {}
        }
        let Event::Access(access) = event else {
            if let Some(relaxed) = &mut state.relaxed {
                relaxed.order(fragment, event);
            }
            return 0;
        };
        let Some(word) = self.word(access.address) else { return 0 };
        match &mut state.relaxed {
            None => perform(access, &mut state.words[word..]),
            Some(relaxed) => {
                let old = relaxed.perform(fragment, word, access, choice);
                if access.writes() {
                    let last = relaxed.last(word);
                    state.words[word] = last as u32;
                    if access.words == 2 {
                        state.words[word + 1] = (last >> 32) as u32;
                    }
                }
                old
            }
        }
    }

    /// Returns the value that a helper invocation observes: what memory holds or, for an operation that writes, any other.
    fn observed_by_helper(&self, state: &State, event: &Event, choice: u32) -> u64 {
        match event {
            Event::Access(access) if choice == 0 => {
                self.word(access.address).map_or(0, |word| value(&state.words[word..], access.words))
            }
            _ => u64::from(u32::MAX),
        }
    }

    /// Returns whether a step has returned a fragment to its earlier status and changed nothing else. It has observed an
    /// old value once more, so the step can be left out.
    pub(crate) fn is_idle(&self, before: &State, after: &State, fragment: usize) -> bool {
        before.words == after.words
            && before.relaxed == after.relaxed
            && is_same_but_one(&before.fragments[fragment], &after.fragments[fragment])
    }

    /// Returns whether a fragment waits for another: running alone, it would return to its status without having changed
    /// anything. One word of the status may differ, the number of its attempts.
    pub(crate) fn waits(&self, machine: &mut Machine<'_>, state: &State, fragment: usize) -> bool {
        let Status::Before { at, .. } = &state.fragments[fragment] else { return false };
        if !self.program.is_in_loop(*at) {
            return false;
        }
        let mut words = state.words.clone();
        let mut now = state.fragments[fragment].clone();
        // One iteration of a wait loop reads no more words than this.
        for _ in 0..32 {
            let Status::Before { event: Event::Access(access), saved, .. } = &now else { return false };
            let Some(word) = self.word(access.address) else { return false };
            let before = value(&words[word..], access.words);
            let is_helper = self.helper == Some(fragment);
            if access.new_value(before) != before && !is_helper {
                return false;
            }
            // The worst case of a helper invocation: it never observes the value that would end its wait.
            let reply = if is_helper && access.writes() { u64::from(u32::MAX) } else { before };
            machine.load(saved);
            let Ok(next) = self.run(machine, fragment, Some(reply), &mut words) else { return false };
            if words != state.words {
                return false;
            }
            if is_same_but_one(&state.fragments[fragment], &next) {
                return true;
            }
            now = next;
        }
        false
    }
}

/// Returns whether both have stopped before the same event, and their saved words differ in one at most.
fn is_same_but_one(one: &Status, other: &Status) -> bool {
    match (one, other) {
        (
            Status::Before { event, at, saved },
            Status::Before { event: other_event, at: other_at, saved: other_saved },
        ) => {
            let differences = saved.iter().zip(other_saved).filter(|(a, b)| a != b).count();
            event == other_event && at == other_at && differences <= 1
        }
        _ => false,
    }
}

/// Returns the first two fragments whose next accesses are a data race. Accesses of a helper invocation are exempt: its
/// stores and atomic operations have no effect, and its loads no consequence.
pub(crate) fn racing(context: &SearchContext<'_>, state: &State) -> Option<(usize, usize)> {
    let access = |fragment: usize| match &state.fragments[fragment] {
        Status::Before { event: Event::Access(access), .. } if context.helper != Some(fragment) => Some(*access),
        _ => None,
    };
    let count = state.fragments.len();
    (0..count)
        .flat_map(|one| (one + 1..count).map(move |other| (one, other)))
        .find(|(one, other)| matches!((access(*one), access(*other)), (Some(one), Some(other)) if race(&one, &other)))
}

/// Returns whether two pending accesses are a data race: same word, at least one writes, at least one is not atomic.
fn race(one: &Access, other: &Access) -> bool {
    let meets = |a: &Access, b: &Access| {
        let (a_at, b_at) = (a.address, b.address);
        a_at.buffer == b_at.buffer && (a_at.word..a_at.word + u32::from(a.words)).contains(&b_at.word)
    };
    let same = meets(one, other) || meets(other, one);
    same && (one.operation != Operation::Load || other.operation != Operation::Load)
        && !(one.is_atomic && other.is_atomic)
}

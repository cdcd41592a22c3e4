//! One state of a search: the words in memory, and the status of each fragment.
//!
//! Input: a state and a choice. Output: the next state. A search runs machines only here. Between two states exactly one
//! shared access, fence or interlock event is performed.

use std::hash::{Hash, Hasher};
use std::rc::Rc;

use fragbuf_interpreter::{Access, Atomic, Event, Exit, Machine, Operation, Reply};

use crate::context::SearchContext;
use crate::model::Model;
use crate::pausing::{Pausing, perform, value};
use crate::progress::Anchor;
use crate::relaxed::{Observed, RelaxedMemory};
use crate::runner::{CommutingWrite, Runner, Stop};

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
    /// The invocations that may pass the barrier at which they wait, a bit each: all members of their workgroup have reached it.
    released: u32,
    /// What each fragment has observed. Under sequential consistency it serves to find data races.
    order: Rc<RelaxedMemory>,
}

/// The status of a fragment.
#[derive(Clone, Debug)]
pub(crate) enum Status {
    /// It has stopped before an event.
    Before {
        stop: Rc<Stop>,
        /// An earlier status since which it has changed nothing.
        anchor: Option<Anchor>,
    },
    /// It has ended; whether its sample passes.
    Ended(bool),
}

// The anchor is about the past, and does not change what can follow.
impl PartialEq for Status {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Status::Before { stop, .. }, Status::Before { stop: other, .. }) => {
                Rc::ptr_eq(stop, other) || stop == other
            }
            (Status::Ended(passes), Status::Ended(other)) => passes == other,
            _ => false,
        }
    }
}

impl Eq for Status {}

impl Hash for Status {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Status::Before { stop, .. } => stop.hash(state),
            Status::Ended(passes) => state.write_u8(1 + u8::from(*passes)),
        }
    }
}

impl Status {
    /// Returns the instruction of the barrier at which the fragment waits.
    fn barrier(&self) -> Option<u32> {
        match self {
            Status::Before { stop, .. } if matches!(stop.event, Event::Barrier(_)) => Some(stop.at),
            _ => None,
        }
    }

    /// Returns whether the fragment has ended.
    pub(crate) fn has_ended(&self) -> bool {
        matches!(self, Status::Ended(_))
    }
}

impl State {
    /// Returns whether a write of a value to a word may remove a write that a fragment can observe.
    pub(crate) fn may_forget(&self, word: usize, value: u64) -> bool {
        self.order.may_forget(word as u32, value)
    }

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

    /// Returns whether memory, the interlock and what fragments may observe are those of another state.
    pub(crate) fn has_memory_of(&self, other: &State) -> bool {
        self.words == other.words
            && (Rc::ptr_eq(&self.order, &other.order) || self.order == other.order)
            && self.in_interlock == other.in_interlock
            && self.released == other.released
    }
}

/// What can go wrong in one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StepError {
    /// An index is out of bounds, at this instruction.
    OutOfBounds(u32),
    /// A fragment loops without accessing memory and comes back to a state in which it has been.
    Endless,
    /// A fragment loops without accessing memory for longer than is followed: nothing is decided.
    TooLong,
    /// An invocation waits at a barrier, at this instruction, that another invocation of its workgroup does not reach.
    Barrier { waits: usize, at: u32, missing: usize },
    /// The access of this word of the state and an earlier one of this fragment are a data race.
    DataRace(usize, u32),
}

impl<'p> SearchContext<'p> {
    /// Returns the state in which each machine has stopped before its first event. `Err`: a fragment fails before it.
    pub(crate) fn start(&self, words: Vec<u32>, machines: Vec<Machine<'_>>) -> Result<State, (usize, StepError)> {
        let order = Rc::new(RelaxedMemory::new(machines.len(), self.first_of_workgroups as u32));
        let mut state = State {
            words,
            fragments: Vec::new(),
            in_interlock: None,
            left_interlock: 0,
            started: None,
            released: 0,
            order,
        };
        for (fragment, mut machine) in machines.into_iter().enumerate() {
            let run = self.run(&mut machine, fragment, None, &mut state.words, &mut Vec::new());
            let status = run.map_err(|error| (fragment, error))?;
            state.fragments.push(status);
        }
        self.check_barriers(&state).map_err(|error| (0, error))?;
        Ok(state)
    }

    /// Runs a machine to its next event. Writes that commute are performed, and recorded in `commuting`.
    pub(crate) fn run(
        &self,
        machine: &mut Machine<'_>,
        fragment: usize,
        reply: Option<Reply>,
        words: &mut [u32],
        commuting: &mut Vec<CommutingWrite>,
    ) -> Result<Status, StepError> {
        machine.is_helper = self.helper == Some(fragment);
        machine.clamps = self.clamps;
        let is_helper = machine.is_helper;
        // Writes that commute are the only changes, and the program cannot observe them.
        let exit = machine.run_or_repeat(&mut Pausing { context: self, reply, words, is_helper, commuting }, |_| 0);
        if let Some(access) = machine.out_of_bounds.take() {
            match &self.out_of_bounds {
                Some(known) => drop(known.borrow_mut().insert(access.at)),
                None => return Err(StepError::OutOfBounds(access.at)),
            }
        }
        match exit {
            Exit::Ended => Ok(Status::Ended(true)),
            Exit::Discarded => Ok(Status::Ended(!self.counts_samples)),
            Exit::Endless => {
                let repeats = machine.repeats(&mut Pausing { context: self, reply: None, words, is_helper, commuting });
                Err(if repeats { StepError::Endless } else { StepError::TooLong })
            }
            Exit::Stopped(event) => {
                let event = self.placed(fragment, event);
                let mut saved = Vec::with_capacity(64);
                machine.save(&mut saved);
                Ok(Status::before(Stop::new(event, machine.at(), saved)))
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
        let Status::Before { stop, .. } = &state.fragments[fragment] else { return 0 };
        let event = &stop.event;
        match event {
            Event::Access(access) if self.helper == Some(fragment) && access.writes() => 2,
            // A helper invocation passes the interlock, and its loads return what memory holds.
            _ if self.helper == Some(fragment) => 1,
            Event::CriticalBegin => u32::from(state.in_interlock.is_none() && self.is_next(state, fragment)),
            Event::Barrier(_) => u32::from(self.passes_barrier(state, fragment)),
            Event::Access(access) => self.word(access.address).map_or(1, |word| {
                let value = value(&state.words[word..], access.words);
                match self.model {
                    Model::Relaxed => {
                        state.order.count_ways(fragment, word as u32, access, value, self.has_weak_exchange)
                    }
                    Model::Sequential => 1 + u32::from(self.has_weak_exchange && exchanges(access, value)),
                }
            }),
            _ => 1,
        }
    }

    /// Returns whether a fragment may pass the barrier at which it waits.
    fn passes_barrier(&self, state: &State, fragment: usize) -> bool {
        let is_released = |member: usize| state.released >> member & 1 == 1;
        let waits = |member: &usize| state.fragments[*member].barrier().is_some();
        let members = self.members(fragment);
        is_released(fragment) || members.iter().all(|member| waits(member) && !is_released(*member))
    }

    /// Checks that no member of a workgroup waits at a barrier after another has ended, or while another waits at another barrier.
    fn check_barriers(&self, state: &State) -> Result<(), StepError> {
        let is_released = |member: usize| state.released >> member & 1 == 1;
        let barrier = |member: usize| state.fragments[member].barrier().filter(|_| !is_released(member));
        for fragment in 0..self.workgroups.len() {
            let Some(at) = barrier(fragment) else { continue };
            let missing = self.members(fragment).into_iter().find(|member| {
                state.fragments[*member].has_ended() || barrier(*member).is_some_and(|other| other != at)
            });
            if let Some(missing) = missing {
                return Err(StepError::Barrier { waits: fragment, at, missing });
            }
        }
        Ok(())
    }

    /// Returns whether all earlier fragments have left the interlock, if it is ordered.
    fn is_next(&self, state: &State, fragment: usize) -> bool {
        let has_left = |other: usize| state.left_interlock >> other & 1 == 1 || state.fragments[other].has_ended();
        !self.by_submission || (0..fragment).all(has_left)
    }

    /// Performs a fragment's event in the way of this number, and counts every attempt of a retry loop; returns the next state
    /// and the reply to the event.
    pub(crate) fn step_exactly(
        &self,
        runner: &mut Runner<'p>,
        state: &State,
        fragment: usize,
        choice: u32,
    ) -> Result<(State, Reply), StepError> {
        let Status::Before { stop, .. } = &state.fragments[fragment] else {
            return Ok((state.clone(), Reply::Stop));
        };
        let mut next = state.clone();
        let reply = self.perform(&mut next, fragment, &stop.event, choice)?;
        next.fragments[fragment] = runner.resume(self, fragment, (stop, reply), &mut next.words)?;
        next.started = Some(fragment).filter(|at| self.one_by_one && !next.fragments[*at].has_ended());
        if !next.order.is_trivial() {
            let forgets = Rc::make_mut(&mut next.order).forget(|fragment| !next.fragments[fragment].has_ended());
            self.has_forgotten.set(self.has_forgotten.get() | forgets);
        }
        self.check_barriers(&next)?;
        Ok((next, reply))
    }

    fn perform(&self, state: &mut State, fragment: usize, event: &Event, choice: u32) -> Result<Reply, StepError> {
        if self.helper == Some(fragment) {
            return Ok(Reply::Done(self.observed_by_helper(state, event, choice)));
        }
        match event {
            Event::Barrier(barrier) => {
                if state.released >> fragment & 1 == 0 {
                    let members = self.members(fragment);
                    Rc::make_mut(&mut state.order).barrier(&members, *barrier);
                    state.released |= members.iter().map(|member| 1 << member).sum::<u32>();
                }
                state.released &= !(1 << fragment);
            }
            Event::CriticalBegin => state.in_interlock = Some(fragment),
            Event::CriticalEnd => {
                state.in_interlock = None;
                state.left_interlock |= u32::from(self.by_submission) << fragment;
            }
            _ => {}
        }
        let Event::Access(access) = event else {
            Rc::make_mut(&mut state.order).order(fragment, event, |word| self.is_private(word));
            return Ok(Reply::Done(0));
        };
        let Some(word) = self.word(access.address) else { return Ok(Reply::Done(0)) };
        let old = value(&state.words[word..], access.words);
        let is_mixed = self.is_mixed(word);
        if self.model == Model::Sequential {
            let is_done = choice == 0;
            let matters = !access.is_atomic || is_mixed || !state.order.is_trivial();
            if matters
                && let Some(other) = Rc::make_mut(&mut state.order).perform_at_once(
                    fragment,
                    (word as u32, is_mixed),
                    access,
                    old,
                    is_done,
                )
            {
                return Err(StepError::DataRace(other, word as u32));
            }
            return Ok(match is_done {
                true => Reply::Done(perform(access, &mut state.words[word..])),
                false => Reply::Failed(old),
            });
        }
        let of = (old, self.has_weak_exchange);
        let Some(way) = state.order.way(fragment, word as u32, access, of, choice) else { return Ok(Reply::Stop) };
        let observed = Rc::make_mut(&mut state.order).perform(fragment, (word as u32, is_mixed), access, old, way);
        if let Some(last) = state.order.last(word as u32).filter(|_| access.writes()) {
            state.words[word] = last as u32;
            if access.words == 2 {
                state.words[word + 1] = (last >> 32) as u32;
            }
        }
        match observed {
            Observed::Value(value) => Ok(Reply::Done(value)),
            Observed::Spurious(value) => Ok(Reply::Failed(value)),
            Observed::Race(other) => Err(StepError::DataRace(other, word as u32)),
        }
    }

    /// Returns whether no fence makes a word visible to another fragment. Sequential memory has no such word.
    fn is_private(&self, word: usize) -> bool {
        self.model == Model::Relaxed && self.private[word]
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
}

/// Returns whether an access is a compare-exchange that finds the value that it expects.
fn exchanges(access: &Access, value: u64) -> bool {
    let mask = if access.words == 2 { u64::MAX } else { u64::from(u32::MAX) };
    access.operation == Operation::Atomic(Atomic::CompareExchange) && access.expected & mask == value
}

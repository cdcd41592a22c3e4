//! One state of a search: the words in memory, and where each fragment stands.
//!
//! In: a state and a choice. Out: the state after it. Machines are run here and nowhere else in a search; between two
//! states exactly one shared access, fence or end of an interlock happens.

use std::hash::{Hash, Hasher};

use fragbuf_interpreter::{Access, Buffer, Event, Exit, Machine, Operation, Place, Program};

use crate::model::{Late, Model};
use crate::pausing::{Pausing, apply};
use crate::subject::Subject;

/// What every state of a search shares.
#[derive(Debug)]
pub(crate) struct Ground<'p> {
    pub(crate) program: &'p Program,
    /// Per buffer of the program, its memory.
    pub(crate) homes: Vec<Home>,
    /// Memory that the program never writes, by number.
    pub(crate) fixed: Vec<Vec<u32>>,
    /// Moving words whose order matters come first; how many.
    pub(crate) ordered: usize,
    pub(crate) model: Model,
    /// Whether fences are events: the target has them and the model cares.
    pub(crate) has_fences: bool,
    /// A helper invocation: nothing that it writes has any effect, and what its atomic operations give is anything.
    pub(crate) helper: Option<usize>,
    /// Whether the interlock lets fragments in by number, the order of submission.
    pub(crate) by_submission: bool,
    /// Whether a fragment that has begun runs to its end before another does anything.
    pub(crate) one_by_one: bool,
    /// Whether a loop waits for the samples of the pass, so that fragments which are discarded end otherwise.
    pub(crate) counts_samples: bool,
}

/// Where a buffer lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Home {
    /// In `Ground::fixed`.
    Fixed(usize),
    /// In the words of states: the first, and how many.
    Moving { first: usize, words: usize, commutes: bool },
}

/// One state.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct State {
    /// The words that the program can write, as the last write left them.
    pub(crate) words: Vec<u32>,
    pub(crate) fragments: Vec<Status>,
    /// Who is inside the interlock.
    pub(crate) inside: Option<usize>,
    /// Who has left it, a bit each, where it lets fragments in by number.
    left: u32,
    /// Who runs, where fragments run one by one.
    alone: Option<usize>,
    pub(crate) late: Option<Box<Late>>,
}

/// Where a fragment stands.
#[derive(Clone, Debug)]
pub(crate) enum Status {
    /// Before an event.
    Before {
        event: Event,
        at: u32,
        /// What a machine is loaded from.
        saved: Vec<u32>,
    },
    /// It has ended; whether its sample passes.
    Ended(bool),
}

// The event follows from what is saved.
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

impl Status {
    /// Whether the fragment has ended.
    pub(crate) fn has_ended(&self) -> bool {
        matches!(self, Status::Ended(_))
    }
}

impl State {
    /// What an end state leaves: the words in memory, and behind them the samples that passed, where a loop waits for them.
    pub(crate) fn left_behind(&self, ground: &Ground<'_>) -> Vec<u32> {
        let mut words = self.words.clone();
        if ground.counts_samples {
            let passes = |(number, status): (usize, &Status)| {
                u32::from(*status == Status::Ended(true) && ground.helper != Some(number))
            };
            words.push(self.fragments.iter().enumerate().map(passes).sum());
        }
        words
    }
}

impl Hash for Status {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Status::Before { saved, .. } => saved.hash(state),
            Status::Ended(passes) => state.write_u8(1 + u8::from(*passes)),
        }
    }
}

/// What can go wrong in one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mishap {
    /// An index out of bounds, at this instruction.
    OutOfBounds(u32),
    /// A fragment goes round for ever without touching memory.
    Endless,
    /// An event that a fragment has no business with.
    Barrier,
}

impl<'p> Ground<'p> {
    /// For a program over this memory, with fences if it is late, and nothing else that a caller may set. Also: the words of
    /// the first state.
    pub(crate) fn new(program: &'p Program, memory: &[Vec<u32>], model: Model) -> (Self, Vec<u32>) {
        let (homes, words, ordered) = Ground::lay_out(program, memory);
        let ground = Ground {
            program,
            homes,
            fixed: memory.to_vec(),
            ordered,
            model,
            has_fences: model == Model::Late,
            helper: None,
            by_submission: false,
            one_by_one: false,
            counts_samples: false,
        };
        (ground, words)
    }

    /// Where each buffer of the program lies; the moving words, those whose order matters first; how many those are.
    fn lay_out(program: &Program, memory: &[Vec<u32>]) -> (Vec<Home>, Vec<u32>, usize) {
        let mut homes = vec![Home::Fixed(0); program.buffers.len()];
        let mut words: Vec<u32> = Vec::new();
        let mut ordered = 0;
        for commutes in [false, true] {
            for (number, buffer) in program.buffers.iter().enumerate() {
                let home = Subject::memory_of(buffer.binding);
                if !buffer.is_written {
                    homes[number] = Home::Fixed(home);
                } else if buffer.commutes == commutes {
                    let own = &memory[home];
                    homes[number] = Home::Moving { first: words.len(), words: own.len(), commutes };
                    words.extend_from_slice(own);
                }
            }
            if !commutes {
                ordered = words.len();
            }
        }
        (homes, words, ordered)
    }

    /// Per ordered word, what its buffer is.
    fn each_ordered(&self, is: impl Fn(&Buffer) -> bool) -> Vec<bool> {
        let mut all = vec![false; self.ordered];
        for (buffer, home) in self.program.buffers.iter().zip(&self.homes) {
            if let Home::Moving { first, words, commutes: false } = home {
                all[*first..first + words].fill(is(buffer));
            }
        }
        all
    }

    /// The number of a place among the moving words.
    pub(crate) fn word(&self, place: Place) -> Option<usize> {
        match self.homes[usize::from(place.buffer)] {
            Home::Moving { first, .. } => Some(first + place.word as usize),
            Home::Fixed(_) => None,
        }
    }

    /// The state before the first event of each machine.
    pub(crate) fn start(&self, words: Vec<u32>, machines: Vec<Machine<'_>>) -> Result<State, Mishap> {
        let late = (self.model == Model::Late).then(|| {
            // What is neither atomic nor coherent is private.
            let private = self.each_ordered(|buffer| !buffer.is_coherent);
            let wide = self.each_ordered(|buffer| buffer.is_wide);
            Box::new(Late::new(&words[..self.ordered], machines.len(), private, &wide))
        });
        let mut state = State { words, fragments: Vec::new(), inside: None, left: 0, alone: None, late };
        for (fragment, mut machine) in machines.into_iter().enumerate() {
            let status = self.run(&mut machine, fragment, None, &mut state.words)?;
            state.fragments.push(status);
        }
        Ok(state)
    }

    /// Lets a machine run to its next event.
    fn run(
        &self,
        machine: &mut Machine<'_>,
        fragment: usize,
        reply: Option<u64>,
        words: &mut [u32],
    ) -> Result<Status, Mishap> {
        machine.is_helper = self.helper == Some(fragment);
        let is_idle = machine.is_helper;
        let exit = machine.run(&mut Pausing { ground: self, reply, words, is_idle });
        if let Some(fault) = machine.fault.take() {
            return Err(Mishap::OutOfBounds(fault.at));
        }
        match exit {
            Exit::Ended => Ok(Status::Ended(true)),
            Exit::Discarded => Ok(Status::Ended(!self.counts_samples)),
            Exit::Endless => Err(Mishap::Endless),
            Exit::Stopped(Event::Barrier) => Err(Mishap::Barrier),
            Exit::Stopped(event) => {
                let mut saved = Vec::new();
                machine.save(&mut saved);
                Ok(Status::Before { event, at: machine.at(), saved })
            }
        }
    }

    /// The fragments that have not ended and may go on.
    pub(crate) fn running(&self, state: &State) -> Vec<usize> {
        let has_ended = |at: &usize| state.fragments[*at].has_ended();
        match state.alone {
            Some(fragment) => vec![fragment],
            None => (0..state.fragments.len()).filter(|at| !has_ended(at)).collect(),
        }
    }

    /// In how many ways a fragment's event can happen; 0: it has ended, or must wait for the interlock.
    pub(crate) fn choices(&self, state: &State, fragment: usize) -> u32 {
        let Status::Before { event, .. } = &state.fragments[fragment] else { return 0 };
        match (event, &state.late) {
            (Event::Access(access), _) if self.helper == Some(fragment) && access.writes() => 2,
            // The interlock does not wait for helper invocations, and what they read is what stands there.
            _ if self.helper == Some(fragment) => 1,
            (Event::CriticalBegin, _) => u32::from(state.inside.is_none() && self.is_next(state, fragment)),
            (Event::Access(access), Some(late)) => {
                self.word(access.place).map_or(1, |word| late.choices(fragment, word, access))
            }
            _ => 1,
        }
    }

    /// Whether nobody comes before a fragment who is yet to leave the interlock, if it has an order.
    fn is_next(&self, state: &State, fragment: usize) -> bool {
        let has_left = |other: usize| state.left >> other & 1 == 1 || state.fragments[other].has_ended();
        !self.by_submission || (0..fragment).all(has_left)
    }

    /// The state after a fragment's event has happened in the way of this number, and what the event saw.
    pub(crate) fn step(
        &self,
        machine: &mut Machine<'_>,
        state: &State,
        fragment: usize,
        choice: u32,
    ) -> Result<(State, u64), Mishap> {
        let Status::Before { event, saved, .. } = &state.fragments[fragment] else { return Ok((state.clone(), 0)) };
        let mut next = state.clone();
        let old = self.perform(&mut next, fragment, event, choice);
        machine.load(saved);
        next.fragments[fragment] = self.run(machine, fragment, Some(old), &mut next.words)?;
        next.alone = Some(fragment).filter(|at| self.one_by_one && !next.fragments[*at].has_ended());
        if let Some(late) = &mut next.late {
            let running: Vec<bool> = next.fragments.iter().map(|status| !status.has_ended()).collect();
            late.forget(&running);
        }
        Ok((next, old))
    }

    fn perform(&self, state: &mut State, fragment: usize, event: &Event, choice: u32) -> u64 {
        if self.helper == Some(fragment) {
            return self.seen_by_helper(state, event, choice);
        }
        match event {
            Event::CriticalBegin => state.inside = Some(fragment),
            Event::CriticalEnd => {
                state.inside = None;
                state.left |= u32::from(self.by_submission) << fragment;
            }
            _ => {}
        }
        let Event::Access(access) = event else {
            if let Some(late) = &mut state.late {
                late.order(fragment, event);
            }
            return 0;
        };
        let Some(word) = self.word(access.place) else { return 0 };
        match &mut state.late {
            None => apply(access, &mut state.words[word..]),
            Some(late) => {
                let old = late.perform(fragment, word, access, choice);
                if access.writes() {
                    let last = late.last(word);
                    state.words[word] = last as u32;
                    if access.words == 2 {
                        state.words[word + 1] = (last >> 32) as u32;
                    }
                }
                old
            }
        }
    }

    /// What a helper invocation is given: what stands there, or, by an operation that writes, anything else.
    fn seen_by_helper(&self, state: &State, event: &Event, choice: u32) -> u64 {
        match event {
            Event::Access(access) if choice == 0 => {
                self.word(access.place).map_or(0, |word| joined(&state.words[word..], access.words))
            }
            _ => u64::from(u32::MAX),
        }
    }

    /// Whether a step has brought a fragment back to where it stood, and nothing else has changed: it has seen an old
    /// value once more, and may as well not have looked.
    pub(crate) fn is_idle(&self, before: &State, after: &State, fragment: usize) -> bool {
        before.words == after.words
            && before.late == after.late
            && is_same_but_one(&before.fragments[fragment], &after.fragments[fragment])
    }

    /// Whether a fragment, run alone, would come back to where it stands without having changed anything: it waits for
    /// another. Where it stands may differ in one word, the number of its tries.
    pub(crate) fn waits(&self, machine: &mut Machine<'_>, state: &State, fragment: usize) -> bool {
        let Status::Before { at, .. } = &state.fragments[fragment] else { return false };
        if !self.program.is_in_loop(*at) {
            return false;
        }
        let mut words = state.words.clone();
        let mut now = state.fragments[fragment].clone();
        // A round of a wait reads no more words than this.
        for _ in 0..32 {
            let Status::Before { event: Event::Access(access), saved, .. } = &now else { return false };
            let Some(word) = self.word(access.place) else { return false };
            let before = joined(&words[word..], access.words);
            let is_helper = self.helper == Some(fragment);
            if access.new_value(before) != before && !is_helper {
                return false;
            }
            // The worst that a helper invocation can be given: it never sees what it hopes for.
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

/// Whether both stand before the same event, and all that matters is the same but for one word at most.
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

pub(crate) fn joined(words: &[u32], count: u8) -> u64 {
    let low = u64::from(words[0]);
    if count == 2 { low | u64::from(words[1]) << 32 } else { low }
}

/// Whether two accesses that are about to happen are a data race: the same word, one of them writes, not both atomic.
pub(crate) fn race(one: &Access, other: &Access) -> bool {
    let meets = |a: &Access, b: &Access| {
        a.place.buffer == b.place.buffer && (a.place.word..a.place.word + u32::from(a.words)).contains(&b.place.word)
    };
    let same = meets(one, other) || meets(other, one);
    same && (one.operation != Operation::Load || other.operation != Operation::Load)
        && !(one.is_atomic && other.is_atomic)
}

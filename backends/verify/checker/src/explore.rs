//! Every order of events: breadth first, so that the first failure has the shortest schedule.
//!
//! In: a first state and a judge. Out: how many states there are, or how the first failure is reached. States are known
//! again by a fingerprint of 128 bits; a state is kept only until it has been followed.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, VecDeque};
use std::hash::{BuildHasherDefault, Hash, Hasher};

use fragbuf_interpreter::{Event, Machine};

use crate::state::{Ground, Mishap, State, Status, race};

/// What judges states.
pub(crate) trait Judge {
    /// What is wrong with memory at this instant.
    fn instant(&mut self, words: &[u32]) -> Option<String>;
    /// What is to be said of memory at the end.
    fn end(&mut self, words: &[u32]) -> End;
}

/// What a judge says of an end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum End {
    Right,
    /// Not right, in words, but no worse than is stated.
    Stated(String),
    Wrong(String),
    /// It is no end: the pass is drawn again.
    GoesOn,
}

/// One step: which fragment, and in which of the ways.
pub(crate) type Step = (usize, u32);

/// What a search found.
#[derive(Debug, Default)]
pub(crate) struct Found {
    pub(crate) states: usize,
    /// Whether every state was followed, or some were beyond the limit.
    pub(crate) is_whole: bool,
    pub(crate) failure: Option<Failure>,
    /// The first end that is no worse than is stated.
    pub(crate) stated: Option<Failure>,
    /// Memory at ends from which the pass is drawn again, and how each was reached first.
    pub(crate) goes_on: Vec<(Vec<u32>, Vec<Step>)>,
}

impl Found {
    /// Takes note of an end that the steps lead to; the failure, if it is one.
    pub(crate) fn note(&mut self, end: End, words: &[u32], steps: impl FnOnce() -> Vec<Step>) -> Option<Failure> {
        match end {
            End::Right => None,
            End::Wrong(text) => Some(Failure { steps: steps(), what: What::Outcome(text) }),
            End::Stated(text) => {
                self.stated.get_or_insert_with(|| Failure { steps: steps(), what: What::Outcome(text) });
                None
            }
            End::GoesOn => {
                if !self.goes_on.iter().any(|(known, _)| known == words) {
                    self.goes_on.push((words.to_vec(), steps()));
                }
                None
            }
        }
    }
}

/// The shortest way to a failure.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    pub(crate) steps: Vec<Step>,
    pub(crate) what: What,
}

/// What went wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum What {
    /// The end state, or the invariant at an instant, as the judge says.
    Outcome(String),
    Instant(String),
    /// Two fragments are about to touch one word, and one of them not atomically.
    Race(usize, usize),
    /// Nobody can go on: these wait.
    Waiting(Vec<usize>),
    /// From here no order of steps leads to an end: these go round for ever.
    Circling(Vec<usize>),
    Mishap(usize, Mishap),
}

/// Searches from `first`, up to `limit` states.
pub(crate) fn explore(ground: &Ground<'_>, first: State, judge: &mut dyn Judge, limit: usize) -> Found {
    let mut search = Search {
        ground,
        machine: Machine::new(ground.program),
        seen: HashMap::default(),
        parents: Vec::new(),
        edges: Vec::new(),
        ends: Vec::new(),
        waiting: VecDeque::new(),
        found: Found::default(),
    };
    let running = (0..first.fragments.len()).filter(|fragment| !first.fragments[*fragment].has_ended()).collect();
    search.visit(first, None);
    let mut failure = search.run(judge, limit);
    if failure.is_none() && search.waiting.is_empty() {
        failure = search.dead_end().map(|steps| Failure { steps, what: What::Circling(running) });
    }
    Found { is_whole: search.waiting.is_empty() || failure.is_some(), failure, ..search.found }
}

struct Search<'a, 'p> {
    ground: &'a Ground<'p>,
    machine: Machine<'p>,
    seen: HashMap<u128, u32, BuildHasherDefault<Identity>>,
    /// Per state, the state before it and the step from there.
    parents: Vec<(u32, u8, u8)>,
    /// Every step, from state to state.
    edges: Vec<(u32, u32)>,
    ends: Vec<u32>,
    waiting: VecDeque<(State, u32)>,
    found: Found,
}

impl Search<'_, '_> {
    fn visit(&mut self, state: State, from: Option<(u32, Step)>) {
        let number = self.parents.len() as u32;
        let known = match self.seen.entry(fingerprint(&state)) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(place) => {
                place.insert(number);
                let (parent, (fragment, choice)) = from.unwrap_or((u32::MAX, (0, 0)));
                self.parents.push((parent, fragment as u8, choice as u8));
                self.waiting.push_back((state, number));
                self.found.states += 1;
                number
            }
        };
        if let Some((parent, _)) = from {
            self.edges.push((parent, known));
        }
    }

    fn run(&mut self, judge: &mut dyn Judge, limit: usize) -> Option<Failure> {
        while let Some((state, number)) = self.waiting.pop_front() {
            if let Some(what) = self.follow(&state, number, judge) {
                return Some(what);
            }
            if self.found.states >= limit {
                return None;
            }
        }
        None
    }

    /// Every step from a state.
    fn follow(&mut self, state: &State, number: u32, judge: &mut dyn Judge) -> Option<Failure> {
        let fail = |search: &Self, what| Some(Failure { steps: search.path(number), what });
        if let Some((one, other)) = racing(self.ground, state) {
            return fail(self, What::Race(one, other));
        }
        let mut is_stuck = true;
        let running = self.ground.running(state);
        if running.is_empty() {
            self.ends.push(number);
            let parents = &self.parents;
            let words = state.left_behind(self.ground);
            return self.found.note(judge.end(&words), &words, || path(parents, number));
        }
        for &fragment in &running {
            if self.ground.waits(&mut self.machine, state, fragment) {
                if self.ground.helper == Some(fragment) {
                    return fail(self, What::Waiting(vec![fragment]));
                }
                continue;
            }
            for choice in 0..self.ground.choices(state, fragment) {
                is_stuck = false;
                match self.ground.step(&mut self.machine, state, fragment, choice) {
                    Err(mishap) => {
                        let mut failure = Failure { steps: self.path(number), what: What::Mishap(fragment, mishap) };
                        failure.steps.push((fragment, choice));
                        return Some(failure);
                    }
                    Ok((next, _)) if self.ground.is_idle(state, &next, fragment) => {}
                    Ok((next, _)) => {
                        if next.words != state.words
                            && let Some(text) = judge.instant(&next.words)
                        {
                            let mut failure = Failure { steps: self.path(number), what: What::Instant(text) };
                            failure.steps.push((fragment, choice));
                            return Some(failure);
                        }
                        self.visit(next, Some((number, (fragment, choice))));
                    }
                }
            }
        }
        if is_stuck { fail(self, What::Waiting(running)) } else { None }
    }

    /// The steps to a first state that no steps lead to an end from.
    fn dead_end(&mut self) -> Option<Vec<Step>> {
        let count = self.parents.len();
        self.edges.sort_unstable_by_key(|(_, to)| *to);
        let mut ends = vec![false; count];
        let mut waiting = std::mem::take(&mut self.ends);
        waiting.iter().for_each(|end| ends[*end as usize] = true);
        while let Some(state) = waiting.pop() {
            let first = self.edges.partition_point(|(_, to)| *to < state);
            for (from, _) in self.edges[first..].iter().take_while(|(_, to)| *to == state) {
                if !std::mem::replace(&mut ends[*from as usize], true) {
                    waiting.push(*from);
                }
            }
        }
        ends.iter().position(|reaches| !reaches).map(|state| self.path(state as u32))
    }

    fn path(&self, number: u32) -> Vec<Step> {
        path(&self.parents, number)
    }
}

/// The steps that lead to a state.
fn path(parents: &[(u32, u8, u8)], mut number: u32) -> Vec<Step> {
    let mut steps = Vec::new();
    while let Some(&(parent, fragment, choice)) = parents.get(number as usize) {
        if parent == u32::MAX {
            break;
        }
        steps.push((usize::from(fragment), u32::from(choice)));
        number = parent;
    }
    steps.reverse();
    steps
}

/// Two fragments that are about to race. What a helper invocation reads is of no consequence.
pub(crate) fn racing(ground: &Ground<'_>, state: &State) -> Option<(usize, usize)> {
    let access = |fragment: usize| match &state.fragments[fragment] {
        Status::Before { event: Event::Access(access), .. } if ground.helper != Some(fragment) => Some(*access),
        _ => None,
    };
    let count = state.fragments.len();
    (0..count)
        .flat_map(|one| (one + 1..count).map(move |other| (one, other)))
        .find(|(one, other)| matches!((access(*one), access(*other)), (Some(one), Some(other)) if race(&one, &other)))
}

/// Two lanes of 64 bits, mixed apart.
fn fingerprint(state: &State) -> u128 {
    let mut hasher = Lanes(0x9e37_79b9_7f4a_7c15, 0xc2b2_ae3d_27d4_eb4f);
    state.hash(&mut hasher);
    u128::from(hasher.0) << 64 | u128::from(hasher.1)
}

struct Lanes(u64, u64);

impl Lanes {
    fn mix(&mut self, value: u64) {
        self.0 = (self.0 ^ value).wrapping_mul(0xff51_afd7_ed55_8ccd);
        self.0 ^= self.0 >> 32;
        self.1 = (self.1.rotate_left(23) ^ value).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        self.1 ^= self.1 >> 29;
    }
}

impl Hasher for Lanes {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.mix(u64::from_le_bytes(word));
        }
    }

    fn write_usize(&mut self, value: usize) {
        self.mix(value as u64 ^ 0x5bd1_e995);
    }

    fn write_u64(&mut self, value: u64) {
        self.mix(value);
    }

    fn write_u32(&mut self, value: u32) {
        self.mix(value.into());
    }

    fn write_u8(&mut self, value: u8) {
        self.mix(value.into());
    }
}

/// A fingerprint is its own hash.
#[derive(Default)]
struct Identity(u64);

impl Hasher for Identity {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.0 ^= u64::from_le_bytes(word);
        }
    }

    fn write_u128(&mut self, value: u128) {
        self.0 = value as u64;
    }
}

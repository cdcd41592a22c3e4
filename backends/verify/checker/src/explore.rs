//! Explores every interleaving of events, breadth first, so that the first failure has the shortest schedule.
//!
//! Input: a first state and a property. Output: the number of states, or the schedule of the first failure. A state is
//! recognised by its fingerprint, and is kept in memory only until its steps have been followed.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, VecDeque};
use std::hash::BuildHasherDefault;

use fragbuf_interpreter::Machine;

use crate::context::SearchContext;
use crate::fingerprint::{Identity, fingerprint};
use crate::search::{Failure, FailureKind, Property, SearchResult, Step};
use crate::state::{State, racing};

/// Searches from `first`, up to `limit` states.
pub(crate) fn explore(
    context: &SearchContext<'_>,
    first: State,
    property: &mut dyn Property,
    limit: usize,
) -> SearchResult {
    let mut exploration = Exploration {
        context,
        machine: Machine::new(context.program),
        numbers: HashMap::default(),
        parents: Vec::new(),
        edges: Vec::new(),
        final_states: Vec::new(),
        queue: VecDeque::new(),
        result: SearchResult::default(),
    };
    let running = (0..first.fragments.len()).filter(|fragment| !first.fragments[*fragment].has_ended()).collect();
    exploration.visit(first, None);
    let mut failure = exploration.run(property, limit);
    if failure.is_none() && exploration.queue.is_empty() {
        let livelock = exploration.livelock();
        failure = livelock.map(|steps| Failure { steps, kind: FailureKind::Livelock(running) });
    }
    let is_exhaustive = exploration.queue.is_empty() || failure.is_some();
    SearchResult { is_exhaustive, failure, ..exploration.result }
}

struct Exploration<'a, 'p> {
    context: &'a SearchContext<'p>,
    machine: Machine<'p>,
    /// The number of each visited state, by its fingerprint.
    numbers: HashMap<u128, u32, BuildHasherDefault<Identity>>,
    /// Per state, the state before it and the step from there.
    parents: Vec<(u32, u8, u8)>,
    /// Every step, from state to state.
    edges: Vec<(u32, u32)>,
    final_states: Vec<u32>,
    /// States whose steps have not been followed.
    queue: VecDeque<(State, u32)>,
    result: SearchResult,
}

impl Exploration<'_, '_> {
    fn visit(&mut self, state: State, from: Option<(u32, Step)>) {
        let number = self.parents.len() as u32;
        let known = match self.numbers.entry(fingerprint(&state)) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(entry) => {
                entry.insert(number);
                let (parent, (fragment, choice)) = from.unwrap_or((u32::MAX, (0, 0)));
                self.parents.push((parent, fragment as u8, choice as u8));
                self.queue.push_back((state, number));
                self.result.states += 1;
                number
            }
        };
        if let Some((parent, _)) = from {
            self.edges.push((parent, known));
        }
    }

    fn run(&mut self, property: &mut dyn Property, limit: usize) -> Option<Failure> {
        while let Some((state, number)) = self.queue.pop_front() {
            if let Some(failure) = self.follow(&state, number, property) {
                return Some(failure);
            }
            if self.result.states >= limit {
                return None;
            }
        }
        None
    }

    /// Takes every step from a state.
    fn follow(&mut self, state: &State, number: u32, property: &mut dyn Property) -> Option<Failure> {
        if let Some((one, other)) = racing(self.context, state) {
            return self.failure(number, None, FailureKind::DataRace(one, other));
        }
        let running = self.context.running(state);
        if running.is_empty() {
            self.final_states.push(number);
            let parents = &self.parents;
            let words = state.final_words(self.context);
            return self.result.record(property.final_state(&words), &words, || path(parents, number));
        }
        let mut is_stuck = true;
        for &fragment in &running {
            if self.context.waits(&mut self.machine, state, fragment) {
                if self.context.helper == Some(fragment) {
                    return self.failure(number, None, FailureKind::Deadlock(vec![fragment]));
                }
                continue;
            }
            for choice in 0..self.context.choices(state, fragment) {
                is_stuck = false;
                let step = (fragment, choice);
                match self.context.step(&mut self.machine, state, fragment, choice) {
                    Err(error) => return self.failure(number, Some(step), FailureKind::Step(fragment, error)),
                    Ok((next, _)) if self.context.is_idle(state, &next, fragment) => {}
                    Ok((next, _)) => {
                        if next.words != state.words
                            && let Some(text) = property.instant(&next.words)
                        {
                            return self.failure(number, Some(step), FailureKind::Instant(text));
                        }
                        self.visit(next, Some((number, step)));
                    }
                }
            }
        }
        if is_stuck { self.failure(number, None, FailureKind::Deadlock(running)) } else { None }
    }

    /// Returns a failure in a state, or in one more step from it.
    fn failure(&self, number: u32, step: Option<Step>, kind: FailureKind) -> Option<Failure> {
        let mut steps = path(&self.parents, number);
        steps.extend(step);
        Some(Failure { steps, kind })
    }

    /// Returns the steps to the first state from which no steps lead to a final state.
    fn livelock(&mut self) -> Option<Vec<Step>> {
        let count = self.parents.len();
        self.edges.sort_unstable_by_key(|(_, to)| *to);
        let mut terminates = vec![false; count];
        let mut queue = std::mem::take(&mut self.final_states);
        queue.iter().for_each(|state| terminates[*state as usize] = true);
        while let Some(state) = queue.pop() {
            let first = self.edges.partition_point(|(_, to)| *to < state);
            for (from, _) in self.edges[first..].iter().take_while(|(_, to)| *to == state) {
                if !std::mem::replace(&mut terminates[*from as usize], true) {
                    queue.push(*from);
                }
            }
        }
        terminates.iter().position(|terminates| !terminates).map(|state| path(&self.parents, state as u32))
    }
}

/// Returns the steps that lead to a state.
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

//! Explores every interleaving of events, breadth first, so that the first failure has the shortest schedule.
//!
//! Input: a first state and a property. Output: the number of states, or the schedule of the first failure. A state is
//! recognised by its fingerprint, and is kept in memory only until its steps have been followed. A reduced search follows one
//! order of steps that do not affect each other (`reduction.rs`).

use std::collections::hash_map::Entry;
use std::collections::{BTreeSet, HashMap, VecDeque};
use std::hash::BuildHasherDefault;

use crate::context::SearchContext;
use crate::fingerprint::{Identity, fingerprint};
use crate::graph::StateGraph;
use crate::progress::RunOn;
use crate::reduction::independent;
use crate::runner::Runner;
use crate::search::{Failure, FailureKind, Property, RUN_ON, SearchResult, Step};
use crate::state::State;
use crate::turn::Allowance;
use crate::watched::WatchedWords;

/// Searches from `first`, up to `limit` states.
pub(crate) fn explore(
    context: &SearchContext<'_>,
    first: State,
    property: &mut dyn Property,
    limit: usize,
) -> SearchResult {
    let mut exploration = Exploration {
        context,
        runner: Runner::new(context),
        watched: WatchedWords::new(context, property),
        first: first.clone(),
        numbers: HashMap::default(),
        graph: StateGraph::default(),
        queue: VecDeque::new(),
        undecided: BTreeSet::new(),
        result: SearchResult::default(),
    };
    let running = context.running(&first);
    exploration.visit(first, None);
    let mut allowance = Allowance::new(context.turn.as_ref(), limit);
    let failure = exploration.run(property, &mut allowance, &running);
    let is_exhaustive = failure.is_some() || (exploration.queue.is_empty() && exploration.undecided.is_empty());
    SearchResult { is_exhaustive, failure, ..exploration.result }
}

struct Exploration<'a, 'p> {
    context: &'a SearchContext<'p>,
    runner: Runner<'p>,
    watched: WatchedWords,
    first: State,
    /// The number of each visited state, by its fingerprint.
    numbers: HashMap<u128, u32, BuildHasherDefault<Identity>>,
    graph: StateGraph,
    /// States whose steps have not been followed.
    queue: VecDeque<(State, u32)>,
    /// The states in which no fragment moves on, but the loop of one is too long to decide whether it waits.
    undecided: BTreeSet<u32>,
    result: SearchResult,
}

/// What the steps of some fragments lead to.
#[derive(Clone, Copy, Debug, Default)]
struct Moves {
    /// Another state.
    other: bool,
    /// A state that had not been visited.
    new: bool,
}

impl Exploration<'_, '_> {
    /// Records a state and the step that leads to it; returns its number and whether it is new.
    fn visit(&mut self, state: State, from: Option<(u32, Step, bool)>) -> (u32, bool) {
        let number = self.graph.count();
        let (number, is_new) = match self.numbers.entry(fingerprint(&state)) {
            Entry::Occupied(known) => (*known.get(), false),
            Entry::Vacant(entry) => {
                entry.insert(number);
                self.graph.push(from.map(|(parent, step, _)| (parent, step)));
                self.queue.push_back((state, number));
                self.result.states += 1;
                (number, true)
            }
        };
        if let Some((parent, _, has_effect)) = from {
            self.graph.connect(parent, number, has_effect);
        }
        (number, is_new)
    }

    /// Follows every state. Where no final state can be reached, loops run on to their limits.
    fn run(
        &mut self,
        property: &mut dyn Property,
        allowance: &mut Allowance<'_>,
        running: &[usize],
    ) -> Option<Failure> {
        loop {
            while let Some((state, number)) = self.queue.pop_front() {
                if let Some(failure) = self.follow(&state, number, property) {
                    return Some(failure);
                }
                if allowance.is_used_up(self.result.states) {
                    return None;
                }
            }
            let endless = self.graph.endless()?;
            if endless.idle.is_empty() {
                return self.failure(endless.first, None, FailureKind::Livelock(running.to_vec()));
            }
            match self.run_on_from_any(&endless.idle) {
                Err(failure) => return Some(failure),
                Ok(true) => {}
                Ok(false) => {
                    let waits = endless.idle.iter().find(|number| !self.undecided.contains(number)).copied()?;
                    let kind = FailureKind::Deadlock(self.running_in(waits));
                    return self.failure(waits, None, kind);
                }
            }
        }
    }

    /// Takes every step from a state.
    fn follow(&mut self, state: &State, number: u32, property: &mut dyn Property) -> Option<Failure> {
        let running = self.context.running(state);
        if running.is_empty() {
            self.graph.end(number);
            let words = state.final_words(self.context);
            let verdict = property.final_state(&words);
            return self.result.record(verdict, &words, || self.graph.path(number));
        }
        if let Some(helper) = self.context.helper.filter(|helper| running.contains(helper))
            && self.context.helper_waits(&mut self.runner, state, helper)
        {
            return self.failure(number, None, FailureKind::Deadlock(vec![helper]));
        }
        if let Some((fragment, is_in_loop)) = independent(self.context, &self.watched, state, &running) {
            match self.take(state, number, &[fragment], property) {
                Err(failure) => return Some(failure),
                // A loop of independent steps alone would keep the other fragments from running.
                Ok(moves) if moves.new || moves.other && !is_in_loop => return None,
                Ok(_) => {}
            }
        }
        match self.take(state, number, &running, property) {
            Err(failure) => return Some(failure),
            Ok(moves) if moves.other => return None,
            Ok(_) => {}
        }
        match self.run_on(state, number, &running) {
            Err(failure) => Some(failure),
            Ok(moves) if moves.other || self.undecided.contains(&number) => None,
            Ok(_) => self.failure(number, None, FailureKind::Deadlock(running)),
        }
    }

    /// Takes every step of some fragments.
    fn take(
        &mut self,
        state: &State,
        number: u32,
        fragments: &[usize],
        property: &mut dyn Property,
    ) -> Result<Moves, Failure> {
        let mut moves = Moves::default();
        for &fragment in fragments {
            for choice in 0..self.context.choices(state, fragment) {
                let step = (fragment, choice);
                let stepped = match self.context.step(&mut self.runner, state, fragment, choice) {
                    Ok(stepped) => stepped,
                    Err(error) => {
                        return Err(self.failed(number, Some(step), FailureKind::Step(fragment, error)));
                    }
                };
                if stepped.state.words != state.words
                    && let Some(text) = property.instant(&stepped.state.words)
                {
                    return Err(self.failed(number, Some(step), FailureKind::Instant(text)));
                }
                let (next, is_new) = self.visit(stepped.state, Some((number, step, stepped.has_effect)));
                moves = Moves { other: moves.other || next != number, new: moves.new || is_new };
            }
        }
        Ok(moves)
    }

    /// Lets each fragment run on alone. Where none moves, the state is undecided if the loop of one is too long.
    fn run_on(&mut self, state: &State, number: u32, running: &[usize]) -> Result<Moves, Failure> {
        let (mut moves, mut is_decided) = (Moves::default(), true);
        for &fragment in running {
            let step = (fragment, RUN_ON);
            match self.context.run_on(&mut self.runner, state, fragment) {
                RunOn::Moved(next) => {
                    let (next, is_new) = self.visit(next, Some((number, step, true)));
                    moves = Moves { other: moves.other || next != number, new: moves.new || is_new };
                }
                RunOn::Waits => {}
                RunOn::TooLong => is_decided = false,
                RunOn::Failed(kind) => return Err(self.failed(number, Some(step), kind)),
            }
        }
        if !moves.other && !is_decided {
            self.undecided.insert(number);
        }
        Ok(moves)
    }

    /// The same for states that are no longer in memory, up to one from which a fragment moves; returns whether there is one.
    fn run_on_from_any(&mut self, numbers: &[u32]) -> Result<bool, Failure> {
        for &number in numbers.iter().filter(|number| !self.undecided.contains(number)).collect::<Vec<_>>() {
            let Some(state) = self.replay(number) else { continue };
            let running = self.context.running(&state);
            if self.run_on(&state, number, &running)?.other {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn running_in(&mut self, number: u32) -> Vec<usize> {
        self.replay(number).map_or_else(Vec::new, |state| self.context.running(&state))
    }

    fn replay(&mut self, number: u32) -> Option<State> {
        let steps = self.graph.path(number);
        steps
            .into_iter()
            .try_fold(self.first.clone(), |state, step| self.context.replay(&mut self.runner, &state, step))
    }

    /// Returns a failure in a state, or in one more step from it.
    fn failure(&self, number: u32, step: Option<Step>, kind: FailureKind) -> Option<Failure> {
        Some(self.failed(number, step, kind))
    }

    fn failed(&self, number: u32, step: Option<Step>, kind: FailureKind) -> Failure {
        let mut steps = self.graph.path(number);
        steps.extend(step);
        Failure { steps, kind }
    }
}

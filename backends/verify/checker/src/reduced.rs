//! Dynamic partial-order reduction (Flanagan and Godefroid 2005), with recognised states (Yang et al. 2008).
//!
//! Input: a first state and a property. Output: whether a failure exists. The search is depth first. In each state it follows
//! one fragment. If the step of that fragment can come first (`reduction.rs`), no other is followed. Otherwise another fragment
//! is followed if a later step of it conflicts with a step that was followed there and nothing orders the two, so that another
//! order may have another outcome. A step that can come first orders no later step. When the search comes to a state that it
//! has visited, it compares the summary of the steps after that state with the steps that lead there now. A failure, a deadlock and a cycle are left to the search of all interleavings,
//! which finds the shortest schedule.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::BuildHasherDefault;

use fragbuf_interpreter::Machine;

use crate::context::SearchContext;
use crate::explore::explore;
use crate::fingerprint::{Identity, fingerprint};
use crate::footprint::{Footprint, Summaries};
use crate::graph::StateGraph;
use crate::reduction::independent;
use crate::search::{Failure, FailureKind, Property, SearchResult};
use crate::state::{State, Status};
use crate::watched::WatchedWords;

/// Searches from `first`, up to `limit` states.
pub(crate) fn explore_reduced(
    context: &SearchContext<'_>,
    first: State,
    property: &mut dyn Property,
    limit: usize,
) -> SearchResult {
    if !context.is_reduced || context.by_submission || context.one_by_one {
        return explore(context, first, property, limit);
    }
    let fragments = first.fragments.len();
    let mut search = ReducedSearch {
        context,
        machine: Machine::new(context.program),
        watched: WatchedWords::new(context, property),
        numbers: HashMap::default(),
        depths: Vec::new(),
        incomplete: HashMap::new(),
        graph: StateGraph::default(),
        summaries: Summaries::new(fragments),
        stack: Vec::new(),
        result: SearchResult::default(),
    };
    search.visit(first.clone(), &vec![0; fragments * fragments], None);
    let found = match search.run(property, limit) {
        Ok(is_exhaustive) if !is_exhaustive || search.graph.endless().is_none() => {
            return SearchResult { is_exhaustive, ..search.result };
        }
        Ok(_) => None,
        Err(Undecided(found)) => found,
    };
    // The steps of a failure are an execution, so it needs no confirmation. A loop that is too long decides nothing.
    let found = match found {
        Some(failure) if !context.wants_shortest && !failure.is_undecided() => {
            return SearchResult { is_exhaustive: true, failure: Some(failure), ..search.result };
        }
        found => found,
    };
    let result = explore(context, first, property, limit);
    match result.is_exhaustive {
        true => result,
        false => SearchResult { failure: result.failure.or(found), ..result },
    }
}

/// The most steps of a schedule. The search compares each step with those before it.
const DEEPEST: usize = 10_000;

/// The search has found something that the search of all interleavings must decide.
struct Undecided(Option<Failure>);

struct ReducedSearch<'a, 'p> {
    context: &'a SearchContext<'p>,
    machine: Machine<'p>,
    watched: WatchedWords,
    numbers: HashMap<u128, u32, BuildHasherDefault<Identity>>,
    /// Per state, its depth in the stack, or [`DONE`].
    depths: Vec<u32>,
    /// The states that were left while a cycle leads from them to a state on the stack, and its depth. Their summaries are not
    /// complete before that state is left.
    incomplete: HashMap<u32, u32>,
    graph: StateGraph,
    summaries: Summaries,
    stack: Vec<Visit>,
    result: SearchResult,
}

const DONE: u32 = u32::MAX;

/// A state on the way to the present one.
struct Visit {
    state: State,
    number: u32,
    /// The fragments that can take a step, those to follow and those that were followed, a bit each.
    able: u32,
    to_follow: u32,
    followed: u32,
    /// Whether the step of one fragment can come first, so that no other need be followed.
    is_alone: bool,
    /// The step that is followed: its fragment and footprint, the next choice and the number of choices.
    fragment: usize,
    footprint: Footprint,
    choice: u32,
    choices: u32,
    /// The clock of that step, per fragment.
    clock: Vec<u32>,
    /// Per fragment, the last steps of each fragment that happen before its next one. A step's number is its depth plus one.
    clocks: Vec<u32>,
    has_moved: bool,
    /// Whether the step changes anything but the status of its fragment.
    has_effect: bool,
    /// Whether a step leads to a state that is not on the stack.
    has_exit: bool,
    /// The depth to which a fragment comes back by a choice of the step that changes nothing.
    returns_to: Option<usize>,
    /// The least depth to which a cycle leads from this state or a later one.
    depends_on: u32,
    /// The states that are incomplete until this one is left.
    dependents: Vec<u32>,
}

impl ReducedSearch<'_, '_> {
    /// Pushes a state that has not been visited; returns its number and whether it is new.
    fn visit(&mut self, state: State, clocks: &[u32], last: Option<usize>) -> (u32, bool) {
        let number = self.graph.count();
        match self.numbers.entry(fingerprint(&state)) {
            Entry::Occupied(known) => return (*known.get(), false),
            Entry::Vacant(entry) => entry.insert(number),
        };
        self.graph.push(None);
        self.summaries.push();
        self.depths.push(self.stack.len() as u32);
        self.result.states += 1;
        let running = self.context.running(&state);
        let able: Vec<usize> =
            running.iter().copied().filter(|fragment| self.context.choices(&state, *fragment) > 0).collect();
        let alone = independent(self.context, &self.watched, &state, &running).map(|(fragment, _)| fragment);
        let first = alone.or(last.filter(|last| able.contains(last))).or(able.first().copied());
        let local = Footprint::new(self.context, 0, &fragbuf_interpreter::Event::Fence, &self.watched);
        self.stack.push(Visit {
            number,
            able: able.iter().map(|fragment| 1 << fragment).sum(),
            to_follow: first.map_or(0, |fragment| 1 << fragment),
            followed: 0,
            is_alone: alone.is_some(),
            fragment: 0,
            footprint: local,
            choice: 0,
            choices: 0,
            clock: Vec::new(),
            clocks: clocks.to_vec(),
            has_moved: running.is_empty(),
            has_effect: false,
            has_exit: false,
            returns_to: None,
            depends_on: DONE,
            dependents: Vec::new(),
            state,
        });
        (number, true)
    }

    /// Follows every state on the stack; returns whether all were followed.
    fn run(&mut self, property: &mut dyn Property, limit: usize) -> Result<bool, Undecided> {
        while let Some(top) = self.stack.len().checked_sub(1) {
            if top > DEEPEST {
                return Err(Undecided(None));
            }
            if self.stack[top].able == 0 && self.stack[top].has_moved {
                self.end(top, property)?;
            }
            if self.stack[top].choice < self.stack[top].choices {
                self.take(top, property)?;
                if self.result.states >= limit {
                    return Ok(false);
                }
            } else if !self.begin_next(top)? {
                self.leave();
            }
        }
        Ok(true)
    }

    /// Records a final state.
    fn end(&mut self, top: usize, property: &mut dyn Property) -> Result<(), Undecided> {
        let Visit { state, number, .. } = &self.stack[top];
        self.graph.end(*number);
        let words = state.final_words(self.context);
        let verdict = property.final_state(&words);
        let steps = self.stack[..top].iter().map(|visit| (visit.fragment, visit.choice - 1)).collect();
        self.result.record(verdict, &words, || steps).map_or(Ok(()), |failure| Err(Undecided(Some(failure))))
    }

    /// Begins with the steps of the next fragment to follow in the topmost state; returns whether there is one.
    fn begin_next(&mut self, top: usize) -> Result<bool, Undecided> {
        if let Some(depth) = self.stack[top].returns_to.take()
            && !self.stack[top].has_exit
        {
            self.follow_all(depth);
        }
        let visit = &mut self.stack[top];
        // A fragment that has only waited decides nothing.
        if visit.to_follow & !visit.followed == 0 && !visit.has_moved {
            visit.is_alone = false;
            match visit.able & !visit.followed {
                0 => return Err(Undecided(None)),
                others => visit.to_follow |= 1 << others.trailing_zeros(),
            }
        }
        let remaining = visit.to_follow & !visit.followed;
        if remaining == 0 {
            return Ok(false);
        }
        let fragment = remaining.trailing_zeros() as usize;
        let Status::Before { event, .. } = &visit.state.fragments[fragment] else { return Err(Undecided(None)) };
        visit.followed |= 1 << fragment;
        visit.fragment = fragment;
        visit.footprint = Footprint::new(self.context, fragment, event, &self.watched);
        visit.choice = 0;
        visit.choices = self.context.choices(&visit.state, fragment);
        let is_helper = self.context.helper == Some(fragment);
        let (state, footprint) = (&self.stack[top].state, self.stack[top].footprint);
        if is_helper && self.context.helper_waits(&mut self.machine, state, fragment) {
            return Err(Undecided(None));
        }
        let clock = self.clock_of(top, fragment, footprint);
        self.stack[top].clock = clock;
        let count = self.stack[top].state.fragments.len();
        let (below, visit) = self.stack.split_at_mut(top);
        let known = &visit[0].clocks[fragment * count..(fragment + 1) * count];
        Self::follow_before(below, fragment, known, |earlier| earlier.conflicts(footprint));
        self.summaries.add(self.stack[top].number, fragment, footprint);
        Ok(true)
    }

    /// Returns the clock of a step that a fragment takes in the topmost state.
    fn clock_of(&self, top: usize, fragment: usize, footprint: Footprint) -> Vec<u32> {
        let count = self.stack[top].state.fragments.len();
        let mut clock = self.stack[top].clocks[fragment * count..(fragment + 1) * count].to_vec();
        // A step that can come first does not order the steps that conflict with it.
        let orders = |earlier: &&Visit| !earlier.is_alone && earlier.footprint.conflicts(footprint);
        for earlier in self.stack[..top].iter().filter(orders) {
            clock.iter_mut().zip(&earlier.clock).for_each(|(one, other)| *one = (*one).max(*other));
        }
        clock[fragment] = top as u32 + 1;
        clock
    }

    /// Lets a fragment be followed in every state whose step conflicts with a later step of the fragment, unless the one happens
    /// before the other. `clock`: the steps that happen before the later one, per fragment.
    fn follow_before(stack: &mut [Visit], fragment: usize, clock: &[u32], conflicts: impl Fn(Footprint) -> bool) {
        for (depth, earlier) in stack.iter_mut().enumerate() {
            let is_before = clock[earlier.fragment] > depth as u32;
            if earlier.fragment != fragment && !is_before && !earlier.is_alone && conflicts(earlier.footprint) {
                let is_able = earlier.able >> fragment & 1 == 1;
                earlier.to_follow |= if is_able { 1 << fragment } else { earlier.able };
            }
        }
    }

    /// Takes the next step in the topmost state.
    fn take(&mut self, top: usize, property: &mut dyn Property) -> Result<(), Undecided> {
        let visit = &mut self.stack[top];
        let (fragment, choice, number) = (visit.fragment, visit.choice, visit.number);
        visit.choice += 1;
        let stepped = match self.context.step(&mut self.machine, &visit.state, fragment, choice) {
            Ok(stepped) => stepped,
            Err(error) => return Err(self.failed(FailureKind::Step(fragment, error))),
        };
        let visit = &self.stack[top];
        if stepped.state.words != visit.state.words
            && let Some(text) = property.instant(&stepped.state.words)
        {
            return Err(self.failed(FailureKind::Instant(text)));
        }
        let count = visit.state.fragments.len();
        let mut clocks = visit.clocks.clone();
        clocks[fragment * count..(fragment + 1) * count].copy_from_slice(&visit.clock);
        let (next, is_new) = self.visit(stepped.state, &clocks, Some(fragment));
        self.graph.connect(number, next, stepped.has_effect);
        let is_done = self.depths[next as usize] == DONE;
        let visit = &mut self.stack[top];
        visit.has_moved |= next != number;
        visit.has_effect = stepped.has_effect;
        visit.has_exit |= is_new || is_done;
        match self.depths[next as usize] {
            _ if is_new || next == number => {}
            DONE => self.pass_known(top, next, &clocks),
            depth => self.close_cycle(top, depth as usize),
        }
        Ok(())
    }

    /// Returns a failure of the step that is taken.
    fn failed(&self, kind: FailureKind) -> Undecided {
        let steps = self.stack.iter().map(|visit| (visit.fragment, visit.choice - 1)).collect();
        Undecided(Some(Failure { steps, kind }))
    }

    /// Compares the steps after a state that has been visited with those that lead to it now.
    fn pass_known(&mut self, top: usize, next: u32, clocks: &[u32]) {
        let count = self.stack[top].state.fragments.len();
        let unknown = self.incomplete.get(&next).copied();
        for fragment in 0..count {
            let known = &clocks[fragment * count..(fragment + 1) * count];
            let summaries = &self.summaries;
            let conflicts = |earlier: Footprint| unknown.is_some() || summaries.conflicts(next, fragment, earlier);
            Self::follow_before(&mut self.stack, fragment, known, conflicts);
        }
        if let Some(depth) = unknown {
            self.depend_on(depth as usize);
        }
        self.summaries.join(self.stack[top].number, next);
    }

    /// Handles a step from the topmost state to one on the stack.
    fn close_cycle(&mut self, top: usize, depth: usize) {
        let fragment = self.stack[top].fragment;
        let is_idle = self.stack[depth..].iter().all(|visit| visit.fragment == fragment && !visit.has_effect);
        // A fragment that comes back by one choice, such as a weak exchange that fails, and goes on by another: all its steps
        // come before those of the other choice too.
        if is_idle && self.stack[top].choices > 1 {
            let returns_to = &mut self.stack[top].returns_to;
            *returns_to = Some(returns_to.map_or(depth, |other| other.min(depth)));
        } else {
            self.follow_all(depth);
        }
        self.depend_on(depth);
    }

    /// Follows every fragment in the states of a cycle: what follows them is not known when they are left.
    fn follow_all(&mut self, depth: usize) {
        for visit in &mut self.stack[depth..] {
            visit.is_alone = false;
            visit.to_follow |= visit.able;
        }
    }

    /// Records that what follows the states above a depth is not known before the state there is left.
    fn depend_on(&mut self, depth: usize) {
        for visit in &mut self.stack[depth + 1..] {
            visit.depends_on = visit.depends_on.min(depth as u32);
        }
    }

    /// Leaves the topmost state.
    fn leave(&mut self) {
        let Some(visit) = self.stack.pop() else { return };
        self.depths[visit.number as usize] = DONE;
        match self.stack.get_mut(visit.depends_on as usize) {
            Some(lower) => {
                for state in visit.dependents.into_iter().chain([visit.number]) {
                    self.incomplete.insert(state, visit.depends_on);
                    lower.dependents.push(state);
                }
            }
            None => {
                for state in visit.dependents {
                    self.summaries.join(state, visit.number);
                    self.incomplete.remove(&state);
                }
            }
        }
        if let Some(parent) = self.stack.last() {
            self.summaries.join(parent.number, visit.number);
        }
    }
}

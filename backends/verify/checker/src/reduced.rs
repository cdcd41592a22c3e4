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

use crate::context::SearchContext;
use crate::explore::explore;
use crate::fingerprint::{Identity, fingerprint};
use crate::footprint::{Footprint, Summaries};
use crate::graph::StateGraph;
use crate::reduction::independent;
use crate::runner::Runner;
use crate::search::{Failure, FailureKind, Property, SearchResult, Step};
use crate::state::{State, Status};
use crate::trail::Trail;
use crate::turn::Allowance;
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
    let (found, result) = ReducedSearch::new(context, property, first.fragments.len()).search(&first, property, limit);
    let found = match found {
        None => return result,
        Some(Undecided(found)) => found,
    };
    // The steps of a failure are an execution, so it needs no confirmation. A loop that is too long decides nothing.
    let found = match found {
        Some(failure) if !context.wants_shortest && !failure.is_undecided() => {
            return SearchResult { is_exhaustive: true, failure: Some(failure), ..result };
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
    runner: Runner<'p>,
    watched: WatchedWords,
    numbers: HashMap<u128, u32, BuildHasherDefault<Identity>>,
    /// Per state, its depth in the stack, or [`DONE`].
    depths: Vec<u32>,
    /// The states that were left while a cycle leads from them to a state on the stack, and its depth. Their summaries are not
    /// complete before that state is left.
    incomplete: HashMap<u32, u32>,
    graph: StateGraph,
    /// Whether steps lead from a state to itself by way of another.
    has_cycle: bool,
    summaries: Summaries,
    /// The states on the way to the present one.
    stack: Vec<Visit>,
    /// The steps that are followed in those states.
    trail: Trail,
    fragments: usize,
    result: SearchResult,
}

const DONE: u32 = u32::MAX;

/// A state on the stack.
struct Visit {
    state: State,
    number: u32,
    /// The fragments that were followed, a bit each.
    followed: u32,
    /// The next choice of the step that is followed, and the number of choices.
    choice: u32,
    choices: u32,
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

impl<'a, 'p> ReducedSearch<'a, 'p> {
    fn new(context: &'a SearchContext<'p>, property: &dyn Property, fragments: usize) -> Self {
        ReducedSearch {
            context,
            runner: Runner::new(context),
            watched: WatchedWords::new(context, property),
            numbers: HashMap::default(),
            depths: Vec::new(),
            incomplete: HashMap::new(),
            graph: StateGraph::default(),
            has_cycle: false,
            summaries: Summaries::new(fragments),
            stack: Vec::new(),
            trail: Trail::new(fragments),
            fragments,
            result: SearchResult::default(),
        }
    }

    /// Searches from `first`. Also returns whether the search of all interleavings must decide.
    fn search(mut self, first: &State, property: &mut dyn Property, limit: usize) -> (Option<Undecided>, SearchResult) {
        self.visit(first.clone(), None);
        let end = self.run(property, &mut Allowance::new(self.context.turn.as_ref(), limit));
        let undecided = match end {
            Ok(is_exhaustive) => {
                self.result.is_exhaustive = is_exhaustive;
                // Without a cycle every state leads to a final state.
                let is_endless = is_exhaustive && self.has_cycle && self.graph.endless().is_some();
                is_endless.then_some(Undecided(None))
            }
            Err(undecided) => Some(undecided),
        };
        (undecided, self.result)
    }

    /// Pushes a state, unless it has been visited; returns its number and whether it is new. `last`: the step that leads to it is
    /// that of the topmost state, by this fragment.
    fn visit(&mut self, state: State, last: Option<usize>) -> (u32, bool) {
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
        let able = running.iter().copied().filter(|fragment| self.context.choices(&state, *fragment) > 0);
        let able: u32 = able.map(|fragment| 1 << fragment).sum();
        let alone = independent(self.context, &self.watched, &state, &running).map(|(fragment, _)| fragment);
        let first = alone.map(|fragment| 1 << fragment);
        let first = first.or(last.map(|last| able & 1 << last).filter(|last| *last != 0));
        self.trail.push(able, first.unwrap_or(able & able.wrapping_neg()), alone.is_some());
        self.stack.push(Visit {
            number,
            followed: 0,
            choice: 0,
            choices: 0,
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
    fn run(&mut self, property: &mut dyn Property, allowance: &mut Allowance<'_>) -> Result<bool, Undecided> {
        while let Some(top) = self.stack.len().checked_sub(1) {
            if top > DEEPEST {
                return Err(Undecided(None));
            }
            if self.trail.steps[top].able == 0 && self.stack[top].has_moved {
                self.end(top, property)?;
            }
            if self.stack[top].choice < self.stack[top].choices {
                self.take(top, property)?;
                if allowance.is_used_up(self.result.states) {
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
        let steps = self.steps_to(top);
        self.result.record(verdict, &words, || steps).map_or(Ok(()), |failure| Err(Undecided(Some(failure))))
    }

    /// Begins with the steps of the next fragment to follow in the topmost state; returns whether there is one.
    fn begin_next(&mut self, top: usize) -> Result<bool, Undecided> {
        if let Some(depth) = self.stack[top].returns_to.take()
            && !self.stack[top].has_exit
        {
            // What follows these states is not known when they are left.
            self.trail.follow_all(depth);
        }
        let (visit, trail) = (&mut self.stack[top], &mut self.trail.steps[top]);
        // A fragment that has only waited decides nothing.
        if trail.to_follow & !visit.followed == 0 && !visit.has_moved {
            trail.is_alone = false;
            match trail.able & !visit.followed {
                0 => return Err(Undecided(None)),
                others => trail.to_follow |= 1 << others.trailing_zeros(),
            }
        }
        let remaining = trail.to_follow & !visit.followed;
        if remaining == 0 {
            return Ok(false);
        }
        let fragment = remaining.trailing_zeros() as usize;
        let Status::Before { stop, .. } = &visit.state.fragments[fragment] else { return Err(Undecided(None)) };
        let footprint = Footprint::new(self.context, fragment, &stop.event, &self.watched);
        visit.followed |= 1 << fragment;
        visit.choice = 0;
        visit.choices = self.context.choices(&visit.state, fragment);
        let is_helper = self.context.helper == Some(fragment);
        if is_helper && self.context.helper_waits(&mut self.runner, &self.stack[top].state, fragment) {
            return Err(Undecided(None));
        }
        self.trail.follow(fragment, footprint);
        self.summaries.add(self.stack[top].number, fragment, footprint);
        Ok(true)
    }

    /// Returns the steps that lead to the state at a depth.
    fn steps_to(&self, depth: usize) -> Vec<Step> {
        let steps = self.stack[..depth].iter().zip(&self.trail.steps);
        steps.map(|(visit, trail)| (usize::from(trail.fragment), visit.choice - 1)).collect()
    }

    /// Takes the next step in the topmost state.
    fn take(&mut self, top: usize, property: &mut dyn Property) -> Result<(), Undecided> {
        let fragment = usize::from(self.trail.steps[top].fragment);
        let visit = &mut self.stack[top];
        let (choice, number) = (visit.choice, visit.number);
        visit.choice += 1;
        let stepped = match self.context.step(&mut self.runner, &visit.state, fragment, choice) {
            Ok(stepped) => stepped,
            Err(error) => return Err(self.failed(FailureKind::Step(fragment, error))),
        };
        let visit = &self.stack[top];
        if stepped.state.words != visit.state.words
            && let Some(text) = property.instant(&stepped.state.words)
        {
            return Err(self.failed(FailureKind::Instant(text)));
        }
        let (next, is_new) = self.visit(stepped.state, Some(fragment));
        self.graph.connect(number, next, stepped.has_effect);
        let is_done = self.depths[next as usize] == DONE;
        let visit = &mut self.stack[top];
        visit.has_moved |= next != number;
        visit.has_effect = stepped.has_effect;
        visit.has_exit |= is_new || is_done;
        match self.depths[next as usize] {
            _ if is_new || next == number => {}
            DONE => self.pass_known(top, next),
            depth => self.close_cycle(top, depth as usize),
        }
        Ok(())
    }

    /// Returns a failure of the step that is taken.
    fn failed(&self, kind: FailureKind) -> Undecided {
        Undecided(Some(Failure { steps: self.steps_to(self.stack.len()), kind }))
    }

    /// Compares the steps after a state that has been visited with those that lead to it now.
    fn pass_known(&mut self, top: usize, next: u32) {
        let unknown = self.incomplete.get(&next).copied();
        for fragment in 0..self.fragments {
            let summaries = &self.summaries;
            if unknown.is_some() || summaries.has_steps(next, fragment) {
                let conflicts = |earlier: Footprint| unknown.is_some() || summaries.conflicts(next, fragment, earlier);
                self.trail.follow_later(fragment, conflicts);
            }
        }
        if let Some(depth) = unknown {
            self.depend_on(depth as usize);
        }
        self.summaries.join(self.stack[top].number, next);
    }

    /// Handles a step from the topmost state to one on the stack.
    fn close_cycle(&mut self, top: usize, depth: usize) {
        self.has_cycle = true;
        let fragment = self.trail.steps[top].fragment;
        let mut steps = self.stack[depth..].iter().zip(&self.trail.steps[depth..]);
        let is_idle = steps.all(|(visit, trail)| trail.fragment == fragment && !visit.has_effect);
        // A fragment that comes back by one choice, such as a weak exchange that fails, and goes on by another: all its steps
        // come before those of the other choice too.
        if is_idle && self.stack[top].choices > 1 {
            let returns_to = &mut self.stack[top].returns_to;
            *returns_to = Some(returns_to.map_or(depth, |other| other.min(depth)));
        } else {
            // What follows these states is not known when they are left.
            self.trail.follow_all(depth);
        }
        self.depend_on(depth);
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
        self.trail.pop();
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

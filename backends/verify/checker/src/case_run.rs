//! Runs one case: sets memory to the initial state, starts the fragments and checks every final state.
//!
//! Input: a subject and a case. Output: the result of the search. Where a loop returns the frame to the pass under test,
//! every final state of one iteration is the first state of a search of the next.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use crate::case_setup::{CaseSetup, SearchOptions};
use crate::context::SearchContext;
use crate::explore::explore;
use crate::final_state::FinalStateProperty;
use crate::fragments::at_pixel;
use crate::frame::Frame;
use crate::memory::Memory;
use crate::model::Model;
use crate::random_walk::walk;
use crate::reduced::explore_reduced;
use crate::search::{Failure, FailureKind, Property, SearchResult, StateVerdict, Step};
use crate::sequential::machine_with;
use crate::state::{State, StepError};
use crate::turn::Turn;

/// A case, and the iterations of its pass.
pub(crate) struct CaseRun<'s> {
    pub(crate) setup: CaseSetup<'s>,
    pub(crate) iterations: Vec<Iteration<'s>>,
    turn: Turn,
}

/// One iteration of the pass under test.
pub(crate) struct Iteration<'s> {
    pub(crate) context: SearchContext<'s>,
    pub(crate) first: Result<State, (usize, StepError)>,
    /// The iteration before, and its steps.
    pub(crate) before: Option<(usize, Vec<Step>)>,
    /// The frame before the pass.
    pub(crate) frame: Frame<'s>,
}

/// The result of all searches of a case.
pub(crate) struct CaseResult {
    pub(crate) states: usize,
    pub(crate) is_exhaustive: bool,
    /// The first failure and its iteration.
    pub(crate) failure: Option<(usize, Failure)>,
    /// The first wrong final state that the declared hazards permit.
    pub(crate) hazard: Option<(usize, Failure)>,
}

/// A property of which the first declared hazard is a failure, so that a search finds the shortest schedule of one.
struct FirstHazard<'a> {
    property: &'a mut dyn Property,
    /// Whether it was found. Otherwise the failure is another one.
    is_found: bool,
}

/// The result of a search for the shortest schedule of a declared hazard.
#[derive(Default)]
pub(crate) struct HazardSearch {
    pub(crate) states: usize,
    /// The hazard, or another failure that was found first.
    pub(crate) failure: Option<Failure>,
    /// Whether it is a hazard.
    pub(crate) is_found: bool,
    pub(crate) has_forgotten: bool,
}

impl Property for FirstHazard<'_> {
    fn instant(&mut self, words: &[u32]) -> Option<String> {
        self.property.instant(words)
    }

    fn watched(&self) -> Vec<Range<usize>> {
        self.property.watched()
    }

    fn final_state(&mut self, words: &[u32]) -> StateVerdict {
        match self.property.final_state(words) {
            StateVerdict::Hazard(text) => {
                self.is_found = true;
                StateVerdict::Wrong(text)
            }
            other => other,
        }
    }
}

impl<'s> CaseRun<'s> {
    /// Runs everything that comes before the fragments under test.
    pub(crate) fn new(setup: CaseSetup<'s>, options: &SearchOptions, turn: Turn) -> Result<Self, String> {
        let frame = setup.frame()?;
        let mut run = CaseRun { setup, iterations: Vec::new(), turn };
        run.begin(frame, None, options)?;
        Ok(run)
    }

    /// Starts the fragments of the pass under test, which is the next of the frame.
    fn begin(
        &mut self,
        mut frame: Frame<'s>,
        before: Option<(usize, Vec<Step>)>,
        options: &SearchOptions,
    ) -> Result<(), String> {
        let CaseSetup { subject, case, .. } = &self.setup;
        let runnable = self.setup.runnable();
        for inputs in self.setup.inputs(runnable, &[]) {
            frame.insert(runnable, &inputs)?;
        }
        let (mut context, words) = SearchContext::new(&runnable.program, &frame.memory, options.model);
        context.has_fences &= subject.has_fences;
        context.by_submission = subject.has_ordered_interlock;
        context.one_by_one = options.one_by_one;
        context.is_reduced = options.is_reduced;
        context.wants_shortest = options.wants_shortest;
        context.has_weak_exchange = subject.has_weak_exchange && options.model == Model::Relaxed;
        context.counts_samples = runnable.is_awaited;
        context.turn = Some(self.turn.clone());
        context.helper = case.has_helper.then(|| case.new.len() - 1);
        let new = case.new.iter().map(|fragment| at_pixel(fragment, &runnable.program, case.pixel));
        let machines = new.map(|fragment| machine_with(&runnable.program, &fragment.inputs)).collect();
        let first = context.start(words, machines);
        self.iterations.push(Iteration { context, first, before, frame });
        Ok(())
    }

    /// Searches every iteration.
    pub(crate) fn run(&mut self, options: &SearchOptions) -> Result<CaseResult, String> {
        let mut result = CaseResult { states: 0, is_exhaustive: true, failure: None, hazard: None };
        let mut known: HashSet<(Memory, Vec<Vec<u32>>)> = HashSet::new();
        let pixel = self.setup.case.pixel;
        let mut at = 0;
        while at < self.iterations.len() && result.failure.is_none() {
            let (found, frames) = self.search(at, options);
            result.states += found.states;
            result.is_exhaustive &= found.is_exhaustive;
            result.failure = found.failure.map(|failure| (at, failure));
            result.hazard = result.hazard.or(found.hazard.map(|failure| (at, failure)));
            for (words, steps) in found.next_iterations {
                let Some(frame) = frames.get(&words).filter(|frame| {
                    let state = (frame.memory.clone(), frame.gathered(pixel).to_vec());
                    known.insert(state)
                }) else {
                    continue;
                };
                self.begin(frame.clone(), Some((at, steps)), options)?;
            }
            at += 1;
        }
        Ok(result)
    }

    /// Searches one iteration. Also returns, by the words of each final state that is followed by another iteration, the
    /// frame before that iteration.
    fn search(&self, at: usize, options: &SearchOptions) -> (SearchResult, HashMap<Vec<u32>, Frame<'s>>) {
        let iteration = &self.iterations[at];
        let context = &iteration.context;
        let first = match &iteration.first {
            Err((fragment, error)) => {
                let failure = Some(Failure { steps: Vec::new(), kind: FailureKind::Step(*fragment, *error) });
                let result = SearchResult { states: 1, is_exhaustive: true, failure, ..SearchResult::default() };
                return (result.decided(), HashMap::new());
            }
            Ok(first) => first,
        };
        let mut property = FinalStateProperty::new(&self.setup, context, iteration.frame.clone());
        let result = match options.random_schedules {
            Some(count) => walk(context, first, &mut property, count),
            None => explore_reduced(context, first.clone(), &mut property, options.limit),
        };
        let mut result = result.decided();
        result.is_exhaustive &= !context.has_forgotten.get();
        (result, property.next_iterations)
    }

    /// Searches for the shortest schedule of a declared hazard in one iteration.
    pub(crate) fn shortest_hazard(&self, at: usize, limit: usize) -> HazardSearch {
        let iteration = &self.iterations[at];
        let context = &iteration.context;
        let Ok(first) = &iteration.first else { return HazardSearch::default() };
        let mut property = FinalStateProperty::new(&self.setup, context, iteration.frame.clone());
        let mut first_hazard = FirstHazard { property: &mut property, is_found: false };
        let result = explore(context, first.clone(), &mut first_hazard, limit);
        let is_found = first_hazard.is_found;
        HazardSearch {
            states: result.states,
            failure: result.failure,
            is_found,
            has_forgotten: context.has_forgotten.get(),
        }
    }
}
